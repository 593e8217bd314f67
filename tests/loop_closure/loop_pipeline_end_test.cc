// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
//
// The end of a run.
#include <vector>

#include "absl/types/optional.h"
#include "cartographer_ext/loop_closure/consensus/closed_prediction.h"
#include "cartographer_ext/loop_closure/loop_pipeline.h"
#include "gmock/gmock.h"
#include "gtest/gtest.h"
#include "tests/loop_closure/corridor_pipeline.h"

namespace cartographer_ext {
namespace loop_closure {
namespace {

using proto::LoopDecision;
using testing::IsEmpty;

using LoopPipelineEndTest = LoopPipelineTest;

TEST_F(LoopPipelineEndTest, LoopsAcceptedLaterPredictUndecidedOnes) {
  options_.compatible_subset.single_strong_enabled = true;
  options_.compatible_subset.single_strong_sigma = 0.;
  MakePipeline();
  LoopCandidate first = Candidate(5, 100, 0., &world_);
  LoopCandidate second = Candidate(3, 120, 0., &world_);
  for (LoopCandidate* const candidate : {&first, &second}) {
    candidate->anchor = uncertainty::NodeId{0, 30};
    // Too badly predicted for two.
    candidate->plan.translation_sigma = 2.;
  }
  pipeline_->Process(first);
  pipeline_->Process(second);
  EXPECT_THAT(pipeline_->Decide(), IsEmpty());
  double sigma = 3.;
  double offset = 0.;
  const PathBetween path_between = [&](const uncertainty::VertexId& a,
                                       const uncertainty::VertexId& b)
      -> absl::optional<uncertainty::UncertainPose> {
    if (sigma == 0.) return absl::nullopt;
    uncertainty::UncertainPose path;
    path.pose =
        Pose2(offset, 0., 0.) * Between(*pipeline_->paths().LocalPose(a),
                                        *pipeline_->paths().LocalPose(b));
    path.covariance =
        Eigen::Vector3d(sigma * sigma, sigma * sigma, 1e-4).asDiagonal();
    return path;
  };
  // Nothing better is known, ...
  EXPECT_FALSE(pipeline_->PredictAgain(path_between));
  // ... or there is no path, or the place is elsewhere.
  sigma = 0.;
  EXPECT_FALSE(pipeline_->PredictAgain(path_between));
  sigma = 0.5;
  offset = 4.;
  EXPECT_FALSE(pipeline_->PredictAgain(path_between));
  EXPECT_THAT(pipeline_->Decide(), IsEmpty());
  offset = 0.4;
  EXPECT_TRUE(pipeline_->PredictAgain(path_between));
  // Not twice by the same.
  EXPECT_FALSE(pipeline_->PredictAgain(path_between));
  const std::vector<LoopCandidate> outcomes = pipeline_->Decide();
  ASSERT_EQ(outcomes.size(), 2u);
  for (const LoopCandidate& outcome : outcomes) {
    EXPECT_EQ(outcome.reason, LoopDecision::CONFIRMED_BY_SUBSET);
    EXPECT_NEAR(*outcome.closed_sigma, 0.5, 1e-9);
    EXPECT_NEAR(outcome.innovation->innovation.translation().norm(), 0.4, 1e-9);
  }
}

TEST_F(LoopPipelineEndTest, TheLiteralSubsetPredictsNothingAgain) {
  MakePipeline();
  pipeline_->Process(Candidate(5, 100, 0., &world_));
  EXPECT_FALSE(pipeline_->PredictAgain(
      [](const uncertainty::VertexId&, const uncertainty::VertexId&) {
        ADD_FAILURE();
        return absl::optional<uncertainty::UncertainPose>();
      }));
}

}  // namespace
}  // namespace loop_closure
}  // namespace cartographer_ext
