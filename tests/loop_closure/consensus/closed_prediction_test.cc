// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
#include "cartographer_ext/loop_closure/consensus/closed_prediction.h"

#include <utility>
#include <vector>

#include "cartographer_ext/loop_closure/loop_candidate.h"
#include "cartographer_ext/loop_closure/loop_options.h"
#include "gmock/gmock.h"
#include "gtest/gtest.h"

namespace cartographer_ext {
namespace loop_closure {
namespace {

using ::testing::IsEmpty;
using ::testing::SizeIs;
using uncertainty::NodeId;
using uncertainty::UncertainPose;
using uncertainty::VertexId;

// Along the x axis, a node every metre. Node 10 is matched in the submap of
// node 2, which is turned to the left.
//
// The error of a match by e metres along x has the variance of the path plus
// that of the loop, 0.05^2: with a path of 0.1 metres its chi-square is
// e^2 / 0.0125.
class ClosedPredictionTest : public testing::Test {
 protected:
  ClosedPredictionTest() : paths_(uncertainty::PathNoiseOptions(), 1000) {
    for (int i = 0; i <= 10; ++i) paths_.Add(NodeId{0, i}, Pose2(i, 0., 0.));
  }

  // Searched with a prediction of 0.5 metres, found `error` metres too far.
  static LoopCandidate Candidate(const double error) {
    LoopCandidate candidate;
    candidate.submap = uncertainty::SubmapId{0, 1};
    candidate.submap_local_pose = Pose2(2., 0., kPi / 2.);
    candidate.anchor = VertexId(NodeId{0, 2});
    candidate.node = NodeId{0, 10};
    candidate.predicted =
        Between(candidate.submap_local_pose, Pose2(10., 0., 0.));
    candidate.plan.translation_sigma = 0.5;
    candidate.match.found = true;
    candidate.match.refined =
        Between(candidate.submap_local_pose, Pose2(10. + error, 0., 0.));
    return candidate;
  }

  // The true path from node 2 to node 10, with its sigmas along x and y.
  PathBetween Path(const double sigma_x, const double sigma_y) {
    return [=](const VertexId& a, const VertexId& b) {
      asked_.emplace_back(a, b);
      UncertainPose path;
      path.pose = Pose2(8., 0., 0.);
      path.covariance =
          Eigen::Vector3d(sigma_x * sigma_x, sigma_y * sigma_y, 1e-4)
              .asDiagonal();
      return absl::optional<UncertainPose>(path);
    };
  }
  PathBetween Path(const double sigma) { return Path(sigma, sigma); }
  PathBetween NoPath() {
    return [=](const VertexId& a, const VertexId& b) {
      asked_.emplace_back(a, b);
      return absl::optional<UncertainPose>();
    };
  }

  bool PredictsAgain(const PathBetween& path, LoopCandidate* const candidate) {
    return PredictAgain(options_, paths_, path, candidate);
  }
  bool Contradicts(const PathBetween& path, LoopCandidate* const candidate) {
    return ContradictsPath(options_, paths_, path, candidate);
  }

