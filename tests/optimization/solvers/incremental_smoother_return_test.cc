// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
//
// R-iSAM returns to an earlier map.
#include <cmath>
#include <vector>

#include "cartographer_ext/common/random.h"
#include "cartographer_ext/optimization/solvers/incremental_smoother.h"
#include "gtest/gtest.h"

namespace cartographer_ext {
namespace optimization {
namespace {

constexpr int kLap = 40;  // poses, a metre apart

// Laps of a square, with loops to the first one; after a detour on which heading
// is lost, loops that agree claim another place before the right ones come.
class IncrementalSmootherReturnTest : public ::testing::Test {
 protected:
  void Make(const uint64_t seed, const int num_wrong) {
    Random random(seed);
    poses_.assign(1, Pose2());
    edges_.assign(1, {});
    is_right_.clear();
    const auto step = [&](const int k, const int side) {
      const Pose2 motion(1., 0., (k + 1) % side == 0 ? kPi / 2. : 0.);
      poses_.push_back(poses_.back() * motion);
      const int number = poses_.size() - 1;
      edges_.push_back({Measure(number - 1, number, Pose2(), false, &random)});
    };
    for (int k = 0; k != 6 * kLap; ++k) {
      step(k, kLap / 4);
      if (k >= kLap && k % 4 == 0) AddLoop(Pose2(), true, &random);
    }
    for (int k = 0; k != 2 * kLap; ++k) step(k, kLap / 2);
    for (int k = 0; k != 4 * kLap; ++k) {
      step(k, kLap / 4);
      if (k < num_wrong) {
        AddLoop(Pose2(1.5, -1., 0.), false, &random);
      } else if (k >= kLap / 2 && k % 4 == 0) {
        AddLoop(Pose2(), true, &random);
      }
    }
  }

  // The share of right loops in force and the number of wrong ones.
  void Run(const SmootherOptions& options, double* const right,
           int* const wrong) const {
    IncrementalSmoother smoother(options, poses_[0]);
    for (size_t k = 1; k != edges_.size(); ++k) {
      ASSERT_TRUE(smoother.AddPose(edges_[k], nullptr).ok());
    }
    smoother.Finish();
    int in_force = 0, all = 0;
    *wrong = 0;
    for (size_t i = 0, loop = 0; i != smoother.edges().size(); ++i) {
      if (!smoother.edges()[i].is_loop) continue;
      const bool is_right = is_right_[loop++];
      all += is_right;
      in_force += is_right && smoother.accepted()[i];
      *wrong += !is_right && smoother.accepted()[i];
    }
    *right = 1. * in_force / all;
  }

 private:
  // (from <- to), as if the world were shifted at `to`.
  PoseGraphEdge Measure(const int from, const int to, const Pose2& shift,
                        const bool is_loop, Random* const random) const {
    const double xy = is_loop ? 0.05 : 0.02, theta = is_loop ? 0.02 : 0.01;
    PoseGraphEdge edge;
    edge.from = from;
    edge.to = to;
    edge.is_loop = is_loop;
    edge.measurement = Between(poses_[from], shift * poses_[to]) *
                       Pose2(random->Normal(0., xy), random->Normal(0., xy),
                             random->Normal(0., theta));
    edge.information.setZero();
    edge.information.diagonal() << 1. / (xy * xy), 1. / (xy * xy),
        1. / (theta * theta);
    return edge;
  }

  void AddLoop(const Pose2& shift, const bool is_right, Random* const random) {
    const int number = poses_.size() - 1;
    edges_.back().push_back(
        Measure(number % kLap, number, shift, true, random));
    is_right_.push_back(is_right);
  }

  std::vector<Pose2> poses_;                       // true
  std::vector<std::vector<PoseGraphEdge>> edges_;  // by their later pose
  std::vector<bool> is_right_;                     // of each loop
};

TEST_F(IncrementalSmootherReturnTest, AGroupThatBentTheMapIsReleased) {
  for (const uint64_t seed : {2, 3, 4}) {
    Make(seed, 10);
    SmootherOptions options;
    options.epoch_poses = 20;
    double right = 0.;
    int wrong = 0;
    Run(options, &right, &wrong);
    EXPECT_GT(right, 0.97) << seed;
    EXPECT_EQ(wrong, 0) << seed;
    // On a map whose epochs take two steps there is no time for it.
    options.two_step_map = 100;
    Run(options, &right, &wrong);
    EXPECT_LT(right, 0.7) << seed;
    EXPECT_EQ(wrong, 10) << seed;
  }
}

TEST_F(IncrementalSmootherReturnTest, WithoutWrongLoopsNothingIsGivenUp) {
  Make(4, 0);
  SmootherOptions options;
  options.epoch_poses = 20;
  double right = 0.;
  int wrong = 0;
  Run(options, &right, &wrong);
  EXPECT_EQ(right, 1.);
}

}  // namespace
}  // namespace optimization
}  // namespace cartographer_ext
