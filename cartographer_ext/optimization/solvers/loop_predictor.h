// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
//
// How well a map predicts loops: the covariance J H^-1 J' of the whitened residual
// that the uncertainty of its poses leaves. With H = L D L' it is v' D^-1 v, where
// L v = J' has values along the paths from both ends of the loop to the root only.
// Paths of different loops meet, so several loops walk them together, which reads
// each column once.
#ifndef CARTOGRAPHER_EXT_OPTIMIZATION_SOLVERS_LOOP_PREDICTOR_H_
#define CARTOGRAPHER_EXT_OPTIMIZATION_SOLVERS_LOOP_PREDICTOR_H_

#include <vector>

#include "cartographer_ext/optimization/graph/pose_graph.h"
#include "cartographer_ext/optimization/solvers/block_ldlt.h"
#include "cartographer_ext/optimization/solvers/large_pages.h"

namespace cartographer_ext {
namespace optimization {

// What a map says of a loop.
struct LoopPrediction {
  Eigen::Vector3d residual = Eigen::Vector3d::Zero();    // whitened
  Eigen::Matrix3d covariance = Eigen::Matrix3d::Zero();  // J H^-1 J'
  int blocks = 0;  // of the factor that took part
};

// Predicts loops of a map. Not thread-safe.
class LoopPredictor {
 public:
  // Loops that are predicted together.
  static constexpr int kAtOnce = 4;

  // `factor` is that of the edges in force at `poses`, the first of which is fixed.
  // All have to outlive the predictor.
  LoopPredictor(const std::vector<WhitenedEdge>& edges,
                const std::vector<Pose2>& poses, const BlockLdlt& factor);

  // `loops` are edges, in force or not.
  std::vector<LoopPrediction> Predict(const std::vector<int>& loops);

 private:
  struct Walk;

  // The earlier of those of both ends.
  int FirstColumn(const WhitenedEdge& edge) const;
  void Start(int pose, const Eigen::Matrix3d& jacobian, int loop, Walk* walk);
  void Run(Walk* walk);

  const std::vector<WhitenedEdge>& edges_;
  const std::vector<Pose2>& poses_;
  const BlockLdlt& factor_;
  // v by position: three rows of three values for each of the loops. Zero between
  // walks.
  LargeVector<double> rows_;
};

}  // namespace optimization
}  // namespace cartographer_ext

#endif  // CARTOGRAPHER_EXT_OPTIMIZATION_SOLVERS_LOOP_PREDICTOR_H_