  LoopOptions options_;
  uncertainty::PathUncertainty paths_;
  // Ends of the paths that were asked for.
  std::vector<std::pair<VertexId, VertexId>> asked_;
};

TEST_F(ClosedPredictionTest, ABetterPathPredictsTheMatchAgain) {
  LoopCandidate candidate = Candidate(0.3);
  ASSERT_TRUE(PredictsAgain(Path(0.1), &candidate));
  ASSERT_THAT(asked_, SizeIs(1));
  EXPECT_EQ(asked_[0].first, VertexId(NodeId{0, 2}));
  EXPECT_EQ(asked_[0].second, VertexId(NodeId{0, 10}));
  EXPECT_NEAR(*candidate.closed_sigma, 0.1, 1e-9);
  EXPECT_NEAR(candidate.innovation->innovation.x, 0.3, 1e-9);
  EXPECT_NEAR(candidate.innovation->chi_square, 7.2, 1e-6);
  EXPECT_EQ(candidate.innovation->bound, 21.108);
  EXPECT_FALSE(candidate.innovation->vetoed);
  // The prediction of the search stays in the record.
  EXPECT_EQ(candidate.plan.translation_sigma, 0.5);
}

TEST_F(ClosedPredictionTest, APathThatKnowsNoBetterPredictsNothing) {
  LoopCandidate candidate = Candidate(0.);
  EXPECT_FALSE(PredictsAgain(Path(0.5), &candidate));
  // The worst direction counts.
  EXPECT_FALSE(PredictsAgain(Path(0.1, 0.6), &candidate));
  EXPECT_FALSE(candidate.closed_sigma.has_value());
  EXPECT_FALSE(candidate.innovation.has_value());
  ASSERT_TRUE(PredictsAgain(Path(0.3), &candidate));
  // From then on this is what has to be improved.
  EXPECT_FALSE(PredictsAgain(Path(0.4), &candidate));
  EXPECT_NEAR(*candidate.closed_sigma, 0.3, 1e-9);
  ASSERT_TRUE(PredictsAgain(Path(0.2), &candidate));
  EXPECT_NEAR(*candidate.closed_sigma, 0.2, 1e-9);
}

// Chi-square of 12.8 and 28.8.
TEST_F(ClosedPredictionTest, AMatchElsewhereIsNotPredictedAgain) {
  LoopCandidate near = Candidate(0.4);
  EXPECT_TRUE(PredictsAgain(Path(0.1), &near));
  LoopCandidate elsewhere = Candidate(0.6);
  EXPECT_FALSE(PredictsAgain(Path(0.1), &elsewhere));
  EXPECT_FALSE(elsewhere.closed_sigma.has_value());
  EXPECT_FALSE(elsewhere.innovation.has_value());
  options_.innovation_veto.chi_square_bound = 30.;
  EXPECT_TRUE(PredictsAgain(Path(0.1), &elsewhere));
}

TEST_F(ClosedPredictionTest, WithoutAPathNothingIsPredictedOrContradicted) {
  LoopCandidate candidate = Candidate(5.);
  EXPECT_FALSE(PredictsAgain(NoPath(), &candidate));
  EXPECT_FALSE(Contradicts(NoPath(), &candidate));
  EXPECT_THAT(asked_, SizeIs(2));
  asked_.clear();
  LoopCandidate without_anchor = Candidate(5.);
  without_anchor.anchor.reset();
  LoopCandidate of_another = Candidate(5.);
  of_another.submap.trajectory_id = 1;
  for (LoopCandidate* const unknown : {&without_anchor, &of_another}) {
    EXPECT_FALSE(PredictsAgain(Path(0.1), unknown));
    EXPECT_FALSE(Contradicts(Path(0.1), unknown));
    EXPECT_FALSE(unknown->closed_sigma.has_value());
    EXPECT_FALSE(unknown->innovation.has_value());
  }
  EXPECT_THAT(asked_, IsEmpty());
}

// Chi-square of 12.8 and 7.2 against the bound of cycles, not that of the veto.
TEST_F(ClosedPredictionTest, ACycleThatDoesNotCloseContradicts) {
  LoopCandidate right = Candidate(0.3);
  right.closed_sigma = 0.4;
  EXPECT_FALSE(Contradicts(Path(0.1), &right));
  EXPECT_EQ(*right.closed_sigma, 0.4);
  EXPECT_FALSE(right.innovation.has_value());

  LoopCandidate wrong = Candidate(0.4);
  ASSERT_TRUE(Contradicts(Path(0.1), &wrong));
  EXPECT_EQ(asked_.back().first, VertexId(NodeId{0, 2}));
  EXPECT_EQ(asked_.back().second, VertexId(NodeId{0, 10}));
  EXPECT_NEAR(*wrong.closed_sigma, 0.1, 1e-9);
  EXPECT_NEAR(wrong.innovation->innovation.x, 0.4, 1e-9);
  EXPECT_NEAR(wrong.innovation->chi_square, 12.8, 1e-6);
  EXPECT_EQ(wrong.innovation->bound, 11.345);
  EXPECT_TRUE(wrong.innovation->vetoed);

  options_.compatible_subset.cycle.chi_square_bound = 13.;
  EXPECT_FALSE(Contradicts(Path(0.1), &wrong));
}

// Three sigmas, in any direction.
TEST_F(ClosedPredictionTest, FarFromThePrediction) {
  const auto is_far = [](const Pose2& displacement) {
    LoopCandidate candidate = Candidate(0.);
    candidate.plan.translation_sigma = 0.2;
    candidate.plan.rotation_sigma = 0.1;
    candidate.match.refined = *candidate.predicted * displacement;
    return IsFarFromPrediction(candidate);
  };
  EXPECT_FALSE(is_far(Pose2()));
  EXPECT_FALSE(is_far(Pose2(0.59, 0., 0.)));
  EXPECT_TRUE(is_far(Pose2(0.61, 0., 0.)));
  EXPECT_FALSE(is_far(Pose2(-0.36, 0.47, 0.)));
  EXPECT_TRUE(is_far(Pose2(-0.36, 0.49, 0.)));
  EXPECT_FALSE(is_far(Pose2(0., 0., -0.29)));
  EXPECT_TRUE(is_far(Pose2(0., 0., -0.31)));
  EXPECT_FALSE(is_far(Pose2(0., 0., 2. * kPi)));
}

// Even a perfect prediction is off by what matches are off by.
TEST_F(ClosedPredictionTest, FarFromACertainPrediction) {
  const auto is_far = [](const Pose2& displacement) {
    LoopCandidate candidate = Candidate(0.);
    candidate.plan.translation_sigma = 0.;
    candidate.match.refined = *candidate.predicted * displacement;
    return IsFarFromPrediction(candidate);
  };
  EXPECT_FALSE(is_far(Pose2(0.14, 0., 0.)));
  EXPECT_TRUE(is_far(Pose2(0.16, 0., 0.)));
  EXPECT_FALSE(is_far(Pose2(0., 0., 0.044)));
  EXPECT_TRUE(is_far(Pose2(0., 0., 0.046)));
}

TEST_F(ClosedPredictionTest, WithoutAPredictionNothingIsFarFromIt) {
  EXPECT_TRUE(IsFarFromPrediction(Candidate(5.)));
  LoopCandidate unpredicted = Candidate(5.);
  unpredicted.predicted.reset();
  EXPECT_FALSE(IsFarFromPrediction(unpredicted));
  LoopCandidate anywhere = Candidate(5.);
  anywhere.plan.full_submap = true;
  EXPECT_FALSE(IsFarFromPrediction(anywhere));
  LoopCandidate of_another = Candidate(5.);
  of_another.submap.trajectory_id = 1;
  EXPECT_FALSE(IsFarFromPrediction(of_another));
}

}  // namespace
}  // namespace loop_closure
}  // namespace cartographer_ext
