// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
//
// Only where the swap is selected; see the overlay.
#include "cartographer_ext/swaps.h"
#ifdef CARTOGRAPHER_EXT_SWAP_OPTIMIZATION_PROBLEM
#include <set>
#include <utility>

#include "absl/types/optional.h"
#include "cartographer_ext/common/loop_information.h"
#include "cartographer_ext/common/withdrawn_loops.h"
#include "cartographer_ext/optimization/dropin/stock_solve.h"

namespace cartographer_ext {
namespace optimization {
namespace {

using cartographer::mapping::PoseGraphInterface;
using Constraint = PoseGraphInterface::Constraint;

}  // namespace

void StockSolve(
    const std::vector<Constraint>& constraints,
    const std::map<int, PoseGraphInterface::TrajectoryState>&
        trajectories_state,
    const std::map<std::string, PoseGraphInterface::LandmarkNode>&
        landmark_nodes,
    PoseGraphContext* const context, const Relaxation* const relaxation,
    cartographer::mapping::optimization::StockOptimizationProblem2D* const
        problem) {
  ScopedSqrtInformation::SqrtOfPose sqrt_of_pose;
  if (context != nullptr) {
    const LoopInformation* const information = context->Get<LoopInformation>();
    if (information->size() != 0) {
      for (const Constraint& constraint : constraints) {
        Eigen::Matrix3d sqrt;
        if (constraint.tag != Constraint::INTER_SUBMAP ||
            !information->FindSqrt(
                MakeLoopId(constraint.submap_id, constraint.node_id), &sqrt)) {
          continue;
        }
        Eigen::Map<Eigen::Matrix3d>{sqrt_of_pose[&constraint.pose].data()} =
            sqrt;
      }
    }
  }
  const ScopedSqrtInformation scope(std::move(sqrt_of_pose));
  absl::optional<ScopedRelaxation> relaxed;
  if (relaxation != nullptr) {
    relaxed.emplace(*relaxation, constraints.data(),
                    constraints.data() + constraints.size());
  }
  problem->Solve(constraints, trajectories_state, landmark_nodes);
}

const std::vector<Constraint>& WithoutWithdrawnLoops(
    const std::vector<Constraint>& constraints, PoseGraphContext* const context,
    std::vector<Constraint>* const kept) {
  std::set<LoopId> withdrawn;
  if (context != nullptr) withdrawn = context->Get<WithdrawnLoops>()->All();
  const std::vector<size_t> without = FindWithdrawnLoops(
      constraints, DescribeConstraint<Constraint>, std::move(withdrawn));
  if (without.empty()) return constraints;
  kept->clear();
  kept->reserve(constraints.size() - without.size());
  auto next = without.begin();
  for (size_t i = 0; i != constraints.size(); ++i) {
    if (next != without.end() && *next == i) {
      ++next;
    } else {
      kept->push_back(constraints[i]);
    }
  }
  return *kept;
}

}  // namespace optimization
}  // namespace cartographer_ext
#endif  // CARTOGRAPHER_EXT_SWAP_OPTIMIZATION_PROBLEM
