// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
#include "cartographer/mapping/internal/2d/scan_matching/correlative_scan_matcher_2d.h"

#include <cmath>

#include "cartographer/mapping/internal/2d/scan_matching/rotated_cell_indices.h"
#include "gtest/gtest.h"
#include "tests/host/mapping_test_helpers.h"

namespace cartographer {
namespace mapping {
namespace scan_matching {
namespace {

TEST(SearchParametersTest, AngularStepFollowsTheFarthestPoint) {
  const sensor::PointCloud cloud = test::Cloud({{1.f, 0.f}, {3.f, 4.f}});
  const SearchParameters parameters(0.12, 0.1, cloud, 0.05);
  const double step = 0.999 * std::acos(1. - 0.05 * 0.05 / (2. * 25.));
  EXPECT_NEAR(parameters.angular_perturbation_step_size, step, 1e-12);
  EXPECT_EQ(parameters.num_angular_perturbations, std::ceil(0.1 / step));
  EXPECT_EQ(parameters.num_scans, 2 * parameters.num_angular_perturbations + 1);
  ASSERT_EQ(parameters.linear_bounds.size(),
            static_cast<size_t>(parameters.num_scans));
  EXPECT_EQ(parameters.linear_bounds[0].min_x, -3);
  EXPECT_EQ(parameters.linear_bounds[0].max_y, 3);
}

TEST(SearchParametersTest, NearPointsCountAsThreeCells) {
  const SearchParameters parameters(0., 0.5, test::Cloud({{0.01f, 0.f}}), 0.05);
  EXPECT_NEAR(parameters.angular_perturbation_step_size,
              0.999 * std::acos(1. - 1. / 18.), 1e-6);
}

TEST(CandidateTest, OffsetsRunAgainstTheWorldAxes) {
  const SearchParameters parameters(5, 5, 0.03, 0.05);
  const Candidate2D candidate(3, 4, -5, parameters);
  EXPECT_NEAR(candidate.x, 0.25, 1e-12);
  EXPECT_NEAR(candidate.y, -0.2, 1e-12);
  EXPECT_NEAR(candidate.orientation, -2 * 0.03, 1e-12);
}

TEST(RotatedScansTest, TurnsByEveryAngle) {
  const SearchParameters parameters(0, 1, M_PI / 2., 1.);
  const auto scans =
      GenerateRotatedScans(test::Cloud({{-1.f, 1.f}}), parameters);
  ASSERT_EQ(scans.size(), 3u);
  const float expected[3][2] = {{1.f, 1.f}, {-1.f, 1.f}, {-1.f, -1.f}};
  for (int i = 0; i != 3; ++i) {
    EXPECT_NEAR(scans[i][0].position.x(), expected[i][0], 1e-6);
    EXPECT_NEAR(scans[i][0].position.y(), expected[i][1], 1e-6);
  }
}

TEST(DiscretizeScansTest, MovesThenFindsCells) {
  const MapLimits limits(0.05, Eigen::Vector2d(0.05, 0.25), CellLimits(6, 6));
  const auto scans = DiscretizeScans(
      limits, {test::Cloud({{0.025f, 0.175f}, {-0.125f, 0.125f}})},
      Eigen::Translation2f(0.f, -0.05f));
  ASSERT_EQ(scans.size(), 1u);
  EXPECT_TRUE((scans[0][0] == Eigen::Array2i(2, 0)).all());
  EXPECT_TRUE((scans[0][1] == Eigen::Array2i(3, 3)).all());
}

// The fast method must find exactly the cells of the two steps above.
TEST(RotatedCellIndicesTest, SameCellsBitForBit) {
  const sensor::PointCloud cloud = test::Room();
  const MapLimits limits(0.05, Eigen::Vector2d(3.3, 2.7), CellLimits(60, 70));
  for (const transform::Rigid2d& pose :
       {transform::Rigid2d({0.31, -0.77}, 0.123),
        transform::Rigid2d({-7.12, 1234.5}, -2.9)}) {
    const sensor::PointCloud rotated = RotateCloud(cloud, pose);
    const SearchParameters parameters(0.2, 0.7, rotated, 0.05);
    const Eigen::Vector2f translation = pose.translation().cast<float>();
    const auto scans =
        DiscretizeScans(limits, GenerateRotatedScans(rotated, parameters),
                        Eigen::Translation2f(translation));
    const RotatedCellIndices indices(rotated, parameters, limits,
                                     pose.translation());
    ASSERT_EQ(indices.num_points(), static_cast<int>(cloud.size()));
    ASSERT_EQ(indices.num_rotations(), parameters.num_scans);
    std::vector<int> x(cloud.size());
    std::vector<int> y(cloud.size());
    for (int i = 0; i != parameters.num_scans; ++i) {
      indices.ForRotation(i, x.data(), y.data());
      for (size_t k = 0; k != cloud.size(); ++k) {
        ASSERT_EQ(x[k], scans[i][k].x());
        ASSERT_EQ(y[k], scans[i][k].y());
      }
    }
    x.resize(parameters.num_scans);
    y.resize(parameters.num_scans);
    for (int k = 0; k != indices.num_points(); ++k) {
      indices.ForPoint(k, 1, parameters.num_scans, x.data(), y.data());
      for (int i = 1; i != parameters.num_scans; ++i) {
        ASSERT_EQ(x[i - 1], scans[i][k].x());
        ASSERT_EQ(y[i - 1], scans[i][k].y());
      }
    }
  }
}

TEST(RotatedCellIndicesTest, NumbersFarOutsideStayOutside) {
  const float nan = std::nanf("");
  const sensor::PointCloud cloud = test::Cloud({{1e30f, nan}, {-1e30f, 0.f}});
  const SearchParameters parameters(0, 0, 0.1, 0.05);
  const MapLimits limits(0.05, Eigen::Vector2d(3., 3.), CellLimits(60, 60));
  const RotatedCellIndices indices(cloud, parameters, limits,
                                   Eigen::Vector2d::Zero());
  int x[2];
  int y[2];
  indices.ForRotation(0, x, y);
  for (int i = 0; i != 2; ++i) {
    EXPECT_FALSE(limits.Contains({x[i], y[i]}));
    EXPECT_LE(std::abs(y[i]), 100000001);
  }
}

}  // namespace
}  // namespace scan_matching
}  // namespace mapping
}  // namespace cartographer
