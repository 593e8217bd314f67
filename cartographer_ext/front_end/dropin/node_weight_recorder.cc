// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
#include "cartographer_ext/front_end/dropin/node_weight_recorder.h"

#include <utility>

#include "Eigen/Geometry"
#include "cartographer/mapping/2d/grid_2d.h"
#include "cartographer/transform/rigid_transform.h"
#include "cartographer/transform/transform.h"
#include "cartographer_ext/common/full_information.h"
#include "cartographer_ext/swaps.h"
#include "glog/logging.h"

namespace cartographer_ext {
namespace front_end {
namespace {

namespace mapping = cartographer::mapping;
namespace transform = cartographer::transform;

}  // namespace

NodeWeightRecorder::NodeWeightRecorder(const NodeWeightOptions& options)
    : options_(options) {
#ifndef CARTOGRAPHER_EXT_SWAP_FULL_INFORMATION
  LOG_IF(WARNING, options.enabled)
      << "node_weights has no effect: the swap full_information is not built";
#endif
}

void NodeWeightRecorder::AddScan(const Eigen::Matrix3d& motion,
                                 const bool since_last_scan,
                                 const Eigen::Matrix3d& scan) {
  for (Tracked& tracked : tracked_) {
    if (since_last_scan) tracked.uncertainty.Keep();
    tracked.uncertainty.Add(motion, scan);
  }
}

void NodeWeightRecorder::AddNode(
    const mapping::TrajectoryNode::Data& node,
    const std::vector<std::shared_ptr<const mapping::Submap2D>>& submaps) {
  if (!options_.enabled) return;
  std::vector<Tracked> tracked;
  for (const auto& submap : submaps) {
    Tracked next{submap, ScanUncertainty()};
    for (const Tracked& before : tracked_) {
      if (before.submap == submap) next.uncertainty = before.uncertainty;
    }
    next.uncertainty.Keep();
    tracked.push_back(std::move(next));
  }
  tracked_ = std::move(tracked);

  // The pose graph uses these very expressions.
  const transform::Rigid2d local_pose = transform::Project2D(
      node.local_pose *
      transform::Rigid3d::Rotation(node.gravity_alignment.inverse()));
  for (const Tracked& of : tracked_) {
    if (of.submap->grid()->GetGridType() == mapping::GridType::TSDF) continue;
    const transform::Rigid2d submap_pose =
        transform::Project2D(of.submap->local_pose());
    const transform::Rigid3d constraint =
        transform::Embed3D(submap_pose.inverse() * local_pose);
    const Eigen::Matrix3d turn =
        Eigen::AngleAxisd(-submap_pose.rotation().angle(),
                          Eigen::Vector3d::UnitZ())
            .toRotationMatrix();
    RememberRelativeInformation(
        PoseBitsOf(constraint),
        RelativeInformation(
            options_, turn * of.uncertainty.covariance() * turn.transpose()));
  }
}

}  // namespace front_end
}  // namespace cartographer_ext
