// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
#include "cartographer_ext/slam/metrics_collector.h"

#include <algorithm>

#include "absl/strings/str_cat.h"
#include "absl/strings/str_join.h"
#include "cartographer/metrics/register.h"

namespace cartographer_ext {
namespace evaluation {
namespace {

using cartographer::metrics::Counter;
using cartographer::metrics::Family;
using cartographer::metrics::Gauge;
using cartographer::metrics::Histogram;

}  // namespace

// One number behind any of the three kinds of metric.
class MetricsCollector::Value : public Counter, public Gauge, public Histogram {
 public:
  void Increment() override { Add(1.); }
  void Increment(const double by_value) override { Add(by_value); }
  void Decrement() override { Add(-1.); }
  void Decrement(const double by_value) override { Add(-by_value); }
  void Set(const double value) override { value_.store(value); }
  void Observe(const double /*value*/) override { Add(1.); }

  double Get() const { return value_.load(); }

 private:
  void Add(const double difference) {
    double value = value_.load();
    while (!value_.compare_exchange_weak(value, value + difference)) {
    }
  }

  std::atomic<double> value_{0.};
};

template <typename Metric>
class MetricsCollector::CollectedFamily : public Family<Metric> {
 public:
  CollectedFamily(MetricsCollector* const collector, const std::string& name)
      : collector_(collector), name_(name) {}

  Metric* Add(const Labels& labels) override {
    return collector_->AddValue(name_, labels);
  }

 private:
  MetricsCollector* const collector_;
  const std::string name_;
};

MetricsCollector* MetricsCollector::Global() {
  static MetricsCollector* const collector = [] {
    auto* const created = new MetricsCollector;
    cartographer::metrics::RegisterAllMetrics(created);
    return created;
  }();
  return collector;
}

MetricsCollector::MetricsCollector() = default;
MetricsCollector::~MetricsCollector() = default;

Family<Counter>* MetricsCollector::NewCounterFamily(
    const std::string& name, const std::string& /*description*/) {
  auto family = std::make_shared<CollectedFamily<Counter>>(this, name);
  absl::MutexLock lock(&mutex_);
  families_.push_back(family);
  return family.get();
}

Family<Gauge>* MetricsCollector::NewGaugeFamily(
    const std::string& name, const std::string& /*description*/) {
  auto family = std::make_shared<CollectedFamily<Gauge>>(this, name);
  absl::MutexLock lock(&mutex_);
  families_.push_back(family);
  return family.get();
}

Family<Histogram>* MetricsCollector::NewHistogramFamily(
    const std::string& name, const std::string& /*description*/,
    const Histogram::BucketBoundaries& /*boundaries*/) {
  auto family = std::make_shared<CollectedFamily<Histogram>>(this, name);
  absl::MutexLock lock(&mutex_);
  families_.push_back(family);
  return family.get();
}

MetricsCollector::Value* MetricsCollector::AddValue(const std::string& name,
                                                    const Labels& labels) {
  absl::MutexLock lock(&mutex_);
  values_.push_back(std::make_unique<Value>());
  Value* const value = values_.back().get();
  by_name_.emplace(name, std::make_pair(labels, value));
  return value;
}

double MetricsCollector::Sum(const std::string& name,
                             const Labels& labels) const {
  absl::MutexLock lock(&mutex_);
  double sum = 0.;
  const auto range = by_name_.equal_range(name);
  for (auto it = range.first; it != range.second; ++it) {
    const Labels& own = it->second.first;
    const bool matches =
        std::all_of(labels.begin(), labels.end(), [&own](const auto& wanted) {
          const auto found = own.find(wanted.first);
          return found != own.end() && found->second == wanted.second;
        });
    if (matches) sum += it->second.second->Get();
  }
  return sum;
}

bool MetricsCollector::Has(const std::string& name) const {
  absl::MutexLock lock(&mutex_);
  return by_name_.count(name) > 0;
}

std::map<std::string, double> MetricsCollector::Values() const {
  absl::MutexLock lock(&mutex_);
  std::map<std::string, double> result;
  for (const auto& entry : by_name_) {
    const Labels& labels = entry.second.first;
    const std::string key =
        labels.empty()
            ? entry.first
            : absl::StrCat(entry.first, "{",
                           absl::StrJoin(labels, ",", absl::PairFormatter("=")),
                           "}");
    result[key] += entry.second.second->Get();
  }
  return result;
}

}  // namespace evaluation
}  // namespace cartographer_ext
