// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
#include "cartographer_ext/loop_closure/dropin/match_information.h"

#include <cmath>
#include <memory>

#include "cartographer_ext/common/dropin/pose_conversion.h"
#include "gtest/gtest.h"
#include "tests/host/mapping_test_helpers.h"

namespace cartographer_ext {
namespace loop_closure {
namespace {

namespace host = cartographer::mapping;
using cartographer::sensor::PointCloud;

// Two walls along x, 2 m apart.
PointCloud Corridor(const float length) {
  PointCloud cloud;
  for (float x = -0.5f * length; x <= 0.5f * length; x += 0.04f) {
    cloud.push_back({Eigen::Vector3f(x, -1.025f, 0.f)});
    cloud.push_back({Eigen::Vector3f(x, 0.975f, 0.f)});
  }
  return cloud;
}

class MatchInformationTest : public testing::Test {
 protected:
  // Sees `cloud` five times.
  std::unique_ptr<host::ProbabilityGrid> GridOf(const PointCloud& cloud) {
    auto grid = absl::make_unique<host::ProbabilityGrid>(
        host::MapLimits(0.05, Eigen::Vector2d(5., 5.),
                        host::CellLimits(200, 200)),
        &tables_);
    host::ProbabilityGridRangeDataInserter2D inserter(
        host::test::InserterOptions(0.6, 0.45));
    for (int i = 0; i != 5; ++i) {
      inserter.Insert({Eigen::Vector3f::Zero(), cloud, {}}, grid.get());
    }
    return grid;
  }

  host::ValueConversionTables tables_;
};

TEST_F(MatchInformationTest, RoomIsObservedInAllDirections) {
  const auto grid = GridOf(host::test::Room());
  const Eigen::Matrix3d information =
      MatchInformation(*grid, host::test::Room(), Pose2(), Pose2());
  const Eigen::Vector3d sigma = information.inverse().diagonal().cwiseSqrt();
  // Between a tenth of a cell and a cell.
  EXPECT_GT(sigma.x(), 0.002);
  EXPECT_LT(sigma.x(), 0.05);
  EXPECT_GT(sigma.y(), 0.002);
  EXPECT_LT(sigma.y(), 0.05);
  EXPECT_LT(sigma.z(), 0.02);
}

TEST_F(MatchInformationTest, NothingIsKnownAlongACorridor) {
  const auto grid = GridOf(Corridor(8.f));
  // The scan sees the middle of it only.
  const Eigen::Matrix3d information =
      MatchInformation(*grid, Corridor(4.f), Pose2(), Pose2());
  EXPECT_GT(information(1, 1), 1e3);
  EXPECT_LT(information(0, 0), 1e-3 * information(1, 1));
  // The same corridor, seen from a submap that is turned against the grid.
  const Eigen::Matrix3d turned = MatchInformation(*grid, Corridor(4.f), Pose2(),
                                                  Pose2(0.3, -0.2, 0.5 * kPi));
  EXPECT_NEAR(turned(0, 0), information(1, 1), 1e-6 * information(1, 1));
  EXPECT_LT(turned(1, 1), 1e-3 * turned(0, 0));
}

TEST_F(MatchInformationTest, EmptyCloudHasNone) {
  const auto grid = GridOf(host::test::Room());
  EXPECT_TRUE(
      MatchInformation(*grid, PointCloud(), Pose2(), Pose2()).isZero(0.));
}

TEST_F(MatchInformationTest, FarFromTheMapThereIsNone) {
  const auto grid = GridOf(host::test::Room());
  EXPECT_TRUE(
      MatchInformation(*grid, host::test::Room(), Pose2(100., 0., 0.), Pose2())
          .isZero(1e-9));
}

}  // namespace
}  // namespace loop_closure
}  // namespace cartographer_ext
