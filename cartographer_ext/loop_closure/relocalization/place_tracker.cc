// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
#include "cartographer_ext/loop_closure/relocalization/place_tracker.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <limits>
#include <utility>

namespace cartographer_ext {
namespace loop_closure {

PlaceTracker::Step PlaceTracker::Follow(const Step& from, const Node& from_node,
                                        const Node& to_node,
                                        const Matcher& matcher) const {
  Step step;
  step.pose = from.pose * Between(from_node.local_pose, to_node.local_pose);
  step.match = matcher(to_node.index, step.pose);
  if (step.match.has_value()) step.pose = step.match->pose;
  return step;
}

double PlaceTracker::Score(const Step& step) const {
  return step.match.has_value() ? step.match->score
                                : options_.score_without_match;
}

double PlaceTracker::MeanScore(const Track& track, const int max_nodes) const {
  const size_t n = std::min(track.steps.size(), static_cast<size_t>(max_nodes));
  double sum = 0.;
  for (size_t k = track.steps.size() - n; k < track.steps.size(); ++k) {
    sum += Score(track.steps[k]);
  }
  return n == 0 ? 0. : sum / static_cast<double>(n);
}

PlaceTracker::Track PlaceTracker::StartTrack(const PlaceMatch& found,
                                             const Matcher& matcher) const {
  Track track;
  Step newest;
  newest.pose = found.pose;
  newest.match = found;
  track.steps.push_front(newest);
  for (size_t k = nodes_.size() - 1; k > 0; --k) {
    track.steps.push_front(
        Follow(track.steps.front(), nodes_[k], nodes_[k - 1], matcher));
  }
  return track;
}

bool PlaceTracker::IsSamePlace(const Pose2& a, const Pose2& b) const {
  const Pose2 offset = Between(a, b);
  return offset.translation().norm() < options_.same_metres &&
         std::abs(offset.theta) < options_.same_radians;
}

void PlaceTracker::AddNode(const int node_index, const Pose2& local_pose,
                           const std::vector<PlaceMatch>& found,
                           const Matcher& matcher) {
  const Node node{node_index, local_pose};
  for (Track& track : tracks_) {
    track.steps.push_back(
        Follow(track.steps.back(), nodes_.back(), node, matcher));
  }
  nodes_.push_back(node);
  if (nodes_.size() > static_cast<size_t>(options_.max_nodes)) {
    nodes_.pop_front();
    for (Track& track : tracks_) track.steps.pop_front();
  }
  double best_followed = 0.;
  for (const Track& track : tracks_) {
    best_followed = std::max(best_followed, Score(track.steps.back()));
  }
  bool is_break = false;
  double best_found = best_followed + options_.break_margin;
  for (const PlaceMatch& match : found) {
    Track* same = nullptr;
    for (Track& track : tracks_) {
      if (IsSamePlace(track.steps.back().pose, match.pose)) same = &track;
    }
    if (same == nullptr) {
      tracks_.push_back(StartTrack(match, matcher));
      const std::deque<Step>& steps = tracks_.back().steps;
      if (match.score > best_found) {
        best_found = match.score;
        is_break = steps.size() > 1 && Score(steps[steps.size() - 2]) <
                                           match.score - options_.break_margin;
      }
    } else if (Score(same->steps.back()) < match.score) {
      same->steps.back().pose = match.pose;
      same->steps.back().match = match;
    }
  }
  if (is_break) ForgetBefore(nodes_.size() - 1);
  Prune();
}

void PlaceTracker::Prune() {
  std::stable_sort(tracks_.begin(), tracks_.end(),
                   [this](const Track& a, const Track& b) {
                     return MeanScore(a, options_.max_nodes) >
                            MeanScore(b, options_.max_nodes);
                   });
  std::vector<Track> kept;
  for (Track& track : tracks_) {
    if (kept.size() == static_cast<size_t>(options_.max_tracks)) break;
    const bool is_new =
        std::none_of(kept.begin(), kept.end(), [&](const Track& better) {
          return IsSamePlace(better.steps.back().pose, track.steps.back().pose);
        });
    if (is_new) kept.push_back(std::move(track));
  }
  tracks_ = std::move(kept);
}

PlaceTracker::Decision PlaceTracker::Decide(const int max_nodes) const {
  Decision decision;
  if (tracks_.empty()) return decision;
  size_t best = 0;
  for (size_t t = 1; t < tracks_.size(); ++t) {
    if (MeanScore(tracks_[t], max_nodes) >
        MeanScore(tracks_[best], max_nodes)) {
      best = t;
    }
  }
  const std::deque<Step>& steps = tracks_[best].steps;
  const size_t n = std::min(steps.size(), static_cast<size_t>(max_nodes));
  const size_t first = steps.size() - n;
  decision.lead = std::numeric_limits<double>::infinity();
  decision.significance = std::numeric_limits<double>::infinity();
  for (size_t t = 0; t < tracks_.size(); ++t) {
    if (t == best) continue;
    double sum = 0., squares = 0.;
    for (size_t k = first; k < steps.size(); ++k) {
      const double d = Score(steps[k]) - Score(tracks_[t].steps[k]);
      sum += d;
      squares += d * d;
    }
    const double mean = sum / static_cast<double>(n);
    const double variance =
        n < 2 ? 0. : (squares - sum * mean) / static_cast<double>(n - 1);
    const double sigma =
        std::max(std::sqrt(std::max(0., variance)), options_.sigma_floor);
    decision.lead = std::min(decision.lead, mean);
    decision.significance =
        std::min(decision.significance,
                 mean * std::sqrt(static_cast<double>(n)) / sigma);
  }
  decision.decided = n >= static_cast<size_t>(options_.min_nodes) &&
                     decision.significance >= options_.significance;
  for (size_t k = first; k < steps.size(); ++k) {
    if (!steps[k].match.has_value()) continue;
    decision.nodes.push_back(nodes_[k].index);
    decision.matches.push_back(*steps[k].match);
  }
  return decision;
}

void PlaceTracker::DeleteNodes(const int last_node_index) {
  size_t num_deleted = 0;
  while (num_deleted < nodes_.size() &&
         nodes_[num_deleted].index <= last_node_index) {
    ++num_deleted;
  }
  ForgetBefore(num_deleted);
}

// Forgets the `node` oldest ones, and places that only they knew.
void PlaceTracker::ForgetBefore(const size_t node) {
  nodes_.erase(nodes_.begin(), nodes_.begin() + node);
  for (Track& track : tracks_) {
    track.steps.erase(track.steps.begin(), track.steps.begin() + node);
  }
  tracks_.erase(
      std::remove_if(tracks_.begin(), tracks_.end(),
                     [](const Track& track) {
                       return std::none_of(
                           track.steps.begin(), track.steps.end(),
                           [](const Step& s) { return s.match.has_value(); });
                     }),
      tracks_.end());
}

int PlaceTracker::oldest_node() const {
  return nodes_.empty() ? -1 : nodes_.front().index;
}

}  // namespace loop_closure
}  // namespace cartographer_ext
