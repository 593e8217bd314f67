// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
#include "cartographer_ext/scan_matching/dropin/scan_evidence.h"

#include <cmath>

#include "cartographer/mapping/2d/probability_grid.h"
#include "cartographer/mapping/probability_values.h"
#include "cartographer/mapping/value_conversion_tables.h"
#include "gtest/gtest.h"

namespace cartographer_ext {
namespace scan_matching {
namespace {

using cartographer::mapping::CellLimits;
using cartographer::mapping::MapLimits;
using cartographer::mapping::ProbabilityGrid;
using cartographer::sensor::PointCloud;

// A wall of p = 0.8 along x = 1 from y = 0 to 2, free space of p = 0.2 before
// it (x from 0 to 1), nothing seen behind it. Cells of 5 cm.
class ScanEvidenceTest : public testing::Test {
 protected:
  ScanEvidenceTest()
      : grid_(MapLimits(0.05, Eigen::Vector2d(2., 2.), CellLimits(40, 40)),
              &tables_) {
    for (double y = 0.025; y < 2.; y += 0.05) {
      for (double x = 0.025; x < 1.; x += 0.05) Set(x, y, 0.2f);
      Set(1.025, y, 0.8f);
    }
  }

  void Set(const double x, const double y, const float probability) {
    grid_.SetProbability(grid_.limits().GetCellIndex(Eigen::Vector2f(x, y)),
                         probability);
  }

  static PointCloud Wall(const double from, const double to) {
    PointCloud cloud;
    for (double y = from + 0.0125; y < to; y += 0.025) {
      cloud.push_back({Eigen::Vector3f(1.025f, y, 0.f)});
    }
    return cloud;
  }

