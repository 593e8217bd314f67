// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
#include "cartographer_ext/simulation/obstacle_motion.h"

#include <algorithm>
#include <cmath>

#include "cartographer_ext/simulation/seeds.h"

namespace cartographer_ext {
namespace simulation {

ObstacleMotion::ObstacleMotion(const std::vector<MovingObstacle>& obstacles,
                               const uint64_t seed) {
  Random random = MakeRandom(seed, RandomStream::kObstacles);
  for (const MovingObstacle& obstacle : obstacles) {
    Loop loop;
    loop.radius = obstacle.radius;
    loop.speed = obstacle.speed;
    loop.path = obstacle.path;
    loop.path.push_back(obstacle.path.front());
    loop.distances.push_back(0.);
    for (size_t i = 1; i != loop.path.size(); ++i) {
      loop.distances.push_back(loop.distances.back() +
                               (loop.path[i] - loop.path[i - 1]).norm());
    }
    // Drawn for every obstacle, so that the setting of one does not change the
    // phase of the others.
    const double drawn = random.Uniform();
    loop.start = (obstacle.random_phase ? drawn : obstacle.phase) *
                 loop.distances.back();
    loops_.push_back(loop);
  }
}

Eigen::Vector2d ObstacleMotion::Position(const size_t obstacle,
                                         const double time) const {
  const Loop& loop = loops_[obstacle];
  const double length = loop.distances.back();
  if (length == 0.) return loop.path.front();
  double distance = std::fmod(loop.start + loop.speed * time, length);
  if (distance < 0.) distance += length;
  const auto next = std::upper_bound(loop.distances.begin() + 1,
                                     loop.distances.end() - 1, distance);
  const size_t i = next - loop.distances.begin();
  const double segment = loop.distances[i] - loop.distances[i - 1];
  const double ratio =
      segment > 0. ? (distance - loop.distances[i - 1]) / segment : 0.;
  return loop.path[i - 1] + ratio * (loop.path[i] - loop.path[i - 1]);
}

Disc ObstacleMotion::DiscAt(const size_t obstacle, const double time) const {
  Disc disc;
  disc.center = Position(obstacle, time);
  disc.radius = loops_[obstacle].radius;
  return disc;
}

std::vector<Disc> ObstacleMotion::At(const double time) const {
  std::vector<Disc> discs;
  for (size_t i = 0; i != size(); ++i) discs.push_back(DiscAt(i, time));
  return discs;
}

}  // namespace simulation
}  // namespace cartographer_ext
