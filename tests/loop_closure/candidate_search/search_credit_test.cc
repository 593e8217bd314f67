// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
#include "cartographer_ext/loop_closure/candidate_search/search_credit.h"

#include "gtest/gtest.h"

namespace cartographer_ext {
namespace loop_closure {
namespace {

SearchPlan Window(const double linear, const double angular) {
  SearchPlan plan;
  plan.linear_window = linear;
  plan.angular_window = angular;
  return plan;
}

SearchPlan WholeSubmap() {
  SearchPlan plan = Window(15., 3.14);
  plan.full_submap = true;
  return plan;
}

TEST(SearchCreditTest, WorkGrowsWithTheWindow) {
  EXPECT_EQ(SearchWork(Window(1., 0.2)), 0.);
  EXPECT_EQ(SearchWork(Window(3., 1.)), 0.);
  // 10 m x 10 m x 1 rad of 200.
  EXPECT_DOUBLE_EQ(SearchWork(Window(10., 1.)), 0.5);
  EXPECT_EQ(SearchWork(Window(15., 3.)), 1.);
  EXPECT_DOUBLE_EQ(SearchWork(WholeSubmap()), 0.25);
}

TEST(SearchCreditTest, NarrowSearchesAreFree) {
  SearchCredit credit;
  for (int i = 0; i < 10000; ++i) EXPECT_TRUE(credit.Pay(Window(2., 0.5)));
  EXPECT_EQ(credit.credit(), SearchCredit::kMostCredit);
}

TEST(SearchCreditTest, CostPerNodeIsBounded) {
  SearchCredit credit;
  int searched = 0;
  constexpr int kNodes = 10000;
  for (int i = 0; i < kNodes; ++i) {
    credit.AddNode(uncertainty::NodeId{0, i}, 0.2);
    // Older nodes with new submaps earn nothing.
    credit.AddNode(uncertainty::NodeId{0, i / 2}, 0.2);
    while (credit.Pay(WholeSubmap())) ++searched;
  }
  EXPECT_NEAR(searched * SearchWork(WholeSubmap()),
              SearchCredit::kMostCredit + SearchCredit::kCreditPerNode * kNodes,
              1.5 * SearchWork(WholeSubmap()));
}

TEST(SearchCreditTest, CreditIsSavedUpToALimit) {
  SearchCredit credit;
  for (int i = 0; i < 100000; ++i)
    credit.AddNode(uncertainty::NodeId{0, i}, 0.2);
  EXPECT_EQ(credit.credit(), SearchCredit::kMostCredit);
}

TEST(SearchCreditTest, AcceptedLoopsEarnFurtherSearches) {
  SearchCredit credit;
  while (credit.Pay(WholeSubmap())) {
  }
  const double before = credit.credit();
  credit.Reward(Window(1., 0.2));
  EXPECT_EQ(credit.credit(), before);
  credit.Reward(WholeSubmap());
  EXPECT_DOUBLE_EQ(credit.credit(), before + SearchCredit::kRewardFactor *
                                                 SearchWork(WholeSubmap()));
}

TEST(SearchCreditTest, NodesFarApartEarnMore) {
  SearchCredit credit;
  EXPECT_FALSE(credit.NewestNode(0).has_value());
  while (credit.Pay(WholeSubmap())) {
  }
  credit.AddNode(uncertainty::NodeId{0, 3}, 1.5);
  ASSERT_TRUE(credit.NewestNode(0).has_value());
  EXPECT_EQ(credit.NewestNode(0)->node_index, 3);
  const double per_metre = SearchCredit::kCreditPerMetre;
  double expected = SearchCredit::kCreditPerNode + per_metre;
  EXPECT_DOUBLE_EQ(credit.credit(), expected);
  // Behind a gap no more than for five metres.
  credit.AddNode(uncertainty::NodeId{0, 4}, 1000.);
  expected += SearchCredit::kCreditPerNode + 4.5 * per_metre;
  EXPECT_DOUBLE_EQ(credit.credit(), expected);
}

TEST(SearchCreditTest, TrajectoriesEarnEachForItself) {
  SearchCredit credit;
  while (credit.Pay(WholeSubmap())) {
  }
  credit.AddNode(uncertainty::NodeId{0, 100}, 0.2);
  credit.AddNode(uncertainty::NodeId{1, 0}, 0.2);
  EXPECT_DOUBLE_EQ(credit.credit(), 2. * SearchCredit::kCreditPerNode);
}

}  // namespace
}  // namespace loop_closure
}  // namespace cartographer_ext
