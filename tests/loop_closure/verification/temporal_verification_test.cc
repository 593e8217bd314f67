// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
#include "cartographer_ext/loop_closure/verification/temporal_verification.h"

#include <algorithm>
#include <cmath>
#include <memory>
#include <set>

#include "cartographer_ext/loop_closure/verification/dtw.h"
#include "gtest/gtest.h"

namespace cartographer_ext {
namespace loop_closure {
namespace {

constexpr double kResolution = 0.1;

// A corridor along x from 0 to `length`, 2 m wide (y from -1 to 1), with
// niches of half a metre in its left wall at the given places (metres).
OccupancyView Corridor(double length, const std::vector<double>& niches,
                       double known_from = 0.) {
  const int nx = static_cast<int>(std::lround(length / kResolution));
  const int ny = 32;
  OccupancyView view(Eigen::Vector2d(0., -1.1), kResolution, nx, ny);
  for (int i = 0; i < nx; ++i) {
    const double x = (i + 0.5) * kResolution;
    if (x < known_from) continue;
    bool niche = false;
    for (const double place : niches) {
      niche = niche || std::abs(x - place) < 0.5;
    }
    const int top = niche ? 30 : 21;
    for (int j = 0; j <= top; ++j) {
      view.Set(i, j,
               j == 0 || j == top ? CellState::kOccupied : CellState::kFree);
    }
    // The sides of a niche.
    if (!niche) {
      for (int j = top; j <= 30; ++j) view.Set(i, j, CellState::kOccupied);
    }
  }
  return view;
}

class TemporalVerificationTest : public testing::Test {
 protected:
  TemporalVerificationTest() : history_(1000) {
    options_.comparison = ScanComparison::kSectors;
    options_.signature.max_range = 4.;
    options_.beams.max_range = 8.;
    options_.oversampling = 2;
    options_.minimum_length = 4;
  }

  // Drives along the corridor; the odometry reads `scale` times the distance.
  void Drive(const OccupancyView& world, double from, double to, double scale) {
    int index = 0;
    for (double x = from; x <= to + 1e-9; x += 0.5) {
      HistoryNode node;
      node.node_index = index++;
      node.local_pose = Pose2(0., scale * x, kPi / 2.);  // another frame
      const Pose2 pose(x, 0., 0.);
      if (options_.comparison == ScanComparison::kSectors) {
        node.signature = PredictSignature(options_.signature, world, pose);
      } else {
        DescribeScan(options_, Scan(world, pose), &node);
      }
      history_.Add(0, node);
    }
    last_ = index - 1;
  }

  // In the frame of the robot.
  static std::vector<Eigen::Vector2f> Scan(const OccupancyView& world,
                                           const Pose2& pose) {
    RayOptions rays;
    rays.max_range = 8.;
    std::vector<Eigen::Vector2f> points;
    for (int i = 0; i < 120; ++i) {
      const double angle = 2. * kPi * i / 120.;
      const double range =
          CastRay(world, pose.translation(), pose.theta + angle, rays);
      if (std::isnan(range) || range == rays.max_range) continue;
      points.emplace_back(static_cast<float>(range * std::cos(angle)),
                          static_cast<float>(range * std::sin(angle)));
    }
    return points;
  }

  TemporalResult Verify(const std::vector<ReferenceMap>& maps,
                        const Pose2& candidate, int count = 12) {
    return VerifySequence(options_,
                          history_.Sequence(0, last_, count, 0.5, 1000),
                          candidate, maps);
  }

