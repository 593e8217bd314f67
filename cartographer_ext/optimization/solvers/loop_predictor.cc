// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
#include "cartographer_ext/optimization/solvers/loop_predictor.h"

#include <algorithm>
#include <utility>

#include "cartographer_ext/optimization/solvers/block_kernels.h"

namespace cartographer_ext {
namespace optimization {
namespace {

constexpr int kWidth = 3 * LoopPredictor::kAtOnce;
static_assert(kWidth == kPathWidth, "as wide as the kernel");

}  // namespace

// Loops on their way to the root.
struct LoopPredictor::Walk {
  struct Path {
    int column;
    int loops;  // bits
  };
  std::vector<Path> paths;  // in different columns
  LoopPrediction* predictions[kAtOnce];
};

LoopPredictor::LoopPredictor(const std::vector<WhitenedEdge>& edges,
                             const std::vector<Pose2>& poses,
                             const BlockLdlt& factor)
    : edges_(edges),
      poses_(poses),
      factor_(factor),
      rows_(static_cast<size_t>(3) * kWidth * factor.size(), 0.) {}

std::vector<LoopPrediction> LoopPredictor::Predict(
    const std::vector<int>& loops) {
  std::vector<LoopPrediction> result(loops.size());
  // Neighbours in the order of elimination soon meet.
  std::vector<std::pair<int, int>> order;
  for (size_t i = 0; i != loops.size(); ++i) {
    order.push_back({FirstColumn(edges_[loops[i]]), i});
  }
  std::sort(order.begin(), order.end());
  for (size_t begin = 0; begin < loops.size(); begin += kAtOnce) {
    const size_t count = std::min<size_t>(kAtOnce, loops.size() - begin);
    Walk walk;
    for (size_t k = 0; k != count; ++k) {
      const int i = order[begin + k].second;
      const WhitenedEdge& edge = edges_[loops[i]];
      Eigen::Matrix3d of_from, of_to;
      result[i].residual =
          Linearize(edge, poses_[edge.from], poses_[edge.to], &of_from, &of_to);
      walk.predictions[k] = &result[i];
      Start(edge.from, of_from, k, &walk);
      Start(edge.to, of_to, k, &walk);
    }
    Run(&walk);
  }
  return result;
}

int LoopPredictor::FirstColumn(const WhitenedEdge& edge) const {
  int result = factor_.size();
  for (const int pose : {edge.from, edge.to}) {
    if (pose > 0) result = std::min(result, factor_.position()[pose - 1]);
  }
  return result;
}

void LoopPredictor::Start(const int pose, const Eigen::Matrix3d& jacobian,
                          const int loop, Walk* const walk) {
  if (pose == 0) return;
  const int column = factor_.position()[pose - 1];
  double* const values = rows_.data() + 3 * kWidth * column + 3 * loop;
  for (int r = 0; r != 3; ++r) {
    for (int c = 0; c != 3; ++c) values[kWidth * r + c] = jacobian(c, r);
  }
  for (Walk::Path& path : walk->paths) {
    if (path.column != column) continue;
    path.loops |= 1 << loop;
    return;
  }
  walk->paths.push_back({column, 1 << loop});
}

void LoopPredictor::Run(Walk* const walk) {
  const BlockKernels& kernels = BestBlockKernels();
  std::vector<Walk::Path>& paths = walk->paths;
  double head[3 * kWidth];
  Eigen::Matrix3d head_of_loop;
  while (!paths.empty()) {
    // The first column of all.
    Walk::Path& path =
        *std::min_element(paths.begin(), paths.end(),
                          [](const Walk::Path& a, const Walk::Path& b) {
                            return a.column < b.column;
                          });
    const int j = path.column, start = factor_.start(j);
    const int count = factor_.start(j + 1) - start;
    double* const values = rows_.data() + 3 * kWidth * j;
    std::copy_n(values, 3 * kWidth, head);
    std::fill_n(values, 3 * kWidth, 0.);
    for (int loop = 0; loop != kAtOnce; ++loop) {
      if ((path.loops >> loop & 1) == 0) continue;
      for (int r = 0; r != 3; ++r) {
        for (int c = 0; c != 3; ++c) {
          head_of_loop(r, c) = head[kWidth * r + 3 * loop + c];
        }
      }
      LoopPrediction& prediction = *walk->predictions[loop];
      kernels.predict_column(head_of_loop, factor_.pivot_inverse(j), nullptr, 0,
                             nullptr, &prediction.covariance, nullptr);
      prediction.blocks += count + 1;
    }
    if (count == 0) {
      path = paths.back();
      paths.pop_back();
      continue;
    }
    kernels.predict_rows(head, &factor_.block(start), factor_.rows(start),
                         count, rows_.data());
    // On to the parent, where other paths may be.
    path.column = factor_.row(start);
    for (Walk::Path& other : paths) {
      if (&other == &path || other.column != path.column) continue;
      other.loops |= path.loops;
      path = paths.back();
      paths.pop_back();
      break;
    }
  }
}

}  // namespace optimization
}  // namespace cartographer_ext
