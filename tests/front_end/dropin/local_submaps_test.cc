// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
#include "cartographer_ext/front_end/dropin/local_submaps.h"

#include <algorithm>
#include <memory>
#include <string>
#include <vector>

#include "cartographer/mapping/2d/submap_2d.h"
#include "gtest/gtest.h"
#include "tests/front_end/dropin/simulated_drive.h"

namespace cartographer_ext {
namespace front_end {
namespace {

using cartographer::mapping::ActiveSubmaps2D;
using cartographer::mapping::Submap2D;
using cartographer::sensor::RangeData;

constexpr int kCapacity = 6;

cartographer::mapping::proto::SubmapsOptions2D Options() {
  auto options = test::StockOptions().submaps_options();
  options.set_num_range_data(kCapacity);
  return options;
}

// A wall of 2 m, a metre to the left of a robot at (x, 0).
RangeData Scan(const double x) {
  RangeData scan;
  scan.origin = Eigen::Vector3f(x, 0.f, 0.f);
  for (int i = 0; i <= 40; ++i) {
    scan.returns.push_back({Eigen::Vector3f(x - 1. + 0.05 * i, 1.f, 0.f)});
  }
  return scan;
}

std::string Bytes(const LocalSubmaps::Submaps& submaps) {
  std::string bytes;
  for (const auto& submap : submaps) {
    bytes += submap->ToProto(true).SerializeAsString();
  }
  return bytes;
}

// Follows what a pose graph requires of the submaps of consecutive nodes, and
// counts its submaps.
class PoseGraphRules {
 public:
  void AddNode(const LocalSubmaps::Submaps& submaps) {
    if (submaps.size() == 1) {
      if (submaps_.empty()) submaps_.push_back({submaps[0], false});
      ASSERT_EQ(submaps_.size(), 1u);
      ASSERT_EQ(submaps_[0].submap, submaps[0]);
    } else {
      ASSERT_EQ(submaps.size(), 2u);
      ASSERT_FALSE(submaps_.empty());
      if (submaps_.back().submap == submaps[0]) {
        submaps_.push_back({submaps[1], false});
      }
      ASSERT_GE(submaps_.size(), 2u);
      ASSERT_EQ(submaps_.back().submap, submaps[1]);
      ASSERT_EQ(submaps_[submaps_.size() - 2].submap, submaps[0]);
    }
    if (!submaps[0]->insertion_finished()) return;
    Entry& older = submaps_[submaps_.size() - submaps.size()];
    ASSERT_FALSE(older.finished) << "finished twice";
    older.finished = true;
  }

  int num_submaps() const { return static_cast<int>(submaps_.size()); }
  int num_finished() const {
    int count = 0;
    for (const Entry& entry : submaps_) count += entry.finished;
    return count;
  }
  std::vector<double> Widths() const {
    std::vector<double> widths;
    for (const Entry& entry : submaps_) {
      const auto& limits = entry.submap->grid()->limits();
      widths.push_back(std::max(limits.cell_limits().num_x_cells,
                                limits.cell_limits().num_y_cells) *
                       limits.resolution());
    }
    return widths;
  }

