// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
#include "cartographer_ext/optimization/dropin/loops_in_force.h"

#include <vector>

#include "cartographer/transform/transform.h"
#include "gtest/gtest.h"

namespace cartographer_ext {
namespace optimization {
namespace {

using cartographer::mapping::MapById;
using cartographer::mapping::NodeId;
using cartographer::mapping::PoseGraphInterface;
using cartographer::mapping::SubmapId;
using cartographer::mapping::optimization::NodeSpec2D;
using cartographer::mapping::optimization::SubmapSpec2D;
using cartographer::transform::Embed3D;
using cartographer::transform::Rigid2d;
using Constraint = PoseGraphInterface::Constraint;

Constraint Loop(const int submap, const int node, const Rigid2d& pose,
                const Constraint::Tag tag = Constraint::INTER_SUBMAP) {
  return {SubmapId{0, submap}, NodeId{0, node}, {Embed3D(pose), 1., 1.}, tag};
}

TEST(CountLoopsOffMapTest, CountsLoopsByDistanceAndHeading) {
  MapById<SubmapId, SubmapSpec2D> submaps;
  submaps.Append(0, SubmapSpec2D{Rigid2d({10., 0.}, M_PI / 2.)});
  MapById<NodeId, NodeSpec2D> nodes;
  // At (3, 1) in the submap, turned by 0.5.
  nodes.Append(0, NodeSpec2D{cartographer::common::FromUniversal(1),
                             {},
                             Rigid2d({9., 3.}, M_PI / 2. + 0.5),
                             Eigen::Quaterniond::Identity()});
  const std::vector<Constraint> constraints = {
      Loop(0, 0, Rigid2d({3., 1.}, 0.5)),
      Loop(0, 0, Rigid2d({3.19, 1.}, 0.5)),
      Loop(0, 0, Rigid2d({3., 0.79}, 0.5)),  // off
      Loop(0, 0, Rigid2d({3., 1.}, 0.59)),
      Loop(0, 0, Rigid2d({3., 1.}, 0.39)),  // off
      Loop(0, 0, Rigid2d({9., 9.}, 0.5), Constraint::INTRA_SUBMAP),
      Loop(0, 1, Rigid2d({9., 9.}, 0.5)),   // no such node
      Loop(1, 0, Rigid2d({9., 9.}, 0.5))};  // no such submap
  const LoopsOffMap result = CountLoopsOffMap(constraints, nodes, submaps, 0.2);
  EXPECT_EQ(result.loops, 5);
  EXPECT_EQ(result.off, 2);
}

TEST(CountLoopsOffMapTest, CountsStepsByDistanceAndHeading) {
  MapById<NodeId, NodeSpec2D> nodes;
  const auto add = [&nodes](const double x, const double heading) {
    // Local SLAM drives straight on, a metre a step.
    const double travelled = nodes.size();
    nodes.Append(
        0, NodeSpec2D{cartographer::common::FromUniversal(1),
                      Rigid2d({travelled, 0.}, 0.), Rigid2d({x, 5.}, heading),
                      Eigen::Quaterniond::Identity()});
  };
  EXPECT_EQ(CountLoopsOffMap({}, nodes, {}, 0.2).steps, 0);
  add(0., 0.);
  add(1.19, 0.05);
  add(2., 0.);
  add(3.21, 0.);    // off
  add(4.21, 0.11);  // off
  const LoopsOffMap result = CountLoopsOffMap({}, nodes, {}, 0.2);
  EXPECT_EQ(result.steps, 4);
  EXPECT_EQ(result.steps_off, 2);
}

TEST(TakeOutFarOffTest, TakesTheLoopsThatThePosesContradict) {
  MapById<SubmapId, SubmapSpec2D> submaps;
  submaps.Append(0, SubmapSpec2D{Rigid2d::Identity()});
  MapById<NodeId, NodeSpec2D> nodes;
  for (int i = 0; i < 3; ++i) {
    nodes.Append(0, NodeSpec2D{cartographer::common::FromUniversal(i),
                               {},
                               Rigid2d({3., 1.}, 0.5),
                               Eigen::Quaterniond::Identity()});
  }
  const std::vector<Constraint> some = {
      Loop(0, 0, Rigid2d({3.49, 1.}, 0.5)),
      Loop(0, 1, Rigid2d({3.51, 1.}, 0.5)),  // far off
      Loop(0, 2, Rigid2d({3., 1.}, 0.19)),   // turned
      Loop(0, 2, Rigid2d({3., 1.}, 0.79)),
      Loop(0, 0, Rigid2d({9., 9.}, 0.5), Constraint::INTRA_SUBMAP),
      Loop(0, 3, Rigid2d({9., 9.}, 0.5))};  // no such node
  // Two of 19 are more than a tenth, and the map may be wrong.
  std::vector<Constraint> constraints = some;
  for (int i = 0; i < 15; ++i) {
    constraints.push_back(Loop(0, 0, Rigid2d({3., 1.}, 0.5)));
  }
  EXPECT_TRUE(TakeOutFarOff(nodes, submaps, &constraints).empty());
  EXPECT_EQ(constraints.size(), 21u);
  constraints.push_back(Loop(0, 0, Rigid2d({3., 1.}, 0.5)));
  const std::vector<LoopId> taken = TakeOutFarOff(nodes, submaps, &constraints);
  ASSERT_EQ(taken.size(), 2u);
  EXPECT_EQ(taken[0].node_index, 1);
  EXPECT_EQ(taken[1].node_index, 2);
  ASSERT_EQ(constraints.size(), 20u);
  EXPECT_NEAR(constraints[1].pose.zbar_ij.translation().x(), 3., 1e-12);
  EXPECT_TRUE(TakeOutFarOff(nodes, submaps, &constraints).empty());
}

// What is solved, where so many of a hundred loops are off before, with single
// steps that give way, with weak ones, and solved again.
struct Solutions {
  // Of each solution the factor on the weights of steps, 0 if it is not relaxed.
  std::vector<double> factors;
  LoopsPutInForce result;
};

Solutions PutInForce(const int before, const int single, const int weak,
                     const int again, const int weak_steps_off = 0) {
  Solutions run;
  int off = before, steps_off = 0;
  run.result = PutLoopsInForce(
      [&](const Relaxation* const given) {
        run.factors.push_back(
            given == nullptr ? 0. : given->step_translation_factor);
        off = given == nullptr
                  ? again
                  : (given->step_translation_factor == 1. ? single : weak);
        steps_off = off == weak ? weak_steps_off : 0;
      },
      [&] {
        return LoopsOffMap{100, off, 500, steps_off};
      },
      {Relaxation{30., 1., 1., 300.},
       Relaxation{30., 1., 1., 300., 0.01, 0.1}});
  return run;
}

TEST(PutLoopsInForceTest, AFewLoopsThatAreOffStayOff) {
  const Solutions run = PutInForce(4, 0, 0, 4);
  EXPECT_TRUE(run.factors.empty());
  EXPECT_FALSE(run.result.tried);
  EXPECT_EQ(run.result.after.off, 4);
}

TEST(PutLoopsInForceTest, TheRelaxedResultIsKeptIfNearlyAllAreInForce) {
  const Solutions run = PutInForce(40, 10, 0, 40);
  EXPECT_EQ(run.factors, std::vector<double>{1.});
  EXPECT_TRUE(run.result.relaxed);
  EXPECT_EQ(run.result.before.off, 40);
  EXPECT_EQ(run.result.after.off, 10);
}

TEST(PutLoopsInForceTest, WeakStepsFollowWhereSingleOnesAreNotEnough) {
  const Solutions run = PutInForce(40, 11, 5, 40);
  EXPECT_EQ(run.factors, (std::vector<double>{1., 0.01}));
  EXPECT_TRUE(run.result.relaxed);
  EXPECT_EQ(run.result.after.off, 5);
}

TEST(PutLoopsInForceTest, StepsThatFollowAnyLoopAreNoResult) {
  EXPECT_TRUE(PutInForce(40, 11, 5, 40, 10).result.relaxed);
  EXPECT_FALSE(PutInForce(40, 11, 5, 40, 11).result.relaxed);
}

TEST(PutLoopsInForceTest, OtherwiseTheProblemIsSolvedAsItWas) {
  // More than a tenth of all, more than a quarter of those before.
  for (const Solutions& run :
       {PutInForce(45, 11, 11, 44), PutInForce(60, 16, 16, 59),
        PutInForce(20, 6, 7, 20)}) {
    EXPECT_EQ(run.factors, (std::vector<double>{1., 0.01, 0.}));
    EXPECT_TRUE(run.result.tried);
    EXPECT_FALSE(run.result.relaxed);
    EXPECT_GE(run.result.after.off, 20);
  }
}

TEST(RelaxationsOfTest, TakesTheWeightsOfLocalSlamAndOfInsertions) {
  cartographer::mapping::optimization::proto::OptimizationProblemOptions
      options;
  options.set_local_slam_pose_translation_weight(2.);
  options.set_local_slam_pose_rotation_weight(3.);
  std::vector<Constraint> constraints = {Loop(0, 0, Rigid2d({3., 1.}, 0.5))};
  const std::vector<Relaxation> without = RelaxationsOf(options, constraints);
  ASSERT_EQ(without.size(), 1u);
  EXPECT_EQ(without[0].step_translation_weight, 2.);
  EXPECT_EQ(without[0].step_rotation_weight, 3.);
  EXPECT_EQ(without[0].step_translation_factor, 1.);
  constraints.push_back(
      Loop(0, 0, Rigid2d({3., 1.}, 0.5), Constraint::INTRA_SUBMAP));
  constraints.back().pose.translation_weight = 0.5;
  constraints.back().pose.rotation_weight = 30.;
  const std::vector<Relaxation> both = RelaxationsOf(options, constraints);
  ASSERT_EQ(both.size(), 2u);
  EXPECT_EQ(both[0].pull_of_loops, 30.);
  EXPECT_EQ(both[1].pull_of_loops, 30.);
  EXPECT_EQ(both[1].step_translation_weight, 2.);  // by which steps are known
  EXPECT_EQ(both[1].step_translation_factor, 0.25);
  EXPECT_EQ(both[1].step_rotation_factor, 1.);  // not stiffer than before
}

}  // namespace
}  // namespace optimization
}  // namespace cartographer_ext
