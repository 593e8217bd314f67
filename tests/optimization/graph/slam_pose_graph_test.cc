// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
#include "cartographer_ext/optimization/graph/slam_pose_graph.h"

#include <string>
#include <vector>

#include "gmock/gmock.h"
#include "gtest/gtest.h"

namespace cartographer_ext {
namespace optimization {
namespace {

using ::testing::ElementsAre;
using ::testing::IsEmpty;

SlamConstraint Constrain(const int submap, const int node, const bool is_loop,
                         const double weight = 100.) {
  SlamConstraint constraint;
  constraint.id.submap_index = submap;
  constraint.id.node_index = node;
  constraint.relative_pose = Pose2(node - 2. * submap, 0., 0.);
  constraint.translation_weight = weight;
  constraint.rotation_weight = 2. * weight;
  constraint.is_loop = is_loop;
  return constraint;
}

// Five nodes a metre apart, a submap every two.
SlamGraph Line() {
  SlamGraph slam;
  for (int i = 0; i != 5; ++i) {
    SlamNode node;
    node.id = {0, i};
    node.local_pose = Pose2(1.5 * i, 0., 0.);
    node.global_pose = Pose2(i, 0., 0.);
    slam.nodes.push_back(node);
  }
  for (int i = 0; i != 2; ++i) {
    SlamSubmap submap;
    submap.id = {0, i};
    submap.global_pose = Pose2(2. * i, 0., 0.);
    slam.submaps.push_back(submap);
  }
  for (int i = 0; i != 5; ++i) {
    slam.constraints.push_back(Constrain(0, i, false));
    if (i >= 2) slam.constraints.push_back(Constrain(1, i, false));
  }
  return slam;
}

// "n3" or "s1" per vertex.
std::vector<std::string> Names(const SlamPoseGraph& made) {
  std::vector<std::string> names;
  for (const auto& vertex : made.vertices) {
    names.push_back((vertex.is_submap ? "s" : "n") +
                    std::to_string(vertex.index));
  }
  return names;
}

TEST(SlamPoseGraphTest, VerticesAreInTheOrderOfMapping) {
  const SlamPoseGraph made = MakeSlamPoseGraph(Line(), SlamPoseGraphOptions());
  EXPECT_THAT(Names(made),
              ElementsAre("s0", "n0", "n1", "n2", "s1", "n3", "n4"));
  EXPECT_EQ(made.graph.poses[4].x, 2.);
  EXPECT_THAT(made.graph.ids, ElementsAre(0, 1, 2, 3, 4, 5, 6));
}

TEST(SlamPoseGraphTest, TheMedianLoopHasTheSigma) {
  SlamGraph slam = Line();
  slam.constraints.push_back(Constrain(0, 4, true, 50.));
  slam.constraints.push_back(Constrain(1, 0, true, 200.));
  slam.constraints.push_back(Constrain(1, 1, true, 800.));
  SlamPoseGraphOptions options;
  options.loop_sigma = 0.5;
  const SlamPoseGraph made = MakeSlamPoseGraph(slam, options);
  const size_t median = slam.constraints.size() - 2;
  ASSERT_EQ(made.constraint_of_edge[median], static_cast<int>(median));
  EXPECT_TRUE(made.graph.edges[median].is_loop);
  EXPECT_NEAR(made.graph.edges[median].information(0, 0), 4., 1e-12);
  EXPECT_NEAR(made.graph.edges[median].information(2, 2), 16., 1e-12);
  EXPECT_NEAR(made.graph.edges[0].information(0, 0), 1., 1e-12);
  EXPECT_FALSE(made.graph.edges[0].is_loop);
}

TEST(SlamPoseGraphTest, ConsecutiveNodesAreJoinedByLocalSlam) {
  SlamGraph slam = Line();
  slam.nodes.erase(slam.nodes.begin() + 3);
  const SlamPoseGraph made = MakeSlamPoseGraph(slam, SlamPoseGraphOptions());
  ASSERT_EQ(made.local_slam_edges.size(), 2u);  // 0-1, 1-2; 3 is missing
  const PoseGraphEdge& edge = made.graph.edges[made.local_slam_edges[0]];
  EXPECT_EQ(edge.from, 1);
  EXPECT_EQ(edge.to, 2);
  EXPECT_EQ(edge.measurement.x, 1.5);
  EXPECT_EQ(made.constraint_of_edge[made.local_slam_edges[0]], -1);
  SlamPoseGraphOptions options;
  options.local_slam_rotation_weight = 0.;
  EXPECT_THAT(MakeSlamPoseGraph(slam, options).local_slam_edges, IsEmpty());
}

TEST(SlamPoseGraphTest, SkipsWhatHasNoWeightOrNoEnd) {
  SlamGraph slam = Line();
  const size_t before =
      MakeSlamPoseGraph(slam, SlamPoseGraphOptions()).graph.edges.size();
  slam.constraints.push_back(Constrain(0, 4, true, 0.));
  slam.constraints.push_back(Constrain(7, 4, true));
  slam.constraints.push_back(Constrain(0, 9, true));
  EXPECT_EQ(MakeSlamPoseGraph(slam, SlamPoseGraphOptions()).graph.edges.size(),
            before);
  // A submap whose first node is gone follows the first one that is left.
  slam.nodes.erase(slam.nodes.begin() + 2);
  EXPECT_THAT(Names(MakeSlamPoseGraph(slam, SlamPoseGraphOptions())),
              ElementsAre("s0", "n0", "n1", "n2", "s1", "n3"));
}

TEST(SlamPoseGraphTest, FrozenTrajectoriesAreHeldInPlace) {
  SlamGraph slam = Line();
  const size_t before =
      MakeSlamPoseGraph(slam, SlamPoseGraphOptions()).graph.edges.size();
  slam.frozen_trajectories = {0, 4};
  const SlamPoseGraph made = MakeSlamPoseGraph(slam, SlamPoseGraphOptions());
  ASSERT_EQ(made.graph.edges.size(), before + 6);  // all but the first vertex
  const PoseGraphEdge& last = made.graph.edges.back();
  EXPECT_EQ(last.from, 0);
  EXPECT_EQ(last.to, 6);
  EXPECT_EQ(last.measurement.x, 4.);
  EXPECT_GT(last.information(0, 0), 1e7);
}

TEST(SlamPoseGraphTest, NothingAtAll) {
  const SlamPoseGraph made =
      MakeSlamPoseGraph(SlamGraph(), SlamPoseGraphOptions());
  EXPECT_THAT(made.vertices, IsEmpty());
  EXPECT_THAT(made.graph.edges, IsEmpty());
}

}  // namespace
}  // namespace optimization
}  // namespace cartographer_ext
