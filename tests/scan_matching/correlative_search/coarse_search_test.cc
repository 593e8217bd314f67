// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
#include "cartographer_ext/scan_matching/correlative_search/coarse_search.h"

#include <algorithm>

#include "cartographer_ext/common/random.h"
#include "gtest/gtest.h"

namespace cartographer_ext {
namespace scan_matching {
namespace {

class CoarseSearchTest : public ::testing::Test {
 protected:
  CoarseSearchTest() {
    Random random(9);
    grid_.num_x = 60;
    grid_.num_y = 50;
    grid_.resolution = 0.05;
    grid_.max_x = 1.;
    grid_.max_y = 1.5;
    grid_.values.resize(60 * 50);
    for (uint8_t& value : grid_.values) {
      const int noise = static_cast<int>(random.UniformInt(0, 400));
      value = static_cast<uint8_t>(std::max(0, noise - 145));
    }
    for (int i = 0; i != 40; ++i) {
      cloud_.x.push_back(static_cast<float>(random.Uniform(-1., 1.)));
      cloud_.y.push_back(static_cast<float>(random.Uniform(-1., 1.)));
    }
  }

  int SumOf(const RotatedScan& scan, const int offset_x,
            const int offset_y) const {
    int sum = 0;
    for (size_t i = 0; i != cloud_.size(); ++i) {
      const int x = scan.x[i] + offset_x;
      const int y = scan.y[i] + offset_y;
      if (x < 0 || x >= grid_.num_x || y < 0 || y >= grid_.num_y) continue;
      sum += grid_.values[grid_.num_x * y + x];
    }
    return sum;
  }

  SearchGrid2D grid_;
  PlanarCloud cloud_;
};

// Every pose of the window with a sum above the threshold is in a node, whose
// bound it does not exceed.
TEST_F(CoarseSearchTest, BoundsAreUpperBoundsAndMissNothing) {
  for (const int threshold : {-1, 1500, 2300}) {
    const PreparedGrid prepared(grid_, 7, BestSearchKernels());
    RotatedScans scans(cloud_, Pose2(0., 0.3, 0.2), 0.5, 0.3, prepared.geometry,
                       prepared.kernels);
    ASSERT_TRUE(scans.valid());
    CoarseSearch search(prepared, &scans, threshold);
    SearchStatistics statistics;
    std::vector<CoarseNode> nodes;
    ASSERT_TRUE(search.Score(&statistics, &nodes));
    EXPECT_GE(statistics.coarse_scored, static_cast<int64_t>(nodes.size()));
    int num_poses = 0;
    for (const CoarseNode& node : nodes) {
      for (int rotation = search.FirstRotation(node.group);
           rotation <= search.LastRotation(node.group); ++rotation) {
        const RotatedScan scan = scans.Get(rotation);
        for (int y = node.y; y != node.y + kBlockSize; ++y) {
          for (int x = node.x; x != node.x + kBlockSize; ++x) {
            if (!scan.offsets.Contains(x, y)) continue;
            const int sum = SumOf(scan, x, y);
            ASSERT_LE(sum, CoarseSearch::ToSum(node.sum));
            if (sum > threshold) ++num_poses;
          }
        }
      }
    }
    int expected = 0;
    for (int rotation = 0; rotation != scans.num_rotations(); ++rotation) {
      const RotatedScan scan = scans.Get(rotation);
      for (int y = scan.offsets.min_y; y <= scan.offsets.max_y; ++y) {
        for (int x = scan.offsets.min_x; x <= scan.offsets.max_x; ++x) {
          if (SumOf(scan, x, y) > threshold) ++expected;
        }
      }
    }
    EXPECT_EQ(num_poses, expected) << threshold;
    if (threshold < 2000) {
      EXPECT_GT(expected, 0);
    }
  }
}

TEST_F(CoarseSearchTest, LargestBoundsComeFirst) {
  const PreparedGrid prepared(grid_, 7, BestSearchKernels());
  RotatedScans scans(cloud_, Pose2(), 0.5, 0.3, prepared.geometry,
                     prepared.kernels);
  CoarseSearch search(prepared, &scans, -1);
  SearchStatistics statistics;
  std::vector<CoarseNode> nodes;
  ASSERT_TRUE(search.Score(&statistics, &nodes));
  ASSERT_GT(nodes.size(), 10u);
  for (size_t i = 1; i < nodes.size(); ++i) {
    EXPECT_GE(nodes[i - 1].sum, nodes[i].sum);
    if (nodes[i - 1].sum == nodes[i].sum) {
      EXPECT_LE(nodes[i - 1].group, nodes[i].group);
    }
    // Partial sums grow towards the bound.
    for (int part = 0; part != kNumPartialSums; ++part) {
      EXPECT_LE(nodes[i].partial_sums[part], nodes[i].sum);
    }
  }
}

}  // namespace
}  // namespace scan_matching
}  // namespace cartographer_ext
