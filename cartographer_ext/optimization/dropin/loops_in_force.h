// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
//
// Puts accepted loops in force at the end of a run.
//
// Cartographer's problem may end with many of its loops far from the map
// although they agree with each other: a step that local SLAM took wrongly
// holds the map apart. Then the relaxed problem
// (optimization/graph/relaxation.h) is solved, in which single steps give way,
// and if that is not enough, as where local SLAM drifts all along the path, one
// in which all steps are as weak as scans in submaps. Its result is kept only if
// nearly all loops are in force in it: where they contradict each other that
// cannot be, and the stiff problem is the safer one, since it follows wrong
// loops less. For the same reason nothing is done where many matches of the run
// were wrong (uncertainty/loop_ambiguity.h).
//
// A loop that is far off even so, where nearly all others hold, is wrong and taken
// back, so that what is accepted is in force. If many are, the map may be wrong
// instead.
#ifndef CARTOGRAPHER_EXT_OPTIMIZATION_DROPIN_LOOPS_IN_FORCE_H_
#define CARTOGRAPHER_EXT_OPTIMIZATION_DROPIN_LOOPS_IN_FORCE_H_

#include <functional>
#include <vector>

#include "cartographer/mapping/id.h"
#include "cartographer/mapping/internal/optimization/optimization_problem_2d.h"
#include "cartographer/mapping/pose_graph_interface.h"
#include "cartographer/mapping/proto/pose_graph/optimization_problem_options.pb.h"
#include "cartographer/transform/rigid_transform.h"
#include "cartographer_ext/common/loop_id.h"
#include "cartographer_ext/optimization/graph/relaxation.h"
#include "cartographer_ext/optimization/selection/switched_loops.h"

namespace cartographer_ext {
namespace optimization {

// Whether poses (global <- submap) and (global <- node) contradict a constraint
// by more than `metres` or by more than `radians`.
bool IsOff(
    const cartographer::mapping::PoseGraphInterface::Constraint& constraint,
    const cartographer::transform::Rigid2d& submap_pose,
    const cartographer::transform::Rigid2d& node_pose, double metres,
    double radians);

// `distance`: metres from which a loop is off. Constraints whose submap or node
// is not there are not counted.
LoopsOffMap CountLoopsOffMap(
    const std::vector<cartographer::mapping::PoseGraphInterface::Constraint>&
        constraints,
    const cartographer::mapping::MapById<
        cartographer::mapping::NodeId,
        cartographer::mapping::optimization::NodeSpec2D>& nodes,
    const cartographer::mapping::MapById<
        cartographer::mapping::SubmapId,
        cartographer::mapping::optimization::SubmapSpec2D>& submaps,
    double distance);

// Takes the loops out of `constraints` that the poses contradict by more than half a
// metre or 0.3 rad; none if that is more than a tenth of all.
std::vector<LoopId> TakeOutFarOff(
    const cartographer::mapping::MapById<
        cartographer::mapping::NodeId,
        cartographer::mapping::optimization::NodeSpec2D>& nodes,
    const cartographer::mapping::MapById<
        cartographer::mapping::SubmapId,
        cartographer::mapping::optimization::SubmapSpec2D>& submaps,
    std::vector<cartographer::mapping::PoseGraphInterface::Constraint>*
        constraints);

// The relaxed problems of these options, in the order in which they are tried.
// In both, loops pull thirty times as hard, and steps have a loss of 300, 3 mm
// with the stock weights, so that single steps give way. In the second, which
// needs insertions among the constraints, all steps have at most the weights of an
// insertion besides.
std::vector<Relaxation> RelaxationsOf(
    const cartographer::mapping::optimization::proto::
        OptimizationProblemOptions& options,
    const std::vector<cartographer::mapping::PoseGraphInterface::Constraint>&
        constraints);

// `solve` optimises, relaxed or (null) not, from the current poses; `count`
// counts the loops that are off. The problem has just been solved not relaxed.
// If five loops and a fiftieth of all are off, it is relaxed. The first result is
// kept in which at most a tenth of all and a quarter of these are off, and no more
// than a fiftieth of the steps besides: weak steps follow contradictory loops back
// and forth. Without any the problem is solved again as it was.
LoopsPutInForce PutLoopsInForce(
    const std::function<void(const Relaxation*)>& solve,
    const std::function<LoopsOffMap()>& count,
    const std::vector<Relaxation>& relaxations);

}  // namespace optimization
}  // namespace cartographer_ext

#endif  // CARTOGRAPHER_EXT_OPTIMIZATION_DROPIN_LOOPS_IN_FORCE_H_
