// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
#include "cartographer_ext/loop_closure/dropin/pair_searcher.h"

#include <algorithm>
#include <cstddef>
#include <utility>

#include "Eigen/Cholesky"
#include "cartographer_ext/common/planar_matrix.h"
#include "cartographer_ext/loop_closure/dropin/constraint_metrics.h"
#include "cartographer_ext/loop_closure/dropin/match_information.h"
#include "cartographer_ext/loop_closure/dropin/node_geometry.h"
#include "cartographer_ext/loop_closure/dropin/slide_test.h"
#include "cartographer_ext/loop_closure/verification/search_prior.h"

namespace cartographer_ext {
namespace loop_closure {

using cartographer::mapping::Submap2D;
using proto::LoopDecision;

namespace {

// Chi-square of a match, 3 degrees of freedom, from which on another one nearer to
// the prediction is looked for: one right match in ten is as far off.
constexpr double kUnlikely = 6.25;
// Nearer matches are the same one, metres.
constexpr double kLeastWindow = 0.3;

}  // namespace

PairSearcher::PairSearcher(
    const cartographer::mapping::constraints::proto::ConstraintBuilderOptions&
        options,
    const LoopOptions& extension, SubmapCache* const cache)
    : options_(options),
      slide_test_(extension.slide_test),
      search_options_(extension.search),
      ceres_scan_matcher_(options.ceres_scan_matcher_options()),
      cache_(cache) {}

void PairSearcher::Search(SearchJob* const job) const {
  const ConstraintMetrics& metrics = *ConstraintMetrics::Global();
  const SubmapEntry& entry = *job->entry;
  const SearchPlan& plan = job->candidate.plan;
  const auto& cloud = job->node->filtered_gravity_aligned_point_cloud;
  (plan.full_submap ? metrics.searched_global : metrics.searched_local)
      ->Increment();
  const SubmapMatch found = plan.full_submap && search_options_.enabled
                                ? SearchPlaces(job)
                                : SearchExactly(job);
  SearchMatch& match = job->candidate.match;
  match.score = found.score;
  if (!found.found) return;
  (plan.full_submap ? metrics.found_global : metrics.found_local)->Increment();
  metrics.grid_scores->Observe(found.score);
  match.found = true;
  match.has_pose = true;
  match.matched = Between(entry.local_pose, found.pose);

  const StageMeter meter(metrics.refinement_cpu);
  const Pose2 refined = RefineMatch(ceres_scan_matcher_, *entry.submap->grid(),
                                    cloud, found.pose);
  match.refined = Between(entry.local_pose, refined);
  match.information =
      MatchInformation(*entry.submap->grid(), cloud, refined, entry.local_pose);
  if (slide_test_) match.slide_odds = SlideOddsOf(*job, refined);
  job->candidate.times.refinement = meter.seconds();
}

std::shared_ptr<const SubmapMatcher> PairSearcher::Matcher(
    const SubmapEntry& entry) const {
  const StageMeter meter(ConstraintMetrics::Global()->build_cpu);
  return cache_->Matcher(entry.cached.get());
}

SubmapMatch PairSearcher::SearchExactly(SearchJob* const job) const {
  const SearchPlan& plan = job->candidate.plan;
  const auto& cloud = job->node->filtered_gravity_aligned_point_cloud;
  const std::shared_ptr<const SubmapMatcher> matcher = Matcher(*job->entry);
  const StageMeter meter(ConstraintMetrics::Global()->search_cpu);
  const SubmapMatch found =
      plan.full_submap
          ? matcher->MatchFullSubmap(cloud, MinScore(*job))
          : matcher->Match(
                job->entry->local_pose * job->candidate.SearchCenter(),
                plan.linear_window, plan.angular_window, cloud, MinScore(*job));
  const SubmapMatch likeliest =
      found.found && !plan.full_submap && search_options_.enabled
          ? Likeliest(*job, *matcher, found)
          : found;
  job->candidate.times.search = meter.seconds();
  return likeliest;
}

SubmapMatch PairSearcher::Likeliest(const SearchJob& job,
                                    const SubmapMatcher& matcher,
                                    const SubmapMatch& found) const {
  const LoopCandidate& candidate = job.candidate;
  const SearchPlan& plan = candidate.plan;
  const Pose2 center = job.entry->local_pose * candidate.SearchCenter();
  const Pose2 predicted = candidate.InTrackingFrame(center);
  const Eigen::Matrix3d covariance = ExpectedCovariance(search_options_, plan);
  const auto displacement = [&](const SubmapMatch& match) {
    return Between(predicted, candidate.InTrackingFrame(match.pose));
  };
  const Pose2 far = displacement(found);
  const Eigen::Vector3d error(far.x, far.y, far.theta);
  if (error.dot(covariance.llt().solve(error)) < kUnlikely) return found;
  // Without the match that was found: it is a square.
  const double window =
      std::min(plan.linear_window / 2., 0.7 * far.translation().norm());
  if (window < kLeastWindow) return found;
  const SubmapMatch near = matcher.Match(
      center, window, plan.angular_window,
      job.node->filtered_gravity_aligned_point_cloud, MinScore(job));
  if (!near.found) return found;
  const double search_density =
      1. / SearchVolume(plan.linear_window, plan.angular_window);
  const auto likelihood = [&](const SubmapMatch& match) {
    return LogLikelihoodOfMatch(
        match.score, PredictedDensity(displacement(match), covariance),
        search_density);
  };
  return likelihood(near) > likelihood(found) ? near : found;
}

SubmapMatch PairSearcher::SearchPlaces(SearchJob* const job) const {
  const ConstraintMetrics& metrics = *ConstraintMetrics::Global();
  const auto& cloud = job->node->filtered_gravity_aligned_point_cloud;
  std::shared_ptr<const PlaceMatcher> places;
  {
    const StageMeter meter(metrics.build_cpu);
    places = cache_->Places(job->entry->cached.get());
  }
  absl::optional<Pose2> place;
  {
    const StageMeter meter(metrics.search_cpu);
    place = places->Find(cloud, MinScore(*job));
    job->candidate.times.search = meter.seconds();
  }
  if (!place.has_value()) return SubmapMatch();
  const scan_matching::SearchWindow window = places->WindowOf(cloud);
  const std::shared_ptr<const SubmapMatcher> matcher = Matcher(*job->entry);
  const StageMeter meter(metrics.search_cpu);
  const SubmapMatch found = matcher->Match(
      *place, window.linear, window.angular, cloud, MinScore(*job));
  job->candidate.times.search += meter.seconds();
  return found;
}

double PairSearcher::MinScore(const SearchJob& job) const {
  return job.score_scale * (job.candidate.plan.full_submap
                                ? options_.global_localization_min_score()
                                : options_.min_score());
}

double PairSearcher::SlideOddsOf(const SearchJob& job,
                                 const Pose2& refined) const {
  const SubmapEntry& entry = *job.entry;
  const LoopCandidate& candidate = job.candidate;
  absl::optional<PredictedPosition> predicted;
  if (candidate.predicted.has_value() &&
      candidate.plan.translation_sigma > 0.) {
    predicted.emplace();
    predicted->position =
        (entry.local_pose * *candidate.predicted).translation();
    predicted->sigma = candidate.plan.translation_sigma;
  }
  const Eigen::Matrix3d to_grid = PlanarRotation(entry.local_pose.theta);
  return SlideOdds(refined,
                   to_grid * candidate.match.information * to_grid.transpose(),
                   predicted, job.node->filtered_gravity_aligned_point_cloud,
                   *entry.submap->grid());
}

void PairSearcher::SearchPlace(PlaceQuery* const query) const {
  const ConstraintMetrics& metrics = *ConstraintMetrics::Global();
  const StageMeter meter(metrics.search_cpu);
  std::vector<PlaceSubmap> submaps;
  for (const SearchJob* const job : query->jobs) {
    PlaceSubmap submap;
    submap.submap_index = job->candidate.submap.submap_index;
    CachedSubmap* const cached = job->entry->cached.get();
    submap.matcher = [this, cached]() { return cache_->Matcher(cached); };
    submap.submap = job->entry->submap;
    submap.search = job->candidate.plan.skipped == LoopDecision::NONE;
    if (submap.search) metrics.searched_global->Increment();
    submaps.push_back(submap);
  }
  const SearchJob& first = *query->jobs.front();
  PlaceNode node;
  node.node_index = first.candidate.node.node_index;
  node.time = first.candidate.node_time;
  node.aligned_from_tracking = first.candidate.aligned_from_tracking;
  node.local_pose =
      LocalPose(*first.node) * node.aligned_from_tracking.Inverse();
  node.cloud = first.node->filtered_gravity_aligned_point_cloud;
  query->places->DeleteNodes(query->forget_up_to);
  query->result = query->places->Search(
      std::move(node), submaps, query->is_known,
      [this](const Submap2D& submap,
             const cartographer::sensor::PointCloud& cloud, const Pose2& pose) {
        return RefineMatch(ceres_scan_matcher_, *submap.grid(), cloud, pose);
      });
  size_t next = 0;
  const double share =
      meter.seconds() / std::max<size_t>(1, query->result.scores.size());
  for (SearchJob* const job : query->jobs) {
    LoopCandidate& candidate = job->candidate;
    if (candidate.plan.skipped != LoopDecision::NONE) continue;
    candidate.match.score = query->result.scores[next];
    candidate.match.found = candidate.match.score > 0.;
    if (candidate.match.found) metrics.found_global->Increment();
    candidate.Reject(candidate.match.found ? LoopDecision::FOLLOWED
                     : query->result.outscored[next]
                         ? LoopDecision::OUTSCORED
                         : LoopDecision::LOW_GRID_SCORE);
    candidate.times.search = share;
    ++next;
  }
}

}  // namespace loop_closure
}  // namespace cartographer_ext
