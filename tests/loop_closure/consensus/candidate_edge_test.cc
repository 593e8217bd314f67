// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
#include "cartographer_ext/loop_closure/consensus/candidate_edge.h"

#include "cartographer_ext/loop_closure/information/loop_information.h"
#include "gtest/gtest.h"

namespace cartographer_ext {
namespace loop_closure {
namespace {

using uncertainty::LoopEdge;
using uncertainty::NodeId;
using uncertainty::PathNoiseOptions;
using uncertainty::PathUncertainty;
using uncertainty::SubmapId;
using uncertainty::VertexId;

// A path straight on, a node every metre; the submap begins at node 10 and holds
// nodes 10 to 20. Node 90 was matched 4 m behind its origin, a metre aside.
class CandidateEdgeTest : public testing::Test {
 protected:
  CandidateEdgeTest() : paths_(PathNoiseOptions(), 1000) {
    for (int i = 0; i < 100; ++i) {
      paths_.Add(NodeId{0, i}, Pose2(i, 0., 0.));
    }
    candidate_.submap = SubmapId{0, 1};
    candidate_.node = NodeId{0, 90};
    candidate_.submap_local_pose = Pose2(10., 0., 0.);
    candidate_.anchor = VertexId(NodeId{0, 10});
    candidate_.first_submap_node = 10;
    candidate_.last_submap_node = 20;
    candidate_.match.refined = Pose2(4.2, 1., 0.3);
  }

  LoopEdge Edge() const {
    return CandidateEdge(LoopOptions(), paths_, candidate_);
  }

  PathUncertainty paths_;
  LoopCandidate candidate_;
};

TEST_F(CandidateEdgeTest, BeginsAtTheNodeNearestToTheMatch) {
  const LoopEdge edge = Edge();
  EXPECT_EQ(edge.a, VertexId(NodeId{0, 14}));
  EXPECT_EQ(edge.b, VertexId(NodeId{0, 90}));
  EXPECT_NEAR(edge.pose.pose.x, 0.2, 1e-12);
  EXPECT_NEAR(edge.pose.pose.y, 1., 1e-12);
  EXPECT_NEAR(edge.pose.pose.theta, 0.3, 1e-12);
  EXPECT_EQ(edge.pose.covariance, MatchCovariance(LoopOptions(), candidate_));
}

TEST_F(CandidateEdgeTest, ButAtANodeOfTheSubmap) {
  candidate_.match.refined = Pose2(30., 0., 0.);
  EXPECT_EQ(Edge().a, VertexId(NodeId{0, 20}));
  EXPECT_NEAR(Edge().pose.pose.x, 20., 1e-12);
  candidate_.match.refined = Pose2(-5., 0., 0.);
  EXPECT_EQ(Edge().a, VertexId(NodeId{0, 10}));
}

TEST_F(CandidateEdgeTest, AtTheAnchorWhereTheNodesAreUnknown) {
  candidate_.last_submap_node = -1;
  EXPECT_EQ(Edge().a, VertexId(NodeId{0, 10}));
  EXPECT_NEAR(Edge().pose.pose.x, 4.2, 1e-12);
}

TEST_F(CandidateEdgeTest, AtTheSubmapWhereNoPathIsKnown) {
  candidate_.anchor.reset();
  EXPECT_EQ(Edge().a, VertexId(SubmapId{0, 1}));
  EXPECT_NEAR(Edge().pose.pose.x, 4.2, 1e-12);
  // Nor is there one from a node that is not kept.
  candidate_.anchor = VertexId(NodeId{0, 500});
  candidate_.last_submap_node = -1;
  EXPECT_EQ(Edge().a, VertexId(SubmapId{0, 1}));
}

TEST_F(CandidateEdgeTest, AtTheSubmapBetweenTrajectories) {
  candidate_.node = NodeId{1, 90};
  EXPECT_EQ(Edge().a, VertexId(SubmapId{0, 1}));
  EXPECT_EQ(Edge().b, VertexId(NodeId{1, 90}));
}

// The scan was levelled; the loop is that of the tracking frame.
TEST_F(CandidateEdgeTest, IsInTheTrackingFrame) {
  candidate_.aligned_from_tracking = Pose2(0., 0., 0.1);
  EXPECT_NEAR(Edge().pose.pose.theta, 0.4, 1e-12);
}

}  // namespace
}  // namespace loop_closure
}  // namespace cartographer_ext
