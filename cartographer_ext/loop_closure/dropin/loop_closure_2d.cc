// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
#include "cartographer_ext/loop_closure/dropin/loop_closure_2d.h"

#include <algorithm>
#include <limits>
#include <utility>

#include "absl/memory/memory.h"
#include "absl/strings/str_cat.h"
#include "cartographer/common/time.h"
#include "cartographer/transform/transform.h"
#include "cartographer_ext/common/loop_information.h"
#include "cartographer_ext/loop_closure/decision_log.h"
#include "cartographer_ext/loop_closure/decision_record.h"
#include "cartographer_ext/loop_closure/dropin/constraint_metrics.h"
#include "cartographer_ext/loop_closure/dropin/node_geometry.h"
#include "cartographer_ext/loop_closure/loop_options.h"
#include "cartographer_ext/scan_matching/dropin/mean_score.h"
#include "cartographer_ext/uncertainty/drift_model.h"
#include "cartographer_ext/uncertainty/loop_ambiguity.h"
#include "cartographer_ext/uncertainty/step_errors.h"
#include "glog/logging.h"

namespace cartographer_ext {
namespace loop_closure {
namespace {

using cartographer::common::Task;
using cartographer::mapping::NodeId;
using cartographer::mapping::SubmapId;
using cartographer::mapping::constraints::proto::ConstraintBuilderOptions;
using proto::LoopDecision;

// Scans at most this far behind the end of a submap still see what it ends
// with, metres of travel.
constexpr double kDistanceBehindSubmap = 3.;
// A trajectory without submaps is freed after this many nodes of others.
constexpr int64_t kNodesUntilFreed = 100;
// Loops accepted at the end of a run predict others, at most this often.
constexpr int kMostPredictions = 10;

ConstraintWeights StockWeights(const ConstraintBuilderOptions& options) {
  return {options.loop_closure_translation_weight(),
          options.loop_closure_rotation_weight()};
}

TypicalFitOptions NoTypicalFit() {
  TypicalFitOptions options;
  options.reference = 0.;
  return options;
}

LoopClosure2D::Constraint MakeConstraint(const LoopCandidate& accepted) {
  return LoopClosure2D::Constraint{
      SubmapId(accepted.submap.trajectory_id, accepted.submap.submap_index),
      NodeId(accepted.node.trajectory_id, accepted.node.node_index),
      LoopClosure2D::Constraint::Pose{
          cartographer::transform::Embed3D(ToRigid2d(accepted.match.refined)),
          accepted.weights->translation, accepted.weights->rotation},
      LoopClosure2D::Constraint::INTER_SUBMAP};
}

}  // namespace

LoopClosure2D::LoopClosure2D(
    const ConstraintBuilderOptions& options, const LoopOptions& extension,
    cartographer::common::ThreadPoolInterface* const thread_pool)
    : options_(options),
      extension_(extension),
      thread_pool_(thread_pool),
      context_(PoseGraphContext::CurrentOrNew()),
      recorder_(context_->Get<DecisionRecorder>()),
      log_(extension.log_directory, "loops", DecisionCsvHead()),
      submaps_(options, extension),
      searcher_(options, extension, submaps_.cache()),
      pipeline_(extension, StockWeights(options)),
      planner_(options, extension, &pipeline_.paths()),
      relocalizer_(extension.relocalization,
                   options.global_localization_min_score()),
      typical_fit_(extension.search.enabled ? extension.typical_fit
                                            : NoTypicalFit()),
      second_look_(extension, &searcher_, &typical_fit_, &submaps_, &planner_,
                   &pipeline_) {
  LOG_IF(ERROR, !log_.status().ok())
      << "cartographer_ext: no log of loop decisions: " << log_.status();
  context_->Get<uncertainty::DriftModel>()->SetPrior(extension.path_noise);
}

void LoopClosure2D::AddNode(const std::vector<Proposal>& proposals,
                            Task* const end_of_node) {
  const StageMeter meter(ConstraintMetrics::Global()->planning_cpu);
  std::map<uncertainty::NodeId, const NodeData*> nodes;
  std::vector<LoopCandidate> proposed;
  proposed.reserve(proposals.size());
  for (const Proposal& proposal : proposals) {
    nodes[ToKey(proposal.node_id)] = proposal.node;
    proposed.push_back(Propose(proposal));
  }
  std::vector<LostPlace> lost;
  std::vector<LoopCandidate> planned = planner_.Plan(proposed, &lost);
  for (const LostPlace& place : lost) {
    pipeline_.ForgetLoops(place.trajectory_id, place.map_trajectory_id,
                          place.last_node_index);
    if (place.by_decisions) continue;
    // The places that were followed end there.
    relocalizer_.ForgetPlaces(place.trajectory_id, place.map_trajectory_id,
                              place.last_node_index);
  }
  std::map<int64_t, std::vector<SearchJob*>> queries;
  for (LoopCandidate& candidate : planned) {
    const SearchPlan& plan = candidate.plan;
    if (plan.out_of_reach) continue;
    jobs_.emplace_back();
    SearchJob* const job = &jobs_.back();
    job->node = nodes.at(candidate.node);
    job->entry = submaps_.Find(candidate.submap);
    job->candidate = std::move(candidate);
    if (job->candidate.plan.query >= 0) {
      queries[job->candidate.plan.query].push_back(job);
    } else if (job->candidate.plan.skipped == LoopDecision::NONE) {
      ScheduleSearch(job, end_of_node);
    }
  }
  for (const auto& query : queries) ScheduleQuery(query.second, end_of_node);
  submaps_.EndGroup();
  ++num_nodes_added_;
  FreeDormantTrajectories();
}

LoopCandidate LoopClosure2D::Propose(const Proposal& proposal) {
  RememberNode(proposal);
  const uncertainty::SubmapId submap_id = ToKey(proposal.submap_id);
  const std::shared_ptr<SubmapEntry> entry = submaps_.AddPair(
      submap_id, proposal.submap, proposal.node_id.trajectory_id);
  pipeline_.AddSubmap(submap_id, entry->local_pose);
  dormant_since_.erase(submap_id.trajectory_id);
  dormant_since_.erase(proposal.node_id.trajectory_id);

  LoopCandidate candidate = submaps_.MakeCandidate(
      submap_id, *entry, proposal.node_id.trajectory_id, pipeline_.paths());
  candidate.node = ToKey(proposal.node_id);
  candidate.node_time = cartographer::common::ToUniversal(proposal.node->time);
  candidate.aligned_from_tracking = AlignedFromTracking(*proposal.node);
  if (!candidate.is_inter_trajectory() && entry->newest_node_at_first >= 0) {
    candidate.submap_age =
        1e-7 * static_cast<double>(candidate.node_time - entry->time_at_first);
  }
  if (proposal.initial_relative_pose.has_value()) {
    candidate.predicted = ToPose2(*proposal.initial_relative_pose);
    MeasureFit(proposal, candidate, *entry);
  }
  return candidate;
}

void LoopClosure2D::RememberNode(const Proposal& proposal) {
  const uncertainty::NodeId id = ToKey(proposal.node_id);
  if (pipeline_.HasNode(id)) return;
  HistoryNode node;
  node.node_index = id.node_index;
  node.time = cartographer::common::ToUniversal(proposal.node->time);
  node.local_pose = LocalPose(*proposal.node);
  node.aligned_theta = AlignedFromTracking(*proposal.node).theta;
  if (extension_.temporal.enabled) {
    DescribeScan(pipeline_.temporal_options(), PlanarPoints(*proposal.node),
                 &node);
  }
  submaps_.AddNode(id, node.time);
  const uncertainty::StepError error =
      context_->Get<uncertainty::StepErrors>()->At(node.time);
  pipeline_.AddNode(id.trajectory_id, std::move(node), error);
}

void LoopClosure2D::MeasureFit(const Proposal& proposal,
                               const LoopCandidate& candidate,
                               const SubmapEntry& entry) {
  if (!typical_fit_.is_on() || candidate.is_inter_trajectory() ||
      entry.newest_node_at_first < 0 ||
      candidate.node.node_index <= entry.newest_node_at_first) {
    return;
  }
  const absl::optional<double> travelled = pipeline_.paths().Travelled(
      uncertainty::NodeId{candidate.submap.trajectory_id,
                          entry.newest_node_at_first},
      candidate.node);
  if (!travelled.has_value() || *travelled > kDistanceBehindSubmap) return;
  typical_fit_.Add(
      candidate.node.trajectory_id,
      scan_matching::MeanScore(
          LocalPose(*proposal.node) * candidate.aligned_from_tracking.Inverse(),
          proposal.node->filtered_gravity_aligned_point_cloud,
          *entry.submap->grid()),
      SectorSeen(PlanarPoints(*proposal.node)));
}

void LoopClosure2D::ScheduleSearch(SearchJob* const job,
                                   Task* const end_of_node) {
  const LoopCandidate& candidate = job->candidate;
  if (!candidate.is_inter_trajectory()) {
    job->score_scale = typical_fit_.Scale(candidate.node.trajectory_id);
  }
  auto task = absl::make_unique<Task>();
  task->SetWorkItem([this, job]() { searcher_.Search(job); });
  submaps_.AnnounceSearch(candidate.submap);
  end_of_node->AddDependency(thread_pool_->Schedule(std::move(task)));
}

void LoopClosure2D::ScheduleQuery(const std::vector<SearchJob*>& jobs,
                                  Task* const end_of_node) {
  queries_.push_back(relocalizer_.MakeQuery(jobs, *planner_.localization()));
  PlaceQuery* const query = &queries_.back();
  auto task = absl::make_unique<Task>();
  task->SetWorkItem([this, query]() { searcher_.SearchPlace(query); });
  std::weak_ptr<Task>* const last_task = relocalizer_.LastTask(*query);
  task->AddDependency(*last_task);
  for (const SearchJob* const job : jobs) {
    submaps_.AnnounceSearch(job->candidate.submap);
  }
  *last_task = thread_pool_->Schedule(std::move(task));
  end_of_node->AddDependency(*last_task);
}

void LoopClosure2D::MarkDue(const bool at_end) {
  at_end_ = at_end;
  num_jobs_due_ = jobs_.size();
  num_queries_due_ = queries_.size();
}

std::vector<LoopClosure2D::Constraint> LoopClosure2D::Verify() {
  const ConstraintMetrics& metrics = *ConstraintMetrics::Global();
  const StageMeter meter(metrics.verification_cpu);
  for (size_t i = 0; i < num_jobs_due_; ++i) {
    LoopCandidate candidate = jobs_[i].candidate;
    if (candidate.match.found) submaps_.AddMaps(&candidate);
    pipeline_.Process(std::move(candidate));
  }
  for (size_t i = 0; i < num_queries_due_; ++i) ProcessQuery(queries_[i]);
  queries_.erase(queries_.begin(), queries_.begin() + num_queries_due_);
  jobs_.erase(jobs_.begin(), jobs_.begin() + num_jobs_due_);
  num_jobs_due_ = num_queries_due_ = 0;
  std::vector<Constraint> constraints;
  Decide(false, &constraints);
  if (at_end_) {
    DecideAtEnd(&constraints);
  } else if (second_look_.FollowUndecided(false)) {
    Decide(false, &constraints);
  }
  auto* const drift = context_->Get<uncertainty::DriftModel>();
  for (const auto& estimate : pipeline_.drift().Estimates()) {
    drift->Set(estimate.first, estimate.second);
  }
  context_->Get<uncertainty::LoopAmbiguity>()->Set(pipeline_.share_wrong());
  metrics.undecided->Set(pipeline_.num_undecided());
  return constraints;
}

void LoopClosure2D::DecideAtEnd(std::vector<Constraint>* const constraints) {
  second_look_.FollowUndecided(true);
  Decide(true, constraints);
  for (int i = 0; i < kMostPredictions; ++i) {
    PredictAgain();
    if (!Decide(true, constraints) && !second_look_.SearchAroundAccepted() &&
        !second_look_.FollowUndecided(true)) {
      break;
    }
  }
  pipeline_.Refute(
      [this](const LoopEnds& ends) { return planner_.PathsWithout(ends); });
  Decide(true, constraints);
}

bool LoopClosure2D::Decide(const bool at_end,
                           std::vector<Constraint>* const constraints) {
  const std::vector<LoopCandidate> decided = pipeline_.Decide(at_end);
  Record(decided);
  bool has_closed = false;
  for (const LoopCandidate& candidate : decided) {
    if (candidate.verdict == LoopDecision::UNDECIDED) {
      Withdraw(candidate, constraints);
    }
    if (!candidate.is_accepted()) continue;
    Close(candidate, constraints);
    second_look_.AddAccepted(candidate);
    has_closed = true;
  }
  return has_closed;
}

void LoopClosure2D::PredictAgain() {
  pipeline_.PredictAgain(
      [this](const uncertainty::VertexId& a, const uncertainty::VertexId& b) {
        return planner_.PathBetween(a, b);
      });
}

void LoopClosure2D::ProcessQuery(const PlaceQuery& query) {
  relocalizer_.ReportDecision(query, planner_.localization());
  const LoopCandidate& first = query.jobs.front()->candidate;
  for (const LoopCandidate& placed : query.result.placed) {
    const uncertainty::SubmapId submap_id{first.submap.trajectory_id,
                                          placed.submap.submap_index};
    const std::shared_ptr<SubmapEntry> entry = submaps_.Find(submap_id);
    if (entry == nullptr) continue;
    LoopCandidate candidate = submaps_.MakeCandidate(
        submap_id, *entry, first.node.trajectory_id, pipeline_.paths());
    candidate.node =
        uncertainty::NodeId{first.node.trajectory_id, placed.node.node_index};
    candidate.node_time = placed.node_time;
    candidate.aligned_from_tracking = placed.aligned_from_tracking;
    candidate.relocalized = placed.relocalized;
    candidate.first_node_index = placed.first_node_index;
    candidate.plan = placed.plan;
    candidate.match = placed.match;
    submaps_.AddMaps(&candidate);
    pipeline_.Process(std::move(candidate));
  }
}

void LoopClosure2D::Close(const LoopCandidate& accepted,
                          std::vector<Constraint>* const constraints) {
  const Constraint constraint = MakeConstraint(accepted);
  if (!accepted.full_information.isZero(0.)) {
    context_->Get<LoopInformation>()->Set(
        MakeLoopId(constraint.submap_id, constraint.node_id),
        accepted.full_information);
  }
  absl::optional<uncertainty::LoopEdge> loop;
  const absl::optional<Pose2> anchor_pose =
      accepted.anchor.has_value()
          ? pipeline_.paths().LocalPose(*accepted.anchor)
          : absl::nullopt;
  if (anchor_pose.has_value()) {
    loop = uncertainty::LoopEdge();
    loop->a = *accepted.anchor;
    loop->b = accepted.node;
    loop->pose.pose = accepted.RefinedFromAnchor(*anchor_pose);
    loop->pose.covariance = LoopCovariance(extension_);
  }
  if (planner_.AddAcceptedLoop(accepted, loop)) {
    // Relocalised after it was lost.
    const int trajectory_id = accepted.node.trajectory_id;
    const int map_id = accepted.submap.trajectory_id;
    loop_withdrawer_.Withdraw(
        trajectory_id, map_id,
        planner_.localization()->LastNodeBeforeLost(trajectory_id, map_id),
        context_.get(), constraints);
  }
  loop_withdrawer_.Add(constraint, context_.get(), constraints);
  constraints->push_back(constraint);
}

void LoopClosure2D::Withdraw(const LoopCandidate& accepted,
                             std::vector<Constraint>* const constraints) {
  if (accepted.anchor.has_value()) {
    planner_.RemoveAcceptedLoop(*accepted.anchor, accepted.node);
  }
  loop_withdrawer_.Withdraw(MakeConstraint(accepted), context_.get(),
                            constraints);
}

void LoopClosure2D::Flush() { Record(pipeline_.Flush()); }

void LoopClosure2D::DeleteSubmap(const SubmapId& submap_id) {
  const uncertainty::SubmapId id = ToKey(submap_id);
  const bool is_known = submaps_.Find(id) != nullptr;
  const int newest_node = submaps_.Erase(id);
  loop_withdrawer_.DeleteSubmap(
      submap_id,
      std::min(newest_node, submaps_.NewestNodeIndex(id.trajectory_id)),
      context_.get());
  pipeline_.DeleteSubmap(id);
  pipeline_.DeleteNodes(id.trajectory_id, newest_node);
  relocalizer_.DeleteNodes(id.trajectory_id, newest_node);
  second_look_.DeleteNodes(id.trajectory_id, newest_node);
  planner_.DeleteSubmap(id);
  if (is_known && !submaps_.HasSubmapsOf(id.trajectory_id)) {
    dormant_since_[id.trajectory_id] = num_nodes_added_;
  }
}

void LoopClosure2D::FreeDormantTrajectories() {
  for (auto it = dormant_since_.begin(); it != dormant_since_.end();) {
    if (num_nodes_added_ - it->second < kNodesUntilFreed) {
      ++it;
      continue;
    }
    const int trajectory_id = it->first;
    pipeline_.DeleteNodes(trajectory_id, std::numeric_limits<int>::max());
    pipeline_.DeleteTrajectory(trajectory_id);
    planner_.DeleteTrajectory(trajectory_id);
    submaps_.DeleteTrajectory(trajectory_id);
    relocalizer_.DeleteTrajectory(trajectory_id);
    second_look_.DeleteTrajectory(trajectory_id);
    typical_fit_.DeleteTrajectory(trajectory_id);
    loop_withdrawer_.DeleteTrajectory(trajectory_id);
    context_->Get<uncertainty::DriftModel>()->DeleteTrajectory(trajectory_id);
    it = dormant_since_.erase(it);
  }
}

DecisionCounts LoopClosure2D::counts() const {
  DecisionCounts counts = counts_;
  counts.undecided = pipeline_.num_undecided();
  return counts;
}

std::string LoopClosure2D::Summary() const {
  const std::string drift =
      ToText(context_->Get<uncertainty::DriftModel>()->All());
  return absl::StrCat(ToText(counts()), drift.empty() ? "" : "; ", drift);
}

std::vector<LoopDecision> LoopClosure2D::Undecided() const {
  std::vector<LoopDecision> decisions;
  for (const LoopCandidate& candidate : pipeline_.Undecided()) {
    decisions.push_back(Describe(candidate));
  }
  return decisions;
}

LoopDecision LoopClosure2D::Describe(const LoopCandidate& candidate) const {
  return MakeDecisionRecord(candidate, extension_.log_times);
}

void LoopClosure2D::Record(const std::vector<LoopCandidate>& decided) {
  std::vector<LoopDecision> decisions;
  for (const LoopCandidate& candidate : decided) {
    decisions.push_back(Describe(candidate));
    ConstraintMetrics::Global()->CountDecision(decisions.back());
  }
  recorder_->Record(decisions);
  for (const LoopDecision& decision : decisions) {
    if (decision.verdict() == LoopDecision::UNDECIDED) {
      --counts_.accepted;  // withdrawn, was counted before
    } else {
      counts_.Add(decision);
    }
  }
  if (!log_.is_on()) return;
  std::string bytes;
  for (const LoopDecision& decision : decisions) {
    AppendDecision(decision, &bytes);
  }
  log_.Append(DecisionCsvRows(decisions), bytes);
  LOG_IF(ERROR, !log_.is_on())
      << "cartographer_ext: the log of loop decisions ends: " << log_.status();
}

}  // namespace loop_closure
}  // namespace cartographer_ext
