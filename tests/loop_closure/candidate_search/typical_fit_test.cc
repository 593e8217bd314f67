// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
#include "cartographer_ext/loop_closure/candidate_search/typical_fit.h"

#include "gtest/gtest.h"

namespace cartographer_ext {
namespace loop_closure {
namespace {

TypicalFitOptions Options() {
  TypicalFitOptions options;
  options.reference = 0.6;
  options.least_scale = 0.8;
  options.window = 4;
  options.min_fits = 2;
  return options;
}

TEST(TypicalFitTest, SaysNothingBeforeThereAreEnough) {
  TypicalFit fit(Options());
  EXPECT_EQ(fit.Scale(0), 1.);
  fit.Add(0, 0.5);
  EXPECT_EQ(fit.Scale(0), 1.);
  fit.Add(0, 0.52);
  EXPECT_DOUBLE_EQ(fit.Scale(0), 0.51 / 0.6);
}

TEST(TypicalFitTest, StaysWithinItsBounds) {
  TypicalFit fit(Options());
  for (int i = 0; i < 4; ++i) fit.Add(0, 0.3);
  EXPECT_EQ(fit.Scale(0), 0.8);
  for (int i = 0; i < 4; ++i) fit.Add(1, 0.75);
  EXPECT_EQ(fit.Scale(1), 1.);
}

TEST(TypicalFitTest, OldFitsAreForgotten) {
  TypicalFit fit(Options());
  for (int i = 0; i < 100; ++i) fit.Add(0, 0.2);
  for (int i = 0; i < 4; ++i) fit.Add(0, 0.57);
  EXPECT_DOUBLE_EQ(fit.Scale(0), 0.57 / 0.6);
}

TEST(TypicalFitTest, RunsAreApart) {
  TypicalFit fit(Options());
  for (int i = 0; i < 4; ++i) fit.Add(0, 0.5);
  EXPECT_EQ(fit.Scale(1), 1.);
}

TEST(TypicalFitTest, OffWithoutAReference) {
  TypicalFitOptions options = Options();
  options.reference = 0.;
  TypicalFit fit(options);
  for (int i = 0; i < 4; ++i) fit.Add(0, 0.1);
  EXPECT_EQ(fit.Scale(0), 1.);
}

}  // namespace
}  // namespace loop_closure
}  // namespace cartographer_ext
