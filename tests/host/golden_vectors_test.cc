// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
//
// The host against what the real Cartographer makes of the same simulated log.
#include <algorithm>
#include <cmath>
#include <map>
#include <string>
#include <vector>

#include "gtest/gtest.h"
#include "tests/host/golden_run.h"
#include "tests/test_data.h"

namespace cartographer {
namespace {

using golden_run::Row;
using RowsByName = std::map<std::string, std::vector<std::vector<double>>>;

RowsByName ByName(const std::vector<Row>& rows) {
  RowsByName result;
  for (const Row& row : rows) {
    result[row.name].push_back(row.values);
  }
  return result;
}

class GoldenVectorsTest : public ::testing::Test {
 protected:
  // One run serves all tests.
  static void SetUpTestSuite() {
    golden_ = new RowsByName(ByName(golden_run::Read(
        cartographer_ext::test::OwnData("cartographer/golden.txt"))));
    ours_ =
        new RowsByName(ByName(golden_run::Run(cartographer_ext::test::OwnData(
                                                  "cartographer/loop.clf"))
                                  .All()));
  }
  static void TearDownTestSuite() {
    delete golden_;
    delete ours_;
  }

  // All values of all rows of this name agree within the tolerance.
  static void ExpectSame(const std::string& name, const double tolerance) {
    ASSERT_EQ(golden_->count(name), 1u) << name;
    ASSERT_EQ(ours_->count(name), 1u) << name;
    const auto& golden = golden_->at(name);
    const auto& ours = ours_->at(name);
    ASSERT_EQ(ours.size(), golden.size()) << name;
    for (size_t row = 0; row < golden.size(); ++row) {
      ASSERT_EQ(ours[row].size(), golden[row].size()) << name << " " << row;
      for (size_t i = 0; i < golden[row].size(); ++i) {
        // Nine digits are stored.
        ASSERT_NEAR(ours[row][i], golden[row][i],
                    tolerance + 1e-8 * std::abs(golden[row][i]))
            << name << ", row " << row << ", value " << i;
      }
    }
  }

  static RowsByName* golden_;
  static RowsByName* ours_;
};

RowsByName* GoldenVectorsTest::golden_ = nullptr;
RowsByName* GoldenVectorsTest::ours_ = nullptr;

TEST_F(GoldenVectorsTest, SameResults) {
  ASSERT_EQ(golden_->size(), ours_->size());
}

TEST_F(GoldenVectorsTest, VoxelFilters) {
  ExpectSame("voxel_filter", 1e-6);
  ExpectSame("adaptive_voxel_filter", 1e-6);
}

TEST_F(GoldenVectorsTest, MotionFilter) { ExpectSame("motion_filter", 0.); }

TEST_F(GoldenVectorsTest, PoseExtrapolator) {
  ExpectSame("pose_extrapolator", 1e-7);
  ExpectSame("gravity", 1e-7);
}

TEST_F(GoldenVectorsTest, ProbabilityGrid) {
  ExpectSame("grid_limits", 1e-7);
  ExpectSame("grid_cells", 0.);
}

TEST_F(GoldenVectorsTest, CorrelativeMatchers) {
  ExpectSame("real_time_match", 1e-6);
  ExpectSame("fast_match", 1e-6);
  ExpectSame("fast_match_full", 1e-6);
}

TEST_F(GoldenVectorsTest, CeresMatcher) { ExpectSame("ceres_match", 1e-6); }

TEST_F(GoldenVectorsTest, LocalSlam) { ExpectSame("local_slam", 1e-5); }

TEST_F(GoldenVectorsTest, PoseGraph) {
  ExpectSame("intra_constraint", 1e-5);
  ExpectSame("loop_constraint", 1e-5);
  ExpectSame("submap_pose", 1e-4);
  ExpectSame("node_pose", 1e-4);
}

// What the numbers are good for: the log closes a loop.
TEST_F(GoldenVectorsTest, TheLogHasLoops) {
  ASSERT_EQ(golden_->count("loop_constraint"), 1u);
  const auto& loops = golden_->at("loop_constraint");
  EXPECT_GE(loops.size(), 10u);
  EXPECT_TRUE(std::any_of(loops.begin(), loops.end(),
                          [](const std::vector<double>& loop) {
                            const double submap = loop[3];
                            const double node = loop[4];
                            return submap == 0. && node > 80.;
                          }));
}

}  // namespace
}  // namespace cartographer
