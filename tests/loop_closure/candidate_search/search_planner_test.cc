// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
#include "cartographer_ext/loop_closure/candidate_search/search_planner.h"

#include <cmath>
#include <memory>
#include <vector>

#include "gtest/gtest.h"
#include "tests/uncertainty/random_walk.h"

namespace cartographer_ext {
namespace loop_closure {
namespace {

using proto::LoopDecision;

// A straight path of 200 m, a node every metre. Only the translation is
// uncertain, 0.1 m per root metre.
class SearchPlannerTest : public testing::Test {
 protected:
  SearchPlannerTest() : paths_(Noise(), 1000) {
    for (int i = 0; i <= 200; ++i) {
      paths_.Add(uncertainty::NodeId{0, i}, Pose2(i, 0., 0.));
    }
    options_.window_sigmas = 3.;
    options_.min_linear_window = 1.;
    options_.max_linear_window = 4.;
    options_.min_angular_window = 0.2;
    options_.max_searches_per_node = 2;
    options_.redundant_distance = 5.;
    options_.search_spacing = 2.;
    options_.informative_sigma = 0.15;
  }

  static uncertainty::PathNoiseOptions Noise() {
    uncertainty::PathNoiseOptions noise = uncertainty::RandomWalk();
    noise.translation_per_metre = 0.1;
    noise.translation_per_radian = 0.;
    noise.rotation_per_metre = 0.;
    noise.rotation_per_radian = 0.;
    return noise;
  }

  static Eigen::Matrix3d LoopCovariance() {
    return Eigen::Vector3d(0.01, 0.01, 0.).asDiagonal();
  }

  void MakePlanner() {
    planner_.reset(
        new SearchPlanner(options_, LoopCovariance(), 15., 7., 0.5, &paths_));
  }

  // Submap `s` has its origin at node `anchor`; the node is predicted `x`
  // metres from it.
  static LoopCandidate Pair(int s, int anchor, int node, double x) {
    LoopCandidate pair;
    pair.submap.submap_index = s;
    pair.anchor = uncertainty::NodeId{0, anchor};
    pair.node = uncertainty::NodeId{0, node};
    pair.predicted = Pose2(x, 0., 0.);
    return pair;
  }

  static LoopCandidate Accepted(const int submap, const int64_t node_time) {
    LoopCandidate accepted;
    accepted.submap.submap_index = submap;
    accepted.node_time = node_time;
    return accepted;
  }

  SearchPlan PlanOne(const LoopCandidate& pair) {
    return planner_->Plan({&pair}).front();
  }

  std::vector<SearchPlan> PlanAll(const std::vector<LoopCandidate>& pairs) {
    std::vector<const LoopCandidate*> candidates;
    for (const LoopCandidate& pair : pairs) candidates.push_back(&pair);
    return planner_->Plan(candidates);
  }

