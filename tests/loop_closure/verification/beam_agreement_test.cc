// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
#include "cartographer_ext/loop_closure/verification/beam_agreement.h"

#include <cmath>
#include <limits>
#include <vector>

#include "gtest/gtest.h"

namespace cartographer_ext {
namespace loop_closure {
namespace {

constexpr double kResolution = 0.1;

// A free room of 6 m x 4 m with its middle at (0, 0), walls one cell thick.
OccupancyView Room() {
  OccupancyView view(Eigen::Vector2d(-3.1, -2.1), kResolution, 62, 42);
  for (int j = 0; j < 42; ++j) {
    for (int i = 0; i < 62; ++i) {
      const bool wall = i == 0 || j == 0 || i == 61 || j == 41;
      view.Set(i, j, wall ? CellState::kOccupied : CellState::kFree);
    }
  }
  view.FindDistances(OccupancyView::kMaxReach);
  return view;
}

class BeamAgreementTest : public testing::Test {
 protected:
  BeamAgreementTest() : room_(Room()) {
    options_.tolerance = 1.;
    options_.clip = 0.5;
    options_.minimum_overlap = 0.5;
    maps_ = {{&room_, Pose2()}};
  }

  double Disagreement(const std::vector<Eigen::Vector2f>& points,
                      const Pose2& pose = Pose2()) {
    const std::vector<Beam> beams = BeamsFromPoints(options_, points);
    const PlacedMaps placed(maps_, pose);
    const double exact = placed.Disagreement(options_, beams);
    if (!std::isnan(exact)) {
      EXPECT_LE(placed.LeastDisagreement(options_, beams), exact);
    }
    return exact;
  }

  BeamAgreementOptions options_;
  OccupancyView room_;
  std::vector<ReferenceMap> maps_;
};

TEST_F(BeamAgreementTest, ThinsOutEvenlyAndLeavesOutTheRobot) {
  options_.max_beams = 3;
  const float nan = std::numeric_limits<float>::quiet_NaN();
  const std::vector<Beam> beams = BeamsFromPoints(options_, {{1.f, 0.f},
                                                             {0.05f, 0.f},
                                                             {2.f, 0.f},
                                                             {3.f, 0.f},
                                                             {nan, 0.f},
                                                             {4.f, 0.f},
                                                             {5.f, 0.f},
                                                             {0.f, 6.f}});
  ASSERT_EQ(beams.size(), 3u);
  EXPECT_EQ(beams[0].range, 1.f);
  EXPECT_EQ(beams[1].range, 3.f);
  EXPECT_EQ(beams[2].range, 5.f);
  EXPECT_TRUE(BeamsFromPoints(options_, {}).empty());
}

TEST_F(BeamAgreementTest, BeamsThatEndAtWallsAgree) {
  // In the walls, and one cell in front of one.
  EXPECT_EQ(Disagreement({{3.05f, 0.f}, {0.f, 2.05f}, {-2.95f, 1.f}}), 0.);
  // The robot moved and turned: what was ahead is to the left.
  EXPECT_EQ(
      Disagreement({{0.f, 2.55f}, {1.05f, 0.f}}, Pose2(0.5, -1., -kPi / 2.)),
      0.);
}

TEST_F(BeamAgreementTest, EndsInFreeSpaceDisagreeByTheirDistance) {
  // Three cells before the wall, one is forgiven; 0.2 of 0.5.
  EXPECT_NEAR(Disagreement({{2.75f, 0.05f}}), 0.4, 1e-6);
  // Farther than the clip.
  EXPECT_NEAR(Disagreement({{1.f, 0.05f}}), 1., 1e-6);
  // Half of both.
  EXPECT_NEAR(Disagreement({{1.f, 0.05f}, {3.05f, 0.f}}), 0.5, 1e-6);
  // A beam that grazes a wall: its range is 2 m short, its end one cell off.
  EXPECT_EQ(Disagreement({{-2.85f, 1.95f}}, Pose2(2.9, 0., 0.)), 0.);
}

TEST_F(BeamAgreementTest, BeamsDoNotGoThroughWalls) {
  EXPECT_NEAR(Disagreement({{5.f, 0.f}}), 1., 1e-6);
  OccupancyView larger(Eigen::Vector2d(-10., -10.), kResolution, 200, 200);
  for (int j = 0; j < 42; ++j) {
    for (int i = 0; i < 62; ++i) {
      larger.Set(i + 69, j + 79, room_.At(i, j));
    }
  }
  larger.FindDistances(OccupancyView::kMaxReach);
  maps_ = {{&larger, Pose2()}};
  // One cell behind the wall is forgiven, two are not.
  EXPECT_EQ(Disagreement({{3.15f, 0.05f}}), 0.);
  EXPECT_NEAR(Disagreement({{3.25f, 0.05f}}), (0.25 - 0.1) / 0.5, 0.05);
  // Without prediction along the beams nothing is known of it.
  const PlacedMaps placed(maps_, Pose2());
  EXPECT_EQ(placed.LeastDisagreement(
                options_, BeamsFromPoints(options_, {{3.25f, 0.05f}})),
            0.);
}

TEST_F(BeamAgreementTest, LongBeamsSayThatTheWayIsFree) {
  options_.max_range = 2.5;
  EXPECT_EQ(Disagreement({{50.f, 0.f}}), 0.);
  EXPECT_NEAR(Disagreement({{0.f, 50.f}}), (0.5 - 0.1) / 0.5, 0.05);
}

TEST_F(BeamAgreementTest, UnknownBeamsDoNotCountButAreMissed) {
  OccupancyView open = room_;
  // The right wall was never seen.
  for (int j = 0; j < 42; ++j) open.Set(61, j, CellState::kUnknown);
  open.FindDistances(OccupancyView::kMaxReach);
  maps_ = {{&open, Pose2()}};
  EXPECT_EQ(Disagreement({{5.f, 0.f}, {-3.05f, 0.f}}), 0.);
  EXPECT_TRUE(
      std::isnan(Disagreement({{5.f, 0.f}, {5.f, 0.1f}, {-3.05f, 0.f}})));
  // A second map knows, in a frame of its own.
  maps_.push_back({&room_, Pose2(0., 0., kPi)});
  EXPECT_NEAR(Disagreement({{5.f, 0.f}, {5.f, 0.1f}, {-3.05f, 0.f}}), 2. / 3.,
              1e-6);
}

TEST_F(BeamAgreementTest, WithoutMapsOrBeamsNothingIsKnown) {
  EXPECT_TRUE(std::isnan(Disagreement({})));
  EXPECT_TRUE(std::isnan(Disagreement({{3.f, 0.f}}, Pose2(NAN, 0., 0.))));
  EXPECT_TRUE(std::isnan(Disagreement({{3.f, 0.f}}, Pose2(1e300, 0., 0.))));
  maps_.clear();
  EXPECT_TRUE(std::isnan(Disagreement({{3.f, 0.f}})));
}

TEST_F(BeamAgreementTest, ReachHasRoomForToleranceAndClip) {
  EXPECT_EQ(DistanceReach(options_, 0.1), 6);
  EXPECT_EQ(DistanceReach(options_, 0.01), OccupancyView::kMaxReach);
}

}  // namespace
}  // namespace loop_closure
}  // namespace cartographer_ext
