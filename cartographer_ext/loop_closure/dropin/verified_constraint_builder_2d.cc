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
#include "cartographer_ext/loop_closure/constraint_information.h"
#include "cartographer_ext/loop_closure/decision_recorder.h"
#include "cartographer_ext/loop_closure/dropin/constraint_metrics.h"
#include "cartographer_ext/loop_closure/dropin/match_information.h"
#include "cartographer_ext/loop_closure/loop_options.h"
#include "glog/logging.h"

namespace cartographer_ext {
namespace loop_closure {
namespace {

using cartographer::common::Task;
using cartographer::mapping::constraints::ComputeSubmapPose;
using cartographer::mapping::constraints::proto::ConstraintBuilderOptions;
using cartographer::transform::Rigid2d;
using proto::LoopDecision;

Pose2 ToPose2(const Rigid2d& pose) {
  return Pose2(pose.translation().x(), pose.translation().y(),
               pose.normalized_angle());
}

Rigid2d ToRigid2d(const Pose2& pose) {
  return Rigid2d(pose.translation(), pose.theta);
}

void ToProto(const Pose2& from, LoopDecision::Pose* const to) {
  to->set_x(from.x);
  to->set_y(from.y);
  to->set_theta(from.theta);
}

// (local <- tracking frame)
Pose2 LocalPose(const VerifiedConstraintBuilder2D::NodeData& node) {
  return ToPose2(cartographer::transform::Project2D(node.local_pose));
}

// (gravity-aligned frame <- tracking frame), a rotation.
Pose2 FromRobot(const VerifiedConstraintBuilder2D::NodeData& node) {
  const Pose2 aligned = ToPose2(cartographer::transform::Project2D(
      node.local_pose * cartographer::transform::Rigid3d::Rotation(
                            node.gravity_alignment.inverse())));
  return Pose2(0., 0., NormalizeAngle(LocalPose(node).theta - aligned.theta));
}

// Points of the cloud in the tracking frame.
std::vector<Eigen::Vector2f> PlanarPoints(
    const VerifiedConstraintBuilder2D::NodeData& node) {
  const Pose2 to_robot = FromRobot(node).Inverse();
  std::vector<Eigen::Vector2f> points;
  points.reserve(node.filtered_gravity_aligned_point_cloud.size());
  for (const auto& point : node.filtered_gravity_aligned_point_cloud) {
    const Eigen::Vector2d aligned = point.position.head<2>().cast<double>();
    points.push_back((to_robot * aligned).cast<float>());
  }
  return points;
}

ConstraintWeights StockWeights(const ConstraintBuilderOptions& options) {
  ConstraintWeights weights;
  weights.translation = options.loop_closure_translation_weight();
  weights.rotation = options.loop_closure_rotation_weight();
  return weights;
}

}  // namespace

constexpr int VerifiedConstraintBuilder2D::kUnknownNode;

VerifiedConstraintBuilder2D::VerifiedConstraintBuilder2D(
    const ConstraintBuilderOptions& options,
    const proto::LoopClosureOptions& extension,
    cartographer::common::ThreadPoolInterface* const thread_pool)
    : options_(options),
      extension_(extension),
      thread_pool_(thread_pool),
      ceres_scan_matcher_(options.ceres_scan_matcher_options()),
      verifier_(extension, StockWeights(options)),
      planner_(extension.search(), LoopCovariance(extension),
               options.max_constraint_distance(),
               options.fast_correlative_scan_matcher_options()
                   .linear_search_window(),
               options.fast_correlative_scan_matcher_options()
                   .angular_search_window(),
               &verifier_.paths()),
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
  if (verifier_.HasNode(NodeKey{node_id.trajectory_id, node_id.node_index})) {
    return;
  }
  HistoryNode history;
  history.node_index = node_id.node_index;
  history.time = cartographer::common::ToUniversal(node.time);
  history.local_pose = LocalPose(node);
  history.signature =
      SignatureFromPoints(verifier_.signature_options(), PlanarPoints(node));
  const auto newest =
      newest_nodes_.emplace(node_id.trajectory_id, node_id.node_index).first;
  if (node_id.node_index >= newest->second) {
    newest->second = node_id.node_index;
    newest_times_[node_id.trajectory_id] = history.time;
  }
  verifier_.AddNode(node_id.trajectory_id, std::move(history));
}

VerifiedConstraintBuilder2D::SubmapEntry* VerifiedConstraintBuilder2D::Offer(
    const SubmapId& submap_id, const Submap2D* const submap,
    const NodeId& node_id, const NodeData& node) {
  LOG_IF(WARNING, callback_ != nullptr)
      << "node " << node_id << " comes while a callback is due";
  RememberNode(node_id, node);
  const auto inserted = submaps_.emplace(
      std::piecewise_construct, std::forward_as_tuple(submap_id),
      std::forward_as_tuple(options_.sampling_ratio()));
  SubmapEntry* const entry = &inserted.first->second;
  entry->submap = submap;
  const auto newest = newest_nodes_.find(submap_id.trajectory_id);
  if (inserted.second) {
    entry->local_pose = ToPose2(ComputeSubmapPose(*submap));
    entry->first_group = num_groups_;
    if (newest != newest_nodes_.end()) {
      entry->newest_node_at_first = newest->second;
      entry->time_at_first = newest_times_.at(submap_id.trajectory_id);
    }
    verifier_.AddSubmap(
        SubmapKey{submap_id.trajectory_id, submap_id.submap_index},
        entry->local_pose);
  } else if (entry->newest_node_bound == kUnknownNode &&
             num_groups_ > entry->first_group &&
             node_id.trajectory_id == submap_id.trajectory_id) {
    // A later node of its own trajectory meets it as a complete one.
    entry->newest_node_bound = newest->second;
  }
  return entry;
}

absl::optional<NodeKey> VerifiedConstraintBuilder2D::Anchor(
    const SubmapId& submap_id, const SubmapEntry& entry,
    const int trajectory_id) const {
  if (trajectory_id != submap_id.trajectory_id) {
    return LoopVerifier::PathKey(
        SubmapKey{submap_id.trajectory_id, submap_id.submap_index});
  }
  if (entry.newest_node_at_first < 0) return absl::nullopt;
  // Two submaps are under way at a time, so that the nodes of this one are
  // newer than the end of the last but one.
  int oldest = 0;
  const auto before = submaps_.find(
      SubmapId(submap_id.trajectory_id, submap_id.submap_index - 2));
  if (before != submaps_.end()) {
    oldest = std::max(0, before->second.newest_node_at_first);
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
  pairs_.push_back(Pair{submap_id, node_id, node, false,
                        ToPose2(initial_relative_pose), FromRobot(*node),
                        Anchor(submap_id, *entry, node_id.trajectory_id)});
}

void VerifiedConstraintBuilder2D::MaybeAddGlobalConstraint(
    const SubmapId& submap_id, const Submap2D* const submap,
    const NodeId& node_id, const NodeData* const node) {
  absl::MutexLock lock(&mutex_);
  const SubmapEntry* const entry = Offer(submap_id, submap, node_id, *node);
  pairs_.push_back(Pair{submap_id, node_id, node, true, Pose2(),
                        FromRobot(*node),
                        Anchor(submap_id, *entry, node_id.trajectory_id)});
}

SearchPlan VerifiedConstraintBuilder2D::PlanLikeStock(const Pair& pair) {
  SearchPlan plan;
  const auto& window = options_.fast_correlative_scan_matcher_options();
  plan.linear_window = window.linear_search_window();
  plan.angular_window = window.angular_search_window();
  plan.out_of_reach =
      pair.predicted.translation().norm() > options_.max_constraint_distance();
  if (!plan.out_of_reach && !submaps_.at(pair.submap_id).sampler.Pulse()) {
    plan.skipped = LoopDecision::SKIPPED_SAMPLER;
  }
  return plan;
}

std::vector<SearchPlan> VerifiedConstraintBuilder2D::PlanPairs() {
  std::vector<SearchPlan> plans(pairs_.size());
  std::vector<SearchPair> local;
  std::vector<size_t> local_index;
  for (size_t i = 0; i < pairs_.size(); ++i) {
    const Pair& pair = pairs_[i];
    if (pair.is_global) {
      plans[i].full_submap = true;
    } else if (!extension_.search().enabled()) {
      plans[i] = PlanLikeStock(pair);
    } else {
      SearchPair search;
      search.submap_trajectory_id = pair.submap_id.trajectory_id;
      search.submap_index = pair.submap_id.submap_index;
      search.anchor = pair.anchor;
      search.node =
          NodeKey{pair.node_id.trajectory_id, pair.node_id.node_index};
      search.predicted = pair.predicted;
      local.push_back(search);
      local_index.push_back(i);
    }
  }
  const std::vector<SearchPlan> local_plans = planner_.Plan(local);
  for (size_t k = 0; k < local.size(); ++k) {
    plans[local_index[k]] = local_plans[k];
  }
  return plans;
}

void VerifiedConstraintBuilder2D::NotifyEndOfNode() {
  absl::MutexLock lock(&mutex_);
  {
    const StageMeter meter(ConstraintMetrics::Global()->planning_cpu);
    const std::vector<SearchPlan> plans = PlanPairs();
    for (size_t i = 0; i < pairs_.size(); ++i) {
      if (plans[i].out_of_reach) continue;
      candidates_.emplace_back(pairs_[i], plans[i],
                               &submaps_.at(pairs_[i].submap_id));
      if (plans[i].skipped == LoopDecision::NONE) {
        Schedule(&candidates_.back());
      }
    }
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

void VerifiedConstraintBuilder2D::Schedule(Candidate* const candidate) {
  SubmapEntry* const entry = candidate->entry;
  ScheduleMatcher(entry);
  if (extension_.temporal_verification().enabled()) {
    ScheduleViews(candidate->pair.submap_id);
  }
  auto task = absl::make_unique<Task>();
  task->SetWorkItem([this, candidate]() { Search(candidate); });
  task->AddDependency(entry->matcher_task);
  end_of_node_task_->AddDependency(thread_pool_->Schedule(std::move(task)));
}

void VerifiedConstraintBuilder2D::ScheduleMatcher(SubmapEntry* const entry) {
  if (entry->has_matcher) return;
  entry->has_matcher = true;
  ConstraintMetrics::Global()->num_matchers->Set(++num_matchers_);
  auto task = absl::make_unique<Task>();
  const Submap2D* const submap = entry->submap;
  task->SetWorkItem([this, entry, submap]() {
    const StageMeter meter(ConstraintMetrics::Global()->build_cpu);
    entry->matcher = absl::make_unique<const SubmapMatcher>(
        *submap->grid(), options_.fast_correlative_scan_matcher_options());
  });
  entry->matcher_task = thread_pool_->Schedule(std::move(task));
}

void VerifiedConstraintBuilder2D::ScheduleViews(const SubmapId& submap_id) {
  const int reach = extension_.temporal_verification().num_neighbours();
  for (int k = -reach; k <= reach; ++k) {
    const auto it = submaps_.find(
        SubmapId(submap_id.trajectory_id, submap_id.submap_index + k));
    if (it == submaps_.end() || it->second.has_view) continue;
    SubmapEntry* const entry = &it->second;
    entry->has_view = true;
    auto task = absl::make_unique<Task>();
    const Submap2D* const submap = entry->submap;
    task->SetWorkItem([entry, submap]() {
      const StageMeter meter(ConstraintMetrics::Global()->build_cpu);
      entry->view = absl::make_unique<const OccupancyView>(
          MakeOccupancyView(*submap->grid()));
    });
    end_of_node_task_->AddDependency(thread_pool_->Schedule(std::move(task)));
  }
}

void VerifiedConstraintBuilder2D::Search(Candidate* const candidate) const {
  const ConstraintMetrics& metrics = *ConstraintMetrics::Global();
  const SubmapEntry& entry = *candidate->entry;
  const SearchPlan& plan = candidate->plan;
  const auto& cloud =
      candidate->pair.node->filtered_gravity_aligned_point_cloud;
  SubmapMatch match;
  {
    const StageMeter meter(metrics.search_cpu);
    if (plan.full_submap) {
      metrics.searched_global->Increment();
      match = entry.matcher->MatchFullSubmap(
          cloud, options_.global_localization_min_score());
    } else {
      metrics.searched_local->Increment();
      match = entry.matcher->Match(entry.local_pose * candidate->pair.predicted,
                                   plan.linear_window, plan.angular_window,
                                   cloud, options_.min_score());
    }
  }
  candidate->score = match.score;
  if (!match.found) return;
  (plan.full_submap ? metrics.found_global : metrics.found_local)->Increment();
  metrics.grid_scores->Observe(match.score);
  candidate->found = true;
  candidate->matched = Between(entry.local_pose, match.pose);

  const StageMeter meter(metrics.refinement_cpu);
  Rigid2d pose = ToRigid2d(match.pose);
  ceres::Solver::Summary unused_summary;
  ceres_scan_matcher_.Match(pose.translation(), pose, cloud,
                            *entry.submap->grid(), &pose, &unused_summary);
  candidate->refined = Between(entry.local_pose, ToPose2(pose));
  candidate->information = MatchInformation(*entry.submap->grid(), cloud,
                                            ToPose2(pose), entry.local_pose);
}

LoopCandidate VerifiedConstraintBuilder2D::MakeLoopCandidate(
    const Candidate& candidate) const {
  const Pair& pair = candidate.pair;
  const SubmapEntry& entry = *candidate.entry;
  LoopCandidate loop;
  loop.submap =
      SubmapKey{pair.submap_id.trajectory_id, pair.submap_id.submap_index};
  loop.node = NodeKey{pair.node_id.trajectory_id, pair.node_id.node_index};
  loop.node_time = cartographer::common::ToUniversal(pair.node->time);
  if (pair.submap_id.trajectory_id == pair.node_id.trajectory_id &&
      entry.newest_node_at_first >= 0) {
    loop.submap_age =
        extension_.temporal_verification().age_unit() ==
                proto::LoopClosureOptions::TemporalVerification::NODES
            ? pair.node_id.node_index - entry.newest_node_at_first
            : 1e-7 * static_cast<double>(loop.node_time - entry.time_at_first);
  } else {
    // Of another run: as old as can be.
    loop.submap_age = 1e9;
  }
  loop.submap_local_pose = entry.local_pose;
  loop.anchor = pair.anchor;
  loop.refined = candidate.refined * pair.from_robot;
  loop.constraint_pose = candidate.refined;
  loop.grid_score = candidate.score;
  loop.information = candidate.information;
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
  ToProto(candidate.matched * pair.from_robot, search.mutable_matched());
  ToProto(loop.refined, search.mutable_refined());
  const int reach = extension_.temporal_verification().num_neighbours();
  for (int k = 0; k <= 2 * reach; ++k) {
    // The submap, then its neighbours from near to far.
    const int offset = k % 2 == 1 ? (k + 1) / 2 : -k / 2;
    const auto it = submaps_.find(SubmapId(
        pair.submap_id.trajectory_id, pair.submap_id.submap_index + offset));
    if (it == submaps_.end() || it->second.view == nullptr) continue;
    loop.maps.push_back(ReferenceMap{it->second.view.get(), entry.local_pose});
  }
  return loop;
}

VerifiedConstraintBuilder2D::Result VerifiedConstraintBuilder2D::Verify() {
  const ConstraintMetrics& metrics = *ConstraintMetrics::Global();
  const StageMeter meter(metrics.verification_cpu);
  for (const Candidate& candidate : candidates_) {
    const LoopCandidate loop = MakeLoopCandidate(candidate);
    if (candidate.plan.skipped != LoopDecision::NONE) {
      verifier_.Dismiss(loop, candidate.plan.skipped);
    } else if (!candidate.found) {
      verifier_.Dismiss(loop, LoopDecision::LOW_GRID_SCORE);
    } else {
      verifier_.Process(loop);
    }
  }
  candidates_.clear();
  Result result;
  DecisionRecorder::Decisions decisions;
  for (const LoopOutcome& outcome : verifier_.Decide()) {
    metrics.CountDecision(outcome.decision);
    decisions.push_back(outcome.decision);
    if (!outcome.accepted()) continue;
    const SubmapId submap_id(outcome.submap.trajectory_id,
                             outcome.submap.submap_index);
    const NodeId node_id(outcome.node.trajectory_id, outcome.node.node_index);
    result.push_back(Constraint{
        submap_id, node_id,
        Constraint::Pose{cartographer::transform::Embed3D(
                             ToRigid2d(outcome.constraint_pose)),
                         outcome.weights.translation, outcome.weights.rotation},
        Constraint::INTER_SUBMAP});
    if (!outcome.anchor.has_value()) continue;
    const auto anchor_pose = verifier_.paths().LocalPose(*outcome.anchor);
    if (!anchor_pose.has_value()) continue;
    LoopEdge loop;
    loop.a = *outcome.anchor;
    loop.b = outcome.node;
    loop.pose.pose =
        Between(*anchor_pose, outcome.submap_local_pose) * outcome.pose;
    loop.pose.covariance = LoopCovariance(extension_);
    planner_.AddAcceptedLoop(outcome.submap.trajectory_id,
                             outcome.submap.submap_index, loop);
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
  const int newest_node =
      it == submaps_.end() ? kUnknownNode : it->second.newest_node_bound;
  verifier_.DeleteSubmap(
      SubmapKey{submap_id.trajectory_id, submap_id.submap_index});
  verifier_.DeleteNodes(submap_id.trajectory_id, newest_node);
  planner_.DeleteSubmap(submap_id.trajectory_id, submap_id.submap_index);
  if (it == submaps_.end()) return;
  if (it->second.has_matcher) {
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
