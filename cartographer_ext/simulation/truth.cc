// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
#include "cartographer_ext/simulation/truth.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <map>
#include <utility>

namespace cartographer_ext {
namespace simulation {
namespace {

constexpr double kSampleDistance = 1.;               // metres
constexpr double kSampleAngle = 30. * kPi / 180.;    // radians
constexpr double kLoopDistance = 1.5;                // metres
constexpr double kLoopGap = 60.;                     // seconds
constexpr double kSameDirection = 60. * kPi / 180.;  // radians
constexpr double kPassGap = 10.;                     // seconds
// A mark lies on the wall; the line of sight ends this much before it.
constexpr double kWallMargin = 0.02;  // metres

TrueRelation Relate(const TruePose& first, const TruePose& second) {
  return {first.time, second.time, Between(first.pose, second.pose)};
}

double Distance(const TruePose& a, const TruePose& b) {
  return (a.pose.translation() - b.pose.translation()).norm();
}

// Indices of scans about `distance` metres or `angle` radians apart.
std::vector<size_t> Sample(const std::vector<TruePose>& trajectory,
                           const double distance, const double angle) {
  std::vector<size_t> samples;
  for (size_t i = 0; i != trajectory.size(); ++i) {
    if (!samples.empty()) {
      const TruePose& last = trajectory[samples.back()];
      const double turned =
          std::abs(NormalizeAngle(trajectory[i].pose.theta - last.pose.theta));
      if (Distance(trajectory[i], last) < distance && turned < angle) continue;
    }
    samples.push_back(i);
  }
  return samples;
}

// Whether a point (robot frame) is in the field of view of the laser.
bool InView(const LaserSettings& laser, const Eigen::Vector2d& in_robot) {
  const Eigen::Vector2d in_laser = laser.mounting.Inverse() * in_robot;
  if (in_laser.norm() < laser.min_range || in_laser.norm() > laser.max_range) {
    return false;
  }
  const double span = laser.angle_increment * (laser.beams - 1);
  const double from_middle = std::remainder(
      std::atan2(in_laser.y(), in_laser.x()) - laser.angle_min - 0.5 * span,
      2. * kPi);
  return std::abs(from_middle) <= 0.5 * span + laser.angle_increment;
}

// Samples in square cells of one loop distance, for finding neighbours.
class Neighbours {
 public:
  void Add(const size_t sample, const Eigen::Vector2d& position) {
    cells_[Key(position, 0, 0)].push_back(sample);
  }

  // Ascending.
  std::vector<size_t> Near(const Eigen::Vector2d& position) const {
    std::vector<size_t> near;
    for (int dx = -1; dx <= 1; ++dx) {
      for (int dy = -1; dy <= 1; ++dy) {
        const auto cell = cells_.find(Key(position, dx, dy));
        if (cell == cells_.end()) continue;
        near.insert(near.end(), cell->second.begin(), cell->second.end());
      }
    }
    std::sort(near.begin(), near.end());
    return near;
  }

 private:
  static std::pair<int64_t, int64_t> Key(const Eigen::Vector2d& position,
                                         const int dx, const int dy) {
    return {
        static_cast<int64_t>(std::floor(position.x() / kLoopDistance)) + dx,
        static_cast<int64_t>(std::floor(position.y() / kLoopDistance)) + dy};
  }

