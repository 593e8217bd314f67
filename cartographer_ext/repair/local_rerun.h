// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
//
// Re-runs local SLAM from a stored map alone. A map contains the filtered
// clouds of the nodes, about one every 0.2 m: few, but enough to match each
// node against a running submap, as local SLAM does with every scan. The motion
// between two nodes is predicted from the odometry readings of the map, with
// which the front end calibrates itself as on the robot, or from a chain of
// poses: the local poses of the map, its odometry, or the optimised poses of an
// earlier repair. What the map tells of its gyroscope serves as on the robot
// (stored_gyroscope.h). The match corrects the prediction, and new submaps are
// built from the clouds.
//
// The clouds of a map are gravity aligned, and in Cartographer that includes
// the rotation about the vertical axis since the start. All poses here are of
// the planar tracking frame, into which the clouds are turned back first.
//
// Known limits: rays are cast from the tracking frame, because a map does not
// store the position of its sensor; clouds are filtered, so grids are sparser
// than the stored ones.
#ifndef CARTOGRAPHER_EXT_REPAIR_LOCAL_RERUN_H_
#define CARTOGRAPHER_EXT_REPAIR_LOCAL_RERUN_H_

#include "absl/status/statusor.h"
#include "cartographer/mapping/proto/local_trajectory_builder_options_2d.pb.h"
#include "cartographer_ext/io/pbstream/pbstream_reader.h"
#include "cartographer_ext/repair/motion_chain.h"

namespace cartographer_ext {
namespace repair {

// How the pose of a node in the running submap is determined.
enum class NodeMatching {
  kFrontEnd,          // as local SLAM does; the chain stands for the odometry
  kRecordedOdometry,  // as local SLAM does, with the odometry readings of the
                      // map; the chain is for nodes that cannot be matched
  kNone,              // by the motion of the chain: submaps are only rebuilt
};

// Options of `base` adapted to the clouds of a map: every node is inserted,
// nothing is cropped, submaps have the size and resolution of those of
// `stored`.
cartographer::mapping::proto::LocalTrajectoryBuilderOptions2D OptionsForClouds(
    const cartographer::mapping::proto::LocalTrajectoryBuilderOptions2D& base,
    const cartographer::mapping::proto::LocalTrajectoryBuilderOptions2D&
        stored);

// The map with new local poses, submaps and insertions, without loops; global
// poses are the local ones. Node ids are kept, submaps are numbered from 0.
// Everything else is copied. An error if a node has no cloud. `use_gyroscope`:
// with StoredGyroscopeReadings, if there are any.
absl::StatusOr<io::Pbstream> RerunLocalSlam(
    const io::Pbstream& pbstream, const MotionChain& chain,
    NodeMatching matching, bool use_gyroscope,
    const cartographer::mapping::proto::LocalTrajectoryBuilderOptions2D&
        options);

}  // namespace repair
}  // namespace cartographer_ext

#endif  // CARTOGRAPHER_EXT_REPAIR_LOCAL_RERUN_H_