  cartographer::mapping::ValueConversionTables tables_;
  ProbabilityGrid grid_;
};

// One metre of wall is four patches; each says ln(0.8 / 0.2) against a place 10
// cm before the wall, ln(0.8 / 0.5) against one behind it.
TEST_F(ScanEvidenceTest, CountsPatches) {
  const PointCloud cloud = Wall(0.5, 1.5);
  EXPECT_NEAR(ScanEvidence(Pose2(), Pose2(-0.1, 0., 0.), cloud, grid_),
              4. * std::log(4.), 1e-3);
  EXPECT_NEAR(ScanEvidence(Pose2(), Pose2(0.1, 0., 0.), cloud, grid_),
              4. * std::log(1.6), 1e-3);
  EXPECT_NEAR(ScanEvidence(Pose2(-0.1, 0., 0.), Pose2(), cloud, grid_),
              -4. * std::log(4.), 1e-3);
  // Along the wall nothing tells the places apart.
  EXPECT_NEAR(ScanEvidence(Pose2(), Pose2(0., 0.2, 0.), cloud, grid_), 0.,
              1e-6);
}

// Of two metres of wall a metre may be one object, the evidence of which is left
// out; what speaks against the pose is not.
TEST_F(ScanEvidenceTest, WithoutTheObjectThatSpeaksMostForThePose) {
  const Pose2 before(-0.1, 0., 0.);
  const auto without = [&](const PointCloud& cloud, const Pose2& pose,
                           const Pose2& other) {
    return PoseEvidence(pose, cloud, grid_, PosePrecision::kExact)
        .AgainstWithoutObject(other);
  };
  EXPECT_NEAR(without(Wall(0., 2.), Pose2(), before), 4. * std::log(4.), 0.2);
  EXPECT_NEAR(without(Wall(0.5, 1.4), Pose2(), before), 0., 1e-6);
  EXPECT_NEAR(without(Wall(0., 2.), before, Pose2()), -8. * std::log(4.), 1e-3);
  EXPECT_EQ(without(PointCloud(), Pose2(), before), 0.);
}

// A cell behind the wall nothing was seen.
TEST_F(ScanEvidenceTest, APoseIsNotKnownBetterThanToACell) {
  const PointCloud cloud = Wall(0.5, 1.5);
  const Pose2 behind(0.05, 0., 0.);
  EXPECT_NEAR(PoseEvidence(Pose2(), cloud, grid_, PosePrecision::kExact)
                  .Against(behind),
              4. * std::log(1.6), 1e-3);
  EXPECT_NEAR(
      PoseEvidence(Pose2(), cloud, grid_, PosePrecision::kCell).Against(behind),
      0., 1e-6);
  EXPECT_NEAR(
      PoseEvidence(behind, cloud, grid_, PosePrecision::kCell).Against(Pose2()),
      -4. * std::log(1.6), 1e-3);
  EXPECT_NEAR(ScanEvidence(Pose2(), behind, cloud, grid_), 0., 1e-6);
  // Two cells are more than one.
  EXPECT_NEAR(PoseEvidence(Pose2(), cloud, grid_, PosePrecision::kCell)
                  .Against(Pose2(0.1, 0., 0.)),
              4. * std::log(1.6), 1e-3);
}

// Few beams hit a wall far along a corridor. While the robot stood, the wall
// became known where they did, and free between, where others graze it.
TEST_F(ScanEvidenceTest, AWallGoesOnBetweenItsBeams) {
  PointCloud cloud;
  for (int i = 0; i < 40; ++i) {
    const double y = 0.025 + 0.05 * i;
    const bool is_hit = i % 10 == 5;
    Set(1.525, y, is_hit ? 0.8f : 0.2f);
    if (is_hit) cloud.push_back({Eigen::Vector3f(1.525f, y, 0.f)});
  }
  // The last one leaves the grid.
  const Pose2 moved(0., 0.25, 0.);
  EXPECT_NEAR(
      PoseEvidence(Pose2(), cloud, grid_, PosePrecision::kExact).Against(moved),
      3. * std::log(4.) + std::log(1.6), 1e-3);
  EXPECT_NEAR(ScanEvidence(Pose2(), moved, cloud, grid_), std::log(1.6), 1e-3);
  // Away from the wall it is another place.
  EXPECT_NEAR(ScanEvidence(Pose2(), Pose2(-0.2, 0.25, 0.), cloud, grid_),
              4. * std::log(1.6), 1e-3);
}

TEST_F(ScanEvidenceTest, BeamsOfOnePatchCountOnce) {
  PointCloud dense = Wall(0.5, 1.);
  const int size = static_cast<int>(dense.size());
  for (int i = 0; i < size; ++i) dense.push_back(dense[i]);
  EXPECT_NEAR(ScanEvidence(Pose2(), Pose2(-0.1, 0., 0.), dense, grid_),
              2. * std::log(4.), 1e-3);
}

TEST_F(ScanEvidenceTest, PatchesAreCells) {
  EXPECT_EQ(NumPatches(Wall(0.5, 1.5)), 4);
  PointCloud cloud = Wall(0.5, 0.75);
  EXPECT_EQ(NumPatches(cloud), 1);
  cloud.push_back({Eigen::Vector3f(std::nanf(""), 0.f, 0.f)});
  EXPECT_EQ(NumPatches(cloud), 1);
  // Left of zero begins another one.
  cloud.push_back({Eigen::Vector3f(-0.1f, 0.6f, 0.f)});
  cloud.push_back({Eigen::Vector3f(0.1f, 0.6f, 0.f)});
  EXPECT_EQ(NumPatches(cloud), 3);
  EXPECT_EQ(NumPatches(PointCloud()), 0);
}

TEST_F(ScanEvidenceTest, NothingSeenSaysNothing) {
  EXPECT_EQ(ScanEvidence(Pose2(), Pose2(1., 0., 0.), PointCloud(), grid_), 0.);
  // Both places are outside of what has been seen, one of the grid, too.
  EXPECT_NEAR(ScanEvidence(Pose2(0.5, 0., 0.), Pose2(40., 0., 0.),
                           Wall(0.5, 1.5), grid_),
              0., 1e-9);
  PointCloud bad;
  bad.push_back({Eigen::Vector3f(std::nanf(""), 0.f, 0.f)});
  EXPECT_EQ(ScanEvidence(Pose2(), Pose2(-0.1, 0., 0.), bad, grid_), 0.);
}

}  // namespace
}  // namespace scan_matching
}  // namespace cartographer_ext
