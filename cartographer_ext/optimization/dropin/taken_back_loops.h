// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
//
// Marks the loops that the final optimisation has taken back (loops_in_force.h) in
// the pose graph, whose constraints cannot be deleted (common/withdrawn_loops.h),
// so that whoever reads it, or the state that is written, skips them.
#ifndef CARTOGRAPHER_EXT_OPTIMIZATION_DROPIN_TAKEN_BACK_LOOPS_H_
#define CARTOGRAPHER_EXT_OPTIMIZATION_DROPIN_TAKEN_BACK_LOOPS_H_

#include <set>

#include "cartographer/mapping/pose_graph_interface.h"
#include "cartographer_ext/common/loop_id.h"

namespace cartographer_ext {
namespace optimization {

// `pose_graph` must be one of Cartographer's, with nothing left to do. Nothing is
// done without `loops`.
void MarkTakenBack(const std::set<LoopId>& loops,
                   cartographer::mapping::PoseGraphInterface* pose_graph);

}  // namespace optimization
}  // namespace cartographer_ext

#endif  // CARTOGRAPHER_EXT_OPTIMIZATION_DROPIN_TAKEN_BACK_LOOPS_H_
