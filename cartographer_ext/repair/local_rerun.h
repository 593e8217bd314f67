// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
//
// Local SLAM once more, from nothing but a stored map. What a map holds of its
// scans are the filtered clouds of the nodes, about one every 0.2 m: few, but
// enough to match each node against a running submap, as local SLAM does with
// every scan. Where the robot went between two nodes comes from a chain of
// poses: the local poses of the map, its odometry, or the optimised poses of an
// earlier repair. The chain is the prediction, the match corrects it, and
// submaps are built anew from the clouds.
//
// Known limits: rays are cast from the tracking frame, as a map does not keep
// where its sensor was; clouds are thinned, so grids are sparser than the
// stored ones.
#ifndef CARTOGRAPHER_EXT_REPAIR_LOCAL_RERUN_H_
#define CARTOGRAPHER_EXT_REPAIR_LOCAL_RERUN_H_

#include <map>

#include "absl/status/statusor.h"
#include "cartographer/mapping/proto/local_trajectory_builder_options_2d.pb.h"
#include "cartographer_ext/common/pose2.h"
#include "cartographer_ext/io/pbstream/pbstream_reader.h"
#include "cartographer_ext/map/map_graph.h"

namespace cartographer_ext {
namespace repair {

// How a node is placed in the running submap.
enum class NodeMatching {
  kFrontEnd,  // as local SLAM does, with search where the chain is doubtful
  kNone,      // the chain's motion as it is: submaps are only built anew
};

// Poses of the gravity-aligned frames of the nodes, planar, in any frame: only
// the motion from one node of a trajectory to the next counts.
using MotionChain = std::map<evaluation::GraphId, Pose2>;

// As local SLAM had it.
MotionChain LocalChain(const io::Pbstream& pbstream);
// As the optimised poses of `graph` have it.
MotionChain GlobalChain(const io::Pbstream& pbstream,
                        const evaluation::MapGraph& graph);
// As the wheels had it; LocalChain where there are no readings. Empty where no
// trajectory has odometry over half of its nodes.
MotionChain OdometryChain(const io::Pbstream& pbstream);

// The stored chain with the motion of the wheels wherever the two differ by far
// more than they usually do. Empty where OdometryChain is.
MotionChain MixedChain(const io::Pbstream& pbstream);

// Options of `base` fitted to the clouds of a map: every node is inserted,
// nothing is cropped, submaps are as large and as fine as those of `stored`.
cartographer::mapping::proto::LocalTrajectoryBuilderOptions2D OptionsForClouds(
    const cartographer::mapping::proto::LocalTrajectoryBuilderOptions2D& base,
    const cartographer::mapping::proto::LocalTrajectoryBuilderOptions2D&
        stored);

// The map with new local poses, submaps and insertions, without loops; global
// poses are the local ones. Ids of nodes stay, submaps are numbered from 0.
// Everything else is carried along. An error where a node has no cloud.
absl::StatusOr<io::Pbstream> RerunLocalSlam(
    const io::Pbstream& pbstream, const MotionChain& chain,
    NodeMatching matching,
    const cartographer::mapping::proto::LocalTrajectoryBuilderOptions2D&
        options);

}  // namespace repair
}  // namespace cartographer_ext

#endif  // CARTOGRAPHER_EXT_REPAIR_LOCAL_RERUN_H_
