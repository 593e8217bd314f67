// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
#include "cartographer_ext/loop_closure/dropin/verified_constraint_builder_2d.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "absl/memory/memory.h"
#include "cartographer/common/time.h"
#include "cartographer/mapping/internal/constraints/constraint_builder_2d.h"
#include "cartographer/transform/transform.h"
#include "cartographer_ext/common/full_information.h"
#include "cartographer_ext/loop_closure/decision_recorder.h"
#include "cartographer_ext/loop_closure/dropin/constraint_metrics.h"
#include "cartographer_ext/loop_closure/dropin/match_information.h"
#include "cartographer_ext/loop_closure/dropin/node_geometry.h"
#include "cartographer_ext/loop_closure/information/constraint_information.h"
#include "cartographer_ext/loop_closure/loop_options.h"
#include "cartographer_ext/scan_matching/dropin/mean_score.h"
#include "glog/logging.h"

namespace cartographer_ext {
namespace loop_closure {
namespace {

using cartographer::common::Task;
using cartographer::mapping::constraints::ComputeSubmapPose;
using cartographer::mapping::constraints::proto::ConstraintBuilderOptions;
using cartographer::transform::Rigid2d;
using proto::LoopDecision;

// Loops with another run that are remembered, oldest forgotten first.
constexpr size_t kMaxForeignLoops = 20000;

void ToProto(const Pose2& from, LoopDecision::Pose* const to) {
  to->set_x(from.x);
  to->set_y(from.y);
  to->set_theta(from.theta);
}

// Scans so little further on still see what a submap ends with, metres.
constexpr double kWayBehindSubmap = 3.;

ConstraintWeights StockWeights(const ConstraintBuilderOptions& options) {
  ConstraintWeights weights;
  weights.translation = options.loop_closure_translation_weight();
  weights.rotation = options.loop_closure_rotation_weight();
  return weights;
}

}  // namespace

VerifiedConstraintBuilder2D::VerifiedConstraintBuilder2D(
    const ConstraintBuilderOptions& options,
    const proto::LoopClosureOptions& extension,
    cartographer::common::ThreadPoolInterface* const thread_pool)
    : options_(options),
      extension_(extension),
      thread_pool_(thread_pool),
      searcher_(options),
      verifier_(extension, StockWeights(options)),
      planner_(options, extension, &verifier_.paths()),
      typical_fit_(ToTypicalFitOptions(extension)),
      end_of_node_task_(absl::make_unique<Task>()),
      callback_task_(absl::make_unique<Task>()) {
  pending_id_ = DecisionRecorder::Global()->AddPending([this]() {
    absl::MutexLock lock(&mutex_);
    return verifier_.Undecided();
  });
}

VerifiedConstraintBuilder2D::~VerifiedConstraintBuilder2D() {
  DecisionRecorder::Global()->RemovePending(pending_id_);
  absl::MutexLock lock(&mutex_);
  CHECK(callback_ == nullptr) << "a callback is due";
  CHECK(candidates_.empty()) << "WhenDone was not called";
  CHECK_EQ(num_started_nodes_, num_finished_nodes_);
  DecisionRecorder::Decisions decisions;
  for (const LoopOutcome& outcome : verifier_.Flush()) {
    ConstraintMetrics::Global()->CountDecision(outcome.decision);
    decisions.push_back(outcome.decision);
  }
  DecisionRecorder::Global()->Record(decisions);
}

void VerifiedConstraintBuilder2D::RememberNode(const NodeId& node_id,
                                               const NodeData& node) {
  if (verifier_.HasNode(ToKey(node_id))) {
    return;
  }
  HistoryNode history;
  history.node_index = node_id.node_index;
  history.time = cartographer::common::ToUniversal(node.time);
  history.local_pose = LocalPose(node);
  if (extension_.temporal_verification().enabled()) {
    DescribeScan(verifier_.temporal_options(), PlanarPoints(node), &history);
  }
  const auto newest =
      newest_nodes_.emplace(node_id.trajectory_id, node_id.node_index).first;
  if (node_id.node_index >= newest->second) {
    newest->second = node_id.node_index;
    newest_times_[node_id.trajectory_id] = history.time;
  }
  verifier_.AddNode(node_id.trajectory_id, std::move(history));
}

SubmapEntry* VerifiedConstraintBuilder2D::Offer(const SubmapId& submap_id,
                                                const Submap2D* const submap,
                                                const NodeId& node_id,
                                                const NodeData& node) {
  LOG_IF(WARNING, callback_ != nullptr)
      << "node " << node_id << " comes while a callback is due";
  RememberNode(node_id, node);
  std::shared_ptr<SubmapEntry>& kept = submaps_[submap_id];
  const bool is_new = kept == nullptr;
  if (is_new) kept = std::make_shared<SubmapEntry>();
  SubmapEntry* const entry = kept.get();
  const auto newest = newest_nodes_.find(submap_id.trajectory_id);
  if (is_new) {
    // Not again: tasks read it.
    entry->submap = submap;
    entry->local_pose = ToPose2(ComputeSubmapPose(*submap));
    entry->first_group = num_groups_;
    if (newest != newest_nodes_.end()) {
      entry->newest_node_at_first = newest->second;
      entry->time_at_first = newest_times_.at(submap_id.trajectory_id);
    }
    verifier_.AddSubmap(ToKey(submap_id), entry->local_pose);
  } else if (entry->newest_node_bound == SubmapEntry::kUnknownNode &&
             num_groups_ > entry->first_group &&
             node_id.trajectory_id == submap_id.trajectory_id) {
    // A later node of its own trajectory meets it as a complete one.
    entry->newest_node_bound = newest->second;
  }
  return entry;
}

void VerifiedConstraintBuilder2D::MeasureFit(const OfferedPair& pair,
                                             const SubmapEntry& entry) {
  if (!typical_fit_.is_on() ||
      pair.submap_id.trajectory_id != pair.node_id.trajectory_id ||
      entry.newest_node_at_first < 0 ||
      pair.node_id.node_index <= entry.newest_node_at_first) {
    return;
  }
  const absl::optional<double> travelled = verifier_.paths().Travelled(
      uncertainty::NodeId{pair.submap_id.trajectory_id,
                          entry.newest_node_at_first},
      ToKey(pair.node_id));
  if (!travelled.has_value() || *travelled > kWayBehindSubmap) return;
  typical_fit_.Add(pair.node_id.trajectory_id,
                   scan_matching::MeanScore(
                       LocalPose(*pair.node) * pair.from_robot.Inverse(),
                       pair.node->filtered_gravity_aligned_point_cloud,
                       *entry.submap->grid()));
}

absl::optional<uncertainty::VertexId> VerifiedConstraintBuilder2D::Anchor(
    const SubmapId& submap_id, const SubmapEntry& entry,
    const int trajectory_id) const {
  if (trajectory_id != submap_id.trajectory_id) {
    return uncertainty::VertexId(ToKey(submap_id));
  }
  if (entry.newest_node_at_first < 0) return absl::nullopt;
  // Two submaps are under way at a time, so that the nodes of this one are
  // newer than the end of the last but one.
  int oldest = 0;
  const auto before = submaps_.find(
      SubmapId(submap_id.trajectory_id, submap_id.submap_index - 2));
  if (before != submaps_.end()) {
    oldest = std::max(0, before->second->newest_node_at_first);
  }
  return verifier_.paths().Nearest(submap_id.trajectory_id,
                                   entry.local_pose.translation(), oldest,
                                   entry.newest_node_at_first);
}

void VerifiedConstraintBuilder2D::MaybeAddConstraint(
    const SubmapId& submap_id, const Submap2D* const submap,
    const NodeId& node_id, const NodeData* const node,
    const Rigid2d& initial_relative_pose) {
  absl::MutexLock lock(&mutex_);
  const SubmapEntry* const entry = Offer(submap_id, submap, node_id, *node);
  pairs_.push_back(OfferedPair{
      submap_id, node_id, node, false, ToPose2(initial_relative_pose),
      FromRobot(*node), Anchor(submap_id, *entry, node_id.trajectory_id)});
  MeasureFit(pairs_.back(), *entry);
}

void VerifiedConstraintBuilder2D::MaybeAddGlobalConstraint(
    const SubmapId& submap_id, const Submap2D* const submap,
    const NodeId& node_id, const NodeData* const node) {
  absl::MutexLock lock(&mutex_);
  const SubmapEntry* const entry = Offer(submap_id, submap, node_id, *node);
  pairs_.push_back(
      OfferedPair{submap_id, node_id, node, true, Pose2(), FromRobot(*node),
                  Anchor(submap_id, *entry, node_id.trajectory_id)});
}

void VerifiedConstraintBuilder2D::NotifyEndOfNode() {
  absl::MutexLock lock(&mutex_);
  {
    const StageMeter meter(ConstraintMetrics::Global()->planning_cpu);
    std::vector<LostPlace> lost;
    const std::vector<PlannedPair> planned_pairs = planner_.Plan(pairs_, &lost);
    for (const LostPlace& place : lost) {
      verifier_.ForgetLoops(place.trajectory_id, place.map_trajectory_id,
                            place.last_node_index);
      if (place.by_decisions) continue;
      // What was followed has ended there.
      forgotten_nodes_[std::make_pair(place.trajectory_id,
                                      place.map_trajectory_id)] =
          place.last_node_index;
    }
    std::map<int64_t, std::vector<PairCandidate*>> queries;
    for (const PlannedPair& planned : planned_pairs) {
      if (planned.plan.out_of_reach) continue;
      const OfferedPair& pair = pairs_[planned.pair];
      candidates_.emplace_back();
      PairCandidate& candidate = candidates_.back();
      candidate.pair = pair;
      candidate.plan = planned.plan;
      candidate.query = planned.query;
      candidate.entry = submaps_.at(pair.submap_id);
      if (planned.query >= 0) {
        queries[planned.query].push_back(&candidate);
      } else if (planned.plan.skipped == LoopDecision::NONE) {
        Schedule(&candidate);
      }
    }
    for (const auto& query : queries) ScheduleQuery(query.second);
    pairs_.clear();
    ++num_groups_;
  }
  ++num_started_nodes_;
  end_of_node_task_->SetWorkItem([this]() {
    absl::MutexLock lock(&mutex_);
    ++num_finished_nodes_;
  });
  callback_task_->AddDependency(
      thread_pool_->Schedule(std::move(end_of_node_task_)));
  end_of_node_task_ = absl::make_unique<Task>();
}

void VerifiedConstraintBuilder2D::Schedule(PairCandidate* const candidate) {
  const OfferedPair& pair = candidate->pair;
  if (pair.submap_id.trajectory_id == pair.node_id.trajectory_id) {
    candidate->floor_scale = typical_fit_.Scale(pair.node_id.trajectory_id);
  }
  auto task = absl::make_unique<Task>();
  task->SetWorkItem([this, candidate]() { searcher_.Search(candidate); });
  AwaitSubmap(*candidate, task.get());
  end_of_node_task_->AddDependency(thread_pool_->Schedule(std::move(task)));
}

void VerifiedConstraintBuilder2D::ScheduleQuery(
    const std::vector<PairCandidate*>& candidates) {
  const OfferedPair& first = candidates.front()->pair;
  const int trajectory_id = first.node_id.trajectory_id;
  const int map_id = first.submap_id.trajectory_id;
  const auto key = std::make_pair(trajectory_id, map_id);
  std::unique_ptr<PlaceSearch>& places = places_[key];
  if (places == nullptr) {
    places = absl::make_unique<PlaceSearch>(
        extension_.localization(), options_.global_localization_min_score());
  }
  queries_.emplace_back();
  PlaceQuery* const query = &queries_.back();
  query->candidates = candidates;
  query->places = places.get();
  query->is_known = planner_.localization()->IsKnown(trajectory_id, map_id);
  const auto forgotten = forgotten_nodes_.find(key);
  if (forgotten != forgotten_nodes_.end()) {
    query->forget_up_to = forgotten->second;
    forgotten_nodes_.erase(forgotten);
  }
  auto task = absl::make_unique<Task>();
  task->SetWorkItem([this, query]() { searcher_.SearchPlace(query); });
  // One after the other; they are few.
  task->AddDependency(place_tasks_[key]);
  for (const PairCandidate* const candidate : candidates) {
    AwaitSubmap(*candidate, task.get());
  }
  place_tasks_[key] = thread_pool_->Schedule(std::move(task));
  end_of_node_task_->AddDependency(place_tasks_[key]);
}

void VerifiedConstraintBuilder2D::AwaitSubmap(const PairCandidate& candidate,
                                              Task* const task) {
  ScheduleMatcher(candidate.entry);
  if (extension_.temporal_verification().enabled()) {
    ScheduleViews(candidate.pair.submap_id);
  }
  task->AddDependency(candidate.entry->matcher_task);
}

void VerifiedConstraintBuilder2D::ScheduleMatcher(
    const std::shared_ptr<SubmapEntry>& entry) {
  if (entry->has_matcher) return;
  entry->has_matcher = true;
  ConstraintMetrics::Global()->num_matchers->Set(++num_matchers_);
  auto task = absl::make_unique<Task>();
  task->SetWorkItem([this, entry]() {
    const StageMeter meter(ConstraintMetrics::Global()->build_cpu);
    entry->matcher = absl::make_unique<const SubmapMatcher>(
        *entry->submap->grid(),
        options_.fast_correlative_scan_matcher_options());
  });
  entry->matcher_task = thread_pool_->Schedule(std::move(task));
}

void VerifiedConstraintBuilder2D::ScheduleViews(const SubmapId& submap_id) {
  const int reach = extension_.temporal_verification().num_neighbours();
  for (int k = -reach; k <= reach; ++k) {
    const auto it = submaps_.find(
        SubmapId(submap_id.trajectory_id, submap_id.submap_index + k));
    if (it == submaps_.end() || it->second->has_view) continue;
    const std::shared_ptr<SubmapEntry> entry = it->second;
    entry->has_view = true;
    auto task = absl::make_unique<Task>();
    const TemporalVerificationOptions* const temporal =
        &verifier_.temporal_options();
    task->SetWorkItem([this, entry, temporal]() {
      std::unique_ptr<OccupancyView> view;
      {
        const StageMeter meter(ConstraintMetrics::Global()->build_cpu);
        view = absl::make_unique<OccupancyView>(
            MakeOccupancyView(*entry->submap->grid()));
        if (temporal->comparison == ScanComparison::kBeams) {
          view->FindDistances(
              DistanceReach(temporal->beams, view->resolution()));
        }
      }
      // Verification may be under way.
      absl::MutexLock lock(&mutex_);
      entry->view = std::move(view);
    });
    end_of_node_task_->AddDependency(thread_pool_->Schedule(std::move(task)));
  }
}

LoopCandidate VerifiedConstraintBuilder2D::StartCandidate(
    const SubmapId& submap_id, const SubmapEntry& entry,
    const bool with_maps) const {
  LoopCandidate loop;
  loop.submap = ToKey(submap_id);
  // Of another run: as old as can be.
  loop.submap_age = 1e9;
  loop.submap_local_pose = entry.local_pose;
  loop.anchor = loop.submap;
  if (!with_maps) return loop;
  const int reach = extension_.temporal_verification().num_neighbours();
  for (int k = 0; k <= 2 * reach; ++k) {
    // The submap, then its neighbours from near to far.
    const int offset = k % 2 == 1 ? (k + 1) / 2 : -k / 2;
    const auto it = submaps_.find(
        SubmapId(submap_id.trajectory_id, submap_id.submap_index + offset));
    if (it == submaps_.end() || it->second->view == nullptr) continue;
    loop.maps.push_back(ReferenceMap{it->second->view.get(), entry.local_pose});
  }
  return loop;
}

LoopCandidate VerifiedConstraintBuilder2D::MakeLoopCandidate(
    const PairCandidate& candidate) const {
  const OfferedPair& pair = candidate.pair;
  const SubmapEntry& entry = *candidate.entry;
  LoopCandidate loop = StartCandidate(pair.submap_id, entry,
                                      candidate.found && candidate.query < 0);
  loop.node = ToKey(pair.node_id);
  loop.node_time = cartographer::common::ToUniversal(pair.node->time);
  if (pair.submap_id.trajectory_id == pair.node_id.trajectory_id &&
      entry.newest_node_at_first >= 0) {
    loop.submap_age =
        extension_.temporal_verification().age_unit() ==
                proto::LoopClosureOptions::TemporalVerification::NODES
            ? pair.node_id.node_index - entry.newest_node_at_first
            : 1e-7 * static_cast<double>(loop.node_time - entry.time_at_first);
  }
  loop.anchor = pair.anchor;
  loop.refined = candidate.refined * pair.from_robot;
  loop.constraint_pose = candidate.refined;
  loop.grid_score = candidate.score;
  loop.information = candidate.information;
  loop.search_seconds = candidate.search_seconds;
  loop.refinement_seconds = candidate.refinement_seconds;
  LoopDecision::Search& search = loop.search;
  search.set_full_submap(candidate.plan.full_submap);
  search.set_linear_window(candidate.plan.linear_window);
  search.set_angular_window(candidate.plan.angular_window);
  search.set_prior_translation_sigma(candidate.plan.translation_sigma);
  search.set_prior_rotation_sigma(candidate.plan.rotation_sigma);
  if (!pair.is_global) {
    ToProto(pair.predicted * pair.from_robot, search.mutable_predicted());
  }
  if (!candidate.found) return loop;
  search.set_grid_score(candidate.score);
  if (candidate.query >= 0) return loop;
  ToProto(candidate.matched * pair.from_robot, search.mutable_matched());
  ToProto(loop.refined, search.mutable_refined());
  return loop;
}

void VerifiedConstraintBuilder2D::VerifyQuery(const PlaceQuery& query) {
  const OfferedPair& first = query.candidates.front()->pair;
  const int trajectory_id = first.node_id.trajectory_id;
  const int map_id = first.submap_id.trajectory_id;
  const PlaceResult& result = query.result;
  if (query.is_known && result.decided && !first.is_global) {
    // By the submap that was matched: the host may have moved others.
    for (const PairCandidate* const candidate : query.candidates) {
      const OfferedPair& pair = candidate->pair;
      if (pair.submap_id.submap_index != result.decided_submap) continue;
      planner_.localization()->AddDecision(
          ToKey(pair.node_id), map_id,
          query.places->IsSamePlace(
              candidate->entry->local_pose * pair.predicted,
              result.decided_pose));
    }
  }
  for (const PlacedNode& placed : result.placed) {
    const SubmapId submap_id(map_id, placed.submap_index);
    const auto kept = submaps_.find(submap_id);
    if (kept == submaps_.end()) continue;
    const SubmapEntry& entry = *kept->second;
    LoopCandidate loop = StartCandidate(submap_id, entry, true);
    loop.node = uncertainty::NodeId{trajectory_id, placed.node_index};
    loop.node_time = placed.time;
    loop.constraint_pose = Between(entry.local_pose, placed.refined);
    loop.refined = loop.constraint_pose * placed.from_robot;
    loop.grid_score = placed.score;
    loop.information = placed.information;
    loop.unpredicted = true;
    loop.first_node_index = placed.first_node_index;
    loop.search.set_full_submap(true);
    ToProto(Between(entry.local_pose, placed.matched) * placed.from_robot,
            loop.search.mutable_matched());
    ToProto(loop.refined, loop.search.mutable_refined());
    verifier_.Process(loop);
  }
}

void VerifiedConstraintBuilder2D::TakeBackLoops(const int trajectory_id,
                                                const int map_id) {
  const int last =
      planner_.localization()->LastNodeBeforeLost(trajectory_id, map_id);
  auto& loops = foreign_loops_[std::make_pair(trajectory_id, map_id)];
  const auto old =
      std::stable_partition(loops.begin(), loops.end(),
                            [last](const std::pair<int, ConstraintBits>& loop) {
                              return loop.first > last;
                            });
  for (auto it = old; it != loops.end(); ++it) {
    RememberFullInformation(it->second, Eigen::Matrix3d::Zero());
  }
  loops.erase(old, loops.end());
}

absl::optional<uncertainty::LoopEdge> VerifiedConstraintBuilder2D::MakeLoopEdge(
    const LoopOutcome& outcome) const {
  if (!outcome.anchor.has_value()) return absl::nullopt;
  const auto anchor_pose = verifier_.paths().LocalPose(*outcome.anchor);
  if (!anchor_pose.has_value()) return absl::nullopt;
  uncertainty::LoopEdge loop;
  loop.a = *outcome.anchor;
  loop.b = outcome.node;
  loop.pose.pose =
      Between(*anchor_pose, outcome.submap_local_pose) * outcome.pose;
  loop.pose.covariance = LoopCovariance(extension_);
  return loop;
}

VerifiedConstraintBuilder2D::Result VerifiedConstraintBuilder2D::Verify() {
  const ConstraintMetrics& metrics = *ConstraintMetrics::Global();
  const StageMeter meter(metrics.verification_cpu);
  // Those of nodes that were complete when the callback was asked for; the
  // tasks of others may be under way.
  for (size_t i = 0; i < num_candidates_due_; ++i) {
    const PairCandidate& candidate = candidates_[i];
    const LoopCandidate loop = MakeLoopCandidate(candidate);
    if (candidate.plan.skipped != LoopDecision::NONE) {
      verifier_.Dismiss(loop, candidate.plan.skipped);
    } else if (!candidate.found) {
      verifier_.Dismiss(loop, LoopDecision::LOW_GRID_SCORE);
    } else {
      verifier_.Process(loop);
    }
  }
  for (size_t i = 0; i < num_queries_due_; ++i) VerifyQuery(queries_[i]);
  queries_.erase(queries_.begin(), queries_.begin() + num_queries_due_);
  candidates_.erase(candidates_.begin(),
                    candidates_.begin() + num_candidates_due_);
  Result result;
  DecisionRecorder::Decisions decisions;
  for (const LoopOutcome& outcome : verifier_.Decide()) {
    metrics.CountDecision(outcome.decision);
    decisions.push_back(outcome.decision);
    if (!outcome.accepted()) continue;
    const SubmapId submap_id(outcome.submap.trajectory_id,
                             outcome.submap.submap_index);
    const NodeId node_id(outcome.node.trajectory_id, outcome.node.node_index);
    const Constraint::Pose pose{
        cartographer::transform::Embed3D(ToRigid2d(outcome.constraint_pose)),
        outcome.weights.translation, outcome.weights.rotation};
    result.push_back(
        Constraint{submap_id, node_id, pose, Constraint::INTER_SUBMAP});
    if (!outcome.full_information.isZero(0.)) {
      RememberFullInformation(BitsOf(pose), outcome.full_information);
    }
    if (planner_.AddAcceptedLoop(submap_id, outcome.node,
                                 outcome.decision.node_time(),
                                 MakeLoopEdge(outcome))) {
      TakeBackLoops(node_id.trajectory_id, submap_id.trajectory_id);
    }
    if (submap_id.trajectory_id == node_id.trajectory_id) continue;
    auto& loops = foreign_loops_[std::make_pair(node_id.trajectory_id,
                                                submap_id.trajectory_id)];
    loops.emplace_back(node_id.node_index, BitsOf(pose));
    if (loops.size() > kMaxForeignLoops) loops.pop_front();
  }
  metrics.undecided->Set(verifier_.num_undecided());
  DecisionRecorder::Global()->Record(decisions);
  return result;
}

void VerifiedConstraintBuilder2D::WhenDone(
    const std::function<void(const Result&)>& callback) {
  absl::MutexLock lock(&mutex_);
  CHECK(callback_ == nullptr) << "WhenDone was called twice";
  callback_ = callback;
  num_candidates_due_ = candidates_.size();
  num_queries_due_ = queries_.size();
  callback_task_->SetWorkItem([this]() { CallBack(); });
  thread_pool_->Schedule(std::move(callback_task_));
  callback_task_ = absl::make_unique<Task>();
}

void VerifiedConstraintBuilder2D::CallBack() {
  Result result;
  std::function<void(const Result&)> callback;
  {
    absl::MutexLock lock(&mutex_);
    result = Verify();
    callback = std::move(callback_);
    callback_ = nullptr;
  }
  callback(result);
}

int VerifiedConstraintBuilder2D::GetNumFinishedNodes() {
  absl::MutexLock lock(&mutex_);
  return num_finished_nodes_;
}

void VerifiedConstraintBuilder2D::DeleteScanMatcher(const SubmapId& submap_id) {
  absl::MutexLock lock(&mutex_);
  LOG_IF(WARNING, callback_ != nullptr)
      << "submap " << submap_id << " is forgotten while pairs are under way";
  const auto it = submaps_.find(submap_id);
  const int newest_node = it == submaps_.end() ? SubmapEntry::kUnknownNode
                                               : it->second->newest_node_bound;
  verifier_.DeleteSubmap(ToKey(submap_id));
  verifier_.DeleteNodes(submap_id.trajectory_id, newest_node);
  for (const auto& places : places_) {
    if (places.first.first != submap_id.trajectory_id) continue;
    int& forgotten = forgotten_nodes_.emplace(places.first, -1).first->second;
    forgotten = std::max(forgotten, newest_node);
  }
  planner_.DeleteSubmap(submap_id);
  // The host does not delete between the pairs of a node.
  pairs_.erase(std::remove_if(pairs_.begin(), pairs_.end(),
                              [&](const OfferedPair& pair) {
                                return pair.submap_id == submap_id;
                              }),
               pairs_.end());
  if (it == submaps_.end()) return;
  if (it->second->has_matcher) {
    ConstraintMetrics::Global()->num_matchers->Set(--num_matchers_);
  }
  submaps_.erase(it);
}

void VerifiedConstraintBuilder2D::RegisterMetrics(
    cartographer::metrics::FamilyFactory* const family_factory) {
  ConstraintMetrics::Register(family_factory);
}

}  // namespace loop_closure
}  // namespace cartographer_ext
