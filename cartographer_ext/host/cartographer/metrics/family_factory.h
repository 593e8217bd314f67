// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
#ifndef CARTOGRAPHER_METRICS_FAMILY_FACTORY_H_
#define CARTOGRAPHER_METRICS_FAMILY_FACTORY_H_

#include <map>
#include <memory>
#include <string>

#include "cartographer/metrics/counter.h"
#include "cartographer/metrics/gauge.h"
#include "cartographer/metrics/histogram.h"

namespace cartographer {
namespace metrics {

// Metrics of one name that differ in labels.
template <typename MetricType>
class Family {
 public:
  // Its metrics ignore everything.
  static Family<MetricType>* Null();

  virtual ~Family() = default;
  virtual MetricType* Add(const std::map<std::string, std::string>& labels) = 0;
};

template <typename MetricType>
class NullFamily : public Family<MetricType> {
 public:
  MetricType* Add(const std::map<std::string, std::string>&) override {
    return MetricType::Null();
  }
};

template <typename MetricType>
Family<MetricType>* Family<MetricType>::Null() {
  static NullFamily<MetricType> family;
  return &family;
}

// What a monitoring system implements to receive metrics. The factory owns what
// it makes.
class FamilyFactory {
 public:
  virtual ~FamilyFactory() = default;

  virtual Family<Counter>* NewCounterFamily(const std::string& name,
                                            const std::string& description) = 0;
  virtual Family<Gauge>* NewGaugeFamily(const std::string& name,
                                        const std::string& description) = 0;
  virtual Family<Histogram>* NewHistogramFamily(
      const std::string& name, const std::string& description,
      const Histogram::BucketBoundaries& boundaries) = 0;
};

}  // namespace metrics
}  // namespace cartographer

#endif  // CARTOGRAPHER_METRICS_FAMILY_FACTORY_H_
