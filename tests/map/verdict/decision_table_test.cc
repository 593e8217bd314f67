// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
#include "cartographer_ext/map/verdict/decision_table.h"

#include "gtest/gtest.h"

namespace cartographer_ext {
namespace evaluation {
namespace {

MapGraph SmallGraph() {
  MapGraph graph;
  graph.nodes[{0, 5}].time = 12500000000;
  graph.nodes[{0, 5}].global_pose = Pose2(1., 0., 0.);
  graph.submaps[{0, 2}];
  graph.constraints.resize(2);
  for (GraphConstraint& constraint : graph.constraints) {
    constraint.submap_id = {0, 2};
    constraint.node_id = {0, 5};
    constraint.translation_weight = 500.;
    constraint.rotation_weight = 1600.;
  }
  graph.constraints[0].relative_pose = Pose2(1., 0., 0.);
  graph.constraints[1].relative_pose = Pose2(0.5, 0., 0.25);
  graph.constraints[1].is_loop = true;
  return graph;
}

TEST(DecisionTableTest, ConstraintsOnePerLine) {
  EXPECT_EQ(ConstraintTable(SmallGraph(), nullptr),
            "submap_trajectory_id,submap_index,node_trajectory_id,node_index,"
            "kind,node_time,x,y,theta,translation_weight,rotation_weight,"
            "residual_translation,residual_rotation,switched_off\n"
            "0,2,0,5,intra,12.500000000,1.000000,0.000000,0.000000,500,1600,"
            "0.000000,0.000000,0\n"
            "0,2,0,5,inter,12.500000000,0.500000,0.000000,0.250000,500,1600,"
            "0.500000,0.250000,0\n");
}

TEST(DecisionTableTest, TruthAddsColumns) {
  LoopStatistics loops;
  loops.loops.resize(1);
  loops.loops[0].constraint = 1;
  loops.loops[0].verdict = LoopVerdict::kWrong;
  loops.loops[0].translation_error = 2.;
  const std::string table = ConstraintTable(SmallGraph(), &loops);
  EXPECT_NE(table.find(",truth,error_translation,error_rotation\n"),
            std::string::npos);
  EXPECT_NE(table.find("0.000000,0.000000,0,unknown,,\n"), std::string::npos);
  EXPECT_NE(table.find("0.500000,0.250000,0,wrong,2.000000,0.000000\n"),
            std::string::npos);
}

TEST(DecisionTableTest, DecisionsAreTheLoops) {
  EXPECT_EQ(DecisionTable(SmallGraph()),
            "submap_trajectory_id,submap_index,node_trajectory_id,node_index,"
            "node_time,verdict,x,y,theta,translation_weight,rotation_weight,"
            "residual_translation,residual_rotation\n"
            "0,2,0,5,12.500000000,accepted,0.500000,0.000000,0.250000,500,1600,"
            "0.500000,0.250000\n");
}

TEST(DecisionTableTest, TellsWhatIsSwitchedOff) {
  MapGraph graph = SmallGraph();
  graph.constraints[1].switched_off = true;
  EXPECT_NE(ConstraintTable(graph, nullptr).find("0.500000,0.250000,1\n"),
            std::string::npos);
  EXPECT_NE(DecisionTable(graph).find(",switched_off,0.500000,"),
            std::string::npos);
}

TEST(DecisionTableTest, MissingNodesLeaveColumnsEmpty) {
  MapGraph graph = SmallGraph();
  graph.nodes.clear();
  const std::string table = DecisionTable(graph);
  EXPECT_NE(table.find("0,2,0,5,,accepted,"), std::string::npos);
  EXPECT_EQ(table.substr(table.size() - 3), ",,\n");
}

}  // namespace
}  // namespace evaluation
}  // namespace cartographer_ext
