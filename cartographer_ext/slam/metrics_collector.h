// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
//
// Collects the values of the host's metrics, for lookup by name, such as the
// number of searches or the length of the queue. The host registers its metrics
// once per process and never releases them, so there is one collector with the
// lifetime of the process; runs use differences.
#ifndef CARTOGRAPHER_EXT_SLAM_METRICS_COLLECTOR_H_
#define CARTOGRAPHER_EXT_SLAM_METRICS_COLLECTOR_H_

#include <atomic>
#include <deque>
#include <map>
#include <memory>
#include <string>
#include <utility>

#include "absl/synchronization/mutex.h"
#include "cartographer/metrics/family_factory.h"

namespace cartographer_ext {
namespace evaluation {

class MetricsCollector : public cartographer::metrics::FamilyFactory {
 public:
  using Labels = std::map<std::string, std::string>;

  // The collector that the host's metrics report to; registers them on the
  // first call, which must precede the creation of a map builder.
  static MetricsCollector* Global();

  MetricsCollector();
  ~MetricsCollector() override;

  cartographer::metrics::Family<cartographer::metrics::Counter>*
  NewCounterFamily(const std::string& name,
                   const std::string& description) override;
  cartographer::metrics::Family<cartographer::metrics::Gauge>* NewGaugeFamily(
      const std::string& name, const std::string& description) override;
  cartographer::metrics::Family<cartographer::metrics::Histogram>*
  NewHistogramFamily(const std::string& name, const std::string& description,
                     const cartographer::metrics::Histogram::BucketBoundaries&
                         boundaries) override;

  // Sum of the counters and gauges of a family whose labels include those
  // given; for histograms the number of observations. 0 for an unknown name.
  double Sum(const std::string& name, const Labels& labels = {}) const;
  bool Has(const std::string& name) const;
  // All values by name and labels, "name{key=value,...}".
  std::map<std::string, double> Values() const;

 private:
  class Value;
  template <typename Metric>
  class CollectedFamily;

  Value* AddValue(const std::string& name, const Labels& labels);

  mutable absl::Mutex mutex_;
  // Handles remain valid: values are never moved or removed.
  std::deque<std::unique_ptr<Value>> values_;
  std::multimap<std::string, std::pair<Labels, Value*>> by_name_;
  std::deque<std::shared_ptr<void>> families_;
};

}  // namespace evaluation
}  // namespace cartographer_ext

#endif  // CARTOGRAPHER_EXT_SLAM_METRICS_COLLECTOR_H_
