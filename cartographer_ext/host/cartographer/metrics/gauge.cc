// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
#include "cartographer/metrics/gauge.h"

namespace cartographer {
namespace metrics {

namespace {

class NullGauge : public Gauge {
 public:
  void Increment() override {}
  void Increment(double) override {}
  void Decrement() override {}
  void Decrement(double) override {}
  void Set(double) override {}
};

}  // namespace

Gauge* Gauge::Null() {
  static NullGauge gauge;
  return &gauge;
}

}  // namespace metrics
}  // namespace cartographer
