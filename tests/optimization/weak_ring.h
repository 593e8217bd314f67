// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
//
// A ring of a hundred poses driven twice with a heading noise (radians a step)
// that leaves nothing of it, and loops between the laps: all along them, or on
// `stretches` of eight poses that are as far apart as they are long.
#ifndef TESTS_OPTIMIZATION_WEAK_RING_H_
#define TESTS_OPTIMIZATION_WEAK_RING_H_

#include "tests/optimization/test_graphs.h"

namespace cartographer_ext {
namespace optimization {
namespace test {

inline GridWorld MakeWeakRing(const uint64_t seed,
                              const double heading_noise = 0.03,
                              const bool stretches = false) {
  Random random(seed);
  GridWorld world;
  constexpr int kLap = 100;
  Pose2 pose;
  for (int i = 0; i != 2 * kLap; ++i) {
    world.truth.push_back(pose);
    pose = pose * Pose2(3., 0., 2. * kPi / kLap);
  }
  const auto add = [&](const int from, const int to, const double position,
                       const double angle) {
    PoseGraphEdge edge;
    edge.from = from;
    edge.to = to;
    edge.is_loop = to != from + 1;
    edge.measurement =
        Between(world.truth[from], world.truth[to]) *
        Pose2(random.Normal(0., position), random.Normal(0., position),
              random.Normal(0., angle));
    edge.information =
        Eigen::Vector3d(1. / (position * position), 1. / (position * position),
                        1. / (angle * angle))
            .asDiagonal();
    world.graph.edges.push_back(edge);
  };
  for (int i = 1; i != 2 * kLap; ++i) add(i - 1, i, 0.06, heading_noise);
  for (int i = 0; i < kLap; i += stretches ? 1 : 3) {
    if (!stretches || i % 16 < 8) add(i, i + kLap, 0.2, 0.03);
  }
  for (int i = 0; i != 2 * kLap; ++i) world.graph.ids.push_back(i);
  world.graph.poses.assign(2 * kLap, Pose2());
  world.graph.poses = DeadReckoning(world.graph);
  return world;
}

}  // namespace test
}  // namespace optimization
}  // namespace cartographer_ext

#endif  // TESTS_OPTIMIZATION_WEAK_RING_H_
