// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
//
// The linear systems of the solver: their pattern and their values.
#include "cartographer_ext/optimization/solvers/robust_solver.h"

namespace cartographer_ext {
namespace optimization {
namespace {

// Loops with so many times the weight that counts may count soon; if they are
// few, a new pattern has room for them.
constexpr double kRoom = 1e-2;
// Edges that may leave or enter before the order of elimination is worked out
// anew, besides one loop in fifty, and by how much the factor may grow until
// then.
constexpr size_t kFewChanges = 5;
constexpr double kMaxGrowth = 1.1;

// Adds to the three values of a variable.
void AddToVector(const int variable, const double x, const double y,
                 const double theta, Eigen::VectorXd* const sum) {
  double* const values = sum->data() + 3 * variable;
  values[0] += x;
  values[1] += y;
  values[2] += theta;
}

}  // namespace

// Chooses the edges of the linear systems; true when they were analysed anew.
bool RobustSolver::UpdatePattern(const std::vector<double>& weights) {
  if (!analysed_) in_pattern_.assign(edges_.size(), false);
  std::vector<int> wanted, entering, near;
  size_t dead = 0, near_inside = 0, loops = 0;
  for (size_t i = 0; i != edges_.size(); ++i) {
    if (!edges_[i].is_loop || !options_.prune ||
        weights[i] >= options_.prune_weight) {
      wanted.push_back(i);
      loops += edges_[i].is_loop;
      if (!in_pattern_[i]) entering.push_back(i);
    } else if (weights[i] >= kRoom * options_.prune_weight) {
      near.push_back(i);
      near_inside += in_pattern_[i];
    } else {
      dead += in_pattern_[i];
    }
  }
  const size_t few = kFewChanges + loops / 50;
  if (near.size() > few) {
    near.clear();
    dead += near_inside;
  }
  // A few dead edges cost less than a new analysis, and so does a new edge that
  // needs no more fill.
  if (analysed_ && dead <= few) {
    if (entering.empty()) return false;
    std::vector<std::pair<int, int>> pairs;
    for (const int i : entering) {
      if (edges_[i].from > 0 && edges_[i].to > 0) {
        pairs.push_back({edges_[i].from - 1, edges_[i].to - 1});
      }
    }
    if (factor_.Extend(pairs)) {
      AddToPattern(entering, nullptr);
      return false;
    }
  }
  // Much the same pattern has much the same best order.
  const bool reorder = !analysed_ || dead + entering.size() > few;
  analysed_ = true;
  in_pattern_.assign(edges_.size(), false);
  pattern_.clear();
  num_pairs_ = 0;
  wanted.insert(wanted.end(), near.begin(), near.end());
  std::vector<std::pair<int, int>> pairs;
  AddToPattern(wanted, &pairs);
  std::vector<int> groups;
  if (last_pose_last_ && poses_.size() > 2) {
    groups.assign(poses_.size() - 1, 0);
    groups.back() = 1;
  }
  if (reorder) {
    factor_.Analyze(poses_.size() - 1, pairs, groups);
    ordered_blocks_ = factor_.num_blocks();
  } else {
    factor_.AnalyzeInOrder(pairs);
    if (factor_.num_blocks() > kMaxGrowth * ordered_blocks_) {
      factor_.Analyze(poses_.size() - 1, pairs, groups);
      ordered_blocks_ = factor_.num_blocks();
    }
  }
  return true;
}

void RobustSolver::AddToPattern(const std::vector<int>& edges,
                                std::vector<std::pair<int, int>>* const pairs) {
  for (const int i : edges) {
    in_pattern_[i] = true;
    const int a = edges_[i].from - 1, b = edges_[i].to - 1;
    if (a >= 0 && b >= 0) {
      pattern_.push_back({i, num_pairs_++});
      if (pairs != nullptr) pairs->push_back({a, b});
    } else {
      pattern_.push_back({i, -1});
    }
  }
}

void RobustSolver::Assemble(const std::vector<double>& weights) {
  const int size = poses_.size() - 1;
  gradient_.setZero(3 * size);
  diagonal_.setZero(3 * size);
  factor_.SetZero();
  for (const std::pair<int, int>& entry : pattern_) {
    const double weight = weights[entry.first];
    if (weight != 0.) AddToSystem(edges_[entry.first], weight, entry.second);
  }
}

// With the error e in the frame of `from`, whose rotation is R, the whitened
// residual is A e and its Jacobian J_to = A diag(R', 1): J_to' J_to is the
// information A'A turned by R. J_from = -J_to T with T = [1 0 -dy; 0 1 dx; 0 0 1].
// Value by value: a block that is written by values and read by pairs waits.
void RobustSolver::AddToSystem(const WhitenedEdge& edge, const double weight,
                               const int pair) {
  const Pose2 &from = poses_[edge.from], &to = poses_[edge.to];
  const double c = rotations_[edge.from].x(), s = rotations_[edge.from].y();
  const double dx = to.x - from.x, dy = to.y - from.y;
  const auto product = [&](const int i, const int j) {
    return weight * edge.whitening.col(i).dot(edge.whitening.col(j));
  };
  const double xx = product(0, 0), xy = product(0, 1), yy = product(1, 1);
  const double xt = product(0, 2), yt = product(1, 2), tt = product(2, 2);
  const Eigen::Vector3d error = MeasurementError(edge, from, to, c, s);
  const double ex = error.x(), ey = error.y(), et = error.z();
  const double px = xx * ex + xy * ey + xt * et;
  const double py = xy * ex + yy * ey + yt * et;
  const double gx = c * px - s * py, gy = s * px + c * py;
  const double gt = xt * ex + yt * ey + tt * et;
  const double cc = c * c, cs = c * s, ss = s * s, mixed = 2. * cs * xy;
  // J_to' J_to.
  const double h00 = cc * xx - mixed + ss * yy;
  const double h11 = ss * xx + mixed + cc * yy;
  const double h10 = cs * (xx - yy) + (cc - ss) * xy;
  const double h20 = c * xt - s * yt, h21 = s * xt + c * yt;
  const int a = edge.from - 1, b = edge.to - 1;
  if (b >= 0) {
    factor_.AddDiagonal(b,
                        BlockLdlt::SymmetricBlock{h00, h10, h20, h11, h21, tt});
    AddToVector(b, h00, h11, tt, &diagonal_);
    AddToVector(b, gx, gy, gt, &gradient_);
  }
  if (a < 0) return;
  // The last row of T' J_to' J_to, whose others are those of J_to' J_to.
  const double t0 = h20 + (dx * h10 - dy * h00);
  const double t1 = h21 + (dx * h11 - dy * h10);
  const double t2 = tt + (dx * h21 - dy * h20);
  const double last = t2 + (dx * t1 - dy * t0);
  factor_.AddDiagonal(a,
                      BlockLdlt::SymmetricBlock{h00, h10, t0, h11, t1, last});
  AddToVector(a, h00, h11, last, &diagonal_);
  AddToVector(a, -gx, -gy, -(gt + dx * gy - dy * gx), &gradient_);
  if (pair >= 0) {
    factor_.AddOffDiagonal(pair, BlockLdlt::Block{-h00, -h10, -t0, -h10, -h11,
                                                  -t1, -h20, -h21, -t2});
  }
}

// Decrease of the quadratic model; costs are sums of squares without 1/2.
double RobustSolver::PredictedDecrease(const Eigen::VectorXd& step,
                                       const double lambda) const {
  return step.dot(lambda * diagonal_.cwiseProduct(step) - gradient_);
}

}  // namespace optimization
}  // namespace cartographer_ext
