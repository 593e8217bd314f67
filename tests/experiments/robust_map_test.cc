// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
//
// The robust optimisation problem inside the host on a sound map, with and
// without wrong loops, the stock problem beside it.
#include <iostream>
#include <memory>
#include <string>
#include <vector>

#include "cartographer/mapping/map_builder.h"
#include "cartographer_ext/common/pose_graph_context.h"
#include "cartographer_ext/configuration/slam_configuration.h"
#include "cartographer_ext/experiments/wrong_loops.h"
#include "cartographer_ext/io/pbstream/pbstream_writer.h"
#include "cartographer_ext/io/relations_file.h"
#include "cartographer_ext/map/host_map.h"
#include "cartographer_ext/map/pbstream_map.h"
#include "cartographer_ext/map/pbstream_optimization.h"
#include "cartographer_ext/map/switched_constraints.h"
#include "cartographer_ext/metrics/relations_metric.h"
#include "cartographer_ext/optimization/selection/switched_loops.h"
#include "gtest/gtest.h"
#include "tests/test_data.h"

namespace cartographer_ext {
namespace evaluation {
namespace {

struct Outcome {
  double relations = 0.;  // mean translational error in metres
  int wrong_loops_off = 0;
  optimization::SwitchedLoops switched;
};

class RobustMapTest : public ::testing::Test {
 protected:
  void SetUp() override {
    map_ = test::SharedData("pbstream/aces-sound-by-cartographer.pbstream");
    relations_ = test::SharedData("relations/aces.relations");
  }

  // Without the loops in `dropped`.
  Outcome Optimize(
      const std::string& block, const int wrong_loops,
      const std::vector<optimization::SwitchedLoop>& dropped = {}) {
    Outcome outcome;
    auto configuration = ParseSlamConfiguration(
        {"configuration_files"}, "test.lua",
        "include \"common_2d.lua\"\n" + block +
            "\nreturn { map_builder = MAP_BUILDER,\n"
            "  trajectory_builder = TRAJECTORY_BUILDER }\n");
    EXPECT_TRUE(configuration.ok()) << configuration.status();
    if (!configuration.ok()) return outcome;
    auto pbstream = io::ReadPbstream(map_);
    EXPECT_TRUE(pbstream.ok()) << pbstream.status();
    if (!pbstream.ok()) return outcome;
    MapGraph map = MakeMapGraph(*pbstream);
    DropConstraints(MarkSwitchedOff(dropped, &map), &*pbstream);
    WrongLoopOptions options;
    options.count = wrong_loops;
    const auto indices = AddWrongLoops(options, &*pbstream);
    EXPECT_TRUE(indices.ok()) << indices.status();
    const std::string filename =
        ::testing::TempDir() + "aces_with_wrong_loops.pbstream";
    EXPECT_TRUE(io::WritePbstream(*pbstream, filename).ok());

    const auto context = std::make_shared<PoseGraphContext>();
    const ScopedPoseGraphContext scope(context);
    auto map_builder = cartographer::mapping::CreateMapBuilder(
        configuration->map_builder_options);
    map_builder->LoadStateFromFile(filename, false /* load_frozen_state */);
    map_builder->pose_graph()->RunFinalOptimization();
    outcome.switched =
        context->Get<optimization::SwitchedLoopRecorder>()->Get();
    for (const auto& loop : outcome.switched.off) {
      for (const int index : *indices) {
        const auto& constraint = pbstream->pose_graph.constraint(index);
        outcome.wrong_loops_off +=
            loop.submap_index == constraint.submap_id().submap_index() &&
            loop.node_index == constraint.node_id().node_index();
      }
    }
    const auto relations = io::ReadRelations(relations_);
    EXPECT_TRUE(relations.ok()) << relations.status();
    const auto metric = ComputeRelationsMetric(
        MakeMapGraph(*map_builder->pose_graph()).GlobalTrajectory(), *relations,
        RelationsMetricOptions());
    EXPECT_TRUE(metric.ok()) << metric.status();
    outcome.relations = metric->all.translation.mean;
    RecordProperty("relations", std::to_string(outcome.relations));
    std::cout << "relations " << outcome.relations << " m, "
              << outcome.switched.off.size() << " of " << outcome.switched.loops
              << " loops off, of the wrong ones " << outcome.wrong_loops_off
              << "; selection " << outcome.switched.selection_cpu_seconds
              << " s, solution " << outcome.switched.solution_cpu_seconds
              << " s\n";
    return outcome;
  }

  std::string map_, relations_;
};

constexpr char kBlock[] =
    "POSE_GRAPH.optimization_problem.cartographer_ext = {}";
constexpr char kPassive[] =
    "POSE_GRAPH.optimization_problem.cartographer_ext = {\n"
    "  robust_loops = false, odometry_check = false }";

TEST_F(RobustMapTest, AcesSurvivesTwentyWrongLoops) {
  CARTOGRAPHER_EXT_SKIP_WITHOUT(map_);
  const Outcome stock = Optimize("", 0);
  const Outcome passive = Optimize(kPassive, 0);
  const Outcome robust = Optimize(kBlock, 0);
  const Outcome stock_wrong = Optimize("", 20);
  const Outcome robust_wrong = Optimize(kBlock, 20);
  EXPECT_EQ(stock.switched.optimizations, 0);
  EXPECT_DOUBLE_EQ(passive.relations, stock.relations);
  EXPECT_TRUE(passive.switched.off.empty());
  // No worse than stock without, and hardly touched by, wrong loops.
  EXPECT_LE(robust.relations, 1.01 * stock.relations);
  EXPECT_LE(robust_wrong.relations, 1.05 * robust.relations);
  EXPECT_EQ(robust_wrong.wrong_loops_off, 20);
  EXPECT_LE(robust_wrong.relations, stock_wrong.relations);
}

TEST_F(RobustMapTest, RightLoopsAloneCostNextToNothing) {
  CARTOGRAPHER_EXT_SKIP_WITHOUT(map_);
  const std::vector<optimization::SwitchedLoop> off =
      Optimize(kBlock, 0).switched.off;
  const Outcome passive = Optimize(kPassive, 0, off);
  const Outcome robust = Optimize(kBlock, 0, off);
  EXPECT_EQ(passive.switched.loops + off.size(), 730u);
  EXPECT_TRUE(robust.switched.off.empty());
  EXPECT_DOUBLE_EQ(robust.relations, passive.relations);
  EXPECT_LT(robust.switched.selection_cpu_seconds,
            0.5 * passive.switched.solution_cpu_seconds);
}

}  // namespace
}  // namespace evaluation
}  // namespace cartographer_ext
