// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
#include "cartographer/sensor/internal/collator.h"

#include <map>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "absl/strings/str_cat.h"
#include "cartographer/sensor/internal/trajectory_collator.h"
#include "gtest/gtest.h"

namespace cartographer {
namespace sensor {
namespace {

class FakeData : public Data {
 public:
  FakeData(const std::string& sensor_id, const int64 ticks)
      : Data(sensor_id), time_(common::FromUniversal(ticks)) {}
  common::Time GetTime() const override { return time_; }
  void AddToTrajectoryBuilder(mapping::TrajectoryBuilderInterface*) override {}

 private:
  const common::Time time_;
};

std::unique_ptr<Data> NewData(const std::string& sensor_id, const int64 ticks) {
  return std::unique_ptr<Data>(new FakeData(sensor_id, ticks));
}

// What comes out, as trajectory, sensor, ticks.
class Recorder {
 public:
  CollatorInterface::Callback For(const int trajectory_id) {
    return [this, trajectory_id](const std::string& sensor_id,
                                 std::unique_ptr<Data> data) {
      EXPECT_EQ(sensor_id, data->GetSensorId());
      out_.push_back(absl::StrCat(trajectory_id, sensor_id,
                                  common::ToUniversal(data->GetTime())));
    };
  }
  const std::vector<std::string>& out() const { return out_; }

 private:
  std::vector<std::string> out_;
};

using Texts = std::vector<std::string>;

// Two trajectories; the scans of the second one come late.
void Feed(CollatorInterface* const collator, Recorder* const recorder) {
  collator->AddTrajectory(0, {"laser", "odom"}, recorder->For(0));
  collator->AddTrajectory(1, {"laser"}, recorder->For(1));
  collator->AddSensorData(0, NewData("odom", 1));
  collator->AddSensorData(0, NewData("laser", 1));
  collator->AddSensorData(0, NewData("odom", 3));
  collator->AddSensorData(0, NewData("laser", 4));
  collator->AddSensorData(1, NewData("laser", 2));
}

TEST(CollatorTest, OneOrderForAll) {
  Collator collator;
  Recorder recorder;
  Feed(&collator, &recorder);
  EXPECT_EQ(recorder.out(), (Texts{"0laser1", "0odom1", "1laser2"}));
  EXPECT_EQ(collator.GetBlockingTrajectoryId(), 1);
  collator.FinishTrajectory(1);
  EXPECT_EQ(recorder.out(), (Texts{"0laser1", "0odom1", "1laser2", "0odom3"}));
  collator.Flush();
  EXPECT_EQ(recorder.out().back(), "0laser4");
}

TEST(TrajectoryCollatorTest, TrajectoriesDoNotWait) {
  TrajectoryCollator collator;
  Recorder recorder;
  Feed(&collator, &recorder);
  EXPECT_EQ(recorder.out(), (Texts{"0laser1", "0odom1", "0odom3", "1laser2"}));
  EXPECT_FALSE(collator.GetBlockingTrajectoryId().has_value());
  collator.FinishTrajectory(0);
  EXPECT_EQ(recorder.out().back(), "0laser4");
  collator.Flush();
}

class CountingFactory : public metrics::FamilyFactory,
                        public metrics::Family<metrics::Counter>,
                        public metrics::Counter {
 public:
  metrics::Family<metrics::Counter>* NewCounterFamily(
      const std::string& name, const std::string&) override {
    EXPECT_EQ(name, "collator_input_total");
    return this;
  }
  metrics::Family<metrics::Gauge>* NewGaugeFamily(const std::string&,
                                                  const std::string&) override {
    return metrics::Family<metrics::Gauge>::Null();
  }
  metrics::Family<metrics::Histogram>* NewHistogramFamily(
      const std::string&, const std::string&,
      const metrics::Histogram::BucketBoundaries&) override {
    return metrics::Family<metrics::Histogram>::Null();
  }
  metrics::Counter* Add(
      const std::map<std::string, std::string>& labels) override {
    labels_.push_back(labels);
    return this;
  }
  void Increment() override { ++count_; }
  void Increment(double) override { ADD_FAILURE(); }

  std::vector<std::map<std::string, std::string>> labels_;
  int count_ = 0;
};

TEST(TrajectoryCollatorTest, CountsReadings) {
  CountingFactory factory;
  TrajectoryCollator::RegisterMetrics(&factory);
  {
    TrajectoryCollator collator;
    Recorder recorder;
    Feed(&collator, &recorder);
    collator.Flush();
  }
  EXPECT_EQ(factory.count_, 5);
  ASSERT_EQ(factory.labels_.size(), 3);
  EXPECT_EQ(factory.labels_[0].at("sensor_id"), "odom");
  EXPECT_EQ(factory.labels_[2].at("trajectory_id"), "1");
}

}  // namespace
}  // namespace sensor
}  // namespace cartographer
