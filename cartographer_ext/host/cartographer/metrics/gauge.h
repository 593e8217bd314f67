// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
#ifndef CARTOGRAPHER_METRICS_GAUGE_H_
#define CARTOGRAPHER_METRICS_GAUGE_H_

#include <map>
#include <vector>

namespace cartographer {
namespace metrics {

// A value that goes up and down.
class Gauge {
 public:
  // Ignores everything.
  static Gauge* Null();

  virtual ~Gauge() = default;
  virtual void Increment() = 0;
  virtual void Increment(double by_value) = 0;
  virtual void Decrement() = 0;
  virtual void Decrement(double by_value) = 0;
  virtual void Set(double value) = 0;
};

}  // namespace metrics
}  // namespace cartographer

#endif  // CARTOGRAPHER_METRICS_GAUGE_H_