 private:
  struct Entry {
    std::shared_ptr<const Submap2D> submap;
    bool finished;
  };
  std::vector<Entry> submaps_;
};

TEST(LocalSubmapsTest, AreThoseOfTheHost) {
  LocalSubmaps submaps(Options());
  ActiveSubmaps2D host(Options());
  EXPECT_EQ(submaps.Reference(), nullptr);
  for (int i = 0; i < 5 * kCapacity; ++i) {
    const RangeData scan = Scan(0.2 * i);
    const std::string inserted = Bytes(submaps.Insert(scan, 1));
    ASSERT_EQ(inserted, Bytes(host.InsertRangeData(scan))) << i;
    ASSERT_EQ(Bytes({submaps.Reference()}), Bytes({host.submaps().front()}));
  }
}

TEST(LocalSubmapsTest, SeveralInsertionsEndWithTheSubmap) {
  LocalSubmaps submaps(Options());
  submaps.Insert(Scan(0.), 4);
  EXPECT_EQ(submaps.Insert(Scan(0.2), 4).back()->num_range_data(), kCapacity);
  auto both = submaps.Insert(Scan(0.4), 100);
  ASSERT_EQ(both.size(), 2u);
  EXPECT_TRUE(both.front()->insertion_finished());
  EXPECT_EQ(both.front()->num_range_data(), 2 * kCapacity);
  EXPECT_EQ(both.back()->num_range_data(), kCapacity);
}

// At every moment of the life of a submap.
TEST(LocalSubmapsTest, ScansElsewhereBeginNewOnes) {
  for (int before = 1; before <= 4 * kCapacity; ++before) {
    SCOPED_TRACE(before);
    LocalSubmaps submaps(Options());
    PoseGraphRules rules;
    for (int i = 0; i < before; ++i) {
      rules.AddNode(submaps.Insert(Scan(0.2 * i), 1));
    }
    const int num_before = rules.num_submaps();
    const int num_finished = rules.num_finished();
    ASSERT_FALSE(submaps.Overlaps(Scan(100.)));
    rules.AddNode(submaps.InsertElsewhere(Scan(100.)));
    for (int i = 1; i <= 3 * kCapacity; ++i) {
      rules.AddNode(submaps.Insert(Scan(100. + 0.2 * i), 1));
      ASSERT_TRUE(submaps.Overlaps(Scan(100.2 + 0.2 * i)));
    }
    ASSERT_FALSE(testing::Test::HasFatalFailure());
    EXPECT_GE(rules.num_submaps(), num_before + 3);
    EXPECT_GE(rules.num_finished(), num_finished + 3);
    for (const double width : rules.Widths()) EXPECT_LT(width, 12.);
  }
}

// Each sighting is far from the one before.
TEST(LocalSubmapsTest, EveryScanMayLieElsewhere) {
  LocalSubmaps submaps(Options());
  PoseGraphRules rules;
  for (int i = 0; i < 20; ++i) {
    rules.AddNode(submaps.InsertElsewhere(Scan(50. * i)));
    ASSERT_FALSE(testing::Test::HasFatalFailure());
    ASSERT_NE(submaps.Reference(), nullptr);
  }
  EXPECT_EQ(rules.num_submaps(), 20);
  for (const double width : rules.Widths()) EXPECT_LT(width, 12.);
}

// Between the two scans that end the two submaps the newer one is kept; then
// the next scan is matched against the new one, not the one that was left.
TEST(LocalSubmapsTest, TheFirstScanElsewhereIsNotInserted) {
  LocalSubmaps submaps(Options());
  for (int i = 0; i < kCapacity + 2; ++i) submaps.Insert(Scan(0.2 * i), 1);
  const auto first = submaps.InsertElsewhere(Scan(100.));
  ASSERT_EQ(first.size(), 2u);
  EXPECT_TRUE(first.front()->insertion_finished());
  EXPECT_EQ(first.front()->num_range_data(), kCapacity + 2);
  EXPECT_EQ(first.back()->num_range_data(), 2);
  const auto second = submaps.Insert(Scan(100.2), 1);
  ASSERT_EQ(second.size(), 2u);
  EXPECT_EQ(second.front(), first.back());
  EXPECT_TRUE(second.front()->insertion_finished());
  EXPECT_EQ(second.back()->num_range_data(), 1);
  EXPECT_EQ(submaps.Reference(), second.back());
  const auto third = submaps.Insert(Scan(100.4), 1);
  EXPECT_EQ(third.front(), second.back());
  EXPECT_EQ(third.back()->num_range_data(), 1);
  EXPECT_EQ(submaps.Reference(), third.front());
}

// Two rooms 60 m apart, and nothing is seen in between.
TEST(LocalSubmapsTest, LocalSlamUsesThemBehindABlindDrive) {
  std::vector<test::Wall> walls = test::Room();
  for (const test::Wall& wall : test::Room()) {
    const Eigen::Vector2d away(60., 0.);
    walls.push_back({wall.a + away, wall.b + away});
  }
  AdaptiveLocalTrajectoryBuilder2D builder(test::StockOptions(),
                                           FrontEndOptions(), {"scan"});
  Random random(7);
  PoseGraphRules rules;
  for (int i = 0; i <= 260; ++i) {
    // 2 m in each room, at a metre a second.
    const double x = i < 100 ? 0.02 * i : i < 160 ? i - 98. : 0.02 * i + 58.8;
    const Pose2 pose(x - 1., 0., 0.);
    builder.AddOdometryData(test::Odometry(0.5 * i, pose));
    if (i >= 100 && i < 160) continue;
    const auto matched = builder.AddRangeData(
        "scan", test::Scan(walls, 0.5 * i, pose, 6., &random));
    ASSERT_NE(matched, nullptr) << i;
    if (matched->insertion_result == nullptr) continue;
    rules.AddNode(matched->insertion_result->insertion_submaps);
    ASSERT_FALSE(testing::Test::HasFatalFailure());
  }
  EXPECT_EQ(rules.num_submaps(), 3);
  for (const double width : rules.Widths()) EXPECT_LT(width, 25.);
}

TEST(LocalSubmapsTest, OverlapIsATenthOfTheReturns) {
  LocalSubmaps submaps(Options());
  EXPECT_TRUE(submaps.Overlaps(Scan(0.)));
  submaps.Insert(Scan(0.), 1);
  EXPECT_TRUE(submaps.Overlaps(RangeData()));
  EXPECT_TRUE(submaps.Overlaps(Scan(1.7)));  // 0.3 of 2 m
  EXPECT_FALSE(submaps.Overlaps(Scan(1.95)));
}

}  // namespace
}  // namespace front_end
}  // namespace cartographer_ext
