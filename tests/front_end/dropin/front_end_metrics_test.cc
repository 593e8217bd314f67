// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
#include "cartographer_ext/front_end/dropin/front_end_metrics.h"

#include <deque>
#include <map>
#include <string>

#include "absl/strings/str_cat.h"
#include "cartographer/metrics/counter.h"
#include "cartographer/metrics/gauge.h"
#include "cartographer/metrics/histogram.h"
#include "gtest/gtest.h"

namespace cartographer_ext {
namespace front_end {
namespace {

namespace metrics = cartographer::metrics;
using Labels = std::map<std::string, std::string>;
using proto::MatchRecord;

// Counter, gauge and histogram in one: a number.
class Number : public metrics::Counter,
               public metrics::Gauge,
               public metrics::Histogram {
 public:
  void Increment() override { value += 1.; }
  void Increment(const double by_value) override { value += by_value; }
  void Decrement() override { value -= 1.; }
  void Decrement(const double by_value) override { value -= by_value; }
  void Set(const double new_value) override { value = new_value; }
  void Observe(const double observed) override {
    value += 1.;
    last_observed = observed;
  }

  double value = 0.;
  double last_observed = 0.;
};

// Numbers by "name{label=value}".
class Registry : public metrics::FamilyFactory {
 public:
  template <typename Metric>
  class NamedFamily : public metrics::Family<Metric> {
   public:
    NamedFamily(Registry* const registry, const std::string& name)
        : registry_(registry), name_(name) {}
    Metric* Add(const Labels& labels) override {
      std::string name = name_;
      for (const auto& label : labels) {
        absl::StrAppend(&name, "{", label.first, "=", label.second, "}");
      }
      return &registry_->numbers[name];
    }

   private:
    Registry* const registry_;
    const std::string name_;
  };

  metrics::Family<metrics::Counter>* NewCounterFamily(
      const std::string& name, const std::string&) override {
    counters_.emplace_back(this, name);
    return &counters_.back();
  }
  metrics::Family<metrics::Gauge>* NewGaugeFamily(const std::string& name,
                                                  const std::string&) override {
    gauges_.emplace_back(this, name);
    return &gauges_.back();
  }
  metrics::Family<metrics::Histogram>* NewHistogramFamily(
      const std::string& name, const std::string&,
      const metrics::Histogram::BucketBoundaries&) override {
    histograms_.emplace_back(this, name);
    return &histograms_.back();
  }

  const Number& Of(const std::string& name) {
    return numbers["mapping_2d_adaptive_local_trajectory_builder_" + name];
  }

  std::map<std::string, Number> numbers;

 private:
  std::deque<NamedFamily<metrics::Counter>> counters_;
  std::deque<NamedFamily<metrics::Gauge>> gauges_;
  std::deque<NamedFamily<metrics::Histogram>> histograms_;
};

TEST(FrontEndMetricsTest, CountsScansByWhatWasFound) {
  // Handles are kept for the life of the process.
  static auto* const registry = new Registry;
  RegisterFrontEndMetrics(registry);
  const size_t registered = registry->numbers.size();

  MatchRecord record;
  record.set_score(0.7);
  CountMatch(record);
  record.set_odometry(MatchRecord::SLIPPING);
  record.set_degeneracy(MatchRecord::TRANSLATION);
  record.set_searched(true);
  record.set_source(MatchRecord::SEARCH);
  record.set_score(0.4);
  record.set_time_offset(0.02);
  record.set_odometry_scale(1.01);
  CountMatch(record);
  record.set_source(MatchRecord::ODOMETRY);
  CountMatch(record);

  EXPECT_EQ(registry->Of("scans{odometry=ok}").value, 1.);
  EXPECT_EQ(registry->Of("scans{odometry=slipping}").value, 2.);
  EXPECT_EQ(registry->Of("scans{odometry=slip_suspected}").value, 0.);
  EXPECT_EQ(registry->Of("degenerate_scans").value, 2.);
  EXPECT_EQ(registry->Of("searches{outcome=relocated}").value, 1.);
  EXPECT_EQ(registry->Of("searches{outcome=kept}").value, 1.);
  EXPECT_EQ(registry->Of("scores").value, 3.);
  EXPECT_EQ(registry->Of("scores").last_observed, 0.4);
  EXPECT_EQ(registry->Of("time_offset").value, 0.02);
  EXPECT_EQ(registry->Of("odometry_scale").value, 1.01);
  // All names asked for above were registered.
  EXPECT_EQ(registry->numbers.size(), registered);
}

}  // namespace
}  // namespace front_end
}  // namespace cartographer_ext
