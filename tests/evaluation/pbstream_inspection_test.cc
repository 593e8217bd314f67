// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
#include "cartographer_ext/evaluation/pbstream_inspection.h"

#include "cartographer_ext/evaluation/host_types.h"
#include "cartographer_ext/evaluation/pbstream_map.h"
#include "gmock/gmock.h"
#include "gtest/gtest.h"
#include "tests/test_data.h"

namespace cartographer_ext {
namespace evaluation {
namespace {

using cartographer::mapping::proto::PoseGraph;
using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;

cartographer::transform::proto::Rigid3d PoseProto(double x) {
  cartographer::transform::proto::Rigid3d proto;
  proto.mutable_translation()->set_x(x);
  proto.mutable_rotation()->set_w(1.);
  return proto;
}

// One submap at the origin with three nodes, one metre and one second apart.
io::Pbstream SmallState() {
  io::Pbstream state;
  state.header.set_format_version(2);
  auto* const sensors = state.options.add_options_with_sensor_ids();
  sensors->add_sensor_id()->set_id("scan");
  auto* const trajectory = state.pose_graph.add_trajectory();
  auto* const placed = trajectory->add_submap();
  *placed->mutable_pose() = PoseProto(10.);
  state.submaps.emplace_back();
  auto* const submap = state.submaps.back().mutable_submap_2d();
  *submap->mutable_local_pose() = PoseProto(0.);
  submap->set_finished(true);
  submap->set_num_range_data(3);
  auto* const grid = submap->mutable_grid();
  grid->mutable_limits()->set_resolution(0.05);
  grid->mutable_limits()->mutable_max()->set_x(1.);
  grid->mutable_limits()->mutable_cell_limits()->set_num_x_cells(1);
  grid->mutable_limits()->mutable_cell_limits()->set_num_y_cells(1);
  grid->mutable_probability_grid_2d();
  grid->set_min_correspondence_cost(0.1f);
  grid->set_max_correspondence_cost(0.9f);
  grid->add_cells(1);
  for (int i = 0; i < 3; ++i) {
    const int64_t ticks = cartographer::common::ToUniversal(
        ToHostTime((1000 + i) * 1000000000LL));
    auto* const node = trajectory->add_node();
    node->set_node_index(i);
    node->set_timestamp(ticks);
    *node->mutable_pose() = PoseProto(10. + i);
    state.nodes.emplace_back();
    state.nodes.back().mutable_node_id()->set_node_index(i);
    auto* const data = state.nodes.back().mutable_node_data();
    data->set_timestamp(ticks);
    data->mutable_gravity_alignment()->set_w(1.);
    *data->mutable_local_pose() = PoseProto(i);
    auto* const constraint = state.pose_graph.add_constraint();
    constraint->mutable_submap_id();
    constraint->mutable_node_id()->set_node_index(i);
    *constraint->mutable_relative_pose() = PoseProto(i);
    constraint->set_translation_weight(500.);
    constraint->set_rotation_weight(1600.);
  }
  return state;
}

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
              ElementsAre(HasSubstr("which was inserted in it")));
}

TEST(PbstreamInspectionTest, FindsOrphans) {
  io::Pbstream state = SmallState();
  state.pose_graph.mutable_constraint(0)->mutable_node_id()->set_node_index(77);
  const auto problems = FindProblems(state);
  ASSERT_FALSE(problems.empty());
  EXPECT_THAT(problems[0], HasSubstr("77"));
  EXPECT_EQ(FindProblems(state, 0).size(), 0u);
}

TEST(PbstreamInspectionTest, EqualStatesAreIdentical) {
  const PbstreamDifference difference = Compare(SmallState(), SmallState());
  EXPECT_TRUE(difference.identical);
  EXPECT_THAT(difference.differences, IsEmpty());
  EXPECT_EQ(difference.numbers["nodes"]["common"], 3);
}

TEST(PbstreamInspectionTest, NamesEveryDifference) {
  io::Pbstream other = SmallState();
  *other.pose_graph.mutable_trajectory(0)->mutable_node(2)->mutable_pose() =
      PoseProto(12.25);
  other.submaps[0].mutable_submap_2d()->mutable_grid()->set_cells(0, 7);
  auto* const loop = other.pose_graph.add_constraint();
  *loop->mutable_relative_pose() = PoseProto(0.);
  loop->mutable_submap_id();
  loop->mutable_node_id();
  loop->set_tag(PoseGraph::Constraint::INTER_SUBMAP);
  const PbstreamDifference difference = Compare(SmallState(), other);
  EXPECT_FALSE(difference.identical);
  EXPECT_THAT(difference.differences,
              ElementsAre(HasSubstr("global poses of nodes differ up to 0.25"),
                          HasSubstr("loops: 0 only in the first, 1 only"),
                          HasSubstr("1 grids differ")));
}

TEST(PbstreamInspectionTest, LocalAgreementComparesMotions) {
  const MapGraph first = MakeMapGraph(SmallState());
  io::Pbstream other = SmallState();
  // The last node a little further, everything moved and a node dropped.
  *other.nodes[2].mutable_node_data()->mutable_local_pose() = PoseProto(2.03);
  const LocalAgreement agreement = CompareLocalSlam(first, MakeMapGraph(other));
  EXPECT_EQ(agreement.common_stamps, 3);
  EXPECT_EQ(agreement.pairs, 2);
  EXPECT_DOUBLE_EQ(agreement.fraction_alike, 0.5);
  EXPECT_DOUBLE_EQ(agreement.fraction_alike_translation, 0.5);
  EXPECT_NEAR(agreement.max_translation, 0.03, 1e-12);
  // Stamps that were rounded otherwise are the same.
  for (auto& node : other.nodes) {
    node.mutable_node_data()->set_timestamp(node.node_data().timestamp() + 900);
  }
  EXPECT_EQ(CompareLocalSlam(first, MakeMapGraph(other)).pairs, 2);
  other.nodes.erase(other.nodes.begin() + 1);
  EXPECT_EQ(CompareLocalSlam(first, MakeMapGraph(other)).pairs, 0);
}

TEST(PbstreamInspectionTest, RealMapsAreWhole) {
  const std::string filename =
      test::SharedData("pbstream/csail-sound-by-cartographer.pbstream");
  CARTOGRAPHER_EXT_SKIP_WITHOUT(filename);
  const auto state = io::ReadPbstream(filename);
  ASSERT_TRUE(state.ok()) << state.status();
  EXPECT_THAT(FindProblems(*state), IsEmpty());
  EXPECT_EQ(Summarise(*state)["constraints"]["inter"], 166);
}

}  // namespace
}  // namespace evaluation
}  // namespace cartographer_ext
