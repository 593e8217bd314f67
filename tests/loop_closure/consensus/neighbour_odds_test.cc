// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
#include "cartographer_ext/loop_closure/consensus/neighbour_odds.h"

#include "gtest/gtest.h"

namespace cartographer_ext {
namespace loop_closure {
namespace {

TEST(NeighbourOddsTest, NothingSeenSaysNothing) {
  EXPECT_NEAR(OddsOfNeighbours({0, 0}, 0.1), 1., 1e-12);
}

TEST(NeighbourOddsTest, MatchesHandComputedValues) {
  // One found: L(2, 1) = 2/3, L(1, 4) = 1/5.
  EXPECT_NEAR(OddsOfNeighbours({1, 0}, 0.1), (2. / 3.) / (0.9 / 5. + 0.2 / 3.),
              1e-9);
  // One missed: 1/3 and 4/5.
  EXPECT_NEAR(OddsOfNeighbours({0, 1}, 0.1), (1. / 3.) / (0.9 * 0.8 + 0.1 / 3.),
              1e-9);
  // Two found, one missed: B(4, 2) / B(2, 1) = 2/20, B(3, 5) / B(1, 4) = 4/105.
  EXPECT_NEAR(OddsOfNeighbours({2, 1}, 0.1), 0.1 / (0.9 * 4. / 105. + 0.01),
              1e-9);
}

TEST(NeighbourOddsTest, VerificationAloneSaysLess) {
  FollowedMatch followed{2, 0};
  followed.by_verification = true;
  // L(2, 1) = 1/2, L(1, 2) = B(3, 2) / B(1, 2) = 1/6.
  EXPECT_NEAR(OddsOfNeighbours(followed, 0.1), 0.5 / (0.9 / 6. + 0.05), 1e-9);
  EXPECT_LT(OddsOfNeighbours(followed, 0.1), OddsOfNeighbours({2, 0}, 0.1));
  followed = {0, 3, true};
  EXPECT_GT(OddsOfNeighbours(followed, 0.1), OddsOfNeighbours({0, 3}, 0.1));
  // L(2, 1) = B(2, 4) / B(2, 1) = 1/10, L(1, 2) = B(1, 5) / B(1, 2) = 2/5.
  EXPECT_NEAR(OddsOfNeighbours(followed, 0.1), 0.1 / (0.9 * 0.4 + 0.01), 1e-9);
}

TEST(NeighbourOddsTest, ManyFoundAreBoundedByPlacesThatLookAlike) {
  EXPECT_GT(OddsOfNeighbours({13, 0}, 0.1), 9.);
  EXPECT_LT(OddsOfNeighbours({1000, 0}, 0.1), 10.);
  EXPECT_LT(OddsOfNeighbours({0, 20}, 0.1), 0.05);
  for (int found = 0; found < 20; ++found) {
    EXPECT_GT(OddsOfNeighbours({found + 1, 5}, 0.1),
              OddsOfNeighbours({found, 5}, 0.1));
    EXPECT_LT(OddsOfNeighbours({5, found + 1}, 0.1),
              OddsOfNeighbours({5, found}, 0.1));
  }
}

TEST(NeighbourOddsTest, WhereEverythingLooksAlikeTheySayNothing) {
  EXPECT_NEAR(OddsOfNeighbours({12, 0}, 1.), 1., 1e-12);
  EXPECT_NEAR(OddsOfNeighbours({1, 11}, 1.), 1., 1e-12);
  EXPECT_LT(OddsOfNeighbours({12, 0}, 0.5), 2.);
}

TEST(NeighbourOddsTest, LearnsTheShareOfPlacesAlikeFromWrongMatches) {
  ShareAlike share;
  EXPECT_NEAR(share.Mean(), 0.1, 1e-12);
  share.AddWrong({0, 8});
  share.AddWrong({2, 8});
  share.AddWrong({0, 0});  // nothing was mapped there
  EXPECT_NEAR(share.Mean(), 0.5 / 7., 1e-12);
  for (int i = 0; i < 12; ++i) share.AddWrong({9, 1});
  EXPECT_NEAR(share.Mean(), 12.5 / 19., 1e-12);
  EXPECT_EQ(share.num_wrong(), 14);
}

}  // namespace
}  // namespace loop_closure
}  // namespace cartographer_ext
