// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
//
// Comes before Cartographer's header of the same path. The class found
// there becomes StockConstraintBuilder2D; the class of the original name
// forwards to it, or, where the options have our block, to ours.
#pragma GCC system_header

#include "cartographer_ext/swaps.h"

#if !defined(CARTOGRAPHER_EXT_SWAP_CONSTRAINT_BUILDER) || \
    defined(ConstraintBuilder2D)
// Not selected, or this is the stock source with its class renamed.
#include_next "cartographer/mapping/internal/constraints/constraint_builder_2d.h"
#else
#ifndef CARTOGRAPHER_EXT_OVERLAY_CONSTRAINT_BUILDER_2D_H_
#define CARTOGRAPHER_EXT_OVERLAY_CONSTRAINT_BUILDER_2D_H_

#define ConstraintBuilder2D StockConstraintBuilder2D
#include_next "cartographer/mapping/internal/constraints/constraint_builder_2d.h"
#undef ConstraintBuilder2D

#include <functional>
#include <memory>
#include <vector>

namespace cartographer_ext {
class PoseGraphContext;
namespace loop_closure {
class VerifiedConstraintBuilder2D;
}  // namespace loop_closure
}  // namespace cartographer_ext

namespace cartographer {
namespace mapping {
namespace constraints {

// Exactly one of the two builders exists, chosen once by the options. Callbacks
// run in the scope of the builder's context
// (cartographer_ext/common/pose_graph_context.h).
class ConstraintBuilder2D {
 public:
  using Constraint = PoseGraphInterface::Constraint;
  using Result = std::vector<Constraint>;

  ConstraintBuilder2D(const proto::ConstraintBuilderOptions& options,
                      common::ThreadPoolInterface* thread_pool);
  ~ConstraintBuilder2D();
  ConstraintBuilder2D(const ConstraintBuilder2D&) = delete;
  ConstraintBuilder2D& operator=(const ConstraintBuilder2D&) = delete;

  void MaybeAddConstraint(const SubmapId& submap_id, const Submap2D* submap,
                          const NodeId& node_id,
                          const TrajectoryNode::Data* constant_data,
                          const transform::Rigid2d& initial_relative_pose);
  void MaybeAddGlobalConstraint(const SubmapId& submap_id,
                                const Submap2D* submap, const NodeId& node_id,
                                const TrajectoryNode::Data* constant_data);
  void NotifyEndOfNode();
  void WhenDone(const std::function<void(const Result&)>& callback);
  int GetNumFinishedNodes();
  void DeleteScanMatcher(const SubmapId& submap_id);

  // The stock families, and ours under names of their own.
  static void RegisterMetrics(metrics::FamilyFactory* family_factory);

 private:
  const std::shared_ptr<::cartographer_ext::PoseGraphContext> context_;
  std::unique_ptr<StockConstraintBuilder2D> stock_;
  std::unique_ptr<::cartographer_ext::loop_closure::VerifiedConstraintBuilder2D>
      verified_;
};

}  // namespace constraints
}  // namespace mapping
}  // namespace cartographer

#endif  // CARTOGRAPHER_EXT_OVERLAY_CONSTRAINT_BUILDER_2D_H_
#endif
