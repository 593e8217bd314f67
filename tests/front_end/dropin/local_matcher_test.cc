// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
#include "cartographer_ext/front_end/dropin/local_matcher.h"

#include <cmath>
#include <memory>
#include <string>
#include <vector>

#include "absl/memory/memory.h"
#include "cartographer/common/configuration_file_resolver.h"
#include "cartographer/common/lua_parameter_dictionary.h"
#include "cartographer/mapping/internal/2d/local_trajectory_builder_options_2d.h"
#include "cartographer/transform/transform.h"
#include "cartographer_ext/scan_matching/dropin/mean_score.h"
#include "gtest/gtest.h"
#include "tests/front_end/dropin/simulated_room.h"

namespace cartographer_ext {
namespace front_end {
namespace {

using cartographer::mapping::ActiveSubmaps2D;
using cartographer::mapping::proto::LocalTrajectoryBuilderOptions2D;
using cartographer::sensor::PointCloud;

TEST(ContradictionTest, GrowsBetweenItsBounds) {
  const Pose2 predicted(3., -2., 1.5);
  EXPECT_EQ(Inconsistency(predicted, predicted), 0.);
  // In the frame of the prediction; only the distance counts.
  EXPECT_EQ(Inconsistency(predicted, predicted * Pose2(0.03, -0.03, 0.)), 0.);
  EXPECT_NEAR(Inconsistency(predicted, predicted * Pose2(0.06, 0.08, 0.)), 0.5,
              1e-9);
  EXPECT_EQ(Inconsistency(predicted, predicted * Pose2(0., -0.2, 0.)), 1.);
  EXPECT_EQ(Inconsistency(predicted, predicted * Pose2(0., 0., DegToRad(1.9))),
            0.);
  EXPECT_NEAR(
      Inconsistency(predicted, predicted * Pose2(0., 0., -DegToRad(4.))),
      2. / 3., 1e-9);
  EXPECT_EQ(Inconsistency(predicted, predicted * Pose2(0., 0., DegToRad(170.))),
            1.);
  // The larger of both.
  EXPECT_NEAR(
      Inconsistency(predicted, predicted * Pose2(0.06, 0., DegToRad(3.5))), 0.5,
      1e-9);
}

TEST(MatchDoubtTest, GrowsWhereTheScoreIsBelowTheUsual) {
  EXPECT_EQ(MatchDoubt(0.5, 0.5), 0.);
  EXPECT_EQ(MatchDoubt(0.4, 0.5), 0.);
  EXPECT_EQ(MatchDoubt(0.1, 0.), 0.);
  EXPECT_NEAR(MatchDoubt(0.37, 0.5), 1. / (1. + std::exp(3.96)), 1e-9);
  EXPECT_NEAR(MatchDoubt(0.2, 0.5), 1. / (1. + std::exp(0.9)), 1e-9);
  EXPECT_NEAR(MatchDoubt(0.15, 0.5), 0.5, 1e-9);
}

// A field of view that is no evidence enough against odometry that is trusted.
constexpr double kFewDegrees = 40.;

// A map of the room, a robot at its origin, and a prediction
// that is held for certain.
class LocalMatcherTest : public testing::Test {
 protected:
  LocalMatcherTest() {
    cartographer::common::LuaParameterDictionary dictionary(
        "include 'common_2d.lua' include 'front_end_default.lua' "
        "return TRAJECTORY_BUILDER_2D",
        absl::make_unique<cartographer::common::ConfigurationFileResolver>(
            std::vector<std::string>{"configuration_files"}));
    const LocalTrajectoryBuilderOptions2D stock =
        cartographer::mapping::CreateLocalTrajectoryBuilderOptions2D(
            &dictionary);
    matcher_options_ = stock.ceres_scan_matcher_options();
    submaps_ = absl::make_unique<ActiveSubmaps2D>(stock.submaps_options());
    for (int i = 0; i < 20; ++i) {
      cartographer::sensor::RangeData range_data;
      range_data.origin = Eigen::Vector3f::Zero();
      range_data.returns = Cloud();
      submaps_->InsertRangeData(range_data);
    }
    prediction_.source = PredictionSource::kOdometry;
    prediction_.covariance = Eigen::Vector3d(1e-4, 1e-4, 25e-6).asDiagonal();
  }

