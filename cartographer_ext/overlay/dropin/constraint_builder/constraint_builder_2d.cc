// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
#include "cartographer/mapping/internal/constraints/constraint_builder_2d.h"

#include "absl/memory/memory.h"
#include "cartographer_ext/common/pose_graph_context.h"
#include "cartographer_ext/loop_closure/dropin/constraint_metrics.h"
#include "cartographer_ext/loop_closure/dropin/verified_constraint_builder_2d.h"
#include "cartographer_ext/loop_closure/loop_options.h"
#include "cartographer_ext/loop_closure_options.pb.h"
#include "cartographer_ext/options/extension_field.h"
#include "cartographer_ext/overlay/signature.h"
#include "cartographer_ext/overlay/start_line.h"

#ifndef CARTOGRAPHER_EXT_OVERLAY_CONSTRAINT_BUILDER_2D_H_
#error \
    "The overlay of cartographer_ext is not first on the include path: another package puts Cartographer's sources before it."
#endif

namespace cartographer {
namespace mapping {
namespace constraints {
namespace {

using Stock = StockConstraintBuilder2D;
using ::cartographer_ext::PoseGraphContext;
using ::cartographer_ext::ScopedPoseGraphContext;
using ::cartographer_ext::loop_closure::VerifiedConstraintBuilder2D;

CARTOGRAPHER_EXT_EXPECT_SIGNATURE(
    Stock::MaybeAddConstraint,
    void (Stock::*)(const SubmapId&, const Submap2D*, const NodeId&,
                    const TrajectoryNode::Data*, const transform::Rigid2d&));
CARTOGRAPHER_EXT_EXPECT_SIGNATURE(Stock::MaybeAddGlobalConstraint,
                                  void (Stock::*)(const SubmapId&,
                                                  const Submap2D*,
                                                  const NodeId&,
                                                  const TrajectoryNode::Data*));
CARTOGRAPHER_EXT_EXPECT_SIGNATURE(Stock::NotifyEndOfNode, void (Stock::*)());
CARTOGRAPHER_EXT_EXPECT_SIGNATURE(
    Stock::WhenDone,
    void (Stock::*)(const std::function<void(
                        const std::vector<PoseGraphInterface::Constraint>&)>&));
CARTOGRAPHER_EXT_EXPECT_SIGNATURE(Stock::GetNumFinishedNodes, int (Stock::*)());
CARTOGRAPHER_EXT_EXPECT_SIGNATURE(Stock::DeleteScanMatcher,
                                  void (Stock::*)(const SubmapId&));
CARTOGRAPHER_EXT_EXPECT_SIGNATURE(Stock::RegisterMetrics,
                                  void (*)(metrics::FamilyFactory*));
CARTOGRAPHER_EXT_EXPECT_SIGNATURE(ComputeSubmapPose,
                                  transform::Rigid2d (*)(const Submap2D&));

}  // namespace

ConstraintBuilder2D::ConstraintBuilder2D(
    const proto::ConstraintBuilderOptions& options,
    common::ThreadPoolInterface* const thread_pool)
    : context_(PoseGraphContext::CurrentOrNew()) {
  const ScopedPoseGraphContext scope(context_);
  ::cartographer_ext::proto::LoopClosureOptions extension;
  if (::cartographer_ext::options::GetExtension(options, &extension)) {
    ::cartographer_ext::LogStart(
        "ConstraintBuilder2D", "POSE_GRAPH.constraint_builder.cartographer_ext",
        extension);
    verified_ = absl::make_unique<VerifiedConstraintBuilder2D>(
        options, ::cartographer_ext::loop_closure::ToLoopOptions(extension),
        thread_pool);
  } else {
    stock_ = absl::make_unique<Stock>(options, thread_pool);
  }
}

ConstraintBuilder2D::~ConstraintBuilder2D() = default;

void ConstraintBuilder2D::MaybeAddConstraint(
    const SubmapId& submap_id, const Submap2D* const submap,
    const NodeId& node_id, const TrajectoryNode::Data* const constant_data,
    const transform::Rigid2d& initial_relative_pose) {
  if (stock_ != nullptr) {
    stock_->MaybeAddConstraint(submap_id, submap, node_id, constant_data,
                               initial_relative_pose);
  } else {
    verified_->MaybeAddConstraint(submap_id, submap, node_id, constant_data,
                                  initial_relative_pose);
  }
}

void ConstraintBuilder2D::MaybeAddGlobalConstraint(
    const SubmapId& submap_id, const Submap2D* const submap,
    const NodeId& node_id, const TrajectoryNode::Data* const constant_data) {
  if (stock_ != nullptr) {
    stock_->MaybeAddGlobalConstraint(submap_id, submap, node_id, constant_data);
  } else {
    verified_->MaybeAddGlobalConstraint(submap_id, submap, node_id,
                                        constant_data);
  }
}

void ConstraintBuilder2D::NotifyEndOfNode() {
  if (stock_ != nullptr) {
    stock_->NotifyEndOfNode();
  } else {
    verified_->NotifyEndOfNode();
  }
}

void ConstraintBuilder2D::WhenDone(
    const std::function<void(const Result&)>& callback) {
  const std::shared_ptr<PoseGraphContext> context = context_;
  const auto in_scope = [context, callback](const Result& result) {
    const ScopedPoseGraphContext scope(context);
    callback(result);
  };
  if (stock_ != nullptr) {
    stock_->WhenDone(in_scope);
  } else {
    verified_->WhenDone(in_scope);
  }
}

int ConstraintBuilder2D::GetNumFinishedNodes() {
  return stock_ != nullptr ? stock_->GetNumFinishedNodes()
                           : verified_->GetNumFinishedNodes();
}

void ConstraintBuilder2D::DeleteScanMatcher(const SubmapId& submap_id) {
  if (stock_ != nullptr) {
    stock_->DeleteScanMatcher(submap_id);
  } else {
    verified_->DeleteScanMatcher(submap_id);
  }
}

void ConstraintBuilder2D::RegisterMetrics(
    metrics::FamilyFactory* const family_factory) {
  Stock::RegisterMetrics(family_factory);
  ::cartographer_ext::loop_closure::ConstraintMetrics::Register(family_factory);
}

}  // namespace constraints
}  // namespace mapping
}  // namespace cartographer
