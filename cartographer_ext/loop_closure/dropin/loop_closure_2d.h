// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
//
// Loop closure of one pose graph, on the host's types:
//
//   proposed   Nodes and submaps of the pairs are remembered.
//   planned    PairPlanner chooses which pairs of a node are searched and how
//              widely; the others only get a record.
//   searched   Each in a task of its own: correlative search, refinement,
//              information of the match (PairSearcher). Where the place in
//              another trajectory is not known, all of its submaps in one task
//              (Relocalizer).
//   verified   Pair by pair, in the order of the proposals: LoopPipeline. What
//              it accepts, now or from earlier rounds, becomes a constraint;
//              what lacks evidence waits for the next round.
//
// Only planning and verification have state, and both process the same sequence
// for any number of threads.
//
// A node of the host is the gravity-aligned frame, which does not rotate with
// the robot. Searches and constraints use it; everything that concerns motion
// (paths, scans of several nodes, records) uses the tracking frame.
//
// The pose graph deletes nodes together with their submaps, but announces the
// submaps only. A constraint with a deleted node would be fatal there, so when
// a submap is deleted, all undecided loops of nodes that may have belonged to
// it are rejected (SubmapStore).
//
// Not thread-safe, except that its tasks run on the pool at any time.
#ifndef CARTOGRAPHER_EXT_LOOP_CLOSURE_DROPIN_LOOP_CLOSURE_2D_H_
#define CARTOGRAPHER_EXT_LOOP_CLOSURE_DROPIN_LOOP_CLOSURE_2D_H_

#include <cstddef>
#include <cstdint>
#include <deque>
#include <map>
#include <memory>
#include <string>
#include <vector>

#include "absl/types/optional.h"
#include "cartographer/common/task.h"
#include "cartographer/common/thread_pool.h"
#include "cartographer/mapping/2d/submap_2d.h"
#include "cartographer/mapping/id.h"
#include "cartographer/mapping/pose_graph_interface.h"
#include "cartographer/mapping/proto/pose_graph/constraint_builder_options.pb.h"
#include "cartographer/mapping/trajectory_node.h"
#include "cartographer/transform/rigid_transform.h"
#include "cartographer_ext/common/pose_graph_context.h"
#include "cartographer_ext/common/record_log.h"
#include "cartographer_ext/loop_closure/candidate_search/typical_fit.h"
#include "cartographer_ext/loop_closure/decision_counts.h"
#include "cartographer_ext/loop_closure/decision_recorder.h"
#include "cartographer_ext/loop_closure/dropin/loop_withdrawer.h"
#include "cartographer_ext/loop_closure/dropin/pair_planner.h"
#include "cartographer_ext/loop_closure/dropin/pair_searcher.h"
#include "cartographer_ext/loop_closure/dropin/relocalizer.h"
#include "cartographer_ext/loop_closure/dropin/second_look.h"
#include "cartographer_ext/loop_closure/dropin/submap_store.h"
#include "cartographer_ext/loop_closure/loop_options.h"
#include "cartographer_ext/loop_closure/loop_pipeline.h"
#include "cartographer_ext/loop_decision.pb.h"

namespace cartographer_ext {
namespace loop_closure {

// Loop closure of one pose graph, see above.
class LoopClosure2D {
 public:
  using Constraint = cartographer::mapping::PoseGraphInterface::Constraint;
  using NodeData = cartographer::mapping::TrajectoryNode::Data;

  // A pair proposed by the pose graph. Submap and node must remain valid until
  // `Verify` has returned.
  struct Proposal {
    cartographer::mapping::SubmapId submap_id;
    const cartographer::mapping::Submap2D* submap;
    cartographer::mapping::NodeId node_id;
    const NodeData* node;
    // (submap <- node); none where the whole submap is to be searched.
    absl::optional<cartographer::transform::Rigid2d> initial_relative_pose;
  };
  LoopClosure2D(
      const cartographer::mapping::constraints::proto::ConstraintBuilderOptions&
          options,
      const LoopOptions& extension,
      cartographer::common::ThreadPoolInterface* thread_pool);
  LoopClosure2D(const LoopClosure2D&) = delete;
  LoopClosure2D& operator=(const LoopClosure2D&) = delete;

