// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
#include "cartographer_ext/navigation/moving_obstacles.h"

#include <algorithm>
#include <cmath>
#include <utility>

namespace cartographer_ext {
namespace navigation {

std::vector<MovingObstacles::Cluster> MovingObstacles::FindClusters(
    const std::vector<Echo>& echoes) const {
  // Neighbouring beams hit neighbouring points, so one pass is enough to join
  // them. The first and the last beam are neighbours, too.
  std::vector<std::vector<Echo>> groups;
  const auto apart = [this](const Echo& a, const Echo& b) {
    return (a.point - b.point).norm() > options_.join_distance;
  };
  for (const Echo& echo : echoes) {
    if (!echo.point.allFinite()) continue;
    if (groups.empty() || apart(groups.back().back(), echo)) {
      groups.emplace_back();
    }
    groups.back().push_back(echo);
  }
  if (groups.size() > 1 &&
      !apart(groups.back().back(), groups.front().front())) {
    groups.front().insert(groups.front().begin(), groups.back().begin(),
                          groups.back().end());
    groups.pop_back();
  }
  std::vector<Cluster> clusters;
  for (const auto& group : groups) {
    // One echo alone may be an error of the laser.
    if (group.size() < 2) continue;
    Eigen::Vector2d low = group.front().point, high = low;
    int old = 0;
    for (const Echo& echo : group) {
      low = low.cwiseMin(echo.point);
      high = high.cwiseMax(echo.point);
      old += echo.age > options_.old_seconds;
    }
    Cluster cluster;
    cluster.center = 0.5 * (low + high);
    cluster.old_share = static_cast<double>(old) / group.size();
    for (const Echo& echo : group) {
      cluster.radius =
          std::max(cluster.radius, (echo.point - cluster.center).norm());
    }
    if (2. * cluster.radius <= options_.max_extent) clusters.push_back(cluster);
  }
  return clusters;
}

void MovingObstacles::Correct(const Cluster& cluster, const double time,
                              Track* const track) const {
  const double elapsed = time - track->seen;
  if (elapsed <= 0.) return;
  const Eigen::Vector2d predicted = track->disc.At(elapsed);
  const Eigen::Vector2d innovation = cluster.center - predicted;
  track->disc.position = predicted + options_.position_gain * innovation;
  track->disc.velocity += options_.velocity_gain / elapsed * innovation;
  const double speed = track->disc.velocity.norm();
  if (speed > options_.max_speed) {
    track->disc.velocity *= options_.max_speed / speed;
  }
  track->disc.radius = std::max(cluster.radius, 0.9 * track->disc.radius);
  track->seen = time;
  track->missed = 0.;
  ++track->updates;
  if (speed >= options_.moving_speed) track->fast = time;
  track->has_moved =
      track->has_moved ||
      (cluster.center - track->begin).norm() >= options_.min_displacement;
  track->is_stationary = cluster.old_share > options_.max_old_share;
  if (track->is_stationary) {
    // The track must prove again that it moves.
    track->has_moved = false;
    track->begin = cluster.center;
  }
}

bool MovingObstacles::IsForgotten(const double time, const InView& in_view,
                                  Track* const track) const {
  const double unseen = time - track->seen;
  if (unseen <= 0.) return false;
  if (in_view == nullptr || in_view(track->disc.At(unseen))) {
    track->missed += time - updated_;
  }
  return track->missed > options_.memory_seconds ||
         unseen > (track->has_moved ? options_.unseen_memory_seconds
                                    : options_.memory_seconds);
}

void MovingObstacles::Update(const std::vector<Echo>& echoes, const double time,
                             const InView& in_view) {
  const std::vector<Cluster> clusters = FindClusters(echoes);
  // The nearest pairs of track and cluster are assigned first.
  struct Pair {
    double distance;
    size_t track, cluster;
  };
  std::vector<Pair> pairs;
  for (size_t i = 0; i != tracks_.size(); ++i) {
    const Eigen::Vector2d predicted =
        tracks_[i].disc.At(time - tracks_[i].seen);
    for (size_t j = 0; j != clusters.size(); ++j) {
      const double distance = (clusters[j].center - predicted).norm();
      if (distance <= options_.gate) pairs.push_back({distance, i, j});
    }
  }
  std::stable_sort(
      pairs.begin(), pairs.end(),
      [](const Pair& a, const Pair& b) { return a.distance < b.distance; });
  std::vector<bool> track_used(tracks_.size()), cluster_used(clusters.size());
  for (const Pair& pair : pairs) {
    if (track_used[pair.track] || cluster_used[pair.cluster]) continue;
    track_used[pair.track] = cluster_used[pair.cluster] = true;
    Correct(clusters[pair.cluster], time, &tracks_[pair.track]);
  }
  std::vector<Track> kept;
  for (Track& track : tracks_) {
    if (!IsForgotten(time, in_view, &track)) kept.push_back(track);
  }
  tracks_ = std::move(kept);
  updated_ = time;
  for (size_t j = 0; j != clusters.size(); ++j) {
    if (cluster_used[j] ||
        tracks_.size() >= static_cast<size_t>(options_.max_tracks)) {
      continue;
    }
    Track track;
    track.disc.position = track.begin = clusters[j].center;
    track.disc.radius = clusters[j].radius;
    track.seen = time;
    tracks_.push_back(track);
  }
}

std::vector<MovingDisc> MovingObstacles::Moving(const double time) const {
  std::vector<MovingDisc> moving;
  for (const Track& track : tracks_) {
    if (track.is_stationary || !track.has_moved ||
        track.updates < options_.min_updates ||
        track.seen - track.fast > options_.slow_seconds) {
      continue;
    }
    MovingDisc disc = track.disc;
    disc.position = track.disc.At(time - track.seen);
    moving.push_back(disc);
  }
  return moving;
}

}  // namespace navigation
}  // namespace cartographer_ext
