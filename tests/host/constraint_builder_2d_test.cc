// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
#include "cartographer/mapping/internal/constraints/constraint_builder_2d.h"

#include <functional>
#include <memory>
#include <vector>

#include "absl/memory/memory.h"
#include "absl/synchronization/notification.h"
#include "cartographer/common/internal/testing/thread_pool_for_testing.h"
#include "cartographer/common/thread_pool.h"
#include "cartographer/mapping/2d/probability_grid.h"
#include "cartographer/transform/transform.h"
#include "gtest/gtest.h"
#include "tests/host/mapping_test_helpers.h"
#include "tests/host/slam_test_helpers.h"

namespace cartographer {
namespace mapping {
namespace constraints {
namespace {

using Result = ConstraintBuilder2D::Result;
using Constraint = ConstraintBuilder2D::Constraint;

proto::ConstraintBuilderOptions Options(const double min_score,
                                        const double sampling_ratio) {
  auto options = test::LoadSlamOptions("")
                     .map_builder.pose_graph_options()
                     .constraint_builder_options();
  options.set_min_score(min_score);
  options.set_global_localization_min_score(min_score);
  options.set_sampling_ratio(sampling_ratio);
  options.set_log_matches(false);
  return options;
}

std::unique_ptr<Submap2D> RoomSubmap(ValueConversionTables* const tables) {
  auto submap = absl::make_unique<Submap2D>(
      Eigen::Vector2f(0.5f, -0.25f), test::RoomGrid(tables, 0.05, 3), tables);
  submap->Finish();
  return submap;
}

// The room seen from (submap <- node).
TrajectoryNode::Data RoomNode(const transform::Rigid2d& submap_from_node,
                              const Submap2D& submap) {
  TrajectoryNode::Data data;
  data.gravity_alignment = Eigen::Quaterniond::Identity();
  data.filtered_gravity_aligned_point_cloud = test::Moved(
      test::Room(), (ComputeSubmapPose(submap) * submap_from_node).inverse());
  return data;
}

// Waits for the callback of WhenDone.
Result Collect(ConstraintBuilder2D* const builder) {
  Result result;
  absl::Notification done;
  builder->WhenDone([&result, &done](const Result& found) {
    result = found;
    done.Notify();
  });
  done.WaitForNotification();
  return result;
}

TEST(ConstraintBuilder2DTest, CallsBackWithoutPairs) {
  common::testing::ThreadPoolForTesting pool;
  ConstraintBuilder2D builder(Options(0., 1.), &pool);
  EXPECT_EQ(builder.GetNumFinishedNodes(), 0);
  builder.NotifyEndOfNode();
  EXPECT_TRUE(Collect(&builder).empty());
  EXPECT_EQ(builder.GetNumFinishedNodes(), 1);
  // Nor without a node.
  EXPECT_TRUE(Collect(&builder).empty());
  EXPECT_EQ(builder.GetNumFinishedNodes(), 1);
  pool.WaitUntilIdle();
}

// A single point and a grid of which nothing is known: as bad as data gets,
// yet every pair has to come through at a threshold of zero.
TEST(ConstraintBuilder2DTest, FindsConstraintsInDegenerateData) {
  common::testing::ThreadPoolForTesting pool;
  ConstraintBuilder2D builder(Options(0., 1.), &pool);
  TrajectoryNode::Data node;
  node.filtered_gravity_aligned_point_cloud = test::Cloud({{0.1f, 0.2f}});
  node.gravity_alignment = Eigen::Quaterniond::Identity();
  ValueConversionTables tables;
  const Submap2D submap(
      Eigen::Vector2f(4.f, 5.f),
      absl::make_unique<ProbabilityGrid>(
          MapLimits(1., Eigen::Vector2d(2., 3.), CellLimits(100, 110)),
          &tables),
      &tables);
  const SubmapId submap_id{0, 1};
  int expected_nodes = 0;
  for (int round = 0; round < 2; ++round) {
    EXPECT_EQ(builder.GetNumFinishedNodes(), expected_nodes);
    for (int i = 0; i < 2; ++i) {
      builder.MaybeAddConstraint(submap_id, &submap, NodeId{0, 0}, &node,
                                 transform::Rigid2d::Identity());
    }
    builder.MaybeAddGlobalConstraint(submap_id, &submap, NodeId{0, 0}, &node);
    builder.NotifyEndOfNode();
    builder.NotifyEndOfNode();
    expected_nodes += 2;
    const Result result = Collect(&builder);
    EXPECT_EQ(builder.GetNumFinishedNodes(), expected_nodes);
    ASSERT_EQ(result.size(), 3);
    for (const Constraint& constraint : result) {
      EXPECT_EQ(constraint.tag, Constraint::INTER_SUBMAP);
      EXPECT_EQ(constraint.submap_id, submap_id);
      EXPECT_EQ(constraint.pose.translation_weight, 1.1e4);
      EXPECT_EQ(constraint.pose.rotation_weight, 1e5);
    }
    builder.DeleteScanMatcher(submap_id);
  }
  pool.WaitUntilIdle();
}

TEST(ConstraintBuilder2DTest, FindsTheRelativePose) {
  common::ThreadPool pool(2);
  ConstraintBuilder2D builder(Options(0.55, 1.), &pool);
  ValueConversionTables tables;
  const auto submap = RoomSubmap(&tables);
  const transform::Rigid2d truth({0.31, 0.12}, 0.2);
  const TrajectoryNode::Data node = RoomNode(truth, *submap);
  builder.MaybeAddConstraint(SubmapId{0, 0}, submap.get(), NodeId{0, 7}, &node,
                             transform::Rigid2d({0.9, -0.3}, 0.));
  builder.MaybeAddGlobalConstraint(SubmapId{0, 0}, submap.get(), NodeId{1, 3},
                                   &node);
  builder.NotifyEndOfNode();
  const Result result = Collect(&builder);
  ASSERT_EQ(result.size(), 2);
  EXPECT_EQ(result[0].node_id, NodeId(0, 7));
  EXPECT_EQ(result[1].node_id, NodeId(1, 3));
  for (const Constraint& constraint : result) {
    const transform::Rigid2d error =
        transform::Project2D(constraint.pose.zbar_ij).inverse() * truth;
    EXPECT_LT(error.translation().norm(), 0.02);
    EXPECT_LT(std::abs(error.normalized_angle()), 0.01);
  }
}

TEST(ConstraintBuilder2DTest, ReportsInOrderOfTheCallsForAnyNumberOfThreads) {
  std::vector<Result> results;
  for (const int num_threads : {1, 4}) {
    common::ThreadPool pool(num_threads);
    ConstraintBuilder2D builder(Options(0.3, 1.), &pool);
    ValueConversionTables tables;
    const auto submap = RoomSubmap(&tables);
    std::vector<TrajectoryNode::Data> nodes;
    for (int i = 0; i < 8; ++i) {
      nodes.push_back(
          RoomNode(transform::Rigid2d({0.1 * i, 0.05}, 0.02 * i), *submap));
    }
    for (int i = 7; i >= 0; --i) {
      builder.MaybeAddConstraint(SubmapId{0, i % 2}, submap.get(), NodeId{0, i},
                                 &nodes[i], transform::Rigid2d::Identity());
      builder.NotifyEndOfNode();
    }
    results.push_back(Collect(&builder));
    ASSERT_EQ(results.back().size(), 8);
  }
  for (int i = 0; i < 8; ++i) {
    EXPECT_EQ(results[0][i].node_id, NodeId(0, 7 - i));
    EXPECT_EQ(results[1][i].node_id, NodeId(0, 7 - i));
    EXPECT_EQ(results[0][i].pose.zbar_ij.translation(),
              results[1][i].pose.zbar_ij.translation());
    EXPECT_EQ(results[0][i].pose.zbar_ij.rotation().coeffs(),
              results[1][i].pose.zbar_ij.rotation().coeffs());
  }
}

TEST(ConstraintBuilder2DTest, GatesOfLocalPairs) {
  common::ThreadPool pool(1);
  ConstraintBuilder2D builder(Options(0., 0.5), &pool);
  ValueConversionTables tables;
  const auto submap = RoomSubmap(&tables);
  const TrajectoryNode::Data node =
      RoomNode(transform::Rigid2d::Identity(), *submap);
  for (int i = 0; i < 6; ++i) {
    // Beyond max_constraint_distance (15 m); does not count for sampling.
    builder.MaybeAddConstraint(SubmapId{0, 0}, submap.get(), NodeId{0, 100},
                               &node, transform::Rigid2d({15.1, 0.}, 0.));
    builder.MaybeAddConstraint(SubmapId{0, 0}, submap.get(), NodeId{0, i},
                               &node, transform::Rigid2d::Identity());
  }
  builder.NotifyEndOfNode();
  const Result result = Collect(&builder);
  // Half of the six, beginning with the first.
  ASSERT_EQ(result.size(), 3);
  EXPECT_EQ(result[0].node_id, NodeId(0, 0));
  EXPECT_EQ(result[1].node_id, NodeId(0, 2));
  EXPECT_EQ(result[2].node_id, NodeId(0, 4));
}

TEST(ConstraintBuilder2DTest, RejectsBadMatches) {
  common::ThreadPool pool(1);
  ConstraintBuilder2D builder(Options(0.95, 1.), &pool);
  ValueConversionTables tables;
  const auto submap = RoomSubmap(&tables);
  const TrajectoryNode::Data node =
      RoomNode(transform::Rigid2d::Identity(), *submap);
  builder.MaybeAddConstraint(SubmapId{0, 0}, submap.get(), NodeId{0, 0}, &node,
                             transform::Rigid2d::Identity());
  builder.MaybeAddGlobalConstraint(SubmapId{0, 0}, submap.get(), NodeId{0, 0},
                                   &node);
  builder.NotifyEndOfNode();
  EXPECT_TRUE(Collect(&builder).empty());
}

TEST(ConstraintBuilder2DTest, TheCallbackMayUseTheBuilder) {
  common::ThreadPool pool(1);
  ConstraintBuilder2D builder(Options(0., 1.), &pool);
  ValueConversionTables tables;
  const auto submap = RoomSubmap(&tables);
  const TrajectoryNode::Data node =
      RoomNode(transform::Rigid2d::Identity(), *submap);
  absl::Notification done;
  int num_rounds = 0;
  size_t num_found = 0;
  std::function<void(const Result&)> next = [&](const Result& result) {
    num_found += result.size();
    if (++num_rounds == 4) {
      done.Notify();
      return;
    }
    builder.DeleteScanMatcher(SubmapId{0, 0});
    builder.MaybeAddConstraint(SubmapId{0, 0}, submap.get(), NodeId{0, 0},
                               &node, transform::Rigid2d::Identity());
    builder.NotifyEndOfNode();
    builder.WhenDone(next);
  };
  builder.WhenDone(next);
  done.WaitForNotification();
  EXPECT_EQ(num_found, 3);
  EXPECT_EQ(builder.GetNumFinishedNodes(), 3);
}

}  // namespace
}  // namespace constraints
}  // namespace mapping
}  // namespace cartographer