  TemporalVerificationOptions options_;
  NodeHistory history_;
  int last_ = 0;
  const double candidate_x_ = 9.8;  // beside the true place
};

TEST_F(TemporalVerificationTest, TrueLoopScoresHigherThanLookAlike) {
  // The niche at 20 looks like the one at 10, the path to it differs.
  const OccupancyView world =
      Corridor(30., {5.5, 7., 8.5, 10., 11.5, 20., 21.5});
  Drive(world, 4., 10., 1.);
  const std::vector<ReferenceMap> maps = {{&world, Pose2()}};
  const TemporalResult same = Verify(maps, Pose2(10., 0., 0.));
  ASSERT_EQ(same.outcome, TemporalOutcome::kScored);
  EXPECT_EQ(same.num_query, 12);
  EXPECT_EQ(same.num_reference, 23);
  EXPECT_NEAR(same.travelled, 5.5, 1e-9);
  EXPECT_GT(same.score, 0.97);
  const TemporalResult other = Verify(maps, Pose2(20., 0., 0.));
  ASSERT_EQ(other.outcome, TemporalOutcome::kScored);
  EXPECT_GT(same.score - other.score, 0.02);
  // One scan alone could not tell.
  options_.minimum_length = 1;
  EXPECT_NEAR(Verify(maps, Pose2(20., 0., 0.), 1).score,
              Verify(maps, Pose2(10., 0., 0.), 1).score, 0.03);
}

TEST_F(TemporalVerificationTest, PerfectRepetitionIsOne) {
  const OccupancyView world = Corridor(30., {5.5, 8., 10.});
  Drive(world, 4., 10., 1.);
  const std::vector<ReferenceMap> maps = {{&world, Pose2()}};
  // Local pose and candidate differ by a turn, so rays are rounded apart.
  const double asymmetric = Verify(maps, Pose2(10., 0., 0.)).score;
  EXPECT_NEAR(asymmetric, 1., 2e-2);
  // The samples between the nodes cost something.
  options_.step = WarpingStep::kSymmetric;
  const double symmetric = Verify(maps, Pose2(10., 0., 0.)).score;
  EXPECT_LE(symmetric, asymmetric);
  EXPECT_GT(symmetric, 0.85);
  options_.oversampling = 1;
  EXPECT_NEAR(Verify(maps, Pose2(10., 0., 0.)).score, 1., 2e-2);
}

TEST_F(TemporalVerificationTest, WarpingAbsorbsOdometryScale) {
  const OccupancyView world = Corridor(30., {5.5, 8., 10.});
  Drive(world, 4., 10., 1.06);
  const std::vector<ReferenceMap> maps = {{&world, Pose2()}};
  options_.oversampling = 4;
  const double warped = Verify(maps, Pose2(10., 0., 0.)).score;
  options_.band = 0.;
  const double stiff = Verify(maps, Pose2(10., 0., 0.)).score;
  EXPECT_GT(warped, stiff);
  EXPECT_GT(warped, 0.85);
}

TEST_F(TemporalVerificationTest, NeighboursContinueTheReference) {
  const std::vector<double> niches = {5.5, 8., 10.};
  const OccupancyView world = Corridor(30., niches);
  const OccupancyView late = Corridor(30., niches, 8.);
  Drive(world, 4., 10., 1.);
  const TemporalResult alone = Verify({{&late, Pose2()}}, Pose2(10., 0., 0.));
  ASSERT_EQ(alone.outcome, TemporalOutcome::kScored);
  EXPECT_LT(alone.num_query, 8);
  // The neighbour has its own frame.
  OccupancyView moved(Eigen::Vector2d(100., -1.1), kResolution, world.num_x(),
                      world.num_y());
  for (int i = 0; i < world.num_x(); ++i) {
    for (int j = 0; j < world.num_y(); ++j) moved.Set(i, j, world.At(i, j));
  }
  const TemporalResult both = Verify(
      {{&late, Pose2()}, {&moved, Pose2(100., 0., 0.)}}, Pose2(10., 0., 0.));
  EXPECT_EQ(both.num_query, 12);
  EXPECT_GT(both.score, 0.9);
}

TEST_F(TemporalVerificationTest, BeamsTellLookAlikesApart) {
  OccupancyView world =
      Corridor(30., {5.5, 7., 8.5, 10., 15.5, 17.3, 18.2, 20.});
  world.FindDistances(OccupancyView::kMaxReach);
  const std::vector<ReferenceMap> maps = {{&world, Pose2()}};
  options_.comparison = ScanComparison::kBeams;
  Drive(world, 4., 10., 1.);
  const TemporalResult same = Verify(maps, Pose2(10., 0., 0.));
  ASSERT_EQ(same.outcome, TemporalOutcome::kScored);
  EXPECT_EQ(same.num_query, 12);
  EXPECT_GT(same.score, 0.99);
  const TemporalResult other = Verify(maps, Pose2(20., 0., 0.));
  ASSERT_EQ(other.outcome, TemporalOutcome::kScored);
  EXPECT_GT(same.score - other.score, 0.05);
  EXPECT_EQ(Verify(maps, Pose2(10., 40., 0.)).outcome,
            TemporalOutcome::kPathUnknown);
}

// Costs that are only bounded do not change the result.
TEST_F(TemporalVerificationTest, LazyCostsGiveTheCheapestWay) {
  OccupancyView world = Corridor(30., {5.5, 8., 10.});
  world.FindDistances(OccupancyView::kMaxReach);
  const std::vector<ReferenceMap> maps = {{&world, Pose2()}};
  options_.comparison = ScanComparison::kBeams;
  for (const double scale : {1., 1.05, 0.9}) {
    history_.DeleteTrajectory(0);
    Drive(world, 4., 10., scale);
    const auto query = history_.Sequence(0, last_, 12, 0.4, 1000);
    const int n = static_cast<int>(query.size());
    std::vector<double> cost;
    for (int i = 0; i < n; ++i) {
      for (int j = 0; j < 2 * n - 1; ++j) {
        const Pose2 pose = j % 2 == 0
                               ? query[j / 2]->local_pose
                               : Interpolate(query[j / 2 + 1]->local_pose,
                                             query[j / 2]->local_pose, 0.5);
        cost.push_back(PlacedMaps(maps, Pose2(candidate_x_, 0., 0.) *
                                            query.back()->local_pose.Inverse() *
                                            pose)
                           .Disagreement(options_.beams, query[i]->beams));
      }
    }
    const auto exhaustive = AsymmetricTimeWarping(n, 2 * n - 1, cost, 2., 4);
    const TemporalResult lazy =
        VerifySequence(options_, query, Pose2(candidate_x_, 0., 0.), maps);
    ASSERT_TRUE(exhaustive.has_value());
    ASSERT_EQ(lazy.num_query, n);
    EXPECT_NEAR(lazy.score, exhaustive->score(), 1e-12);
  }
}

TEST_F(TemporalVerificationTest, WithoutEvidenceThereIsNoScore) {
  const OccupancyView world = Corridor(30., {5.5, 8., 10.});
  Drive(world, 4., 10., 1.);
  const std::vector<ReferenceMap> maps = {{&world, Pose2()}};
  EXPECT_EQ(Verify(maps, Pose2(10., 0., 0.), 3).outcome,
            TemporalOutcome::kShortHistory);
  EXPECT_EQ(Verify(maps, Pose2(10., 40., 0.)).outcome,
            TemporalOutcome::kPathUnknown);
  EXPECT_EQ(Verify(maps, Pose2(NAN, 0., 0.)).outcome,
            TemporalOutcome::kPathUnknown);
  EXPECT_EQ(Verify({}, Pose2(10., 0., 0.)).outcome,
            TemporalOutcome::kPathUnknown);
  EXPECT_EQ(VerifySequence(options_, {}, Pose2(), maps).outcome,
            TemporalOutcome::kShortHistory);
  // Half of the path is beyond the start of the map.
  const TemporalResult cut = Verify(maps, Pose2(2., 0., 0.));
  EXPECT_LT(cut.num_query, 6);
}

}  // namespace
}  // namespace loop_closure
}  // namespace cartographer_ext
