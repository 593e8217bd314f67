// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
//
// Solves a planar pose graph whose loops may be wrong:
//   solve_g2o in.g2o out.g2o
#include <cstdio>
#include <map>

#include "cartographer_ext/io/g2o.h"
#include "cartographer_ext/optimization/offline/optimize.h"

namespace io = cartographer_ext::io;
namespace optimization = cartographer_ext::optimization;

int main(const int argc, char** const argv) {
  if (argc != 3) {
    std::fprintf(stderr, "usage: solve_g2o in.g2o out.g2o\n");
    return 2;
  }
  auto g2o = io::ReadG2o(argv[1]);
  if (!g2o.ok()) {
    std::fprintf(stderr, "%s\n", g2o.status().ToString().c_str());
    return 1;
  }
  optimization::PoseGraph graph;
  std::map<int64_t, int> index;
  for (const auto& vertex : g2o->vertices) {
    index[vertex.first] = static_cast<int>(graph.poses.size());
    graph.ids.push_back(vertex.first);
    graph.poses.push_back(vertex.second);
  }
  for (const io::G2oEdge& edge : g2o->edges) {
    optimization::PoseGraphEdge converted;
    converted.from = index.at(edge.from);
    converted.to = index.at(edge.to);
    converted.measurement = edge.measurement;
    converted.information = edge.information;
    graph.edges.push_back(converted);
  }
  optimization::MarkLoops(&graph);
  if (g2o->lacks_vertices) graph.poses = optimization::DeadReckoning(graph);

  const auto result = optimization::Optimize(graph, {});
  if (!result.ok()) {
    std::fprintf(stderr, "%s\n", result.status().ToString().c_str());
    return 1;
  }
  int loops = 0, accepted = 0;
  for (size_t i = 0; i < graph.edges.size(); ++i) {
    if (!graph.edges[i].is_loop) continue;
    ++loops;
    if (result->accepted[i]) ++accepted;
  }
  std::printf("%zu poses, %d of %d loops accepted\n", graph.poses.size(),
              accepted, loops);
  for (size_t i = 0; i < graph.ids.size(); ++i) {
    g2o->vertices[graph.ids[i]] = result->poses[i];
  }
  const absl::Status written = io::WriteG2o(*g2o, argv[2]);
  if (!written.ok()) {
    std::fprintf(stderr, "%s\n", written.ToString().c_str());
    return 1;
  }
  return 0;
}
