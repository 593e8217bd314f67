// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
#include "cartographer_ext/loop_closure/dropin/place_search.h"

#include <algorithm>
#include <cstddef>
#include <limits>
#include <utility>

#include "cartographer/mapping/internal/constraints/constraint_builder_2d.h"
#include "cartographer_ext/loop_closure/dropin/match_information.h"
#include "cartographer_ext/loop_closure/dropin/node_geometry.h"

namespace cartographer_ext {
namespace loop_closure {
namespace {

using cartographer::mapping::Submap2D;
using cartographer::mapping::constraints::ComputeSubmapPose;

// A track is expected within this of where the motion of the run puts it.
constexpr double kFollowMetres = 0.5;
constexpr double kFollowRadians = 0.06;
// A node of a place that was decided for is returned in at most this number of
// submaps.
constexpr size_t kSubmapsPerNode = 4;
// The newest nodes that decide where the place is thought to be known.
constexpr int kNodesWhenKnown = 5;

// Whether a node at a pose in the local frame of the map may lie in a submap.
bool Covers(const Submap2D& submap, const Pose2& pose) {
  const auto& limits = submap.grid()->limits();
  const auto& cells = limits.cell_limits();
  const double x = limits.max().x() - pose.x;
  const double y = limits.max().y() - pose.y;
  return x >= 0. && y >= 0. && x <= limits.resolution() * cells.num_y_cells &&
         y <= limits.resolution() * cells.num_x_cells;
}

}  // namespace

PlaceSearch::PlaceSearch(const RelocalizationOptions& options,
                         const double min_score)
    : options_(options), min_score_(min_score), tracker_(options.tracker) {}

std::vector<PlaceMatch> PlaceSearch::FindPlaces(
    const PlaceNode& node, const std::vector<PlaceSubmap>& submaps,
    PlaceResult* const result) const {
  std::vector<std::shared_ptr<const SubmapMatcher>> matchers;
  std::vector<const SubmapMatcher*> searched;
  std::vector<int> searched_index;
  for (const PlaceSubmap& submap : submaps) {
    if (!submap.search) continue;
    matchers.push_back(submap.matcher());
    searched.push_back(matchers.back().get());
    searched_index.push_back(submap.submap_index);
  }
  const std::vector<SubmapRanking> ranking = MatchBestSubmaps(
      searched, node.cloud, min_score_, options_.places_per_query);
  const bool is_full =
      static_cast<int>(ranking.size()) == options_.places_per_query;
  result->scores.assign(searched.size(), 0.);
  result->outscored.assign(searched.size(), is_full);
  std::vector<PlaceMatch> found;
  for (const SubmapRanking& ranked : ranking) {
    result->scores[ranked.submap] = ranked.match.score;
    result->outscored[ranked.submap] = false;
    PlaceMatch match;
    match.submap_index = searched_index[ranked.submap];
    match.pose = ranked.match.pose;
    match.score = ranked.match.score;
    found.push_back(match);
  }
  return found;
}

absl::optional<PlaceMatch> PlaceSearch::MatchNearby(
    const int node_index, const Pose2& guess, const PlaceSubmap& submap,
    const double min_score) const {
  absl::optional<PlaceMatch> result;
  if (!Covers(*submap.submap, guess)) return result;
  const SubmapMatch match =
      submap.matcher()->Match(guess, kFollowMetres, kFollowRadians,
                              nodes_.at(node_index).cloud, min_score);
  if (!match.found) return result;
  result = PlaceMatch();
  result->submap_index = submap.submap_index;
  result->pose = match.pose;
  result->score = match.score;
  return result;
}

absl::optional<PlaceMatch> PlaceSearch::Follow(
    const int node_index, const Pose2& guess,
    const std::vector<PlaceSubmap>& submaps) const {
  absl::optional<PlaceMatch> best;
  for (const PlaceSubmap& submap : submaps) {
    const absl::optional<PlaceMatch> match = MatchNearby(
        node_index, guess, submap, best.has_value() ? best->score : 0.);
    if (match.has_value()) best = match;
  }
  return best;
}

void PlaceSearch::AppendCandidates(
    const int node_index, const Pose2& place,
    const std::vector<PlaceSubmap>& submaps, const Refiner& refiner,
    std::vector<LoopCandidate>* const candidates) const {
  // In each of the submaps that know the place: those of one visit confirm
  // each other, those of several visits lie too far apart for that.
  const PlaceNode& node = nodes_.at(node_index);
  std::vector<std::pair<PlaceMatch, const Submap2D*>> matches;
  for (const PlaceSubmap& submap : submaps) {
    const absl::optional<PlaceMatch> match =
        MatchNearby(node_index, place, submap, min_score_);
    if (match.has_value()) matches.emplace_back(*match, submap.submap);
  }
  std::stable_sort(matches.begin(), matches.end(),
                   [](const std::pair<PlaceMatch, const Submap2D*>& a,
                      const std::pair<PlaceMatch, const Submap2D*>& b) {
                     return a.first.score > b.first.score;
                   });
  if (matches.size() > kSubmapsPerNode) matches.resize(kSubmapsPerNode);
  for (const auto& match_and_submap : matches) {
    const PlaceMatch& match = match_and_submap.first;
    const Submap2D& submap = *match_and_submap.second;
    const Pose2 submap_pose = ToPose2(ComputeSubmapPose(submap));
    const Pose2 refined = refiner(submap, node.cloud, match.pose);
    LoopCandidate candidate;
    candidate.submap.submap_index = match.submap_index;
    candidate.submap_local_pose = submap_pose;
    candidate.node.node_index = node.node_index;
    candidate.node_time = node.time;
    candidate.aligned_from_tracking = node.aligned_from_tracking;
    candidate.relocalized = true;
    candidate.plan.full_submap = true;
    candidate.match.found = true;
    candidate.match.has_pose = true;
    candidate.match.score = match.score;
    candidate.match.matched = Between(submap_pose, match.pose);
    candidate.match.refined = Between(submap_pose, refined);
    candidate.match.information =
        MatchInformation(*submap.grid(), node.cloud, refined, submap_pose);
    candidates->push_back(candidate);
  }
}

PlaceResult PlaceSearch::Search(PlaceNode node,
                                const std::vector<PlaceSubmap>& submaps,
                                const bool is_known, const Refiner& refiner) {
  PlaceResult result;
  const std::vector<PlaceMatch> found = FindPlaces(node, submaps, &result);

  // Places are followed forwards only.
  const int node_index = node.node_index;
  if (node_index <= newest_node_) return result;
  newest_node_ = node_index;
  const Pose2 local_pose = node.local_pose;
  nodes_.emplace(node_index, std::move(node));
  tracker_.AddNode(node_index, local_pose, found,
                   [&](const int index, const Pose2& guess) {
                     return Follow(index, guess, submaps);
                   });
  while (!nodes_.empty() && nodes_.begin()->first < tracker_.oldest_node()) {
    nodes_.erase(nodes_.begin());
  }

  const PlaceTracker::Decision decision = tracker_.Decide(
      is_known ? kNodesWhenKnown : std::numeric_limits<int>::max());
  result.significance = decision.significance;
  result.decided = decision.decided && !decision.nodes.empty() &&
                   decision.nodes.back() == node_index;
  if (!result.decided) return result;
  result.decided_pose = decision.matches.back().pose;
  result.decided_submap = decision.matches.back().submap_index;
  if (is_known) return result;
  for (size_t k = 0; k < decision.nodes.size(); ++k) {
    if (decision.nodes[k] <= last_returned_) continue;
    AppendCandidates(decision.nodes[k], decision.matches[k].pose, submaps,
                     refiner, &result.placed);
  }
  for (LoopCandidate& candidate : result.placed) {
    // The motion from nodes before the first one may be wrong.
    candidate.first_node_index = decision.nodes.front();
  }
  last_returned_ = node_index;
  return result;
}

void PlaceSearch::DeleteNodes(const int last_node_index) {
  tracker_.DeleteNodes(last_node_index);
  nodes_.erase(nodes_.begin(), nodes_.upper_bound(last_node_index));
}

}  // namespace loop_closure
}  // namespace cartographer_ext
