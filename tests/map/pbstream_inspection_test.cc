// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
#include "cartographer_ext/map/pbstream_inspection.h"

#include "gmock/gmock.h"
#include "gtest/gtest.h"
#include "tests/map/small_state.h"
#include "tests/test_data.h"

namespace cartographer_ext {
namespace evaluation {
namespace {

using cartographer::mapping::proto::PoseGraph;
using evaluation::test::PoseProto;
using evaluation::test::SmallState;
using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;

TEST(PbstreamInspectionTest, SummaryCounts) {
  const auto summary = Summarise(SmallState());
  EXPECT_EQ(summary["nodes"], 3);
  EXPECT_EQ(summary["submaps"], 1);
  EXPECT_EQ(summary["constraints"]["intra"], 3);
  EXPECT_EQ(summary["constraints"]["inter"], 0);
  ASSERT_EQ(summary["trajectories"].size(), 1u);
  const auto& trajectory = summary["trajectories"][0];
  EXPECT_EQ(trajectory["finished_submaps"], 1);
  EXPECT_DOUBLE_EQ(trajectory["metres"].get<double>(), 2.);
  EXPECT_DOUBLE_EQ(trajectory["begin_seconds"].get<double>(), 1000.);
  EXPECT_DOUBLE_EQ(trajectory["end_seconds"].get<double>(), 1002.);
  EXPECT_EQ(trajectory["sensors"][0], "RANGE:scan");
  EXPECT_EQ(trajectory["has_extension_options"], false);
  EXPECT_THAT(SummaryToText(summary), HasSubstr("3 nodes, 1 submaps"));
}

TEST(PbstreamInspectionTest, SeesOptionsOfOurs) {
  io::Pbstream state = SmallState();
  auto* const matcher = state.options.mutable_options_with_sensor_ids(0)
                            ->mutable_trajectory_builder_options()
                            ->mutable_trajectory_builder_2d_options()
                            ->mutable_ceres_scan_matcher_options();
  matcher->GetReflection()->MutableUnknownFields(matcher)->AddLengthDelimited(
      51966, "block");
  EXPECT_EQ(Summarise(state)["trajectories"][0]["has_extension_options"], true);
}

TEST(PbstreamInspectionTest, AWholeStateHasNoProblems) {
  EXPECT_THAT(FindProblems(SmallState()), IsEmpty());
}

TEST(PbstreamInspectionTest, FindsContradictionsWithLocalPoses) {
  io::Pbstream state = SmallState();
  *state.pose_graph.mutable_constraint(1)->mutable_relative_pose() =
      PoseProto(1.5);
  EXPECT_THAT(FindProblems(state),
              ElementsAre(HasSubstr("node (0, 1) in submap (0, 0)")));
}

TEST(PbstreamInspectionTest, FindsLoopsToTheOwnSubmap) {
  io::Pbstream state = SmallState();
  auto* const loop = state.pose_graph.add_constraint();
  *loop = state.pose_graph.constraint(2);
  loop->set_tag(PoseGraph::Constraint::INTER_SUBMAP);
  EXPECT_THAT(FindProblems(state),
              ElementsAre(HasSubstr("which was inserted into it")));
}

TEST(PbstreamInspectionTest, FindsOrphans) {
  io::Pbstream state = SmallState();
  state.pose_graph.mutable_constraint(0)->mutable_node_id()->set_node_index(77);
  const auto problems = FindProblems(state);
  ASSERT_FALSE(problems.empty());
  EXPECT_THAT(problems[0], HasSubstr("77"));
  EXPECT_EQ(FindProblems(state, 0).size(), 0u);
}

// The map of a localisation, whose own submaps may have been trimmed.
TEST(PbstreamInspectionTest, AFrozenMapHasNoInsertions) {
  io::Pbstream state = SmallState();
  state.pose_graph.clear_constraint();
  EXPECT_THAT(FindProblems(state), IsEmpty());
  const auto summary = Summarise(state);
  EXPECT_EQ(summary["nodes_in_no_submap"], 0);
  EXPECT_EQ(summary["trajectories"][0]["has_insertions"], false);
  EXPECT_THAT(SummaryToText(summary), HasSubstr("loaded frozen"));
}

TEST(PbstreamInspectionTest, OtherwiseASubmapNeedsNodes) {
  io::Pbstream state = SmallState();
  auto submap = state.submaps[0];
  submap.mutable_submap_id()->set_submap_index(1);
  state.submaps.push_back(submap);
  auto* const pose =
      state.pose_graph.mutable_trajectory(0)->mutable_submap()->Add();
  *pose = state.pose_graph.trajectory(0).submap(0);
  pose->set_submap_index(1);
  EXPECT_THAT(FindProblems(state),
              ElementsAre(HasSubstr("submap (0, 1) has no nodes")));
  EXPECT_EQ(SummaryToText(Summarise(state)).find("loaded frozen"),
            std::string::npos);
}

TEST(PbstreamInspectionTest, RealMapsAreWhole) {
  const std::string filename = cartographer_ext::test::SharedData(
      "pbstream/csail-sound-by-cartographer.pbstream");
  CARTOGRAPHER_EXT_SKIP_WITHOUT(filename);
  const auto state = io::ReadPbstream(filename);
  ASSERT_TRUE(state.ok()) << state.status();
  EXPECT_THAT(FindProblems(*state), IsEmpty());
  EXPECT_EQ(Summarise(*state)["constraints"]["inter"], 166);
}

}  // namespace
}  // namespace evaluation
}  // namespace cartographer_ext
