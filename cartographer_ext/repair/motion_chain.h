// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
//
// Motion of the robot from node to node of a stored map by different sources:
// its local SLAM, its odometry, both, or an optimised map.
#ifndef CARTOGRAPHER_EXT_REPAIR_MOTION_CHAIN_H_
#define CARTOGRAPHER_EXT_REPAIR_MOTION_CHAIN_H_

#include <map>

#include "cartographer_ext/common/pose2.h"
#include "cartographer_ext/io/pbstream/pbstream_reader.h"
#include "cartographer_ext/map/map_graph.h"

namespace cartographer_ext {
namespace repair {

// Poses of the tracking frame at the nodes, planar, in any frame: only the
// motion from one node of a trajectory to the next is used.
using MotionChain = std::map<evaluation::GraphId, Pose2>;

// By the stored local poses.
MotionChain LocalChain(const io::Pbstream& pbstream);
// By the optimised poses of `graph`, and the stored local ones of nodes that it
// lacks.
MotionChain GlobalChain(const io::Pbstream& pbstream,
                        const evaluation::MapGraph& graph);
// By the odometry; LocalChain where there are no readings. Empty if no
// trajectory has odometry for half of its nodes.
MotionChain OdometryChain(const io::Pbstream& pbstream);

// The stored chain, with the motion of the odometry wherever the two differ by
// far more than usual, and half of it is left kLastingSeconds later: odometry
// that freezes and then catches up is not followed. Empty if OdometryChain is.
MotionChain MixedChain(const io::Pbstream& pbstream);

}  // namespace repair
}  // namespace cartographer_ext

#endif  // CARTOGRAPHER_EXT_REPAIR_MOTION_CHAIN_H_
