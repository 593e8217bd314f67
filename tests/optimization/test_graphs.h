// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
//
// Small pose graphs for the tests: a robot that walks the streets of a grid and
// recognises places it has been to.
#ifndef TESTS_OPTIMIZATION_TEST_GRAPHS_H_
#define TESTS_OPTIMIZATION_TEST_GRAPHS_H_

#include <string>
#include <vector>

#include "cartographer_ext/common/random.h"
#include "cartographer_ext/experiments/outliers/outlier_generator.h"
#include "cartographer_ext/io/g2o.h"
#include "cartographer_ext/optimization/graph/pose_graph.h"

namespace cartographer_ext {
namespace optimization {
namespace test {

struct GridWorld {
  PoseGraph graph;           // poses are dead reckoning
  std::vector<Pose2> truth;  // of each pose
};

// `num_poses` steps of one metre on a `blocks` x `blocks` grid, with loops
// wherever a pose comes within 1.1 m of one at least 10 steps older (at most
// two a pose). Noise sigma 0.02 m and 0.01 rad on every edge, with the matching
// information.
inline GridWorld MakeGridWorld(const int num_poses, const int blocks,
                               const uint64_t seed) {
  Random random(seed);
  GridWorld world;
  const double sigma_xy = 0.02, sigma_theta = 0.01;
  const auto noisy = [&](const Pose2& pose) {
    return pose * Pose2(random.Normal(0., sigma_xy),
                        random.Normal(0., sigma_xy),
                        random.Normal(0., sigma_theta));
  };
  const auto add_edge = [&](const int from, const int to, const bool is_loop) {
    PoseGraphEdge edge;
    edge.from = from;
    edge.to = to;
    edge.is_loop = is_loop;
    edge.measurement = noisy(Between(world.truth[from], world.truth[to]));
    edge.information.setZero();
    edge.information.diagonal() << 1. / (sigma_xy * sigma_xy),
        1. / (sigma_xy * sigma_xy), 1. / (sigma_theta * sigma_theta);
    world.graph.edges.push_back(edge);
  };
  world.truth.push_back(Pose2());
  while (static_cast<int>(world.truth.size()) < num_poses) {
    const Pose2& last = world.truth.back();
    Pose2 next;
    do {
      const double turn = random.UniformInt(0, 3) == 0
                              ? (random.UniformInt(0, 1) == 0 ? 1. : -1.)
                              : 0.;
      next = last * Pose2(1., 0., turn * kPi / 2.);
      if (next.x < -0.1 || next.y < -0.1 || next.x > blocks + 0.1 ||
          next.y > blocks + 0.1) {
        // Turn round on the spot at the edge of town.
        next = Pose2(last.x, last.y, NormalizeAngle(last.theta + kPi / 2.));
      }
    } while (next.x < -0.1 || next.y < -0.1 || next.x > blocks + 0.1 ||
             next.y > blocks + 0.1);
    world.truth.push_back(next);
    const int k = world.truth.size() - 1;
    add_edge(k - 1, k, false);
    int loops = 0;
    for (int old = 0; old < k - 10 && loops < 2; old += 3) {
      if ((world.truth[old].translation() - next.translation()).norm() < 1.1) {
        add_edge(old, k, true);
        ++loops;
      }
    }
  }
  for (int i = 0; i != num_poses; ++i) world.graph.ids.push_back(i);
  world.graph.poses.assign(num_poses, Pose2());
  world.graph.poses = DeadReckoning(world.graph);
  return world;
}

// `count` wrong loops.
inline OutlierOptions Outliers(const int count,
                               const OutlierType type = OutlierType::kRandom,
                               const uint64_t seed = 1) {
  OutlierOptions options;
  options.type = type;
  options.count = count;
  options.seed = seed;
  return options;
}

// Appends the outliers that `options` make for `graph` to `edges`.
inline void AppendOutliers(const PoseGraph& graph,
                           const OutlierOptions& options,
                           std::vector<PoseGraphEdge>* const edges) {
  const std::vector<PoseGraphEdge> outliers =
      GenerateOutliers(graph, options).value();
  edges->insert(edges->end(), outliers.begin(), outliers.end());
}

// The same, to its own edges.
inline void AddOutliers(const OutlierOptions& options, PoseGraph* const graph) {
  AppendOutliers(*graph, options, &graph->edges);
}

// A g2o file as a graph; empty when it cannot be read.
inline PoseGraph ReadGraph(const std::string& filename) {
  PoseGraph graph;
  const auto file = io::ReadG2o(filename);
  if (!file.ok()) return graph;
  std::map<int64_t, int> index_of_id;
  for (const auto& vertex : file->vertices) {
    index_of_id[vertex.first] = graph.poses.size();
    graph.ids.push_back(vertex.first);
    graph.poses.push_back(vertex.second);
  }
  for (const io::G2oEdge& from_file : file->edges) {
    PoseGraphEdge edge;
    edge.from = index_of_id[from_file.from];
    edge.to = index_of_id[from_file.to];
    edge.measurement = from_file.measurement;
    edge.information = from_file.information;
    edge.is_loop = IsLoopById(from_file.from, from_file.to);
    graph.edges.push_back(edge);
  }
  return graph;
}

}  // namespace test
}  // namespace optimization
}  // namespace cartographer_ext

#endif  // TESTS_OPTIMIZATION_TEST_GRAPHS_H_