  // Plans the pairs proposed when one node was added and schedules their
  // searches before `end_of_node`.
  void AddNode(const std::vector<Proposal>& proposals,
               cartographer::common::Task* end_of_node);
  // The next `Verify` processes the nodes added so far. `at_end`: no node will
  // be added for now.
  void MarkDue(bool at_end = false);
  // Processes the due candidates by the stages after the search, and returns
  // the constraints of those that are accepted now. The tasks of their nodes
  // must have run.
  std::vector<Constraint> Verify();
  // Rejects all undecided candidates.
  void Flush();
  bool has_candidates() const { return !jobs_.empty(); }

  void DeleteSubmap(const cartographer::mapping::SubmapId& submap_id);

  // The recorder of the pose graph, which records every decision.
  DecisionRecorder* recorder() const { return recorder_; }
  // Records of the undecided candidates.
  std::vector<proto::LoopDecision> Undecided() const;
  // Counts of all decisions so far, and of undecided candidates.
  DecisionCounts counts() const;
  // Counts, and how much local SLAM drifts, for the host's log.
  std::string Summary() const;

 private:
  LoopCandidate Propose(const Proposal& proposal);
  void RememberNode(const Proposal& proposal);
  // Measures the score of a node in a submap of its trajectory that ended right
  // before it.
  void MeasureFit(const Proposal& proposal, const LoopCandidate& candidate,
                  const SubmapEntry& entry);
  void ScheduleSearch(SearchJob* job, cartographer::common::Task* end_of_node);
  void ScheduleQuery(const std::vector<SearchJob*>& jobs,
                     cartographer::common::Task* end_of_node);
  void ProcessQuery(const PlaceQuery& query);
  // Decides what can be decided, with the constraints of the accepted ones;
  // returns whether there are any.
  bool Decide(bool at_end, std::vector<Constraint>* constraints);
  // As LoopPipeline::PredictAgain, over the accepted loops.
  void PredictAgain();
  // Decides what the end of a run allows to decide.
  void DecideAtEnd(std::vector<Constraint>* constraints);
  // Adds the constraint of an accepted candidate, and the marks of the loops
  // that are withdrawn on its account (common/withdrawn_loops.h).
  void Close(const LoopCandidate& accepted,
             std::vector<Constraint>* constraints);
  // Adds the mark of an accepted candidate that is withdrawn.
  void Withdraw(const LoopCandidate& accepted,
                std::vector<Constraint>* constraints);
  // Frees trajectories that the pose graph has apparently deleted.
  void FreeDormantTrajectories();
  proto::LoopDecision Describe(const LoopCandidate& candidate) const;
  // Adds to the recorder, the counts and, if enabled, a log.
  void Record(const std::vector<LoopCandidate>& decided);

  const cartographer::mapping::constraints::proto::ConstraintBuilderOptions
      options_;
  const LoopOptions extension_;
  cartographer::common::ThreadPoolInterface* const thread_pool_;
  const std::shared_ptr<PoseGraphContext> context_;
  DecisionRecorder* const recorder_;  // of the context
  DecisionCounts counts_;
  RecordLog log_;
  SubmapStore submaps_;
  const PairSearcher searcher_;
  LoopPipeline pipeline_;
  PairPlanner planner_;
  Relocalizer relocalizer_;
  TypicalFit typical_fit_;
  SecondLook second_look_;
  LoopWithdrawer loop_withdrawer_;
  // Jobs of all nodes since the last `Verify`, at stable addresses. The first
  // ones, as many as are due, belong to the next `Verify`.
  std::deque<SearchJob> jobs_;
  std::deque<PlaceQuery> queries_;
  bool at_end_ = false;
  size_t num_jobs_due_ = 0;
  size_t num_queries_due_ = 0;
  // Trajectories whose last known submap was deleted, with the number of nodes
  // added before.
  std::map<int, int64_t> dormant_since_;
  int64_t num_nodes_added_ = 0;
};

}  // namespace loop_closure
}  // namespace cartographer_ext

#endif  // CARTOGRAPHER_EXT_LOOP_CLOSURE_DROPIN_LOOP_CLOSURE_2D_H_
