// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
#ifndef CARTOGRAPHER_METRICS_COUNTER_H_
#define CARTOGRAPHER_METRICS_COUNTER_H_

#include <map>
#include <vector>

namespace cartographer {
namespace metrics {

// A value that only grows.
class Counter {
 public:
  // Ignores everything.
  static Counter* Null();

  virtual ~Counter() = default;
  virtual void Increment() = 0;
  virtual void Increment(double by_value) = 0;
};

}  // namespace metrics
}  // namespace cartographer

#endif  // CARTOGRAPHER_METRICS_COUNTER_H_
