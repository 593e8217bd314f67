// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
#include "cartographer_ext/optimization/solvers/incremental_smoother.h"

#include <cmath>

#include "cartographer_ext/experiments/outliers/outlier_generator.h"
#include "cartographer_ext/optimization/offline/graph_metrics.h"
#include "gmock/gmock.h"
#include "tests/optimization/test_graphs.h"

namespace cartographer_ext {
namespace optimization {
namespace {

using ::testing::HasSubstr;

std::vector<std::vector<PoseGraphEdge>> ByPose(const PoseGraph& graph) {
  std::vector<std::vector<PoseGraphEdge>> result(graph.poses.size());
  for (const PoseGraphEdge& edge : graph.edges) {
    result[std::max(edge.from, edge.to)].push_back(edge);
  }
  return result;
}

TEST(IncrementalSmootherTest, SwitchOfACertainPose) {
  // Q = 0: s = w / (w + chi2), equation (8) of the ACS paper.
  const double s =
      MinimizeSwitch(Eigen::Vector3d(2., 0., 1.), Eigen::Vector3d::Zero(), 1.5);
  EXPECT_NEAR(s, 1.5 / (1.5 + 3.), 1e-6);
}

TEST(IncrementalSmootherTest, SwitchGrowsWithTheUncertainty) {
  const Eigen::Vector3d innovation(400., 0., 0.);
  double last = 0.;
  for (const double variance : {0., 10., 100., 1000.}) {
    const double s = MinimizeSwitch(
        innovation, Eigen::Vector3d::Constant(variance), kChi2Gate);
    EXPECT_GE(s, last - 1e-9);
    EXPECT_LE(s, 1.);
    last = s;
  }
  // 20 sigma of the loop but within one of the prediction: believed.
  EXPECT_GT(last, 0.9);
}

TEST(IncrementalSmootherTest, SwitchIsTheMinimum) {
  const Eigen::Vector3d u(30., 3., 0.5), q(5., 20., 0.1);
  const double s = MinimizeSwitch(u, q, 4.);
  const auto cost = [&](const double t) {
    double sum = 4. * (1. - t) * (1. - t);
    for (int i = 0; i != 3; ++i) sum += u[i] * t * t / (1. + t * t * q[i]);
    return sum;
  };
  for (double t = 0.; t <= 1.; t += 1e-3) {
    EXPECT_LE(cost(s), cost(t) + 1e-6);
  }
}

TEST(IncrementalSmootherTest, CleanGraphEndsAtTheBatchOptimum) {
  const test::GridWorld world = test::MakeGridWorld(330, 8, 4);
  ReplayResult result;
  ASSERT_TRUE(Replay(world.graph, SmootherOptions(), &result).ok());
  std::vector<Pose2> optimum = world.graph.poses;
  SolveRobust(Whiten(world.graph.edges), SolverOptions(), &optimum);
  EXPECT_LT(AbsoluteTrajectoryError(result.poses, optimum), 0.02);
  EXPECT_EQ(result.step_seconds.size(), 329u);
  int accepted = 0, total = 0;
  for (size_t i = 0; i != world.graph.edges.size(); ++i) {
    if (!world.graph.edges[i].is_loop) continue;
    ++total;
    accepted += result.accepted[i];
  }
  EXPECT_GT(accepted, 0.97 * total);
}

TEST(IncrementalSmootherTest, SurvivesOutliers) {
  test::GridWorld world = test::MakeGridWorld(330, 8, 4);
  std::vector<Pose2> optimum = world.graph.poses;
  SolveRobust(Whiten(world.graph.edges), SolverOptions(), &optimum);
  const size_t clean = world.graph.edges.size();
  test::AddOutliers(test::Outliers(100), &world.graph);
  for (const SwitchEstimate estimate :
       {SwitchEstimate::kPointwise, SwitchEstimate::kJoint}) {
    SmootherOptions options;
    options.switch_estimate = estimate;
    if (estimate == SwitchEstimate::kJoint) {
      options.switch_penalty = kChi2Gate;
    }
    ReplayResult result;
    ASSERT_TRUE(Replay(world.graph, options, &result).ok());
    EXPECT_LT(AbsoluteTrajectoryError(result.poses, optimum), 0.05);
    const LoopScore score =
        ScoreLoops(Whiten(world.graph.edges), clean, result.poses, optimum);
    EXPECT_GT(score.recall, 0.9);
    EXPECT_GT(score.precision, 0.97);
  }
}

// On a linear problem (all angles zero and certain) the increments must give
// the batch solution to rounding, in each step and across epochs.
TEST(IncrementalSmootherTest, LinearProblemMatchesBatchExactly) {
  Random random(8);
  PoseGraph graph;
  for (int i = 0; i != 60; ++i) {
    graph.ids.push_back(i);
    graph.poses.push_back(Pose2(i, 0., 0.));
    if (i == 0) continue;
    PoseGraphEdge edge;
    edge.from = i - 1;
    edge.to = i;
    edge.measurement =
        Pose2(1. + random.Normal(0., 0.01), random.Normal(0., 0.01), 0.);
    edge.information.diagonal() << 100., 100., 1e12;
    graph.edges.push_back(edge);
    if (i > 5) {
      edge.from = i - 5;
      edge.measurement =
          Pose2(5. + random.Normal(0., 0.01), random.Normal(0., 0.01), 0.);
      graph.edges.push_back(edge);
    }
  }
  SmootherOptions options;
  options.epoch_poses = 20;
  IncrementalSmoother smoother(options, graph.poses[0]);
  const auto edges = ByPose(graph);
  for (size_t k = 1; k != edges.size(); ++k) {
    ASSERT_TRUE(smoother.AddPose(edges[k], nullptr).ok());
    if (k % 7 != 0 && k % 20 != 0) continue;
    std::vector<Pose2> batch = smoother.poses();
    SolverOptions solver;
    solver.cost_tolerance = 0.;
    solver.initial_lambda = 0.;
    SolveRobust(smoother.edges(), solver, &batch);
    for (size_t i = 0; i != batch.size(); ++i) {
      EXPECT_NEAR(smoother.poses()[i].x, batch[i].x, 1e-8);
      EXPECT_NEAR(smoother.poses()[i].y, batch[i].y, 1e-8);
    }
  }
}

TEST(IncrementalSmootherTest, LateRejectionAndReadmission) {
  // A wrong loop comes before the true ones which contradict it.
  test::GridWorld world = test::MakeGridWorld(300, 6, 12);
  PoseGraphEdge wrong;
  wrong.from = 2;
  wrong.to = 18;
  wrong.is_loop = true;
  wrong.information = world.graph.edges[0].information;
  // Close enough to dead reckoning to be believed at first, yet not true.
  wrong.measurement = Between(world.graph.poses[2], world.graph.poses[18]) *
                      Pose2(0.05, 0.04, 0.02);
  world.graph.edges.push_back(wrong);
  SmootherOptions options;
  options.epoch_poses = 20;
  ReplayResult free, fixed;
  ASSERT_TRUE(Replay(world.graph, options, &free).ok());
  options.late_rejection = false;
  options.readmission = false;
  ASSERT_TRUE(Replay(world.graph, options, &fixed).ok());
  const double chi2 = Chi2(Whiten(wrong), free.poses[2], free.poses[18]);
  EXPECT_EQ(free.accepted.back(), chi2 < kChi2Gate);
  const std::vector<WhitenedEdge> edges = Whiten(world.graph.edges);
  EXPECT_LE(TruncatedCost(edges, free.poses),
            TruncatedCost(edges, fixed.poses) + 1e-6);
}

TEST(IncrementalSmootherTest, TheCapDelaysLoopsOnly) {
  const test::GridWorld world = test::MakeGridWorld(230, 6, 3);
  SmootherOptions options;
  options.max_loops_per_step = 1;
  IncrementalSmoother smoother(options, world.graph.poses[0]);
  const auto edges = ByPose(world.graph);
  for (size_t k = 1; k != edges.size(); ++k) {
    StepReport report;
    ASSERT_TRUE(smoother.AddPose(edges[k], &report).ok());
    EXPECT_LE(report.loops_tested, 1);
  }
  smoother.Finish();
  int accepted = 0, total = 0;
  for (size_t i = 0; i != smoother.edges().size(); ++i) {
    if (!smoother.edges()[i].is_loop) continue;
    ++total;
    accepted += smoother.accepted()[i];
  }
  EXPECT_GT(accepted, 0.95 * total);
}

// The second half comes with the next pose and changes nothing but the time.
TEST(IncrementalSmootherTest, AnEpochOfALargeMapEndsInTwoSteps) {
  test::GridWorld world = test::MakeGridWorld(330, 8, 4);
  test::AddOutliers(test::Outliers(60), &world.graph);
  SmootherOptions options;
  options.epoch_poses = 20;
  options.two_step_map = 100;
  IncrementalSmoother in_two_steps(options, world.graph.poses[0]);
  options.epoch_poses = 1000;
  IncrementalSmoother at_once(options, world.graph.poses[0]);
  const auto edges_of_pose = ByPose(world.graph);
  int split = 0;
  bool epoch = false;
  for (size_t k = 1; k != edges_of_pose.size(); ++k) {
    StepReport report;
    ASSERT_TRUE(in_two_steps.AddPose(edges_of_pose[k], &report).ok());
    ASSERT_TRUE(at_once.AddPose(edges_of_pose[k], nullptr).ok());
    if (epoch) {
      EXPECT_EQ(in_two_steps.factor_blocks(), at_once.factor_blocks()) << k;
    }
    epoch = report.epoch;
    if (!epoch) continue;
    at_once.EndEpoch();
    split += in_two_steps.factor_blocks() != at_once.factor_blocks();
  }
  EXPECT_GT(split, 5);
  in_two_steps.Finish();
  at_once.Finish();
  EXPECT_EQ(in_two_steps.accepted(), at_once.accepted());
  for (size_t k = 0; k != world.truth.size(); ++k) {
    EXPECT_EQ(in_two_steps.poses()[k].x, at_once.poses()[k].x);
    EXPECT_EQ(in_two_steps.poses()[k].y, at_once.poses()[k].y);
  }
}

// Nor does it solve the graph to the end in the first of them.
TEST(IncrementalSmootherTest, ALargeBatchSolutionIsDividedBetweenTwoSteps) {
  test::GridWorld world = test::MakeGridWorld(330, 8, 4);
  SmootherOptions options;
  options.epoch_cost_tolerance = 1e-12;  // takes more iterations
  options.two_step_map = 100;
  IncrementalSmoother smoother(options, world.graph.poses[0]);
  const auto edges_of_pose = ByPose(world.graph);
  int in_next_step = 0;
  bool epoch = false;
  for (size_t k = 1; k != edges_of_pose.size(); ++k) {
    StepReport report;
    ASSERT_TRUE(smoother.AddPose(edges_of_pose[k], &report).ok());
    if (epoch) in_next_step += report.batch_iterations;
    epoch = report.epoch && smoother.num_poses() > options.two_step_map;
    if (epoch) {
      EXPECT_LE(report.batch_iterations, 2);
    }
  }
  EXPECT_GT(in_next_step, 0);
}

// A way of 60 m and back with a bent odometry: all loops that are rejected at
// the end of the epoch lead to the same map.
TEST(IncrementalSmootherTest, LoopsThatLeadToTheSameMapAreOneHypothesis) {
  constexpr int kLength = 60;
  std::vector<Pose2> truth;
  for (int i = 0; i != 2 * kLength; ++i) {
    const bool back = i >= kLength;
    truth.push_back(back ? Pose2(2 * kLength - 1 - i, 0.5, kPi)
                         : Pose2(i, 0., 0.));
  }
  SmootherOptions options;
  options.epoch_poses = 1000;
  IncrementalSmoother smoother(options, truth[0]);
  for (int i = 1; i != 2 * kLength; ++i) {
    PoseGraphEdge odometry;
    odometry.from = i - 1;
    odometry.to = i;
    odometry.measurement = Between(truth[i - 1], truth[i]);
    odometry.measurement.theta += 0.002;
    odometry.information = Eigen::Vector3d(1e4, 1e4, 1e3).asDiagonal();
    std::vector<PoseGraphEdge> edges = {odometry};
    if (i > kLength + 20 && i % 2 == 0) {
      PoseGraphEdge loop;
      loop.from = 2 * kLength - 1 - i;
      loop.to = i;
      loop.measurement = Between(truth[loop.from], truth[i]);
      loop.information = Eigen::Vector3d(1e4, 1e4, 1e4).asDiagonal();
      loop.is_loop = true;
      edges.push_back(loop);
    }
    ASSERT_TRUE(smoother.AddPose(edges, nullptr).ok());
  }
  smoother.EndEpoch();
  EXPECT_EQ(smoother.num_hypotheses(), 1);
  for (const bool accepted : smoother.accepted()) EXPECT_TRUE(accepted);
}

PoseGraphEdge MakeEdge(const int from, const int to, const Pose2& measurement,
                       const double sigma, const double angle_sigma) {
  PoseGraphEdge edge;
  edge.from = from;
  edge.to = to;
  edge.measurement = measurement;
  edge.information = Eigen::Vector3d(1. / (sigma * sigma), 1. / (sigma * sigma),
                                     1. / (angle_sigma * angle_sigma))
                         .asDiagonal();
  edge.is_loop = to != from + 1;
  return edge;
}

// A lap of a circle of 100 m whose heading is off by a standard deviation, and
// metres with it, when the loop to its start comes.
TEST(IncrementalSmootherTest, ALargeMapTakesInWhatItsUncertaintyExplains) {
  constexpr int kLap = 100;
  for (const bool is_large : {false, true}) {
    SmootherOptions options;
    options.epoch_poses = 1000;
    options.max_hypotheses = 0;
    options.large_map = is_large ? 10 : 1000;
    IncrementalSmoother smoother(options, Pose2());
    for (int k = 1; k <= kLap; ++k) {
      const double turn = 2. * kPi / kLap;
      std::vector<PoseGraphEdge> edges = {
          MakeEdge(k - 1, k, Pose2(1., 0., turn + 0.002), 0.01, 0.02)};
      // The other side of the circle is not the start.
      if (k == 60 || k == kLap) {
        edges.push_back(MakeEdge(0, k, Pose2(), 0.05, 0.02));
      }
      if (k == kLap) smoother.EndEpoch();
      StepReport report;
      ASSERT_TRUE(smoother.AddPose(edges, &report).ok());
      EXPECT_EQ(report.loops_entered, is_large && k == kLap) << k;
    }
    const auto distance = [&] {
      return smoother.poses().back().translation().norm();
    };
    EXPECT_EQ(distance() < 0.5, is_large) << distance();
    smoother.EndEpoch();
    EXPECT_EQ(distance() < 0.1, is_large) << distance();
    EXPECT_EQ(smoother.accepted().back(), is_large);
    EXPECT_FALSE(smoother.accepted()[60]);
  }
}

TEST(IncrementalSmootherTest, OnALargeMapLoopsThatSayLittleWait) {
  for (const bool is_large : {false, true}) {
    SmootherOptions options;
    options.epoch_poses = 1000;
    options.large_map = is_large ? 10 : 1000;
    IncrementalSmoother smoother(options, Pose2());
    int entered = 0;
    for (int k = 1; k <= 40; ++k) {
      std::vector<PoseGraphEdge> edges = {
          MakeEdge(k - 1, k, Pose2(1., 0., 0.), 0.02, 0.002)};
      if (k > 10) {
        edges.push_back(MakeEdge(k - 10, k, Pose2(10., 0., 0.), 0.05, 0.01));
      }
      StepReport report;
      ASSERT_TRUE(smoother.AddPose(edges, &report).ok());
      entered += report.loops_entered;
    }
    if (is_large) {
      EXPECT_GE(entered, 6);
      EXPECT_LE(entered, 12);
    } else {
      EXPECT_EQ(entered, 30);
    }
    smoother.EndEpoch();
    for (const bool accepted : smoother.accepted()) EXPECT_TRUE(accepted);
  }
}

// Loops whose noise is that of their matrices have hardly any weight with the
// kernel of the epochs, which rejects some until they are decided and solved in
// turn. Also where most loops are wrong.
TEST(IncrementalSmootherTest, EpochsKeepRightLoopsAmongMoreWrongOnes) {
  Random random(5);
  const auto noise = [&](const double sigma, const double angle_sigma) {
    return Pose2(sigma * random.Normal(), sigma * random.Normal(),
                 angle_sigma * random.Normal());
  };
  const SmootherOptions options;
  IncrementalSmoother smoother(options, Pose2());
  int right = 0;
  for (int k = 1; k <= 300; ++k) {
    std::vector<PoseGraphEdge> edges = {MakeEdge(
        k - 1, k, Pose2(1., 0., 0.) * noise(0.02, 0.001), 0.02, 0.001)};
    if (k > 20) {
      edges.push_back(MakeEdge(
          k - 20, k, Pose2(20., 0., 0.) * noise(0.05, 0.01), 0.05, 0.01));
      edges.push_back(MakeEdge(k / 3, k, noise(0.3, 0.2), 0.05, 0.01));
      edges.push_back(MakeEdge(k / 5, k, noise(0.3, 0.2), 0.05, 0.01));
      ++right;
    }
    ASSERT_TRUE(smoother.AddPose(edges, nullptr).ok());
  }
  int accepted = 0;
  for (size_t i = 0; i != smoother.edges().size(); ++i) {
    accepted += smoother.edges()[i].is_loop && smoother.accepted()[i];
  }
  EXPECT_GE(accepted, 0.96 * right) << right;
}

TEST(IncrementalSmootherTest, TheEndNeedNotBePolished) {
  test::GridWorld world = test::MakeGridWorld(330, 8, 4);
  test::AddOutliers(test::Outliers(100), &world.graph);
  const std::vector<WhitenedEdge> edges = Whiten(world.graph.edges);
  SmootherOptions options;
  options.adaptive_gate = false;
  ReplayResult polished, rough;
  ASSERT_TRUE(Replay(world.graph, options, &polished).ok());
  options.polish_at_end = false;
  ASSERT_TRUE(Replay(world.graph, options, &rough).ok());
  EXPECT_GT(TruncatedCost(edges, rough.poses),
            TruncatedCost(edges, polished.poses));
  // A start near the same map.
  EXPECT_LT(AbsoluteTrajectoryError(rough.poses, polished.poses), 0.1);
  const std::vector<double> decisions =
      DecideLoops(edges, rough.poses, kChi2Gate);
  for (size_t i = 0; i != edges.size(); ++i) {
    EXPECT_EQ(rough.accepted[i], decisions[i] > 0.5) << i;
  }
}

TEST(IncrementalSmootherTest, Errors) {
  const SmootherOptions options;
  IncrementalSmoother smoother(options, Pose2(0., 0., 0.));
  PoseGraphEdge edge;
  edge.from = 0;
  edge.to = 1;
  edge.is_loop = true;
  EXPECT_THAT(std::string(smoother.AddPose({edge}, nullptr).message()),
              HasSubstr("without odometry"));
  edge.is_loop = false;
  edge.to = 2;
  EXPECT_THAT(std::string(smoother.AddPose({edge}, nullptr).message()),
              HasSubstr("does not join"));
  EXPECT_EQ(smoother.num_poses(), 1);
  edge.to = 1;
  EXPECT_TRUE(smoother.AddPose({edge}, nullptr).ok());
  EXPECT_EQ(smoother.num_poses(), 2);
  smoother.Finish();
}

}  // namespace
}  // namespace optimization
}  // namespace cartographer_ext
