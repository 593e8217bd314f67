// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
#include "cartographer_ext/tuning/comparable_trials.h"

#include "gmock/gmock.h"
#include "gtest/gtest.h"

namespace cartographer_ext {
namespace tuning {
namespace {

using testing::ElementsAre;

Trial MakeTrial(const double fidelity, const double objective,
                const bool ok = true) {
  Trial trial;
  trial.point = {objective};
  trial.fidelity = fidelity;
  trial.ok = ok;
  trial.objective = objective;
  return trial;
}

std::vector<Trial> Trials(const int whole, const int parts) {
  std::vector<Trial> trials;
  for (int i = 0; i < whole; ++i) trials.push_back(MakeTrial(1., 10. + i));
  for (int i = 0; i < parts; ++i) trials.push_back(MakeTrial(0.25, 1. + i));
  return trials;
}

TEST(ComparableTrialsTest, WholeRecordingsWhereThereAreEnough) {
  const ComparableTrials trials = SelectComparable(Trials(8, 20));
  EXPECT_EQ(trials.fidelity, 1.);
  ASSERT_EQ(trials.points.size(), 8u);
  EXPECT_EQ(trials.objectives.front(), 10.);
  EXPECT_EQ(ToText(trials), "8 trials on whole recordings");
}

TEST(ComparableTrialsTest, ElseThePartThatMostWereTriedOn) {
  std::vector<Trial> all = Trials(7, 9);
  all.push_back(MakeTrial(0.25, 100., false));  // failed
  all.push_back(MakeTrial(0.5, 200.));
  const ComparableTrials trials = SelectComparable(all);
  EXPECT_EQ(trials.fidelity, 0.25);
  EXPECT_THAT(trials.objectives,
              ElementsAre(1., 2., 3., 4., 5., 6., 7., 8., 9.));
  EXPECT_EQ(ToText(trials), "9 trials on the first 25 % of the recordings");
}

TEST(ComparableTrialsTest, FewTrialsOnWholeRecordingsStayWhereMostAre) {
  EXPECT_EQ(SelectComparable(Trials(3, 3)).fidelity, 1.);
  EXPECT_EQ(SelectComparable({}).fidelity, 1.);
  EXPECT_TRUE(SelectComparable({}).points.empty());
}

}  // namespace
}  // namespace tuning
}  // namespace cartographer_ext
