// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
#include "cartographer_ext/io/trajectory_file.h"

#include <string>
#include <vector>

#include "cartographer_ext/common/random.h"
#include "gmock/gmock.h"
#include "gtest/gtest.h"
#include "tests/mutation.h"
#include "tests/test_data.h"

namespace cartographer_ext {
namespace io {
namespace {

using ::testing::HasSubstr;

absl::StatusOr<std::vector<StampedPose>> ReadText(const std::string& text) {
  test::TemporaryFile file(".tum");
  test::WriteBytes(file.path(), text);
  return ReadTumTrajectory(file.path());
}

TEST(TrajectoryFileTest, ReadsKnownText) {
  const auto trajectory = ReadText(
      "# timestamp tx ty tz qx qy qz qw\n"
      "\n"
      "1305031102.1753 1 2 3 0 0 0.7071068 0.7071068\n"
      "1305031102.2753 -1 0 0 0 0 0 -1\n");
  ASSERT_TRUE(trajectory.ok()) << trajectory.status();
  ASSERT_EQ(trajectory->size(), 2u);
  EXPECT_EQ((*trajectory)[0].time, 1305031102175300000);
  const Eigen::Isometry3d& pose = (*trajectory)[0].pose;
  EXPECT_TRUE(pose.translation().isApprox(Eigen::Vector3d(1., 2., 3.)));
  // A quarter turn: x goes to y.
  EXPECT_TRUE((pose.linear() * Eigen::Vector3d::UnitX())
                  .isApprox(Eigen::Vector3d::UnitY(), 1e-6));
  EXPECT_TRUE((*trajectory)[1].pose.linear().isIdentity(1e-12));
}

TEST(TrajectoryFileTest, RoundTrip) {
  Random random(2);
  std::vector<StampedPose> trajectory;
  for (int i = 0; i < 100; ++i) {
    StampedPose stamped;
    stamped.time = 1134864629895182123 + 1000000007LL * i;
    stamped.pose.translation() = Eigen::Vector3d(
        random.Normal(0., 100.), random.Normal(0., 100.), random.Normal());
    stamped.pose.linear() = Eigen::Quaterniond(random.Normal(), random.Normal(),
                                               random.Normal(), random.Normal())
                                .normalized()
                                .toRotationMatrix();
    trajectory.push_back(stamped);
  }
  trajectory.push_back(
      MakeStampedPose(trajectory.back().time + 1, Pose2(1., 2., kPi / 2.)));
  EXPECT_TRUE((trajectory.back().pose.linear() * Eigen::Vector3d::UnitX())
                  .isApprox(Eigen::Vector3d::UnitY(), 1e-12));
  test::TemporaryFile file(".tum");
  ASSERT_TRUE(WriteTumTrajectory(trajectory, file.path()).ok());
  const auto again = ReadTumTrajectory(file.path());
  ASSERT_TRUE(again.ok()) << again.status();
  ASSERT_EQ(again->size(), trajectory.size());
  for (size_t i = 0; i < trajectory.size(); ++i) {
    EXPECT_EQ((*again)[i].time, trajectory[i].time);
    EXPECT_LT(
        ((*again)[i].pose.translation() - trajectory[i].pose.translation())
            .cwiseAbs()
            .maxCoeff(),
        6e-7);
    EXPECT_LT(((*again)[i].pose.linear() - trajectory[i].pose.linear()).norm(),
              1e-8);
  }
}

TEST(TrajectoryFileTest, ErrorsNameTheLine) {
  const auto message = [](const std::string& text) {
    return std::string(ReadText(text).status().message());
  };
  EXPECT_THAT(message(""), HasSubstr("no pose"));
  EXPECT_THAT(message("x 0 0 0 0 0 0 1\n"), HasSubstr(".tum:1: invalid stamp"));
  EXPECT_THAT(message("1 0 0 0 0 0 0\n"),
              HasSubstr(".tum:1: expected numbers up to 1e9"));
  EXPECT_THAT(message("1 0 1e308 0 0 0 0 1\n"),
              HasSubstr("expected numbers up to 1e9"));
  EXPECT_THAT(message("1 0 nan 0 0 0 0 1\n"),
              HasSubstr("expected numbers up to 1e9"));
  EXPECT_THAT(message("1 0 0 0 0 0 0 1 5\n"), HasSubstr("too many words"));
  EXPECT_THAT(message("1 0 0 0 0 0 0 0.5\n"), HasSubstr("unit length"));
  EXPECT_THAT(message("2 0 0 0 0 0 0 1\n1 0 0 0 0 0 0 1\n"),
              HasSubstr(".tum:2: the stamp goes backwards"));
  EXPECT_FALSE(WriteTumTrajectory({}, "/nonexistent/a.tum").ok());
  if (test::Exists("/dev/full")) {
    EXPECT_EQ(WriteTumTrajectory({}, "/dev/full").code(),
              absl::StatusCode::kResourceExhausted);
  }
}

TEST(TrajectoryFileTest, SurvivesMutations) {
  const std::string sample =
      "# timestamp tx ty tz qx qy qz qw\n"
      "1.5 1 2 3 0 0 0.7071068 0.7071068\n"
      "2.5 1 2 3 0 0 0 1\n"
      "3.5 1.5 2 3 0 0 0 1\n";
  test::ForEachMutation(sample, [](const std::string& damaged) {
    const auto trajectory = ReadText(damaged);
    if (!trajectory.ok()) return;
    for (const StampedPose& stamped : *trajectory) {
      EXPECT_TRUE(stamped.pose.matrix().allFinite());
    }
  });
}

}  // namespace
}  // namespace io
}  // namespace cartographer_ext
