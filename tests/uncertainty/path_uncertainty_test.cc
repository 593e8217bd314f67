// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
#include "cartographer_ext/uncertainty/path_uncertainty.h"

#include <cmath>
#include <utility>
#include <vector>

#include "cartographer_ext/common/random.h"
#include "gtest/gtest.h"
#include "tests/uncertainty/random_walk.h"

namespace cartographer_ext {
namespace uncertainty {
namespace {

PathNoiseOptions Noise() {
  PathNoiseOptions options = RandomWalk();
  options.translation_per_metre = 0.1;
  options.translation_per_radian = 0.;
  options.rotation_per_metre = 0.01;
  options.rotation_per_radian = 0.1;
  return options;
}

// Steps are certain up to these thresholds.
PathNoiseOptions OnlyJumps() {
  PathNoiseOptions options = RandomWalk();
  options.translation_per_metre = 0.;
  options.rotation_per_metre = 0.;
  options.translation_per_radian = 0.;
  options.rotation_per_radian = 0.;
  options.jump_threshold_metres = 0.5;
  options.jump_threshold_radians = 0.4;
  return options;
}

NodeId Key(int index) { return NodeId{0, index}; }

TEST(PathUncertaintyTest, StraightPathByHand) {
  PathUncertainty paths(Noise(), 100);
  for (int i = 0; i <= 4; ++i) paths.Add(Key(i), Pose2(5. + i, 7., 0.));
  const auto path = paths.Between(Key(1), Key(4));
  ASSERT_TRUE(path.has_value());
  EXPECT_NEAR(path->pose.x, 3., 1e-12);
  // Three steps of 1 m, each with variances 0.01, 0.01 and 1e-4. A rotation
  // error of a step moves the end by what is left to go: 2, 1 and 0 metres.
  EXPECT_NEAR(path->covariance(0, 0), 0.03, 1e-12);
  EXPECT_NEAR(path->covariance(1, 1), 0.03 + 1e-4 * (4. + 1.), 1e-12);
  EXPECT_NEAR(path->covariance(2, 2), 3e-4, 1e-12);
  EXPECT_NEAR(path->covariance(1, 2), 1e-4 * (2. + 1.), 1e-12);
  EXPECT_NEAR(*paths.Travelled(Key(4), Key(1)), 3., 1e-12);
}

// Of the second step the heading is doubted, which moves the end by the two metres
// that are left to go; other paths do not know of it.
TEST(PathUncertaintyTest, ADoubtedStepIsLessCertain) {
  PathUncertainty paths(Noise(), 100), usual(Noise(), 100);
  StepError doubted;
  doubted.doubt = Eigen::Vector3d(0., 0., 0.04).asDiagonal();
  for (int i = 0; i <= 4; ++i) {
    const Pose2 pose(5. + i, 7., 0.);
    paths.Add(Key(i), pose, i == 2 ? doubted : StepError());
    usual.Add(Key(i), pose);
  }
  Eigen::Matrix3d more;
  more << 0., 0., 0., 0., 0.16, 0.08, 0., 0.08, 0.04;
  EXPECT_NEAR((paths.Between(Key(0), Key(4))->covariance -
               usual.Between(Key(0), Key(4))->covariance - more)
                  .norm(),
              0., 1e-12);
  EXPECT_NEAR((paths.Between(Key(2), Key(4))->covariance -
               usual.Between(Key(2), Key(4))->covariance)
                  .norm(),
              0., 1e-12);
  // Whatever the estimate of the drift makes of the usual noise.
  paths.SetDrift(0, {0.5, 0.5, 0.5}, CommonDrift());
  EXPECT_NEAR(paths.Parts(Key(0), Key(4))->other(2, 2), 0.04, 1e-12);
  EXPECT_GT(*paths.PathCost(Key(1), Key(2)), *usual.PathCost(Key(1), Key(2)));
}

TEST(PathUncertaintyTest, EqualsComposingTheSteps) {
  Random random(5);
  PathUncertainty paths(Noise(), 1000);
  std::vector<Pose2> poses = {Pose2(300., -200., 1.)};
  paths.Add(Key(0), poses[0]);
  for (int i = 1; i < 200; ++i) {
    poses.push_back(poses.back() *
                    Pose2(random.Uniform(), 0.1, random.Uniform() - 0.5));
    paths.Add(Key(i), poses[i]);
  }
  UncertainPose composed;
  for (int i = 51; i <= 150; ++i) {
    PathUncertainty step(Noise(), 2);
    step.Add(Key(0), poses[i - 1]);
    step.Add(Key(1), poses[i]);
    composed = Compose(composed, *step.Between(Key(0), Key(1)));
  }
  const auto path = paths.Between(Key(50), Key(150));
  EXPECT_NEAR((path->covariance - composed.covariance).norm(), 0.,
              1e-9 * composed.covariance.norm());
  EXPECT_NEAR(path->pose.x, composed.pose.x, 1e-9);
  EXPECT_NEAR(path->pose.theta, composed.pose.theta, 1e-9);
  // Backwards is the inverse.
  const auto back = paths.Between(Key(150), Key(50));
  const UncertainPose inverse = Invert(composed);
  EXPECT_NEAR((back->covariance - inverse.covariance).norm(), 0.,
              1e-9 * inverse.covariance.norm());
}

TEST(PathUncertaintyTest, OrderOfAddingDoesNotMatter) {
  PathUncertainty forward(Noise(), 100);
  PathUncertainty shuffled(Noise(), 100);
  const auto pose = [](int i) { return Pose2(i, 0.1 * i * i, 0.2 * i); };
  for (int i = 0; i < 6; ++i) forward.Add(Key(i), pose(i));
  for (const int i : {5, 1, 3}) shuffled.Add(Key(i), pose(i));
  EXPECT_TRUE(shuffled.Between(Key(1), Key(5)).has_value());
  EXPECT_FALSE(shuffled.Between(Key(0), Key(5)).has_value());
  for (const int i : {0, 4, 2, 3}) shuffled.Add(Key(i), pose(i));
  EXPECT_EQ(forward.Between(Key(0), Key(5))->covariance,
            shuffled.Between(Key(0), Key(5))->covariance);
}

TEST(PathUncertaintyTest, IsBounded) {
  PathUncertainty unbounded(Noise(), 100);
  PathUncertainty paths(Noise(), 3);
  for (int i = 0; i < 10; ++i) {
    paths.Add(Key(i), Pose2(i, 0., 0.1 * i));
    unbounded.Add(Key(i), Pose2(i, 0., 0.1 * i));
    if (i == 5) {
      EXPECT_TRUE(paths.Between(Key(3), Key(5)).has_value());
    }
  }
  EXPECT_FALSE(paths.Between(Key(6), Key(9)).has_value());
  paths.Add(Key(2), Pose2(2., 0., 0.));  // too old
  EXPECT_FALSE(paths.LocalPose(Key(2)).has_value());
  EXPECT_NEAR((paths.Between(Key(7), Key(9))->covariance -
               unbounded.Between(Key(7), Key(9))->covariance)
                  .norm(),
              0., 1e-12);
}

TEST(PathUncertaintyTest, NearestNodeAndMissingTrajectories) {
  PathUncertainty paths(Noise(), 100);
  for (int i = 0; i < 5; ++i) paths.Add(Key(i), Pose2(i, 0., 0.));
  EXPECT_EQ(paths.Nearest(0, Eigen::Vector2d(2.2, 1.))->node_index, 2);
  EXPECT_EQ(paths.Nearest(0, Eigen::Vector2d(2.5, 0.))->node_index, 2);
  EXPECT_FALSE(paths.Nearest(1, Eigen::Vector2d::Zero()).has_value());
  EXPECT_FALSE(paths.Between(Key(1), NodeId{1, 1}).has_value());
  EXPECT_FALSE(paths.Travelled(Key(1), NodeId{1, 1}).has_value());
  EXPECT_NEAR(paths.LocalPose(Key(3))->x, 3., 0.);
  paths.Add(SubmapId{0, 3}, Pose2());
  paths.DeleteTrajectory(0);
  EXPECT_FALSE(paths.LocalPose(Key(3)).has_value());
  EXPECT_FALSE(paths.LocalPose(SubmapId{0, 3}).has_value());
}

TEST(PathUncertaintyTest, DriftAndScaleAreConstantAlongTheRun) {
  PathNoiseOptions options = RandomWalk();
  options.translation_per_metre = 0.;
  options.rotation_per_metre = 0.;
  options.heading_drift = 0.01;
  options.scale_error = 0.02;
  PathUncertainty paths(options, 100);
  for (int i = 0; i <= 10; ++i) paths.Add(Key(i), Pose2(3., 2. + i, 0.5 * kPi));
  const auto path = paths.Between(Key(2), Key(6));
  ASSERT_TRUE(path.has_value());
  // Four metres: the heading is off by 0.04, every metre turns those before it,
  // 0.01 (3 + 2 + 1) m to the side; the length by 0.08 m.
  EXPECT_NEAR(path->covariance(0, 0), 0.08 * 0.08, 1e-12);
  EXPECT_NEAR(path->covariance(1, 1), 0.06 * 0.06, 1e-12);
  EXPECT_NEAR(path->covariance(2, 2), 0.04 * 0.04, 1e-12);
}

TEST(PathUncertaintyTest, JumpsAreAsUncertainAsTheyAreLong) {
  PathUncertainty paths(OnlyJumps(), 100);
  paths.Add(Key(0), Pose2(0., 0., 0.));
  paths.Add(Key(1), Pose2(0.5, 0., 0.4));
  paths.Add(Key(2), Pose2(1.8, 0., 0.9));
  EXPECT_TRUE(paths.Between(Key(0), Key(1))->covariance.isZero(1e-12));
  const auto path = paths.Between(Key(1), Key(2));
  EXPECT_NEAR(path->covariance(0, 0), 0.8 * 0.8, 1e-12);
  EXPECT_NEAR(path->covariance(1, 1), 0.8 * 0.8, 1e-12);
  EXPECT_NEAR(path->covariance(2, 2), 0.1 * 0.1, 1e-12);
}

// What dead reckoning may be off is the error of a long step, not its length.
TEST(PathUncertaintyTest, ABridgedGapIsAsUncertainAsItsReckoning) {
  PathUncertainty paths(OnlyJumps(), 100);
  StepError error;
  error.bridged = Eigen::Vector3d(0.09, 0.16, 0.01).asDiagonal();
  paths.Add(Key(0), Pose2(0., 0., 0.));
  paths.Add(Key(1), Pose2(20., 0., 0.), error);
  paths.Add(Key(2), Pose2(20.4, 0., 0.));
  EXPECT_TRUE(paths.Between(Key(0), Key(1))
                  ->covariance.isApprox(*error.bridged, 1e-12));
  EXPECT_TRUE(paths.Between(Key(1), Key(2))->covariance.isZero(1e-12));
}

TEST(PathUncertaintyTest, NodesThatAreStillMissingAreNoJump) {
  PathUncertainty paths(OnlyJumps(), 100);
  paths.Add(Key(0), Pose2(0., 0., 0.));
  paths.Add(Key(10), Pose2(5., 0., 1.));
  EXPECT_TRUE(paths.Between(Key(0), Key(10))->covariance.isZero(1e-12));
  paths.Add(Key(12), Pose2(7., 0., 1.));
  EXPECT_NEAR(paths.Between(Key(10), Key(12))->covariance(0, 0), 1., 1e-12);
}

// A slow laser on a fast robot: nodes are a metre and half a radian apart.
TEST(PathUncertaintyTest, NodesThatAreAlwaysFarApartAreNoJumps) {
  PathUncertainty paths(OnlyJumps(), 100);
  for (int i = 0; i <= 20; ++i) {
    paths.Add(Key(i), Pose2(i, 0., i % 2 == 0 ? 0. : 0.5));
  }
  EXPECT_TRUE(paths.Between(Key(4), Key(20))->covariance.isZero(1e-12));
  EXPECT_TRUE(paths.Between(Key(0), Key(1))->covariance.isZero(1e-12));
  // Both thresholds are four times as long: twice the median step of 1 m.
  paths.Add(Key(21), Pose2(25., 0., 2.));
  const auto jump = paths.Between(Key(20), Key(21));
  EXPECT_NEAR(jump->covariance(0, 0), 3. * 3., 1e-12);
  EXPECT_NEAR(jump->covariance(2, 2), 0.4 * 0.4, 1e-12);
}

// A scan per metre or half radian: in a room, where the robot rotates more than
// it drives, the median step is short, and steps of a metre or half a radian are
// still ordinary.
TEST(PathUncertaintyTest, LongStepsAmongShortOnesAreNoJumps) {
  PathUncertainty paths(OnlyJumps(), 100);
  double x = 0.;
  double theta = 0.;
  paths.Add(Key(0), Pose2(x, 0., theta));
  for (int i = 1; i <= 60; ++i) {
    i % 4 == 0 ? x += 1. : theta += i % 4 == 2 ? 0.55 : 0.1;
    paths.Add(Key(i), Pose2(x, 0., theta));
  }
  // The first steps have too few others to be compared with.
  EXPECT_TRUE(paths.Between(Key(4), Key(60))->covariance.isZero(1e-12));
  // A step more than one and a half times as long is a jump.
  paths.Add(Key(61), Pose2(x + 2., 0., theta + 1.));
  const auto jump = paths.Between(Key(60), Key(61));
  EXPECT_NEAR(jump->covariance(0, 0), 0.5 * 0.5, 1e-12);
  EXPECT_NEAR(jump->covariance(2, 2), 0.175 * 0.175, 1e-12);
}

// No step is part of its own threshold.
TEST(PathUncertaintyTest, TheFirstStepsAreJudgedByThoseAfterThem) {
  PathUncertainty paths(OnlyJumps(), 100);
  paths.Add(Key(0), Pose2(0., 0., 0.));
  paths.Add(Key(1), Pose2(5., 0., 0.));
  EXPECT_NEAR(paths.Between(Key(0), Key(1))->covariance(0, 0), 4.5 * 4.5,
              1e-12);
  for (int i = 2; i <= 4; ++i) paths.Add(Key(i), Pose2(4. + i, 0., 0.));
  // Twice the median of one metre.
  EXPECT_NEAR(paths.Between(Key(0), Key(1))->covariance(0, 0), 3. * 3., 1e-12);
  EXPECT_TRUE(paths.Between(Key(1), Key(4))->covariance.isZero(1e-12));
}

TEST(PathUncertaintyTest, AnOrdinaryStepIsTheMedianWhicheverOrderNodesCome) {
  PathNoiseOptions options = RandomWalk();
  options.jump_threshold_metres = 0.5;
  PathUncertainty in_order(options, 100), backwards(options, 100);
  const auto pose = [](const int i) {
    return Pose2(i + (i > 10 ? 4. : 0.), 0., 0.);
  };
  for (int i = 0; i <= 20; ++i) in_order.Add(Key(i), pose(i));
  for (int i = 20; i >= 0; --i) {
    backwards.Add(Key(i), pose(i));
    // Computes sums that later nodes make invalid.
    backwards.Between(Key(i), Key(20));
  }
  EXPECT_EQ(in_order.Between(Key(2), Key(19))->covariance,
            backwards.Between(Key(2), Key(19))->covariance);
}

TEST(PathUncertaintyTest, DriftScalesEachPart) {
  PathNoiseOptions options = Noise();
  options.translation_per_radian = 0.03;
  DriftFactors factors;
  factors.translation = 2.;
  factors.rotation = 3.;
  factors.turning = 0.5;
  PathUncertainty learnt(options, 100), given(Scaled(options, factors), 100);
  for (int i = 0; i <= 20; ++i) {
    const Pose2 pose(0.3 * i, 0.02 * i * i, 0.1 * i);
    learnt.Add(Key(i), pose);
    given.Add(Key(i), pose);
  }
  learnt.SetDrift(0, factors, CommonDrift());
  EXPECT_EQ(learnt.drift_version(), 1);
  for (const auto& ends : {std::make_pair(2, 17), std::make_pair(17, 2)}) {
    const VertexId u = Key(ends.first), v = Key(ends.second);
    const Eigen::Matrix3d expected = given.Between(u, v)->covariance;
    EXPECT_NEAR((learnt.Between(u, v)->covariance - expected).norm(), 0.,
                1e-12);
    EXPECT_NEAR(
        (learnt.Parts(u, v)->Total(factors, Eigen::Matrix3d::Zero()) - expected)
            .norm(),
        0., 1e-12);
  }
  // Another trajectory is not concerned.
  EXPECT_EQ(learnt.Drift(1).translation, 1.);
  EXPECT_FALSE(learnt.Parts(Key(2), Key(99)).has_value());
}

// A run whose heading drifts, whose turns and whose scale are off, corrected.
TEST(PathUncertaintyTest, CommonDriftIsTakenOut) {
  CommonDrift common;
  common.mean << 0.01, 0.05, -0.03;
  common.covariance.diagonal() << 1e-6, 1e-4, 1e-5;
  PathUncertainty paths(Noise(), 100), truth(Noise(), 100);
  Pose2 local, corrected;
  for (int i = 0; i <= 20; ++i) {
    if (i > 0) {
      const Pose2 step(0.5, 0.02 * i, 0.03 * (i - 8));
      local = local * step;
      corrected = corrected *
                  Pose2(0.97 * step.x, 0.97 * step.y,
                        1.05 * step.theta + 0.01 * std::hypot(step.x, step.y));
    }
    paths.Add(Key(i), local);
    truth.Add(Key(i), corrected);
  }
  paths.SetDrift(0, DriftFactors(), common);
  const auto path = paths.Between(Key(3), Key(17));
  const Pose2 error = Between(truth.Between(Key(3), Key(17))->pose, path->pose);
  EXPECT_NEAR(error.translation().norm(), 0., 1e-9);
  EXPECT_NEAR(NormalizeAngle(error.theta), 0., 1e-9);
  // Where the submaps are is not changed.
  EXPECT_EQ(paths.LocalPose(Key(20))->x, local.x);

  // The effects of each are the derivatives of the relative pose.
  for (const auto& ends : {std::make_pair(3, 17), std::make_pair(17, 3)}) {
    const VertexId u = Key(ends.first), v = Key(ends.second);
    const Eigen::Matrix3d effects = paths.Parts(u, v)->common;
    const Pose2 middle = paths.Between(u, v)->pose;
    for (int k = 0; k < 3; ++k) {
      constexpr double kStep = 1e-6;
      CommonDrift changed = common;
      changed.mean(k) += kStep;
      PathUncertainty other = paths;
      other.SetDrift(0, DriftFactors(), changed);
      const Pose2 moved = Between(middle, other.Between(u, v)->pose);
      const Eigen::Vector3d derivative =
          Eigen::Vector3d(moved.x, moved.y, NormalizeAngle(moved.theta)) /
          kStep;
      // A step is straight to first order only.
      EXPECT_NEAR((derivative - effects.col(k)).norm(), 0.,
                  0.02 * (1. + derivative.norm()))
          << k;
    }
  }
}

TEST(PathUncertaintyTest, NearestAmongSomeNodes) {
  PathUncertainty paths(Noise(), 100);
  for (int i = 0; i <= 10; ++i) paths.Add(Key(i), Pose2(i, 0., 0.));
  EXPECT_EQ(paths.Nearest(0, Eigen::Vector2d(7.2, 0.), 0, 5)->node_index, 5);
  EXPECT_EQ(paths.Nearest(0, Eigen::Vector2d(7.2, 0.), 8, 20)->node_index, 8);
  EXPECT_FALSE(paths.Nearest(0, Eigen::Vector2d(7.2, 0.), 11, 20).has_value());
}

TEST(PathUncertaintyTest, SubmapsHaveASequenceOfTheirOwnWithoutJumps) {
  PathNoiseOptions options = Noise();
  options.jump_threshold_metres = 0.5;
  PathUncertainty paths(options, 2);
  paths.Add(Key(0), Pose2());
  paths.Add(Key(1), Pose2(4., 0., 0.));
  paths.Add(SubmapId{0, 0}, Pose2(0., 1., 0.));
  paths.Add(SubmapId{0, 1}, Pose2(4., 1., 0.));
  EXPECT_NEAR(paths.Between(SubmapId{0, 0}, SubmapId{0, 1})->covariance(0, 0),
              0.01 * 4., 1e-12);
  EXPECT_NEAR(paths.Between(Key(0), Key(1))->covariance(0, 0),
              0.01 * 4. + 3.5 * 3.5, 1e-12);
  EXPECT_FALSE(paths.Between(SubmapId{0, 0}, Key(1)).has_value());
  EXPECT_EQ(paths.Nearest(0, Eigen::Vector2d(4., 1.))->node_index, 1);
}

}  // namespace
}  // namespace uncertainty
}  // namespace cartographer_ext
