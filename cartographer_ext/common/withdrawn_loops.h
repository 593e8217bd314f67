// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
//
// Loop closure constraints that were accepted and later withdrawn, for example
// those of a run that turns out to have been lost.
//
// Cartographer's pose graph accepts new constraints from its constraint builder
// but cannot remove any, and their weights are fixed. So the builder adds a
// mark: a second loop constraint between the same submap and node with both
// weights zero. It has no effect on the optimisation in any Cartographer, and
// it is stored and loaded with the constraints, so the rule is a property of
// the data:
//
//   A loop constraint with both weights zero withdraws every loop constraint
//   before it in the list between the same submap and node.
//
// OptimizationProblem2D of the swap `optimization_problem` and the reader of
// stored maps skip withdrawn loops and their marks. An optimisation problem
// without the swap does not implement the rule and still uses withdrawn loops.
//
// A mark must not name a node that the pose graph has trimmed. If that is not
// certain, the loop is withdrawn in WithdrawnLoops only, for the lifetime of
// the pose graph or until it is accepted again.
#ifndef CARTOGRAPHER_EXT_COMMON_WITHDRAWN_LOOPS_H_
#define CARTOGRAPHER_EXT_COMMON_WITHDRAWN_LOOPS_H_

#include <cstddef>
#include <deque>
#include <set>
#include <vector>

#include "absl/base/thread_annotations.h"
#include "absl/synchronization/mutex.h"
#include "cartographer_ext/common/loop_id.h"

namespace cartographer_ext {

// A part of PoseGraphContext: loops withdrawn without a mark. Thread-safe.
class WithdrawnLoops {
 public:
  // Beyond this number the oldest are dropped; by then their nodes are gone.
  static constexpr size_t kCapacity = 100000;

  void Add(const LoopId& id) ABSL_LOCKS_EXCLUDED(mutex_);
  // Returns whether the loop was withdrawn.
  bool Erase(const LoopId& id) ABSL_LOCKS_EXCLUDED(mutex_);
  // The pose graph deletes the loops of a submap together with it.
  void EraseSubmap(int trajectory_id, int submap_index)
      ABSL_LOCKS_EXCLUDED(mutex_);
  std::set<LoopId> All() const ABSL_LOCKS_EXCLUDED(mutex_);

 private:
  mutable absl::Mutex mutex_;
  std::deque<LoopId> ids_ ABSL_GUARDED_BY(mutex_);
};

// The properties of a constraint that the rule above needs.
struct LoopDescription {
  bool is_loop = false;
  LoopId id;
  bool has_weight = true;  // one of the weights is not zero
};

// The indices of withdrawn loops and of their marks, ascending.
// `describe(constraint)` returns a LoopDescription; `withdrawn` are the ids
// that are withdrawn without a mark.
template <typename Constraints, typename Describe>
std::vector<size_t> FindWithdrawnLoops(const Constraints& constraints,
                                       const Describe& describe,
                                       std::set<LoopId> withdrawn = {}) {
  std::vector<size_t> result;
  size_t index = constraints.size();
  for (auto it = constraints.end(); it != constraints.begin();) {
    --it;
    --index;
    const LoopDescription loop = describe(*it);
    if (!loop.is_loop) continue;
    if (!loop.has_weight) {
      withdrawn.insert(loop.id);
      result.push_back(index);
    } else if (!withdrawn.empty() && withdrawn.count(loop.id) != 0) {
      result.push_back(index);
    }
  }
  return std::vector<size_t>(result.rbegin(), result.rend());
}

// For Cartographer's PoseGraphInterface::Constraint.
template <typename Constraint>
LoopDescription DescribeConstraint(const Constraint& constraint) {
  LoopDescription loop;
  loop.is_loop = constraint.tag == Constraint::INTER_SUBMAP;
  loop.id = MakeLoopId(constraint.submap_id, constraint.node_id);
  loop.has_weight = constraint.pose.translation_weight != 0. ||
                    constraint.pose.rotation_weight != 0.;
  return loop;
}

// The mark that withdraws a loop.
template <typename Constraint>
Constraint WithdrawalMark(Constraint loop) {
  loop.pose.translation_weight = loop.pose.rotation_weight = 0.;
  return loop;
}

// For Cartographer's message PoseGraph.Constraint.
template <typename ConstraintProto>
LoopDescription DescribeConstraintProto(const ConstraintProto& constraint) {
  LoopDescription loop;
  loop.is_loop = constraint.tag() == ConstraintProto::INTER_SUBMAP;
  loop.id.submap_trajectory = constraint.submap_id().trajectory_id();
  loop.id.submap_index = constraint.submap_id().submap_index();
  loop.id.node_trajectory = constraint.node_id().trajectory_id();
  loop.id.node_index = constraint.node_id().node_index();
  loop.has_weight = constraint.translation_weight() != 0. ||
                    constraint.rotation_weight() != 0.;
  return loop;
}

// Removes withdrawn loops and their marks from Cartographer's constraints.
template <typename Constraint>
void RemoveWithdrawnLoops(std::vector<Constraint>* const constraints) {
  const std::vector<size_t> withdrawn =
      FindWithdrawnLoops(*constraints, DescribeConstraint<Constraint>);
  auto next = withdrawn.begin();
  size_t kept = 0;
  for (size_t i = 0; i != constraints->size(); ++i) {
    if (next != withdrawn.end() && *next == i) {
      ++next;
    } else {
      (*constraints)[kept++] = (*constraints)[i];
    }
  }
  constraints->erase(constraints->begin() + kept, constraints->end());
}

}  // namespace cartographer_ext

#endif  // CARTOGRAPHER_EXT_COMMON_WITHDRAWN_LOOPS_H_
