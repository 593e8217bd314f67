// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
#include "cartographer_ext/loop_closure/dropin/verified_constraint_builder_2d.h"

#include <vector>

#include "absl/memory/memory.h"
#include "cartographer/common/internal/testing/thread_pool_for_testing.h"
#include "cartographer/common/thread_pool.h"
#include "cartographer/mapping/2d/probability_grid.h"
#include "cartographer/transform/transform.h"
#include "cartographer_ext/uncertainty/loop_ambiguity.h"
#include "gtest/gtest.h"
#include "tests/loop_closure/dropin/verified_constraint_builder_room.h"

namespace cartographer_ext {
namespace loop_closure {
namespace {

namespace host = cartographer::mapping;
using cartographer::transform::Rigid2d;
using cartographer::transform::Rigid3d;
using host::NodeId;
using host::Submap2D;
using host::SubmapId;
using proto::LoopDecision;
using test::Builder;
using test::Collect;
using test::StagesOff;
using test::StockOptions;

using VerifiedConstraintBuilder2DTest = test::VerifiedConstraintBuilderRoom;

TEST_F(VerifiedConstraintBuilder2DTest, CallsBackWithoutPairs) {
  cartographer::common::ThreadPool pool(1);
  Builder builder(StockOptions(), LoopOptions(), &pool);
  EXPECT_EQ(builder.GetNumFinishedNodes(), 0);
  EXPECT_TRUE(Collect(&builder).empty());
  builder.NotifyEndOfNode();
  EXPECT_TRUE(Collect(&builder).empty());
  EXPECT_EQ(builder.GetNumFinishedNodes(), 1);
}

TEST_F(VerifiedConstraintBuilder2DTest, TellsTheOptimizationHowManyAreWrong) {
  const auto* const ambiguity = context_->Get<uncertainty::LoopAmbiguity>();
  EXPECT_FALSE(ambiguity->share_wrong().has_value());
  cartographer::common::ThreadPool pool(1);
  Builder builder(StockOptions(), LoopOptions(), &pool);
  Collect(&builder);
  EXPECT_EQ(ambiguity->share_wrong(), 0.);
}

// What Cartographer's own test asks of its builder.
TEST_F(VerifiedConstraintBuilder2DTest, StagesOffLetDegenerateDataThrough) {
  cartographer::common::testing::ThreadPoolForTesting pool;
  auto options = StockOptions();
  options.set_min_score(0.);
  options.set_global_localization_min_score(0.);
  options.set_sampling_ratio(1.);
  Builder builder(options, StagesOff(), &pool);
  Builder::NodeData node;
  node.filtered_gravity_aligned_point_cloud = host::test::Cloud({{0.1f, 0.2f}});
  node.gravity_alignment = Eigen::Quaterniond::Identity();
  const Submap2D submap(Eigen::Vector2f(4.f, 5.f),
                        absl::make_unique<host::ProbabilityGrid>(
                            host::MapLimits(1., Eigen::Vector2d(2., 3.),
                                            host::CellLimits(100, 110)),
                            &tables_),
                        &tables_);
  for (int round = 1; round <= 2; ++round) {
    for (int i = 0; i < 2; ++i) {
      builder.MaybeAddConstraint(SubmapId{0, 1}, &submap, NodeId{0, 0}, &node,
                                 Rigid2d::Identity());
    }
    builder.MaybeAddGlobalConstraint(SubmapId{0, 1}, &submap, NodeId{0, 0},
                                     &node);
    builder.NotifyEndOfNode();
    builder.NotifyEndOfNode();
    const Builder::Result result = Collect(&builder);
    EXPECT_EQ(builder.GetNumFinishedNodes(), 2 * round);
    ASSERT_EQ(result.size(), 3u);
    for (const Builder::Constraint& constraint : result) {
      EXPECT_EQ(constraint.tag, Builder::Constraint::INTER_SUBMAP);
      EXPECT_EQ(constraint.pose.translation_weight, 1.1e4);
      EXPECT_EQ(constraint.pose.rotation_weight, 1e5);
    }
    builder.DeleteScanMatcher(SubmapId{0, 1});
  }
  pool.WaitUntilIdle();
}

TEST_F(VerifiedConstraintBuilder2DTest, FindsThePoseOfTheGravityAlignedNode) {
  cartographer::common::ThreadPool pool(2);
  Builder builder(StockOptions(), StagesOff(), &pool);
  for (int i = 0; i < 20; ++i) {
    Offer(&builder, 0, i);
    builder.NotifyEndOfNode();
  }
  const Builder::Result result = Collect(&builder);
  ASSERT_GE(result.size(), 5u);
  for (const Builder::Constraint& constraint : result) {
    const Rigid2d error =
        cartographer::transform::Project2D(constraint.pose.zbar_ij).inverse() *
        Relative(0, constraint.node_id.node_index);
    EXPECT_LT(error.translation().norm(), 0.03);
    EXPECT_LT(std::abs(error.normalized_angle()), 0.02);
  }
}

// Scans of which half hits things that are not in the map, as between bushes.
TEST_F(VerifiedConstraintBuilder2DTest, FloorFollowsWhatScansReach) {
  for (Builder::NodeData& node : nodes_) {
    cartographer::sensor::PointCloud half;
    for (size_t i = 0; i < node.filtered_gravity_aligned_point_cloud.size();
         ++i) {
      cartographer::sensor::RangefinderPoint point =
          node.filtered_gravity_aligned_point_cloud[i];
      if (i % 2 == 0) point.position *= 3.f;
      half.push_back(point);
    }
    node.filtered_gravity_aligned_point_cloud = half;
  }
  auto stock_options = StockOptions();
  auto options = StagesOff();
  options.search.enabled = true;
  options.search.informative_sigma = 0.;
  options.search.search_spacing = 0.;
  std::vector<size_t> found;
  for (const double reference : {0., 0.65}) {
    cartographer::common::ThreadPool pool(2);
    options.typical_fit.reference = reference;
    Builder builder(stock_options, options, &pool);
    found.push_back(0);
    for (const Builder::Result& result : Drive(&builder)) {
      found.back() += result.size();
      for (const Builder::Constraint& constraint : result) {
        const Rigid2d error =
            cartographer::transform::Project2D(constraint.pose.zbar_ij)
                .inverse() *
            Relative(constraint.submap_id.submap_index,
                     constraint.node_id.node_index);
        EXPECT_LT(error.translation().norm(), 0.05);
      }
    }
  }
  EXPECT_EQ(found[0], 0u);
  EXPECT_GT(found[1], 50u);
}

}  // namespace
}  // namespace loop_closure
}  // namespace cartographer_ext
