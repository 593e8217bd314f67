// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
#include "cartographer/metrics/counter.h"

namespace cartographer {
namespace metrics {

namespace {

class NullCounter : public Counter {
 public:
  void Increment() override {}
  void Increment(double) override {}
};

}  // namespace

Counter* Counter::Null() {
  static NullCounter counter;
  return &counter;
}

}  // namespace metrics
}  // namespace cartographer
