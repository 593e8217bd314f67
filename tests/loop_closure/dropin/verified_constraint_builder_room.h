// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
//
// A room with three submaps and a robot in it, for tests of the constraint
// builder.
#ifndef CARTOGRAPHER_EXT_TESTS_LOOP_CLOSURE_DROPIN_VERIFIED_CONSTRAINT_BUILDER_ROOM_H_
#define CARTOGRAPHER_EXT_TESTS_LOOP_CLOSURE_DROPIN_VERIFIED_CONSTRAINT_BUILDER_ROOM_H_

#include <memory>
#include <vector>

#include "absl/memory/memory.h"
#include "absl/synchronization/notification.h"
#include "cartographer/mapping/internal/constraints/constraint_builder_2d.h"
#include "cartographer/transform/transform.h"
#include "cartographer_ext/common/pose_graph_context.h"
#include "cartographer_ext/loop_closure/decision_recorder.h"
#include "cartographer_ext/loop_closure/dropin/verified_constraint_builder_2d.h"
#include "gtest/gtest.h"
#include "tests/host/mapping_test_helpers.h"
#include "tests/host/slam_test_helpers.h"

namespace cartographer_ext {
namespace loop_closure {
namespace test {

using Builder = VerifiedConstraintBuilder2D;

inline cartographer::mapping::constraints::proto::ConstraintBuilderOptions
StockOptions() {
  auto options = cartographer::mapping::test::LoadSlamOptions("")
                     .map_builder.pose_graph_options()
                     .constraint_builder_options();
  options.set_log_matches(false);
  return options;
}

// Nothing but Cartographer's search.
inline LoopOptions StagesOff() {
  LoopOptions options;
  options.search.enabled = false;
  options.temporal.enabled = false;
  options.threshold.enabled = false;
  options.slide_test = false;
  options.fusion.enabled = false;
  options.information.enabled = false;
  options.compatible_subset.enabled = false;
  options.innovation_veto.enabled = false;
  return options;
}

inline Builder::Result Collect(Builder* const builder) {
  Builder::Result result;
  absl::Notification done;
  builder->WhenDone([&result, &done](const Builder::Result& found) {
    result = found;
    done.Notify();
  });
  done.WaitForNotification();
  return result;
}

// A room, seen by submaps whose origins are a little apart, and a robot that
// goes round and round in it.
class VerifiedConstraintBuilderRoom : public testing::Test {
 protected:
  static constexpr int kNumNodes = 60;

  VerifiedConstraintBuilderRoom() {
    for (int s = 0; s < 3; ++s) {
      submaps_.push_back(absl::make_unique<cartographer::mapping::Submap2D>(
          Eigen::Vector2f(0.1f * s, 0.f),
          cartographer::mapping::test::RoomGrid(&tables_, 0.05, 5), &tables_));
      submaps_.back()->Finish();
    }
    for (int i = 0; i < kNumNodes; ++i) {
      const cartographer::transform::Rigid2d pose = Truth(i);
      Builder::NodeData node;
      node.time = cartographer::common::FromUniversal(10000000LL * i);
      node.local_pose = cartographer::transform::Embed3D(pose);
      // Turned against the robot, as the host's gravity alignment may be.
      const double turn = 0.3 * i;
      node.gravity_alignment =
          Eigen::Quaterniond(Eigen::AngleAxisd(turn, Eigen::Vector3d::UnitZ()));
      node.filtered_gravity_aligned_point_cloud =
          cartographer::mapping::test::Moved(
              cartographer::mapping::test::Room(),
              (pose * cartographer::transform::Rigid2d::Rotation(-turn))
                  .inverse());
      nodes_.push_back(node);
    }
  }

  static cartographer::transform::Rigid2d Truth(const int i) {
    const double angle = 0.2 * i;
    return cartographer::transform::Rigid2d(
        {std::cos(angle), 0.5 * std::sin(angle)}, angle);
  }

  // (submap <- gravity-aligned node)
  cartographer::transform::Rigid2d Relative(const int s, const int i) const {
    return cartographer::mapping::constraints::ComputeSubmapPose(*submaps_[s])
               .inverse() *
           Truth(i) * cartographer::transform::Rigid2d::Rotation(-0.3 * i);
  }

  void Offer(Builder* const builder, const int s, const int i) {
    builder->MaybeAddConstraint(
        cartographer::mapping::SubmapId{0, s}, submaps_[s].get(),
        cartographer::mapping::NodeId{0, i}, &nodes_[i], Relative(s, i));
  }

  // As the pose graph does: each node against all submaps, a callback now and
  // then.
  std::vector<Builder::Result> Drive(Builder* const builder) {
    std::vector<Builder::Result> results;
    for (int i = 0; i < kNumNodes; ++i) {
      for (int s = 0; s < 3; ++s) Offer(builder, s, i);
      builder->NotifyEndOfNode();
      if (i % 10 == 9) results.push_back(Collect(builder));
    }
    return results;
  }

  const std::shared_ptr<PoseGraphContext> context_ =
      std::make_shared<PoseGraphContext>();
  const ScopedPoseGraphContext scope_{context_};
  DecisionRecorder* const recorder_ = context_->Get<DecisionRecorder>();
  cartographer::mapping::ValueConversionTables tables_;
  std::vector<std::unique_ptr<cartographer::mapping::Submap2D>> submaps_;
  std::vector<Builder::NodeData> nodes_;
};

}  // namespace test
}  // namespace loop_closure
}  // namespace cartographer_ext

#endif  // CARTOGRAPHER_EXT_TESTS_LOOP_CLOSURE_DROPIN_VERIFIED_CONSTRAINT_BUILDER_ROOM_H_
