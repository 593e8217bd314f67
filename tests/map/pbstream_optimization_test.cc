// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
#include "cartographer_ext/map/pbstream_optimization.h"

#include <algorithm>
#include <limits>

#include "cartographer_ext/experiments/wrong_loops.h"
#include "cartographer_ext/map/pbstream_map.h"
#include "cartographer_ext/optimization/offline/optimize.h"
#include "gmock/gmock.h"
#include "tests/map/square_map.h"

namespace cartographer_ext {
namespace evaluation {
namespace {

using optimization::OptimizeOptions;
using test::SquareMap;
using ::testing::ElementsAre;
using ::testing::HasSubstr;

constexpr int kSubmaps = 8;
constexpr int kIntra = 2 * SquareMap::kNodes - SquareMap::kNodesPerSubmap;

// The loop constraints of `graph` that `result` has put out of force.
std::vector<int> Rejected(const MapPoseGraph& graph,
                          const optimization::OptimizeResult& result) {
  std::vector<int> rejected;
  for (size_t i = 0; i != graph.graph.edges.size(); ++i) {
    if (!result.accepted[i]) rejected.push_back(graph.constraint_of_edge[i]);
  }
  return rejected;
}

double LargestError(const SquareMap& map, const io::Pbstream& pbstream) {
  double largest = 0.;
  for (const auto& node : MakeMapGraph(pbstream).nodes) {
    largest = std::max(largest, (node.second.global_pose.translation() -
                                 map.truth[node.first.index].translation())
                                    .norm());
  }
  return largest;
}

TEST(PbstreamOptimizationTest, EdgesCarryTheSigmaOfTheLoops) {
  SquareMap map;
  map.AddRightLoops();
  MapOptimizationOptions options;
  options.loop_sigma = 0.2;
  const auto graph = MakeMapPoseGraph(MakeMapGraph(map.pbstream), options);
  ASSERT_TRUE(graph.ok()) << graph.status();
  EXPECT_EQ(graph->graph.poses.size(), SquareMap::kNodes + kSubmaps);
  ASSERT_EQ(graph->graph.edges.size(), kIntra + 8 + SquareMap::kNodes - 1);
  // In the order of the file; local SLAM behind.
  const auto& intra = graph->graph.edges[0];
  const auto& loop = graph->graph.edges[kIntra];
  const auto& local = graph->graph.edges[kIntra + 8];
  EXPECT_FALSE(intra.is_loop);
  EXPECT_TRUE(loop.is_loop);
  EXPECT_FALSE(local.is_loop);
  EXPECT_EQ(graph->constraint_of_edge[kIntra], kIntra);
  EXPECT_EQ(graph->constraint_of_edge[kIntra + 8], -1);
  EXPECT_NEAR(loop.information(0, 0), 1. / (0.2 * 0.2), 1e-9);
  EXPECT_NEAR(loop.information(2, 2) / loop.information(0, 0),
              1e10 / (1.1e4 * 1.1e4), 1e-6);
  EXPECT_NEAR(intra.information(0, 0) / loop.information(0, 0),
              500. * 500. / (1.1e4 * 1.1e4), 1e-9);
  EXPECT_NEAR(local.information(0, 0) / loop.information(0, 0),
              1e10 / (1.1e4 * 1.1e4), 1e-6);
  // Can be replayed: everything hangs on something earlier.
  std::vector<bool> hangs(graph->graph.poses.size(), false);
  for (const auto& edge : graph->graph.edges) {
    if (!edge.is_loop) hangs[std::max(edge.from, edge.to)] = true;
  }
  EXPECT_EQ(std::count(hangs.begin(), hangs.end(), false), 1);
}

TEST(PbstreamOptimizationTest, FindsWrongLoopsAndStoresPoses) {
  SquareMap map;
  map.AddRightLoops();
  WrongLoopOptions wrong;
  wrong.count = 6;
  const auto added = AddWrongLoops(wrong, &map.pbstream);
  ASSERT_TRUE(added.ok()) << added.status();
  const auto graph =
      MakeMapPoseGraph(MakeMapGraph(map.pbstream), MapOptimizationOptions());
  ASSERT_TRUE(graph.ok()) << graph.status();
  for (const char* method : {"auto", "r_isam", "dcs"}) {
    OptimizeOptions options;
    options.method = method;
    options.adaptive_gate = false;
    options.smoother.adaptive_gate = false;
    const auto result = optimization::Optimize(graph->graph, options);
    ASSERT_TRUE(result.ok()) << result.status();
    EXPECT_EQ(Rejected(*graph, *result), *added) << method;
    io::Pbstream output = map.pbstream;
    StorePoses(*graph, result->poses, &output);
    EXPECT_LT(LargestError(map, output), 0.3) << method;
    EXPECT_GT(LargestError(map, map.pbstream), 0.5);
    // The height is left alone.
    EXPECT_NEAR(
        output.pose_graph.trajectory(0).node(70).pose().translation().z(), 0.5,
        1e-12);
  }
}

TEST(PbstreamOptimizationTest, UndoesALoop) {
  SquareMap map;
  map.AddRightLoops();
  map.Add(1, 33, Pose2(), true);
  const MapGraph before = MakeMapGraph(map.pbstream);
  const auto loops = FindLoops(before, "0:1:0:33");
  ASSERT_TRUE(loops.ok()) << loops.status();
  EXPECT_THAT(*loops, ElementsAre(kIntra + 8));
  const auto error = [&](const io::Pbstream& pbstream) {
    OptimizeOptions options;
    options.method = "none";
    const auto graph =
        MakeMapPoseGraph(MakeMapGraph(pbstream), MapOptimizationOptions());
    const auto result = optimization::Optimize(graph->graph, options);
    io::Pbstream output = pbstream;
    StorePoses(*graph, result->poses, &output);
    return LargestError(map, output);
  };
  EXPECT_GT(error(map.pbstream), 1.);
  DropConstraints(*loops, &map.pbstream);
  EXPECT_EQ(map.pbstream.pose_graph.constraint_size(), kIntra + 8);
  EXPECT_LT(error(map.pbstream), 0.5);
}

TEST(PbstreamOptimizationTest, DroppingKeepsTheOrder) {
  SquareMap map;
  DropConstraints({0, 2, kIntra - 1}, &map.pbstream);
  const auto& constraints = map.pbstream.pose_graph.constraint();
  ASSERT_EQ(constraints.size(), kIntra - 3);
  EXPECT_EQ(constraints[0].node_id().node_index(), 1);
  EXPECT_EQ(constraints[1].node_id().node_index(), 3);
  EXPECT_EQ(constraints[constraints.size() - 1].submap_id().submap_index(),
            kSubmaps - 2);
  DropConstraints({}, &map.pbstream);
  EXPECT_EQ(constraints.size(), kIntra - 3);
}

TEST(PbstreamOptimizationTest, NamesOfLoops) {
  SquareMap map;
  map.AddRightLoops();
  const MapGraph graph = MakeMapGraph(map.pbstream);
  EXPECT_TRUE(FindLoops(graph, "")->empty());
  EXPECT_THAT(*FindLoops(graph, "0:0:0:42, 0:1:0:52\n"),
              ElementsAre(kIntra, kIntra + 2));
  // No loop of that name; one of the map's own insertions; not a name.
  for (const char* bad : {"0:0:0:43", "0:0:0:1", "0:0:0", "0:0:0:x", "1,2"}) {
    const auto loops = FindLoops(graph, bad);
    EXPECT_FALSE(loops.ok()) << bad;
  }
  EXPECT_THAT(std::string(FindLoops(graph, "0:0:0:43").status().message()),
              HasSubstr("no loop between submap (0, 0) and node (0, 43)"));
}

TEST(PbstreamOptimizationTest, DegenerateMapsAreRefusedOrSurvived) {
  const auto make = [](const io::Pbstream& pbstream) {
    return MakeMapPoseGraph(MakeMapGraph(pbstream), MapOptimizationOptions());
  };
  const auto message = [&](const io::Pbstream& pbstream) {
    return std::string(make(pbstream).status().message());
  };
  EXPECT_THAT(message(io::Pbstream()), HasSubstr("no vertices"));

  MapOptimizationOptions without_sigma;
  without_sigma.loop_sigma = 0.;
  EXPECT_FALSE(
      MakeMapPoseGraph(MakeMapGraph(SquareMap().pbstream), without_sigma).ok());

  // Constraints that name nothing or weigh nothing do not count.
  SquareMap map;
  map.AddRightLoops();
  const size_t edges = make(map.pbstream)->graph.edges.size();
  map.Add(0, 1000, Pose2(), true);
  map.Add(99, 5, Pose2(), true);
  map.Add(0, 45, Pose2(), true);
  map.pbstream.pose_graph
      .mutable_constraint(map.pbstream.pose_graph.constraint_size() - 1)
      ->set_translation_weight(0.);
  ASSERT_TRUE(make(map.pbstream).ok());
  EXPECT_EQ(make(map.pbstream)->graph.edges.size(), edges);

  // A measurement that is no number.
  map.Add(0, 45, Pose2(), true);
  map.pbstream.pose_graph
      .mutable_constraint(map.pbstream.pose_graph.constraint_size() - 1)
      ->mutable_relative_pose()
      ->mutable_translation()
      ->set_x(std::numeric_limits<double>::quiet_NaN());
  EXPECT_THAT(message(map.pbstream), HasSubstr("edge"));

  // A submap that nothing holds.
  map = SquareMap();
  auto* const lost =
      map.pbstream.pose_graph.mutable_trajectory(0)->add_submap();
  lost->set_submap_index(8);
  *lost->mutable_pose() = SquareMap::ToProto(Pose2(), 0.);
  map.pbstream.submaps.push_back(map.pbstream.submaps.back());
  map.pbstream.submaps.back().mutable_submap_id()->set_submap_index(8);
  EXPECT_THAT(message(map.pbstream), HasSubstr("vertex 8 cannot be reached"));
}

}  // namespace
}  // namespace evaluation
}  // namespace cartographer_ext