  uncertainty::PathUncertainty paths_;
  SearchPlannerOptions options_;
  std::unique_ptr<SearchPlanner> planner_;
};

TEST_F(SearchPlannerTest, WindowFollowsTheUncertaintyOfThePath) {
  MakePlanner();
  const SearchPlan plan = PlanOne(Pair(0, 0, 100, 3.));
  EXPECT_EQ(plan.skipped, LoopDecision::NONE);
  EXPECT_FALSE(plan.full_submap);
  EXPECT_NEAR(plan.translation_sigma, 1., 1e-12);
  EXPECT_NEAR(plan.linear_window, 3., 1e-12);
  EXPECT_EQ(plan.angular_window, 0.2);
  // A short path: the smallest window.
  EXPECT_EQ(PlanOne(Pair(1, 0, 4, 3.)).linear_window, 1.);
}

TEST_F(SearchPlannerTest, CountsThePlacesProposedForANode) {
  MakePlanner();
  const std::vector<SearchPlan> plans = PlanAll(
      {Pair(0, 0, 100, 3.), Pair(1, 10, 100, 300.), Pair(2, 0, 50, 3.)});
  EXPECT_TRUE(plans[1].out_of_reach);
  EXPECT_EQ(plans[0].num_places, 2);
  EXPECT_EQ(plans[2].num_places, 1);
}

TEST_F(SearchPlannerTest, SearchesTheWholeSubmapWhereTheWindowIsTooSmall) {
  MakePlanner();
  const SearchPlan plan = PlanOne(Pair(0, 0, 200, 3.));
  EXPECT_TRUE(plan.full_submap);
  // 15 m and three times the square root of two.
  EXPECT_FALSE(PlanOne(Pair(1, 0, 200, 19.)).out_of_reach);
  EXPECT_TRUE(PlanOne(Pair(2, 0, 200, 19.3)).out_of_reach);
  options_.global_search = false;
  MakePlanner();
  const SearchPlan bounded = PlanOne(Pair(0, 0, 200, 3.));
  EXPECT_FALSE(bounded.full_submap);
  EXPECT_EQ(bounded.linear_window, 4.);
}

TEST_F(SearchPlannerTest, WithoutAnchorTheDefaultWindowHolds) {
  MakePlanner();
  LoopCandidate pair = Pair(0, 0, 100, 3.);
  pair.anchor.reset();
  const SearchPlan plan = PlanOne(pair);
  EXPECT_EQ(plan.linear_window, 7.);
  EXPECT_EQ(plan.angular_window, 0.5);
  EXPECT_EQ(plan.translation_sigma, 0.);
  pair.predicted->x = 15.1;
  EXPECT_TRUE(PlanOne(pair).out_of_reach);
}

TEST_F(SearchPlannerTest, SkipsWhatIsUninformative) {
  MakePlanner();
  EXPECT_EQ(PlanOne(Pair(0, 0, 2, 2.)).skipped,
            LoopDecision::SKIPPED_UNINFORMATIVE);
  EXPECT_EQ(PlanOne(Pair(0, 0, 3, 3.)).skipped, LoopDecision::NONE);
}

TEST_F(SearchPlannerTest, SpacesSearchesOfASubmap) {
  MakePlanner();
  EXPECT_EQ(PlanOne(Pair(0, 0, 100, 3.)).skipped, LoopDecision::NONE);
  EXPECT_EQ(PlanOne(Pair(0, 0, 101, 3.)).skipped,
            LoopDecision::SKIPPED_SPACING);
  EXPECT_EQ(PlanOne(Pair(0, 0, 99, 3.)).skipped, LoopDecision::SKIPPED_SPACING);
  EXPECT_EQ(PlanOne(Pair(1, 0, 101, 3.)).skipped, LoopDecision::NONE);
  EXPECT_EQ(PlanOne(Pair(0, 0, 102, 3.)).skipped, LoopDecision::NONE);
  planner_->DeleteSubmap(uncertainty::SubmapId{0, 0});
  EXPECT_EQ(PlanOne(Pair(0, 0, 101, 3.)).skipped, LoopDecision::NONE);
}

TEST_F(SearchPlannerTest, AcceptedLoopsNarrowTheWindowAndRestTheSubmap) {
  MakePlanner();
  uncertainty::LoopEdge loop;
  loop.a = uncertainty::NodeId{0, 10};
  loop.b = uncertainty::NodeId{0, 150};
  loop.pose.covariance = LoopCovariance();
  planner_->AddAcceptedLoop(Accepted(7, 0), loop);
  // 10 m before the loop, 9 m behind it, and the loop itself.
  const SearchPlan plan = PlanOne(Pair(1, 0, 159, 3.));
  EXPECT_NEAR(plan.translation_sigma, std::sqrt(0.1 + 0.09 + 0.01), 1e-12);
  EXPECT_EQ(PlanOne(Pair(7, 10, 154, 3.)).skipped,
            LoopDecision::SKIPPED_REDUNDANT);
  EXPECT_EQ(PlanOne(Pair(7, 10, 155, 3.)).skipped, LoopDecision::NONE);
}

TEST_F(SearchPlannerTest, AfterSomeTimeASubmapIsSearchedAgain) {
  options_.redundant_time = 10.;
  MakePlanner();
  LoopCandidate pair = Pair(0, 0, 100, 3.);
  pair.node_time = 1000000000;
  EXPECT_EQ(PlanOne(pair).skipped, LoopDecision::NONE);
  pair.node.node_index = 101;
  pair.node_time += 100000000;
  EXPECT_EQ(PlanOne(pair).skipped, LoopDecision::SKIPPED_SPACING);
  pair.node_time += 1;
  EXPECT_EQ(PlanOne(pair).skipped, LoopDecision::NONE);

  uncertainty::LoopEdge loop;
  loop.a = uncertainty::NodeId{0, 10};
  loop.b = uncertainty::NodeId{0, 150};
  loop.pose.covariance = LoopCovariance();
  planner_->AddAcceptedLoop(Accepted(7, 1000000000), loop);
  pair = Pair(7, 10, 153, 3.);
  pair.node_time = 1100000000;
  EXPECT_EQ(PlanOne(pair).skipped, LoopDecision::SKIPPED_REDUNDANT);
  pair.node_time = 1100000001;
  EXPECT_EQ(PlanOne(pair).skipped, LoopDecision::NONE);
}

TEST_F(SearchPlannerTest, CapsTheSearchesOfANode) {
  MakePlanner();
  // Of equal uncertainty; the nearest are the most promising.
  const std::vector<SearchPlan> plans =
      PlanAll({Pair(0, 0, 100, 14.), Pair(1, 0, 100, 2.), Pair(2, 0, 100, 12.),
               Pair(3, 0, 100, 1.)});
  EXPECT_EQ(plans[0].skipped, LoopDecision::SKIPPED_BUDGET);
  EXPECT_EQ(plans[1].skipped, LoopDecision::NONE);
  EXPECT_EQ(plans[2].skipped, LoopDecision::SKIPPED_BUDGET);
  EXPECT_EQ(plans[3].skipped, LoopDecision::NONE);
  // What was skipped may be searched from the next node.
  EXPECT_EQ(PlanOne(Pair(0, 0, 101, 14.)).skipped, LoopDecision::NONE);
}

TEST_F(SearchPlannerTest, SixWholeSubmapsANode) {
  options_.max_searches_per_node = 100;
  MakePlanner();
  std::vector<LoopCandidate> pairs;
  for (int i = 0; i < 8; ++i) pairs.push_back(Pair(i, 0, 200, 3.));
  const std::vector<SearchPlan> plans = PlanAll(pairs);
  for (int i = 0; i < 8; ++i) {
    EXPECT_TRUE(plans[i].full_submap) << i;
    EXPECT_EQ(plans[i].skipped,
              i < 6 ? LoopDecision::NONE : LoopDecision::SKIPPED_BUDGET)
        << i;
  }
}

TEST_F(SearchPlannerTest, LoopsOfADeletedTrajectoryNoLongerPredict) {
  MakePlanner();
  uncertainty::LoopEdge loop;
  loop.a = uncertainty::NodeId{0, 10};
  loop.b = uncertainty::NodeId{0, 150};
  loop.pose.covariance = LoopCovariance();
  planner_->AddAcceptedLoop(Accepted(7, 0), loop);
  planner_->DeleteTrajectory(1);
  EXPECT_LT(PlanOne(Pair(1, 0, 159, 3.)).translation_sigma, 0.5);
  planner_->DeleteTrajectory(0);
  EXPECT_GT(PlanOne(Pair(2, 0, 159, 3.)).translation_sigma, 1.2);
}

TEST_F(SearchPlannerTest, ForgottenLoopsNoLongerPredict) {
  // Run 1 in the map of run 0.
  const uncertainty::SubmapId submap{0, 0};
  paths_.Add(submap, Pose2());
  for (int i = 0; i <= 20; ++i)
    paths_.Add(uncertainty::NodeId{1, i}, Pose2(i, 0., 0.));
  options_.search_spacing = 0.;
  MakePlanner();
  LoopCandidate pair;
  pair.anchor = submap;
  pair.predicted = Pose2();
  pair.node = uncertainty::NodeId{1, 16};
  // Nothing is known about it.
  EXPECT_EQ(PlanOne(pair).linear_window, 7.);
  uncertainty::LoopEdge loop;
  loop.a = submap;
  loop.b = uncertainty::NodeId{1, 10};
  loop.pose.covariance = LoopCovariance();
  planner_->AddAcceptedLoop(Accepted(0, 0), loop);
  pair.node = uncertainty::NodeId{1, 20};
  EXPECT_LT(PlanOne(pair).linear_window, 2.);
  // Not up to there, or of another map.
  planner_->ForgetLoops(1, 0, 9);
  planner_->ForgetLoops(1, 3, 30);
  planner_->ForgetLoops(2, 0, 30);
  pair.node = uncertainty::NodeId{1, 17};
  EXPECT_EQ(PlanOne(pair).skipped, LoopDecision::NONE);
  pair.node = uncertainty::NodeId{1, 12};
  EXPECT_EQ(PlanOne(pair).skipped, LoopDecision::SKIPPED_REDUNDANT);
  planner_->ForgetLoops(1, 0, 10);
  const SearchPlan plan = PlanOne(pair);
  EXPECT_EQ(plan.skipped, LoopDecision::NONE);
  EXPECT_EQ(plan.linear_window, 7.);
}

// Submaps that many loops constrain share a limit per node, and one record.
TEST_F(SearchPlannerTest, OfSaturatedSubmapsTheNearestIsSearched) {
  options_.max_searches_per_node = 8;
  options_.saturating_loops = 3;
  options_.saturated_sigma = 2.;
  MakePlanner();
  const auto saturate = [&](const int submap, const int num_loops) {
    for (int i = 0; i < num_loops; ++i) {
      LoopCandidate accepted = Accepted(submap, 0);
      uncertainty::LoopEdge loop;
      loop.a = uncertainty::NodeId{0, 0};
      loop.b = uncertainty::NodeId{0, 10 * (i + 1)};
      loop.pose.covariance = Eigen::Vector3d(9., 9., 0.).asDiagonal();
      planner_->AddAcceptedLoop(accepted, loop);
    }
  };
  for (const int submap : {0, 1, 2}) saturate(submap, 3);
  saturate(3, 2);
  const auto plans = PlanAll({Pair(0, 0, 100, 9.), Pair(1, 0, 100, 4.),
                              Pair(2, 0, 100, 6.), Pair(3, 0, 100, 9.)});
  EXPECT_EQ(plans[1].skipped, LoopDecision::NONE);
  EXPECT_EQ(plans[3].skipped, LoopDecision::NONE);
  EXPECT_EQ(plans[2].skipped, LoopDecision::SKIPPED_UNINFORMATIVE);
  EXPECT_FALSE(plans[2].out_of_reach);
  EXPECT_TRUE(plans[0].out_of_reach);
  // While the place is uncertain (one metre), all are.
  options_.saturated_sigma = 0.9;
  MakePlanner();
  for (const int submap : {0, 1, 2}) saturate(submap, 3);
  for (const SearchPlan& plan :
       PlanAll({Pair(0, 0, 100, 9.), Pair(1, 0, 100, 4.)})) {
    EXPECT_EQ(plan.skipped, LoopDecision::NONE);
    EXPECT_FALSE(plan.out_of_reach);
  }
}

// A place that three passes are tied to needs no fourth one.
TEST_F(SearchPlannerTest, OfPlacesWithEnoughPassesTheNearestIsSearched) {
  options_.max_searches_per_node = 8;
  options_.max_passes_per_place = 3;
  MakePlanner();
  for (const int submap : {0, 1}) {
    for (const int node : {20, 40, 60}) {
      LoopCandidate accepted = Accepted(submap, 0);
      accepted.match.refined = Pose2(3.5, 0., 0.);
      uncertainty::LoopEdge loop;
      loop.a = uncertainty::NodeId{0, 0};
      loop.b = uncertainty::NodeId{0, node};
      loop.pose.covariance = LoopCovariance();
      planner_->AddAcceptedLoop(accepted, loop);
    }
  }
  // 0.64 m: the root of the loop and 40 m.
  std::vector<SearchPlan> plans =
      PlanAll({Pair(0, 0, 100, 3.), Pair(1, 0, 100, 3.5), Pair(1, 0, 101, 7.)});
  EXPECT_EQ(plans[0].skipped, LoopDecision::NONE);
  EXPECT_EQ(plans[1].skipped, LoopDecision::SKIPPED_UNINFORMATIVE);
  EXPECT_EQ(plans[2].skipped, LoopDecision::NONE);  // another place
  // A node later the nearest has been searched a moment ago; that is enough.
  plans = PlanAll({Pair(0, 0, 101, 3.), Pair(1, 0, 101, 3.5)});
  EXPECT_EQ(plans[0].skipped, LoopDecision::SKIPPED_SPACING);
  EXPECT_EQ(plans[1].skipped, LoopDecision::SKIPPED_UNINFORMATIVE);
  // 0.24 m, less than three standard deviations of a loop.
  EXPECT_EQ(PlanOne(Pair(0, 0, 65, 3.)).skipped,
            LoopDecision::SKIPPED_UNINFORMATIVE);
  EXPECT_EQ(PlanOne(Pair(0, 0, 65, 7.)).skipped, LoopDecision::NONE);
}

// A third of the smallest window, 1 m and 0.2 rad, is added to what is known.
TEST_F(SearchPlannerTest, ExpectedCovarianceByHand) {
  SearchPlan plan;
  plan.linear_window = 3.;
  plan.angular_window = 0.6;
  Eigen::Matrix3d expected = ExpectedCovariance(options_, plan);
  EXPECT_NEAR(expected(0, 0), 1. + 1. / 9., 1e-12);
  EXPECT_NEAR(expected(1, 1), 1. + 1. / 9., 1e-12);
  EXPECT_NEAR(expected(2, 2), 0.04 + 0.04 / 9., 1e-12);
  Eigen::Matrix3d covariance = Eigen::Vector3d(4., 0.25, 0.01).asDiagonal();
  covariance(0, 1) = covariance(1, 0) = 0.3;
  SetWindow(options_, covariance, &plan);
  expected = ExpectedCovariance(options_, plan);
  EXPECT_NEAR(expected(0, 0), 4. + 1. / 9., 1e-12);
  EXPECT_NEAR(expected(0, 1), 0.3, 1e-12);
  EXPECT_NEAR(expected(1, 1), 0.25 + 1. / 9., 1e-12);
  EXPECT_NEAR(expected(2, 2), 0.01 + 0.04 / 9., 1e-12);
}

// A submap that has just been finished meets the nodes of all earlier laps.
TEST_F(SearchPlannerTest, OfOlderNodesAFewPassesAreSearchedAtEachPlace) {
  options_.max_passes_per_place = 3;
  const auto num_searched = [&](const double spacing) {
    MakePlanner();
    std::vector<LoopCandidate> pairs;
    for (int pass = 0; pass != 5; ++pass) {
      // Two searches of one pass.
      for (const int node : {20 * pass, 20 * pass + 3}) {
        pairs.push_back(Pair(0, 120, node, 3. + spacing * pass));
      }
    }
    int result = 0;
    for (const SearchPlan& plan : PlanAll(pairs)) result += plan.is_searched();
    return result;
  };
  options_.saturated_sigma = 1.2;
  EXPECT_EQ(num_searched(0.), 6);
  // At five places, and where nothing is known well.
  EXPECT_EQ(num_searched(2.5), 10);
  options_.saturated_sigma = 0.3;
  EXPECT_EQ(num_searched(0.), 10);
}

}  // namespace
}  // namespace loop_closure
}  // namespace cartographer_ext
