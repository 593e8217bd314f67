// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
#include "cartographer_ext/loop_closure/dropin/second_look.h"

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <iterator>
#include <utility>
#include <vector>

#include "cartographer/mapping/trajectory_node.h"
#include "cartographer/sensor/point_cloud.h"
#include "cartographer_ext/common/order_statistics.h"
#include "cartographer_ext/loop_closure/consensus/candidate_edge.h"
#include "glog/logging.h"

namespace cartographer_ext {
namespace loop_closure {
namespace {

using cartographer::mapping::TrajectoryNode;
using proto::LoopDecision;
using uncertainty::NodeId;
using uncertainty::SubmapId;
using uncertainty::UncertainPose;

// Of path on either side, metres.
constexpr double kAroundAccepted = 10.;
constexpr double kAroundUndecided = 12.;
// What is nearer has been compared with the undecided match itself.
constexpr double kBeyondUndecided = 2.;
constexpr double kSpacing = 1.;
// A place is mapped if the robot was so near: in median ranges of the scan, and
// metres.
constexpr double kMappedRanges = 0.5;
constexpr double kMapped = 2.;
// What a node still sees of another visit is no revisit, metres of path.
constexpr double kLeastPath = 10.;
// Largest window, metres, half width.
constexpr double kWidest = 3.;
// Bounds on the work of one end of a run.
constexpr size_t kMaxAccepted = 200;
constexpr int kMaxSearches = 400;
constexpr int kMaxFollowingSearches = 1000;
// The same before the end, of one round of verification.
constexpr int kMaxEarlySearches = 200;
constexpr int kEnoughWrong = 20;
// Least score of a match in a whole submap that is followed. It may show the
// place from another side, where scores are lower than those that the mixture
// learns from short paths.
constexpr double kLeastFollowed = 0.02;
// Neighbours of a submap that may see what it sees.
constexpr int kSubmapsAround = 6;
constexpr int kNodesPerSide = 400;

// How far from the place of another scan this one sees mostly the same, metres.
double MappedDistance(const HistoryNode& scan) {
  std::vector<float> ranges;
  ranges.reserve(scan.beams.size());
  for (const Beam& beam : scan.beams) ranges.push_back(beam.range);
  return std::max(kMapped, kMappedRanges * UpperMedian(std::move(ranges)));
}

double LeastFollowed(const LoopCandidate& candidate) {
  return candidate.plan.full_submap ? kLeastFollowed : kConfirmingScore;
}

TrajectoryNode::Data MakeData(const HistoryNode& node) {
  const Eigen::Rotation2Df aligned_from_tracking(
      static_cast<float>(node.aligned_theta));
  std::vector<cartographer::sensor::RangefinderPoint> points;
  points.reserve(node.beams.size());
  for (const Beam& beam : node.beams) {
    const Eigen::Vector2f end = aligned_from_tracking * beam.end;
    points.push_back({Eigen::Vector3f(end.x(), end.y(), 0.f)});
  }
  TrajectoryNode::Data data;
  data.filtered_gravity_aligned_point_cloud =
      cartographer::sensor::PointCloud(points);
  return data;
}

}  // namespace

SecondLook::SecondLook(const LoopOptions& options,
                       const PairSearcher* const searcher,
                       const TypicalFit* const typical_fit,
                       SubmapStore* const submaps, PairPlanner* const planner,
                       LoopPipeline* const pipeline)
    : options_(options),
      is_on_(options.search.enabled &&
             options.compatible_subset.single_strong_enabled),
      searcher_(CHECK_NOTNULL(searcher)),
      typical_fit_(CHECK_NOTNULL(typical_fit)),
      submaps_(CHECK_NOTNULL(submaps)),
      planner_(CHECK_NOTNULL(planner)),
      pipeline_(CHECK_NOTNULL(pipeline)) {}

void SecondLook::AddAccepted(const LoopCandidate& accepted) {
  if (!is_on_ || accepted.is_inter_trajectory() ||
      (!accepted.plan.full_submap &&
       accepted.plan.translation_sigma < options_.search.saturated_sigma)) {
    return;
  }
  accepted_.push_back(accepted);
  if (accepted_.size() > kMaxAccepted) accepted_.pop_front();
}

void SecondLook::DeleteNodes(const int trajectory_id,
                             const int last_node_index) {
  const auto last =
      last_deleted_node_.emplace(trajectory_id, last_node_index).first;
  last->second = std::max(last->second, last_node_index);
}

void SecondLook::DeleteTrajectory(const int trajectory_id) {
  last_deleted_node_.erase(trajectory_id);
  accepted_.erase(std::remove_if(accepted_.begin(), accepted_.end(),
                                 [&](const LoopCandidate& candidate) {
                                   return candidate.node.trajectory_id ==
                                          trajectory_id;
                                 }),
                  accepted_.end());
}

void SecondLook::Walk(const NodeId& from, const double least, const double most,
                      const std::function<void(const NodeId&)>& visit) const {
  const auto deleted = last_deleted_node_.find(from.trajectory_id);
  for (const int step : {-1, 1}) {
    double last = least - kSpacing;
    for (int k = 1; k <= kNodesPerSide; ++k) {
      const NodeId node{from.trajectory_id, from.node_index + step * k};
      if (deleted != last_deleted_node_.end() &&
          node.node_index <= deleted->second) {
        break;
      }
      const absl::optional<double> travelled =
          pipeline_->paths().Travelled(from, node);
      if (!travelled.has_value()) continue;
      if (*travelled > most) break;
      if (*travelled < last + kSpacing) continue;
      last = *travelled;
      visit(node);
    }
  }
}

absl::optional<LoopCandidate> SecondLook::SubmapAround(
    const NodeId& node, const SubmapId& near) const {
  absl::optional<LoopCandidate> best;
  int least = 0;
  for (int k = -kSubmapsAround; k <= kSubmapsAround; ++k) {
    const SubmapId id{near.trajectory_id, near.submap_index + k};
    const std::shared_ptr<SubmapEntry> entry = submaps_->Find(id);
    if (entry == nullptr) continue;
    LoopCandidate candidate = submaps_->MakeCandidate(
        id, *entry, near.trajectory_id, pipeline_->paths());
    if (node.node_index < candidate.first_submap_node ||
        node.node_index > candidate.last_submap_node) {
      continue;
    }
    const int off_centre =
        std::abs(2 * node.node_index - candidate.first_submap_node -
                 candidate.last_submap_node);
    if (best.has_value() && off_centre >= least) continue;
    least = off_centre;
    best = std::move(candidate);
  }
  return best;
}

absl::optional<SearchJob> SecondLook::MakeJob(
    const LoopCandidate& match, const NodeId& a, const NodeId& node,
    const UncertainPose& prediction) const {
  const HistoryNode* const scan =
      pipeline_->history().Find(node.trajectory_id, node.node_index);
  const absl::optional<Pose2> a_pose = pipeline_->paths().LocalPose(a);
  if (scan == nullptr || scan->beams.empty() || !a_pose.has_value()) return {};
  SearchPlan plan;
  SetWindow(options_.search, prediction.covariance, &plan);
  if (plan.linear_window > kWidest) return {};
  const Pose2 predicted = *a_pose * prediction.pose;
  // The other visit may be the earlier or the later one.
  const bool is_earlier = a.node_index < node.node_index;
  const absl::optional<NodeId> seen_by = pipeline_->paths().Nearest(
      a.trajectory_id, predicted.translation(),
      is_earlier ? a.node_index - kNodesPerSide
                 : std::max(a.node_index - kNodesPerSide, node.node_index + 1),
      is_earlier ? std::min(a.node_index + kNodesPerSide, node.node_index - 1)
                 : a.node_index + kNodesPerSide);
  if (!seen_by.has_value()) return {};
  const absl::optional<double> path =
      pipeline_->paths().Travelled(*seen_by, node);
  if (!path.has_value() || *path < kLeastPath ||
      (pipeline_->paths().LocalPose(*seen_by)->translation() -
       predicted.translation())
              .norm() > MappedDistance(*scan)) {
    return {};
  }
  absl::optional<LoopCandidate> candidate =
      SubmapAround(*seen_by, match.submap);
  if (!candidate.has_value() ||
      (node.node_index >= candidate->first_submap_node &&
       node.node_index <= candidate->last_submap_node)) {
    return {};
  }
  SearchJob job;
  job.entry = submaps_->Find(candidate->submap);
  job.score_scale = typical_fit_->Scale(node.trajectory_id);
  job.candidate = std::move(*candidate);
  job.candidate.node = node;
  job.candidate.node_time = scan->time;
  job.candidate.submap_age = std::max(
      0., 1e-7 * static_cast<double>(scan->time - job.entry->time_at_first));
  job.candidate.aligned_from_tracking = Pose2(0., 0., scan->aligned_theta);
  job.candidate.predicted =
      Between(job.candidate.submap_local_pose, predicted) *
      job.candidate.aligned_from_tracking.Inverse();
  job.candidate.plan = plan;
  return job;
}

void SecondLook::Match(SearchJob* const job) const {
  submaps_->AnnounceSearch(job->candidate.submap);
  const NodeId& node = job->candidate.node;
  const TrajectoryNode::Data data =
      MakeData(*pipeline_->history().Find(node.trajectory_id, node.node_index));
  job->node = &data;
  searcher_->Search(job);
  job->node = nullptr;
  if (job->candidate.match.found) submaps_->AddMaps(&job->candidate);
}

bool SecondLook::IsLookedAt(const NodeId& node) const {
  const auto is_near = [&](const NodeId& other) {
    const absl::optional<double> travelled =
        pipeline_->paths().Travelled(other, node);
    return travelled.has_value() && *travelled < kSpacing;
  };
  const auto after = looked_at_.lower_bound(node);
  return (after != looked_at_.end() && is_near(*after)) ||
         (after != looked_at_.begin() && is_near(*std::prev(after)));
}

bool SecondLook::SearchAroundAccepted() {
  int num_searches = 0;
  while (!accepted_.empty()) {
    const LoopCandidate accepted = std::move(accepted_.front());
    accepted_.pop_front();
    const uncertainty::LoopEdge edge =
        CandidateEdge(options_, pipeline_->paths(), accepted);
    if (!edge.a.is_node()) continue;
    Walk(accepted.node, kSpacing, kAroundAccepted, [&](const NodeId& node) {
      if (num_searches >= kMaxSearches || IsLookedAt(node)) return;
      const absl::optional<UncertainPose> path =
          planner_->PathBetween(edge.a, node);
      if (!path.has_value()) return;
      absl::optional<SearchJob> job =
          MakeJob(accepted, NodeId{edge.a.trajectory_id(), edge.a.index()},
                  node, *path);
      if (!job.has_value() || planner_->IsRedundant(job->candidate)) return;
      looked_at_.insert(node);
      Match(&*job);
      pipeline_->Process(std::move(job->candidate));
      ++num_searches;
    });
  }
  return num_searches > 0;
}

bool SecondLook::IsWorthFollowingNow(const LoopCandidate& candidate) const {
  const bool is_wrong = candidate.reason == LoopDecision::INNOVATION_TOO_LARGE;
  const bool is_far_off = candidate.plan.full_submap ||
                          candidate.plan.translation_sigma >
                              options_.compatible_subset.weak_prior_sigma;
  // Some wrong ones show how much places look alike.
  if (is_wrong ? pipeline_->num_wrong_followed() >= kEnoughWrong
               : candidate.reason != LoopDecision::UNSUPPORTED || !is_far_off) {
    return false;
  }
  const absl::optional<double> travelled = pipeline_->paths().Travelled(
      candidate.node,
      NodeId{candidate.node.trajectory_id,
             submaps_->NewestNodeIndex(candidate.node.trajectory_id)});
  return travelled.has_value() && *travelled >= kAroundUndecided;
}

bool SecondLook::FollowUndecided(const bool at_end) {
  if (!is_on_) return false;
  std::vector<LoopCandidate> matches;
  for (LoopCandidate& candidate : pipeline_->Undecided()) {
    if (!candidate.is_inter_trajectory() &&
        candidate.FinalScore() >= LeastFollowed(candidate) &&
        !candidate.followed.has_value() &&
        (at_end || IsWorthFollowingNow(candidate))) {
      matches.push_back(std::move(candidate));
    }
  }
  // Those first that may be accepted.
  std::stable_sort(matches.begin(), matches.end(),
                   [](const LoopCandidate& a, const LoopCandidate& b) {
                     const bool may_a = a.reason == LoopDecision::UNSUPPORTED;
                     const bool may_b = b.reason == LoopDecision::UNSUPPORTED;
                     return may_a != may_b ? may_a
                                           : a.FinalScore() > b.FinalScore();
                   });
  int num_searches = 0;
  for (const LoopCandidate& match : matches) {
    if (num_searches >= (at_end ? kMaxFollowingSearches : kMaxEarlySearches)) {
      break;
    }
    const FollowedMatch followed = Follow(match);
    num_searches += followed.num_found + followed.num_missed;
    pipeline_->SetFollowed(match.number, followed);
  }
  return num_searches > 0;
}

FollowedMatch SecondLook::Follow(const LoopCandidate& candidate) const {
  FollowedMatch followed;
  const uncertainty::LoopEdge edge =
      CandidateEdge(options_, pipeline_->paths(), candidate);
  if (!edge.a.is_node()) return followed;
  followed.by_verification = candidate.plan.full_submap;
  Walk(candidate.node, kBeyondUndecided, kAroundUndecided,
       [&](const NodeId& node) {
         const absl::optional<UncertainPose> path =
             pipeline_->paths().Between(edge.b, node);
         if (!path.has_value()) return;
         absl::optional<SearchJob> job =
             MakeJob(candidate, NodeId{edge.a.trajectory_id(), edge.a.index()},
                     node, uncertainty::Compose(edge.pose, *path));
         if (!job.has_value()) return;
         Match(&*job);
         const absl::optional<double> score = pipeline_->Score(&job->candidate);
         if (!score.has_value()) return;
         const bool is_found = followed.by_verification
                                   ? *score > 0.
                                   : *score >= kConfirmingScore;
         ++(is_found ? followed.num_found : followed.num_missed);
       });
  return followed;
}

}  // namespace loop_closure
}  // namespace cartographer_ext
