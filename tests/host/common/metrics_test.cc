// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
#include "cartographer/metrics/family_factory.h"
#include "gtest/gtest.h"

namespace cartographer {
namespace metrics {
namespace {

TEST(MetricsTest, NullObjectsIgnoreEverything) {
  Counter* const counter = Family<Counter>::Null()->Add({{"a", "b"}});
  EXPECT_EQ(counter, Counter::Null());
  counter->Increment();
  counter->Increment(2.);
  Gauge* const gauge = Family<Gauge>::Null()->Add({});
  EXPECT_EQ(gauge, Gauge::Null());
  gauge->Increment();
  gauge->Increment(2.);
  gauge->Decrement();
  gauge->Decrement(2.);
  gauge->Set(3.);
  Histogram* const histogram = Family<Histogram>::Null()->Add({});
  EXPECT_EQ(histogram, Histogram::Null());
  histogram->Observe(1.);
}

TEST(MetricsTest, Boundaries) {
  EXPECT_EQ(Histogram::FixedWidth(0.5, 3),
            (Histogram::BucketBoundaries{0.5, 1., 1.5}));
  EXPECT_EQ(Histogram::FixedWidth(0.05, 20).size(), 20);
  EXPECT_EQ(Histogram::ScaledPowersOf(2., 3., 20.),
            (Histogram::BucketBoundaries{3., 6., 12.}));
}

TEST(MetricsDeathTest, PowersMustGrow) {
  EXPECT_DEATH(Histogram::ScaledPowersOf(1., 1., 10.), "");
  EXPECT_DEATH(Histogram::ScaledPowersOf(2., 0., 10.), "");
}

}  // namespace
}  // namespace metrics
}  // namespace cartographer