  std::map<std::pair<int64_t, int64_t>, std::vector<size_t>> cells_;
};

}  // namespace

std::vector<TruePose> TrueTrajectory(const Simulation& simulation) {
  std::vector<TruePose> trajectory;
  for (int64_t i = 0; i != simulation.num_scans(); ++i) {
    const double time = simulation.ScanTime(i);
    trajectory.push_back(
        {simulation.Stamp(time), simulation.drive().PoseAt(time)});
  }
  return trajectory;
}

std::vector<TrueRelation> SequentialRelations(
    const std::vector<TruePose>& trajectory) {
  std::vector<TrueRelation> relations;
  const std::vector<size_t> samples =
      Sample(trajectory, kSampleDistance, kSampleAngle);
  for (size_t i = 1; i < samples.size(); ++i) {
    relations.push_back(
        Relate(trajectory[samples[i - 1]], trajectory[samples[i]]));
  }
  return relations;
}

std::vector<TrueRelation> LoopRelations(
    const Simulation& simulation, const std::vector<TruePose>& trajectory) {
  const LaserSettings& laser = simulation.world().laser;
  const bool any_direction =
      laser.angle_increment * laser.beams >= DegToRad(269.);
  const std::vector<size_t> samples =
      Sample(trajectory, kSampleDistance, 2. * kPi);
  std::vector<TrueRelation> relations;
  Neighbours neighbours;
  for (const size_t sample : samples) {
    const TruePose& here = trajectory[sample];
    const Eigen::Vector2d position = here.pose.translation();
    // The nearest scan of the present pass, and the last scan of that pass.
    const TruePose* best = nullptr;
    io::TimeNs last_time = 0;
    const auto emit = [&]() {
      if (best != nullptr) relations.push_back(Relate(*best, here));
      best = nullptr;
    };
    for (const size_t other : neighbours.Near(position)) {
      const TruePose& there = trajectory[other];
      const double distance = Distance(here, there);
      if (io::ToSeconds(here.time - there.time) <= kLoopGap) break;
      if (distance > kLoopDistance) continue;
      if (!any_direction &&
          std::abs(NormalizeAngle(here.pose.theta - there.pose.theta)) >
              kSameDirection) {
        continue;
      }
      if (!simulation.plan().Visible(position, there.pose.translation())) {
        continue;
      }
      if (best != nullptr && io::ToSeconds(there.time - last_time) > kPassGap) {
        emit();
      }
      if (best == nullptr || distance < Distance(here, *best)) best = &there;
      last_time = there.time;
    }
    emit();
    neighbours.Add(sample, position);
  }
  return relations;
}

std::vector<PlaceVisit> PlaceVisits(const Simulation& simulation,
                                    const std::vector<TruePose>& trajectory) {
  std::vector<PlaceVisit> visits;
  for (const RevisitPlace& place : simulation.world().places) {
    int count = 0;
    PlaceVisit best;
    bool open = false;
    io::TimeNs last_time = 0;
    for (const TruePose& here : trajectory) {
      const double distance = (here.pose.translation() - place.position).norm();
      if (distance > place.radius) continue;
      if (open && io::ToSeconds(here.time - last_time) > kPassGap) {
        visits.push_back(best);
        open = false;
      }
      if (!open || distance < best.distance) {
        if (!open) ++count;
        best = {place.name, count, here.time, here.pose, distance};
      }
      open = true;
      last_time = here.time;
    }
    if (open) visits.push_back(best);
  }
  return visits;
}

std::vector<KeyDistanceView> KeyDistanceViews(
    const Simulation& simulation, const std::vector<TruePose>& trajectory) {
  std::vector<KeyDistanceView> views;
  const auto find = [&](const Eigen::Vector2d& mark, io::TimeNs* time,
                        Eigen::Vector2d* in_robot) {
    double nearest = simulation.world().laser.max_range;
    bool found = false;
    for (const TruePose& here : trajectory) {
      const Eigen::Vector2d position = here.pose.translation();
      const double distance = (mark - position).norm();
      if (distance >= nearest || distance <= kWallMargin) continue;
      const Eigen::Vector2d before =
          mark - kWallMargin / distance * (mark - position);
      if (!InView(simulation.world().laser, here.pose.Inverse() * mark) ||
          !simulation.plan().Visible(position, before)) {
        continue;
      }
      nearest = distance;
      *time = here.time;
      *in_robot = here.pose.Inverse() * mark;
      found = true;
    }
    return found;
  };
  for (const KeyDistance& distance : simulation.world().key_distances) {
    KeyDistanceView view;
    view.distance = distance;
    view.length = (distance.b - distance.a).norm();
    const bool a = find(distance.a, &view.time_a, &view.a_in_robot);
    const bool b = find(distance.b, &view.time_b, &view.b_in_robot);
    view.seen = a && b;
    views.push_back(view);
  }
  return views;
}

}  // namespace simulation
}  // namespace cartographer_ext
