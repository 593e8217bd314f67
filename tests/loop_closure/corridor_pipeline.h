// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
//
// The stages of loop closure in a corridor, for tests.
#ifndef TESTS_LOOP_CLOSURE_CORRIDOR_PIPELINE_H_
#define TESTS_LOOP_CLOSURE_CORRIDOR_PIPELINE_H_

#include <cmath>
#include <memory>

#include "cartographer_ext/loop_closure/decision_record.h"
#include "cartographer_ext/loop_closure/loop_pipeline.h"
#include "gtest/gtest.h"

namespace cartographer_ext {
namespace loop_closure {

// A corridor from (0, -1) to (40, 1); its ends are closed. With `wide` the
// middle is twice as wide to the left.
inline OccupancyView Corridor(bool wide) {
  constexpr double kResolution = 0.1;
  constexpr double kLength = 40.;  // metres
  const int nx = static_cast<int>(std::lround(kLength / kResolution));
  const int ny = 32;
  OccupancyView view(Eigen::Vector2d(0., -1.1), kResolution, nx, ny);
  for (int i = 0; i < nx; ++i) {
    const double x = (i + 0.5) * kResolution;
    const int top = wide && x > 10. && x < 30. ? 31 : 21;
    for (int j = 0; j < ny; ++j) {
      const bool wall = j == 0 || j >= top || i == 0 || i == nx - 1;
      view.Set(i, j, wall ? CellState::kOccupied : CellState::kFree);
    }
  }
  return view;
}

// Forth and back through the corridor, a node every half metre; submap s has
// its origin at x = 5 s and is seen on the way forth.
class LoopPipelineTest : public testing::Test {
 protected:
  LoopPipelineTest() : world_(Corridor(true)), other_(Corridor(false)) {
    options_.compatible_subset.single_strong_enabled = false;
    // The robot turns round in one step.
    options_.path_noise.jump_threshold_radians = 4.;
    options_.temporal.comparison.comparison = ScanComparison::kSectors;
    options_.fusion.mode = FusionMode::kAsPrinted;
  }

  static Pose2 True(int i) {
    return i <= 76 ? Pose2(1. + 0.5 * i, 0., 0.)
                   : Pose2(39. - 0.5 * (i - 76), 0., kPi);
  }

  void MakePipeline() {
    pipeline_.reset(
        new LoopPipeline(options_, ConstraintWeights{1000., 2000.}));
    for (int i = 0; i <= 152; ++i) {
      HistoryNode node;
      node.node_index = i;
      node.local_pose = True(i);
      node.signature = PredictSignature(pipeline_->temporal_options().signature,
                                        world_, True(i));
      EXPECT_TRUE(pipeline_->AddNode(0, node));
    }
  }

  // Node `i` found in submap `s`, wrong by `offset` metres. `map` is what the
  // submap shows, in the world's frame.
  LoopCandidate Candidate(int s, int i, double offset,
                          const OccupancyView* map) {
    LoopCandidate candidate;
    candidate.submap = uncertainty::SubmapId{0, s};
    candidate.node = uncertainty::NodeId{0, i};
    candidate.submap_local_pose = Pose2(5. * s, 0., 0.);
    candidate.match.refined =
        Pose2(offset, 0., 0.) * Between(candidate.submap_local_pose, True(i));
    candidate.match.found = true;
    candidate.match.has_pose = true;
    candidate.match.score = 0.7;
    candidate.maps = {{map, candidate.submap_local_pose}};
    return candidate;
  }

  proto::LoopDecision Record(const LoopCandidate& candidate) const {
    return MakeDecisionRecord(candidate, options_.log_times);
  }

  OccupancyView world_;
  OccupancyView other_;
  LoopOptions options_;
  std::unique_ptr<LoopPipeline> pipeline_;
};

}  // namespace loop_closure
}  // namespace cartographer_ext

#endif  // TESTS_LOOP_CLOSURE_CORRIDOR_PIPELINE_H_