  PointCloud Cloud() {
    PointCloud cloud;
    for (const auto& point :
         test::Scan(test::Room(), 0., Pose2(), 12., &random_).ranges) {
      const double angle = std::atan2(point.position.y(), point.position.x());
      if (std::abs(angle) > 0.5 * field_of_view_) continue;
      cloud.push_back({point.position});
    }
    return cloud;
  }

  // From a prediction that is `off` the truth.
  LocalMatch MatchFrom(const Pose2& off) {
    LocalMatcher matcher(options_, matcher_options_);
    const auto& submap = *submaps_->submaps().front();
    // What is usual.
    MotionPrediction certain = prediction_;
    certain.is_uncertain = false;
    const LocalMatch usual = matcher.Match(Pose2(), certain, Cloud(), submap);
    EXPECT_FALSE(usual.relocated);
    EXPECT_NEAR(usual.pose.x, 0., 0.01);
    prediction_.motion = off;
    return matcher.Match(Pose2(), prediction_, Cloud(), submap);
  }

  cartographer::mapping::scan_matching::proto::CeresScanMatcherOptions2D
      matcher_options_;
  LocalSearchOptions options_;
  std::unique_ptr<ActiveSubmaps2D> submaps_;
  MotionPrediction prediction_;
  double field_of_view_ = 2. * kPi;
  Random random_{3};
};

TEST_F(LocalMatcherTest, AMuchBetterPlaceOverrulesThePrediction) {
  const LocalMatch match = MatchFrom(Pose2(0.15, 0.1, DegToRad(6.)));
  EXPECT_TRUE(match.searched);
  EXPECT_TRUE(match.relocated);
  EXPECT_NEAR(match.pose.x, 0., 0.02);
  EXPECT_NEAR(match.pose.y, 0., 0.02);
  EXPECT_NEAR(match.pose.theta, 0., 0.02);
}

// A slow laser: the prediction spans several minima, none of which contradicts
// it, and there is no usual score to miss.
TEST_F(LocalMatcherTest, AWidePredictionIsSearchedForTheLikeliestMinimum) {
  LocalMatcher matcher(options_, matcher_options_);
  prediction_.motion = Pose2(0.15, -0.1, DegToRad(9.));
  prediction_.covariance =
      Eigen::Vector3d(0.01, 0.01, std::pow(DegToRad(5.), 2)).asDiagonal();
  const LocalMatch match = matcher.Match(Pose2(), prediction_, Cloud(),
                                         *submaps_->submaps().front());
  EXPECT_TRUE(match.searched);
  EXPECT_TRUE(match.relocated);
  EXPECT_NEAR(match.pose.x, 0., 0.02);
  EXPECT_NEAR(match.pose.y, 0., 0.02);
  EXPECT_NEAR(match.pose.theta, 0., 0.02);
}

// Most of the scan fits a place that the prediction all but excludes, as leaves
// of trees do: the rest tells where the robot is.
TEST_F(LocalMatcherTest, AHigherScoreFartherOffDoesNotHideTheLikeliestPose) {
  options_.contradiction_gain = 1.;
  LocalMatcher matcher(options_, matcher_options_);
  const Pose2 off(0.1, -0.05, DegToRad(5.));
  const Pose2 elsewhere(-0.3, 0.2, -DegToRad(4.));
  prediction_.motion = Pose2(0.7, 0., 0.);
  prediction_.covariance =
      Eigen::Vector3d(0.0064, 0.0064, std::pow(DegToRad(4.), 2)).asDiagonal();
  PointCloud cloud;
  for (const auto& point : Cloud()) {
    const Eigen::Vector2d seen =
        (cloud.size() % 5 < 2 ? Pose2() : elsewhere.Inverse()) *
        Eigen::Vector2d(point.position.head<2>().cast<double>());
    cloud.push_back({Eigen::Vector3f(seen.x(), seen.y(), 0.f)});
  }
  const auto& submap = *submaps_->submaps().front();
  ASSERT_GT(scan_matching::MeanScore(elsewhere, cloud, *submap.grid()),
            scan_matching::MeanScore(Pose2(), cloud, *submap.grid()) + 0.05);
  const LocalMatch match = matcher.Match(off * prediction_.motion.Inverse(),
                                         prediction_, cloud, submap);
  EXPECT_TRUE(match.relocated);
  EXPECT_NEAR(match.pose.x, 0., 0.03);
  EXPECT_NEAR(match.pose.y, 0., 0.03);
  EXPECT_NEAR(match.pose.theta, 0., 0.02);
}

// What a hint leads to does not overrule a prediction, however well it fits.
TEST_F(LocalMatcherTest, AHintIsNoAlternative) {
  const Pose2 off(1.5, 0.3, 0.);
  prediction_.alternatives = {Pose2()};
  EXPECT_NEAR(MatchFrom(off).pose.x, 0., 0.02);
  prediction_.motion = Pose2();
  prediction_.alternatives.clear();
  prediction_.hints = {Pose2()};
  EXPECT_GT(MatchFrom(off).pose.x, 0.5);
}

// Nor does one beyond the window around the prediction, though it would agree.
TEST_F(LocalMatcherTest, AHintFarOffIsNotFollowed) {
  LocalMatcher matcher(options_, matcher_options_);
  prediction_.motion = Pose2(1.5, 0.3, 0.);
  prediction_.covariance = Eigen::Vector3d(1., 1., 0.01).asDiagonal();
  const auto match = [&] {
    return matcher.Match(Pose2(), prediction_, Cloud(),
                         *submaps_->submaps().front());
  };
  prediction_.hints = {Pose2()};
  EXPECT_GT(match().pose.x, 0.5);
  prediction_.hints.clear();
  prediction_.alternatives = {Pose2()};
  EXPECT_NEAR(match().pose.x, 0., 0.02);
}

// Where scans are far apart, a search needs a higher score, too.
TEST_F(LocalMatcherTest, ASlightlyBetterPlaceDoesNot) {
  options_.contradiction_gain = 1.;
  LocalMatcher matcher(options_, matcher_options_);
  const Pose2 off(0.15, 0.1, DegToRad(6.));
  const auto match_after = [&](const Pose2& motion, const Pose2& predicted) {
    prediction_.motion = motion;
    return matcher.Match(predicted * motion.Inverse(), prediction_, Cloud(),
                         *submaps_->submaps().front());
  };
  match_after(Pose2(), Pose2());  // what is usual
  const LocalMatch match = match_after(Pose2(0.7, 0., 0.), off);
  EXPECT_TRUE(match.searched);
  // Nearer to the prediction than to the place.
  EXPECT_LE(match.report.mahalanobis, options_.gate);
  EXPECT_LT(std::hypot(match.pose.x - off.x, match.pose.y - off.y), 0.05);
  EXPECT_NEAR(match.pose.theta, off.theta, 0.025);
}

// Where they see the same, evidence alone decides.
TEST_F(LocalMatcherTest, EnoughEvidenceDoes) {
  options_.contradiction_gain = 1.;
  const LocalMatch match = MatchFrom(Pose2(0.15, 0.1, DegToRad(6.)));
  EXPECT_TRUE(match.overrules_odometry);
  EXPECT_FALSE(match.ends_contest);
  EXPECT_NEAR(match.pose.x, 0., 0.03);
  EXPECT_NEAR(match.pose.theta, 0., 0.02);
}

TEST_F(LocalMatcherTest, APredictionInDoubtIsOverruledSooner) {
  options_.contradiction_gain = 1.;
  prediction_.is_uncertain = true;
  const LocalMatch match = MatchFrom(Pose2(0.15, 0.1, DegToRad(6.)));
  EXPECT_TRUE(match.relocated);
  EXPECT_NEAR(match.pose.x, 0., 0.02);
  EXPECT_NEAR(match.pose.theta, 0., 0.02);
}

// A few points, as a laser of 57 degrees sees of a wall, fit better elsewhere,
// too: that is no evidence against odometry.
TEST_F(LocalMatcherTest, AFewPointsDoNotOverruleOdometry) {
  const Pose2 off(0.15, 0.1, DegToRad(6.));
  field_of_view_ = DegToRad(20.);
  const LocalMatch match = MatchFrom(off);
  EXPECT_TRUE(match.searched);
  EXPECT_FALSE(match.relocated);
  EXPECT_LT(std::hypot(match.pose.x - off.x, match.pose.y - off.y), 0.02);
  EXPECT_NEAR(match.pose.theta, off.theta, 0.02);
  // So the scan is no evidence of anything.
  EXPECT_EQ(match.report.scan_information.norm(), 0.);
}

// Wheels that slip do so for a while: the next scan needs less evidence, until
// one agrees with the odometry.
TEST_F(LocalMatcherTest, OdometryThatWasOverruledIsDoubted) {
  LocalMatcher matcher(options_, matcher_options_);
  const Pose2 slip(0.15, 0.1, DegToRad(6.));
  const auto match = [&](const Pose2& motion, const double field_of_view) {
    prediction_.motion = motion;
    field_of_view_ = field_of_view;
    return matcher.Match(Pose2(), prediction_, Cloud(),
                         *submaps_->submaps().front());
  };
  const double all = 2. * kPi, few = DegToRad(kFewDegrees);
  match(Pose2(), all);
  EXPECT_FALSE(match(slip, few).relocated);
  EXPECT_FALSE(match(Pose2(), all).relocated);
  EXPECT_TRUE(match(slip, all).relocated);
  EXPECT_TRUE(match(slip, few).relocated);
  EXPECT_FALSE(match(Pose2(), all).relocated);
  EXPECT_FALSE(match(slip, few).relocated);
}

// Scans none of which is evidence enough contradict the odometry together, if no
// scan in between agrees with it.
TEST_F(LocalMatcherTest, ContradictionsInSuccessionOverruleOdometry) {
  LocalMatcher matcher(options_, matcher_options_);
  const auto is_overruled = [&](const Pose2& motion, const double degrees) {
    prediction_.motion = motion;
    field_of_view_ = DegToRad(degrees);
    const LocalMatch match = matcher.Match(Pose2(), prediction_, Cloud(),
                                           *submaps_->submaps().front());
    return match.report.scan_information.norm() > 0.;
  };
  const Pose2 slip(0.08, 0.08, DegToRad(3.));
  constexpr double kFew = 35.;
  ASSERT_TRUE(is_overruled(Pose2(), 360.));
  for (int i = 0; i < 5; ++i) {
    EXPECT_FALSE(is_overruled(slip, kFew));
    EXPECT_TRUE(is_overruled(Pose2(), 360.));  // agrees
  }
  EXPECT_FALSE(is_overruled(slip, kFew));
  bool later = false;
  for (int i = 0; i < 3; ++i) later = later || is_overruled(slip, kFew);
  EXPECT_TRUE(later);
}

// As long as they see one thing only, which may be somebody who walks ahead of the
// robot, they do not, and the map goes on.
TEST_F(LocalMatcherTest, ASingleObjectDoesNotContestOdometry) {
  LocalMatcher matcher(options_, matcher_options_);
  const auto match = [&](const Pose2& motion, const double degrees) {
    prediction_.motion = motion;
    field_of_view_ = DegToRad(degrees);
    return matcher.Match(Pose2(), prediction_, Cloud(),
                         *submaps_->submaps().front());
  };
  matcher.SetFieldOfView(1.);
  for (const double degrees : {12., 13., 14.}) {
    match(Pose2(), 360.);  // what is usual
    for (int i = 0; i < 20; ++i) {
      const LocalMatch found = match(Pose2(0.12, 0.12, DegToRad(4.)), degrees);
      EXPECT_FALSE(found.overrules_odometry) << degrees << " " << i;
      EXPECT_FALSE(found.contested) << degrees << " " << i;
    }
  }
}

// Where something else than the odometry predicts, there is nothing to contest: its
// scans are not searched for the sake of a rival, which is forgotten.
TEST_F(LocalMatcherTest, ARivalOfTheOdometryEndsWithTheOdometry) {
  LocalMatcher matcher(options_, matcher_options_);
  const auto match = [&](const PredictionSource source, const Pose2& motion,
                         const double degrees) {
    prediction_.source = source;
    prediction_.motion = motion;
    field_of_view_ = DegToRad(degrees);
    return matcher.Match(Pose2(), prediction_, Cloud(),
                         *submaps_->submaps().front());
  };
  constexpr double kFew = 35.;
  const Pose2 slip(0.08, 0.08, DegToRad(3.));
  match(PredictionSource::kOdometry, Pose2(), 360.);  // what is usual
  bool is_overruled = false;
  for (int i = 0; i < 8; ++i) {
    const LocalMatch contested = match(PredictionSource::kOdometry, slip, kFew);
    EXPECT_TRUE(contested.searched);
    is_overruled = is_overruled || contested.overrules_odometry;
    match(PredictionSource::kConstantVelocity, Pose2(), 360.);
    EXPECT_FALSE(
        match(PredictionSource::kConstantVelocity, Pose2(), 360.).searched);
  }
  EXPECT_FALSE(is_overruled);
}

// While wheels slip, the pose by the odometry moves away from that of the scans,
// which is followed until it is evident: the last match makes up for the rest.
TEST_F(LocalMatcherTest, ARivalIsFollowedFromScanToScan) {
  LocalMatcher matcher(options_, matcher_options_);
  const auto match = [&](const Pose2& last, const Pose2& motion,
                         const double degrees) {
    prediction_.motion = motion;
    field_of_view_ = DegToRad(degrees);
    return matcher.Match(last, prediction_, Cloud(),
                         *submaps_->submaps().front());
  };
  match(Pose2(), Pose2(), 360.);  // what is usual
  Pose2 last;
  int contested = 0;
  bool is_over = false;
  for (int i = 0; i < 12 && !is_over; ++i) {
    const LocalMatch found = match(last, Pose2(0.03, 0., DegToRad(2.)), 33.);
    contested += found.contested ? 1 : 0;
    is_over = found.ends_contest;
    EXPECT_EQ(found.overrules_odometry, is_over);
    if (is_over) {  // the robot stands
      EXPECT_GT(Between(last, found.pose).translation().norm(), 0.03);
      EXPECT_LT(found.rival_motion.translation().norm(), 0.03);
      EXPECT_NEAR(found.rival_motion.theta, 0., 0.01);
    }
    last = found.pose;
  }
  EXPECT_GT(contested, 0);
  EXPECT_TRUE(is_over);
  EXPECT_LT(std::hypot(last.x, last.y), 0.1);
  EXPECT_NEAR(last.theta, 0., 0.02);
  // The next scan agrees with the odometry, which is trusted again.
  EXPECT_FALSE(match(Pose2(), Pose2(), 360.).overrules_odometry);
}

TEST_F(LocalMatcherTest, WithoutSearchItStaysWithThePrediction) {
  options_.enabled = false;
  const LocalMatch match = MatchFrom(Pose2(0.15, 0.1, DegToRad(6.)));
  EXPECT_FALSE(match.searched);
  EXPECT_FALSE(match.relocated);
}

TEST_F(LocalMatcherTest, NoPointsHaveNoScore) {
  EXPECT_EQ(scan_matching::MeanScore(Pose2(), PointCloud(),
                                     *submaps_->submaps().front()->grid()),
            0.);
  EXPECT_GT(scan_matching::MeanScore(Pose2(), Cloud(),
                                     *submaps_->submaps().front()->grid()),
            0.6);
}

}  // namespace
}  // namespace front_end
}  // namespace cartographer_ext
