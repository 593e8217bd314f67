// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
#include "cartographer_ext/navigation/closed_loop/contact_counter.h"

#include "gtest/gtest.h"

namespace cartographer_ext {
namespace navigation {
namespace {

using simulation::Disc;

class ContactCounterTest : public testing::Test {
 protected:
  ContactCounterTest()
      : plan_({{Eigen::Vector2d(2., -5.), Eigen::Vector2d(2., 5.)}}, {}),
        robot_(simulation::World(), RobotLimits(), LiveRobotOptions(), Pose2(),
               1),
        counter_(0.25) {}

  void Drive(const double seconds, const std::vector<Disc>& stationary,
             const std::vector<Disc>& moving) {
    for (double time = 0.; time < seconds; time += 0.02) {
      robot_.Advance(0.02);
      counter_.Check(robot_, plan_, stationary, moving);
    }
  }

  const simulation::RayCaster plan_;
  LiveRobot robot_;
  ContactCounter counter_;
};

TEST_F(ContactCounterTest, CountsTheWallOnce) {
  robot_.Command({0.7, 0.});
  Drive(6., {}, {});
  EXPECT_EQ(counter_.static_collisions(), 1);
  ASSERT_EQ(counter_.contacts().size(), 1u);
  EXPECT_NEAR(counter_.contacts()[0].place.x(), 1.75, 0.03);
  EXPECT_LT(counter_.least_clearance(), 0.);
}

TEST_F(ContactCounterTest, KnowsTheLeastClearance) {
  Drive(0.1, {{Eigen::Vector2d(0., 1.), 0.3}}, {});
  EXPECT_EQ(counter_.static_collisions(), 0);
  EXPECT_NEAR(counter_.least_clearance(), 1. - 0.3 - 0.25, 1e-9);
}

TEST_F(ContactCounterTest, ARobotThatStandsIsRunInto) {
  const std::vector<Disc> person = {{Eigen::Vector2d(0.3, 0.), 0.2}};
  Drive(0.5, {}, person);
  EXPECT_EQ(counter_.run_into(), 1);
  EXPECT_EQ(counter_.moving_collisions(), 0);
  // But it must not start in the contact.
  robot_.Command({0.3, 0.});
  Drive(0.5, {}, person);
  EXPECT_EQ(counter_.run_into(), 0);
  EXPECT_EQ(counter_.moving_collisions(), 1);
  // A new contact counts anew.
  Drive(0.1, {}, {});
  Drive(0.1, {}, {{robot_.pose().translation(), 0.2}});
  EXPECT_EQ(counter_.moving_collisions(), 2);
}

TEST_F(ContactCounterTest, ARobotThatTurnsInAContactMoves) {
  // Its outline passes over the person at 12.5 mm/s or more.
  const std::vector<Disc> person = {{Eigen::Vector2d(0.3, 0.), 0.2}};
  robot_.Command({0., 0.04});
  Drive(0.5, {}, person);
  EXPECT_EQ(counter_.moving_collisions(), 0);
  EXPECT_EQ(counter_.run_into(), 1);
  robot_.Command({0., 0.3});
  Drive(0.5, {}, person);
  EXPECT_EQ(counter_.moving_collisions(), 1);
  EXPECT_EQ(counter_.run_into(), 0);
  ASSERT_EQ(counter_.contacts().size(), 1u);
  EXPECT_GT(counter_.contacts()[0].turn_rate, 0.05);
}

TEST_F(ContactCounterTest, TellsWhetherSomebodyWasSeen) {
  robot_.Command({0.1, 0.});
  Drive(0.5, {}, {});
  const Disc person{robot_.pose() * Eigen::Vector2d(0.4, 0.), 0.2};
  for (const bool seen : {true, false}) {
    // The first echo comes from the person, the second one does not.
    const Eigen::Vector2d echo(seen ? 0.22 : 0.9, 0.);
    counter_.AddScan({robot_.pose() * echo}, {person}, robot_.time());
    Drive(0.1, {}, {person});
    Drive(0.1, {}, {});
  }
  EXPECT_EQ(counter_.moving_collisions(), 2);
  EXPECT_EQ(counter_.unseen_collisions(), 0);  // seen just before
  ASSERT_EQ(counter_.contacts().size(), 2u);
  EXPECT_NEAR(counter_.contacts()[0].unseen_seconds, 0.1, 0.1);
  Drive(1.5, {}, {});
  counter_.AddScan({}, {person}, robot_.time());
  Drive(0.1, {}, {person});
  EXPECT_EQ(counter_.moving_collisions(), 3);
  EXPECT_EQ(counter_.unseen_collisions(), 1);
}

}  // namespace
}  // namespace navigation
}  // namespace cartographer_ext
