// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
//
// What the search planner plans for a robot that drives the same route again
// and again.
#include <cmath>
#include <memory>
#include <vector>

#include "cartographer_ext/loop_closure/candidate_search/search_planner.h"
#include "gtest/gtest.h"

namespace cartographer_ext {
namespace loop_closure {
namespace {

// A robot that patrols along a ring of 60 m, a node every half metre, a submap
// every 5 m. What is searched is found, in rounds of 30 nodes.
class PatrolTest : public testing::Test {
 protected:
  static constexpr int kNodesPerLap = 120;
  static constexpr int kNodesPerSubmap = 10;

  struct Lap {
    int planned = 0;
    int searched = 0;
  };

  PatrolTest() {
    options_.saturating_loops = 30;
    // Otherwise it hides what this is about.
    options_.max_searches_per_node = 100;
  }

  static Pose2 At(const int node) {
    const double angle = 2. * kPi * node / kNodesPerLap;
    const double radius = 60. / (2. * kPi);
    return Pose2(radius * std::cos(angle), radius * std::sin(angle),
                 angle + 0.5 * kPi);
  }

  std::vector<Lap> Drive(const int num_laps) {
    const Eigen::Matrix3d covariance =
        Eigen::Vector3d(2.5e-3, 2.5e-3, 1e-4).asDiagonal();
    paths_.reset(new uncertainty::PathUncertainty(
        uncertainty::PathNoiseOptions(), max_vertices_));
    SearchPlanner planner(options_, covariance, 15., 7., 0.5, paths_.get());
    std::vector<Lap> laps(num_laps);
    std::vector<LoopCandidate> found;
    for (int node = 0; node < num_laps * kNodesPerLap; ++node) {
      Lap& lap = laps[node / kNodesPerLap];
      paths_->Add(uncertainty::NodeId{0, node}, At(node));
      std::vector<LoopCandidate> pairs = Propose(node, &planner);
      if (node % kNodesPerSubmap == 1) ProposeNewSubmap(node, &planner, &pairs);
      std::vector<const LoopCandidate*> candidates;
      for (const LoopCandidate& pair : pairs) candidates.push_back(&pair);
      const std::vector<SearchPlan> plans = planner.Plan(candidates);
      lap.planned += pairs.size();
      for (size_t i = 0; i < pairs.size(); ++i) {
        if (!plans[i].is_searched()) continue;
        ++lap.searched;
        if (pairs[i].predicted->translation().norm() < 8.) {
          found.push_back(pairs[i]);
        }
      }
      if (node % 30 != 0) continue;
      for (const LoopCandidate& accepted : found) {
        if (!accepted.anchor.has_value()) continue;
        uncertainty::LoopEdge loop;
        loop.a = *accepted.anchor;
        loop.b = accepted.node;
        loop.pose.pose = *accepted.predicted;
        loop.pose.covariance = covariance;
        planner.AddAcceptedLoop(accepted, loop);
      }
      found.clear();
    }
    return laps;
  }

  void AddPair(const int submap, const int node, SearchPlanner* const planner,
               std::vector<LoopCandidate>* const pairs) const {
    const int begin = submap * kNodesPerSubmap;
    LoopCandidate pair;
    pair.submap.submap_index = submap;
    const uncertainty::NodeId anchor{0, begin};
    if (paths_->LocalPose(anchor).has_value()) pair.anchor = anchor;
    pair.node = uncertainty::NodeId{0, node};
    pair.node_time = node * int64_t{10000000};
    pair.predicted = Between(At(begin), At(node));
    if (!planner->CanIgnore(pair.submap, pair.anchor, pair.node, pair.node_time,
                            pair.predicted->translation().norm())) {
      pairs->push_back(pair);
    }
  }

  // The pairs of a node with the finished submaps.
  std::vector<LoopCandidate> Propose(const int node,
                                     SearchPlanner* const planner) const {
    std::vector<LoopCandidate> pairs;
    for (int submap = 0; (submap + 2) * kNodesPerSubmap < node; ++submap) {
      AddPair(submap, node, planner, &pairs);
    }
    return pairs;
  }

  // Those of a submap that has just been finished with all older nodes.
  void ProposeNewSubmap(const int node, SearchPlanner* const planner,
                        std::vector<LoopCandidate>* const pairs) const {
    const int submap = node / kNodesPerSubmap - 2;
    for (int old = 0; old < submap * kNodesPerSubmap; ++old) {
      AddPair(submap, old, planner, pairs);
    }
  }

  SearchPlannerOptions options_;
  int max_vertices_ = 100000;
  std::unique_ptr<uncertainty::PathUncertainty> paths_;
};

constexpr int PatrolTest::kNodesPerLap;
constexpr int PatrolTest::kNodesPerSubmap;

TEST_F(PatrolTest, ANodeOfALateLapCostsNoMoreThanOneOfAnEarlyOne) {
  const std::vector<Lap> laps = Drive(12);
  // The second lap closes loops with the first.
  EXPECT_GT(laps[1].searched, 2 * kNodesPerLap);
  for (size_t i = 4; i < laps.size(); ++i) {
    EXPECT_LE(laps[i].searched, 1.2 * laps[2].searched) << i;
    EXPECT_GE(laps[i].searched, kNodesPerLap / 8) << i;
  }
  // Without the bound every old submap is searched.
  options_.saturating_loops = 1000000;
  const std::vector<Lap> unbounded = Drive(6);
  EXPECT_GT(unbounded[5].searched, 1.5 * unbounded[2].searched);
  EXPECT_LT(laps[11].planned - laps[10].planned,
            0.4 * (unbounded[5].planned - unbounded[4].planned));
}

TEST_F(PatrolTest, ForgottenSubmapsDoNotAddSearches) {
  max_vertices_ = 3 * kNodesPerLap;
  const std::vector<Lap> laps = Drive(10);
  for (size_t i = 4; i < laps.size(); ++i) {
    EXPECT_LE(laps[i].searched, 1.2 * laps[2].searched) << i;
    EXPECT_GE(laps[i].searched, kNodesPerLap / 8) << i;
  }
}

}  // namespace
}  // namespace loop_closure
}  // namespace cartographer_ext
