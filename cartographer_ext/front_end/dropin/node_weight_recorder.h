// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
//
// Follows how sure the newest scan is in each of the submaps being made
// (node_weights.h), and remembers for every node what that leaves of the
// weights of its constraints (common/full_information.h), which the pose graph
// makes later from the same poses.
#ifndef CARTOGRAPHER_EXT_FRONT_END_DROPIN_NODE_WEIGHT_RECORDER_H_
#define CARTOGRAPHER_EXT_FRONT_END_DROPIN_NODE_WEIGHT_RECORDER_H_

#include <memory>
#include <vector>

#include "Eigen/Core"
#include "cartographer/mapping/2d/submap_2d.h"
#include "cartographer/mapping/trajectory_node.h"
#include "cartographer_ext/front_end/node_weights.h"

namespace cartographer_ext {
namespace front_end {

class NodeWeightRecorder {
 public:
  explicit NodeWeightRecorder(const NodeWeightOptions& options);

  // After each match. `motion` is the covariance of the prediction, `scan` the
  // information of the match alone, both about (x, y, theta) in the local
  // frame. `since_last_scan`: the motion is that since the last scan, otherwise
  // since the last node.
  void AddScan(const Eigen::Matrix3d& motion, bool since_last_scan,
               const Eigen::Matrix3d& scan);

  // The scan became a node of these submaps. With a TSDF nothing is
  // remembered.
  void AddNode(
      const cartographer::mapping::TrajectoryNode::Data& node,
      const std::vector<std::shared_ptr<const cartographer::mapping::Submap2D>>&
          submaps);

 private:
  struct Tracked {
    std::shared_ptr<const cartographer::mapping::Submap2D> submap;
    ScanUncertainty uncertainty;
  };

  const NodeWeightOptions options_;
  std::vector<Tracked> tracked_;  // two at most
};

}  // namespace front_end
}  // namespace cartographer_ext

#endif  // CARTOGRAPHER_EXT_FRONT_END_DROPIN_NODE_WEIGHT_RECORDER_H_
