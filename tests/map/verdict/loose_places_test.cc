// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
#include "cartographer_ext/map/verdict/loose_places.h"

#include <cmath>
#include <vector>

#include "gmock/gmock.h"
#include "gtest/gtest.h"

namespace cartographer_ext {
namespace evaluation {
namespace {

constexpr double kStep = 0.5;  // metres between nodes
constexpr int kOneWay = 400;   // nodes

void AddNode(const Pose2& pose, MapGraph* const graph) {
  GraphNode node;
  node.local_pose = pose;
  node.global_pose = pose;
  graph->nodes[{0, static_cast<int>(graph->nodes.size())}] = node;
}

MapGraph Straight() {
  MapGraph graph;
  for (int i = 0; i < kOneWay; ++i) AddNode(Pose2(kStep * i, 0., 0.), &graph);
  return graph;
}

// A street of 200 m, driven along and, after a half circle, back again at this
// distance.
MapGraph ThereAndBack(const double distance) {
  MapGraph graph = Straight();
  const double end = kStep * (kOneWay - 1);
  const double radius = 0.5 * distance;
  const double turn = kStep / radius;
  for (double angle = turn; angle < kPi - 0.5 * turn; angle += turn) {
    AddNode(Pose2(end + radius * std::sin(angle),
                  radius * (1. - std::cos(angle)), angle),
            &graph);
  }
  for (int i = kOneWay - 1; i >= 0; --i) {
    AddNode(Pose2(kStep * i, distance, kPi), &graph);
  }
  return graph;
}

// Every tenth node of the way back sees the way there, the last one first.
std::vector<RevisitTie> Ties(const MapGraph& graph,
                             const Eigen::Vector2d& information) {
  const int last = static_cast<int>(graph.nodes.size()) - 1;
  std::vector<RevisitTie> ties;
  for (int i = 0; i < kOneWay; i += 10) {
    RevisitTie tie;
    tie.node_id = {0, last - i};
    tie.anchor_id = {0, i};
    tie.information = information.asDiagonal();
    ties.push_back(tie);
  }
  return ties;
}

TEST(LoosePlacesTest, WaysSideBySideThatNothingTiesAreLoose) {
  const LoosePlaces result = FindLoosePlaces(ThereAndBack(6.), {}, {});
  EXPECT_GE(result.looked_at, 130);
  EXPECT_LE(result.looked_at, 151);
  // One of the two, but for the path near the turn, which is fixed by itself.
  EXPECT_GT(result.share(), 0.3);
  EXPECT_LE(result.share(), 0.5);
  for (const LoosePlace& place : result.places) {
    EXPECT_GT(place.sigma, 0.25);
    EXPECT_GE(place.distance, 6.);
    EXPECT_GT(std::abs(place.node_id.index - kOneWay), 20);
  }
  // Drift may have moved the first node the farthest against the last ones.
  ASSERT_EQ(result.places.front().node_id, (GraphId{0, 0}));
  EXPECT_GT(result.places.front().sigma, 3.);
}

TEST(LoosePlacesTest, TiesFixThem) {
  const MapGraph graph = ThereAndBack(6.);
  std::vector<RevisitTie> ties = Ties(graph, Eigen::Vector2d(100., 100.));
  EXPECT_EQ(FindLoosePlaces(graph, ties, {}).share(), 0.);
  // Only over the quarter that is farthest from the turn.
  ties.resize(10);
  EXPECT_LT(FindLoosePlaces(graph, ties, {}).share(),
            0.6 * FindLoosePlaces(graph, {}, {}).share());
}

TEST(LoosePlacesTest, BlankWallsDoNotFixThePlaceAlongThem) {
  const MapGraph graph = ThereAndBack(3.);
  EXPECT_EQ(FindLoosePlaces(graph, Ties(graph, Eigen::Vector2d(100., 100.)), {})
                .share(),
            0.);
  EXPECT_GT(FindLoosePlaces(graph, Ties(graph, Eigen::Vector2d(0., 100.)), {})
                .share(),
            0.4);
}

// However few places stand for a long path.
TEST(LoosePlacesTest, PathsSideBySideThatAreKnownToLieApartAreNotLoose) {
  const MapGraph graph = ThereAndBack(8.);
  // They are known against each other to some decimetres.
  const std::vector<RevisitTie> ties = Ties(graph, Eigen::Vector2d(1., 1.));
  LoosePlaceOptions options;
  options.max_places = 30;  // 13 metres apart
  const LoosePlaces result = FindLoosePlaces(graph, ties, options);
  EXPECT_LE(result.looked_at, 32);
  EXPECT_EQ(result.share(), 0.);
  // As they are where they may be one path.
  EXPECT_GT(FindLoosePlaces(ThereAndBack(2.), {}, options).share(), 0.4);
}

// Local SLAM has aligned them already.
TEST(LoosePlacesTest, AScanThatAgreesWithTheWayJustDrivenTiesNothing) {
  const MapGraph graph = ThereAndBack(6.);
  std::vector<RevisitTie> ties;
  for (int i = 50; i < static_cast<int>(graph.nodes.size()); ++i) {
    RevisitTie tie;
    tie.node_id = {0, i};
    tie.anchor_id = {0, i - 50};
    tie.information = 1e4 * Eigen::Matrix2d::Identity();
    // Around the turn the robot does come back.
    if (std::abs(i - kOneWay - 25) > 60) ties.push_back(tie);
  }
  EXPECT_EQ(FindLoosePlaces(graph, ties, {}).share(),
            FindLoosePlaces(graph, {}, {}).share());
}

TEST(LoosePlacesTest, WaysOutOfReachAreNot) {
  EXPECT_EQ(FindLoosePlaces(Straight(), {}, {}).share(), 0.);
}

TEST(LoosePlacesTest, AnotherTrajectoryMayBeAnywhere) {
  MapGraph graph = Straight();
  for (int i = 0; i < 10; ++i) {
    graph.nodes[{1, i}] = graph.nodes.at({0, i});
    graph.nodes[{1, i}].global_pose.y = 50.;
  }
  // It is the smaller part; the other may be anywhere only as seen from it.
  const LoosePlaces result = FindLoosePlaces(graph, {}, {});
  ASSERT_EQ(result.places.size(), 4);
  for (const LoosePlace& place : result.places) {
    EXPECT_EQ(place.node_id.trajectory_id, 1);
    EXPECT_EQ(place.other_id.trajectory_id, 0);
    EXPECT_GT(place.sigma, 100.);
  }
}

TEST(LoosePlacesTest, EmptyMap) {
  const LoosePlaces result = FindLoosePlaces({}, {}, {});
  EXPECT_EQ(result.looked_at, 0);
  EXPECT_EQ(result.share(), 0.);
}

}  // namespace
}  // namespace evaluation
}  // namespace cartographer_ext
