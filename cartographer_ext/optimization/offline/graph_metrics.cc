// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
#include "cartographer_ext/optimization/offline/graph_metrics.h"

#include <cmath>
#include <cstdint>
#include <limits>

#include "cartographer_ext/optimization/solvers/kernels.h"
#include "glog/logging.h"

namespace cartographer_ext {
namespace optimization {

Pose2 Align(const std::vector<Pose2>& estimate,
            const std::vector<Pose2>& reference) {
  CHECK_EQ(estimate.size(), reference.size());
  if (estimate.empty()) return Pose2();
  Eigen::Vector2d mean_estimate = Eigen::Vector2d::Zero();
  Eigen::Vector2d mean_reference = Eigen::Vector2d::Zero();
  for (size_t i = 0; i != estimate.size(); ++i) {
    mean_estimate += estimate[i].translation();
    mean_reference += reference[i].translation();
  }
  mean_estimate /= estimate.size();
  mean_reference /= reference.size();
  double dot = 0., cross = 0.;
  for (size_t i = 0; i != estimate.size(); ++i) {
    const Eigen::Vector2d a = estimate[i].translation() - mean_estimate;
    const Eigen::Vector2d b = reference[i].translation() - mean_reference;
    dot += a.dot(b);
    cross += a.x() * b.y() - a.y() * b.x();
  }
  const Pose2 rotation(0., 0., std::atan2(cross, dot));
  const Eigen::Vector2d translation = mean_reference - rotation * mean_estimate;
  return Pose2(translation.x(), translation.y(), rotation.theta);
}

double AbsoluteTrajectoryError(const std::vector<Pose2>& estimate,
                               const std::vector<Pose2>& reference) {
  if (estimate.empty()) return 0.;
  const Pose2 alignment = Align(estimate, reference);
  double sum = 0.;
  for (size_t i = 0; i != estimate.size(); ++i) {
    sum += (alignment * estimate[i].translation() - reference[i].translation())
               .squaredNorm();
  }
  return std::sqrt(sum / estimate.size());
}

std::vector<int> AssociateByPath(const std::vector<Pose2>& estimate,
                                 const std::vector<Pose2>& reference) {
  constexpr int kRounds = 4;
  const int rows = estimate.size(), columns = reference.size();
  std::vector<int> result(rows, 0);
  if (rows == 0 || columns == 0) return result;
  Pose2 alignment = reference[0] * estimate[0].Inverse();
  // Best cost of reaching (i, j), and where from: 0 both, 1 estimate, 2
  // reference.
  std::vector<double> previous(columns), current(columns);
  std::vector<uint8_t> from(static_cast<size_t>(rows) * columns);
  for (int round = 0; round != kRounds; ++round) {
    for (int i = 0; i != rows; ++i) {
      const Eigen::Vector2d point = alignment * estimate[i].translation();
      uint8_t* const from_row = &from[static_cast<size_t>(i) * columns];
      for (int j = 0; j != columns; ++j) {
        double best =
            i == 0 && j == 0 ? 0. : std::numeric_limits<double>::infinity();
        if (i > 0 && j > 0) {
          best = previous[j - 1];
          from_row[j] = 0;
        }
        if (i > 0 && previous[j] < best) {
          best = previous[j];
          from_row[j] = 1;
        }
        if (j > 0 && current[j - 1] < best) {
          best = current[j - 1];
          from_row[j] = 2;
        }
        current[j] = best + (point - reference[j].translation()).squaredNorm();
      }
      previous.swap(current);
    }
    for (int i = rows - 1, j = columns - 1; i > 0 || j > 0;) {
      result[i] = j;
      const uint8_t step = from[static_cast<size_t>(i) * columns + j];
      if (step != 2) --i;
      if (step != 1) --j;
    }
    result[0] = 0;
    std::vector<Pose2> matched;
    for (const int j : result) matched.push_back(reference[j]);
    alignment = Align(estimate, matched);
  }
  return result;
}

double RelativePoseError(const std::vector<PoseGraphEdge>& edges,
                         const std::vector<Pose2>& estimate,
                         const std::vector<Pose2>& reference) {
  double sum = 0.;
  int count = 0;
  for (const PoseGraphEdge& edge : edges) {
    if (edge.is_loop) continue;
    const Pose2 a = Between(estimate[edge.from], estimate[edge.to]);
    const Pose2 b = Between(reference[edge.from], reference[edge.to]);
    sum += (a.translation() - b.translation()).squaredNorm();
    ++count;
  }
  return count == 0 ? 0. : sum / count;
}

LoopScore ScoreLoops(const std::vector<WhitenedEdge>& edges,
                     const size_t first_outlier,
                     const std::vector<Pose2>& estimate,
                     const std::vector<Pose2>& reference) {
  std::vector<bool> accepted;
  for (const WhitenedEdge& edge : edges) {
    accepted.push_back(Chi2(edge, estimate[edge.from], estimate[edge.to]) <
                       kChi2Gate);
  }
  return ScoreLoops(edges, first_outlier, accepted, reference);
}

LoopScore ScoreLoops(const std::vector<WhitenedEdge>& edges,
                     const size_t first_outlier,
                     const std::vector<bool>& accepted,
                     const std::vector<Pose2>& reference) {
  LoopScore score;
  for (size_t i = 0; i != edges.size(); ++i) {
    const WhitenedEdge& edge = edges[i];
    if (!edge.is_loop) continue;
    const bool fits_reference =
        Chi2(edge, reference[edge.from], reference[edge.to]) < kChi2Gate;
    score.accepted += accepted[i];
    if (i < first_outlier) {
      ++score.true_total;
      score.true_accepted += accepted[i];
    } else {
      score.false_accepted += accepted[i] && !fits_reference;
    }
  }
  if (score.accepted > 0) {
    score.precision =
        1. - static_cast<double>(score.false_accepted) / score.accepted;
  }
  if (score.true_total > 0) {
    score.recall = static_cast<double>(score.true_accepted) / score.true_total;
  }
  return score;
}

}  // namespace optimization
}  // namespace cartographer_ext
