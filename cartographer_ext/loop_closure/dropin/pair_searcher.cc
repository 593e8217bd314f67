// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
#include "cartographer_ext/loop_closure/dropin/pair_searcher.h"

#include <algorithm>
#include <cstddef>
#include <utility>

#include "cartographer/common/time.h"
#include "cartographer_ext/loop_closure/dropin/constraint_metrics.h"
#include "cartographer_ext/loop_closure/dropin/match_information.h"
#include "cartographer_ext/loop_closure/dropin/node_geometry.h"

namespace cartographer_ext {
namespace loop_closure {

using cartographer::mapping::Submap2D;
using cartographer::transform::Rigid2d;
using proto::LoopDecision;

constexpr int SubmapEntry::kUnknownNode;

PairSearcher::PairSearcher(
    const cartographer::mapping::constraints::proto::ConstraintBuilderOptions&
        options)
    : options_(options),
      ceres_scan_matcher_(options.ceres_scan_matcher_options()) {}

void PairSearcher::Search(PairCandidate* const candidate) const {
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
          cloud,
          candidate->floor_scale * options_.global_localization_min_score());
    } else {
      metrics.searched_local->Increment();
      match =
          entry.matcher->Match(entry.local_pose * candidate->pair.predicted,
                               plan.linear_window, plan.angular_window, cloud,
                               candidate->floor_scale * options_.min_score());
    }
    candidate->search_seconds = meter.seconds();
  }
  candidate->score = match.score;
  if (!match.found) return;
  (plan.full_submap ? metrics.found_global : metrics.found_local)->Increment();
  metrics.grid_scores->Observe(match.score);
  candidate->found = true;
  candidate->matched = Between(entry.local_pose, match.pose);

  const StageMeter meter(metrics.refinement_cpu);
  const Pose2 refined = Refine(*entry.submap, cloud, match.pose);
  candidate->refined = Between(entry.local_pose, refined);
  candidate->information =
      MatchInformation(*entry.submap->grid(), cloud, refined, entry.local_pose);
  candidate->refinement_seconds = meter.seconds();
}

void PairSearcher::SearchPlace(PlaceQuery* const query) const {
  const ConstraintMetrics& metrics = *ConstraintMetrics::Global();
  const StageMeter meter(metrics.search_cpu);
  const OfferedPair& pair = query->candidates.front()->pair;
  std::vector<PlaceSubmap> submaps;
  for (const PairCandidate* const candidate : query->candidates) {
    PlaceSubmap submap;
    submap.submap_index = candidate->pair.submap_id.submap_index;
    submap.matcher = candidate->entry->matcher.get();
    submap.submap = candidate->entry->submap;
    submap.search = candidate->plan.skipped == LoopDecision::NONE;
    if (submap.search) metrics.searched_global->Increment();
    submaps.push_back(submap);
  }
  PlaceNode node;
  node.node_index = pair.node_id.node_index;
  node.time = cartographer::common::ToUniversal(pair.node->time);
  node.local_pose = LocalPose(*pair.node) * pair.from_robot.Inverse();
  node.from_robot = pair.from_robot;
  node.cloud = pair.node->filtered_gravity_aligned_point_cloud;
  query->places->DeleteNodes(query->forget_up_to);
  query->result = query->places->Search(
      std::move(node), submaps, query->is_known,
      [this](const Submap2D& submap,
             const cartographer::sensor::PointCloud& cloud,
             const Pose2& pose) { return Refine(submap, cloud, pose); });
  size_t next = 0;
  const double share =
      meter.seconds() / std::max<size_t>(1, query->result.scores.size());
  for (PairCandidate* const candidate : query->candidates) {
    if (candidate->plan.skipped != LoopDecision::NONE) continue;
    candidate->score = query->result.scores[next];
    candidate->found = candidate->score > 0.;
    if (candidate->found) metrics.found_global->Increment();
    candidate->plan.skipped = candidate->found ? LoopDecision::FOLLOWED
                              : query->result.outscored[next]
                                  ? LoopDecision::OUTSCORED
                                  : LoopDecision::LOW_GRID_SCORE;
    candidate->search_seconds = share;
    ++next;
  }
}

Pose2 PairSearcher::Refine(const Submap2D& submap,
                           const cartographer::sensor::PointCloud& cloud,
                           const Pose2& pose) const {
  Rigid2d refined = ToRigid2d(pose);
  ceres::Solver::Summary unused_summary;
  ceres_scan_matcher_.Match(refined.translation(), refined, cloud,
                            *submap.grid(), &refined, &unused_summary);
  return ToPose2(refined);
}

}  // namespace loop_closure
}  // namespace cartographer_ext
