// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
#include "cartographer_ext/map/pbstream_difference.h"

#include "cartographer_ext/map/pbstream_map.h"
#include "gmock/gmock.h"
#include "gtest/gtest.h"
#include "tests/map/small_state.h"

namespace cartographer_ext {
namespace evaluation {
namespace {

using cartographer::mapping::proto::PoseGraph;
using evaluation::test::PoseProto;
using evaluation::test::SmallState;
using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;

TEST(PbstreamDifferenceTest, EqualStatesAreIdentical) {
  const PbstreamDifference difference = Compare(SmallState(), SmallState());
  EXPECT_TRUE(difference.identical);
  EXPECT_THAT(difference.differences, IsEmpty());
  EXPECT_EQ(difference.numbers["nodes"]["common"], 3);
}

TEST(PbstreamDifferenceTest, NamesEveryDifference) {
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

TEST(PbstreamDifferenceTest, LocalAgreementComparesMotions) {
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

}  // namespace
}  // namespace evaluation
}  // namespace cartographer_ext
