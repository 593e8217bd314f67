// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
#include "cartographer/sensor/internal/ordered_multi_queue.h"

#include <memory>
#include <string>
#include <vector>

#include "absl/strings/str_cat.h"
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

class OrderedMultiQueueTest : public ::testing::Test {
 protected:
  ~OrderedMultiQueueTest() override { queue_.Flush(); }

  void AddQueue(const int trajectory_id, const std::string& sensor_id) {
    queue_.AddQueue(
        {trajectory_id, sensor_id},
        [this, trajectory_id](std::unique_ptr<Data> data) {
          out_.push_back(absl::StrCat(trajectory_id, data->GetSensorId(),
                                      common::ToUniversal(data->GetTime())));
        });
  }
  void Add(const int trajectory_id, const std::string& sensor_id,
           const int64 ticks) {
    queue_.Add({trajectory_id, sensor_id}, NewData(sensor_id, ticks));
  }

  OrderedMultiQueue queue_;
  std::vector<std::string> out_;
};

using Texts = std::vector<std::string>;

TEST_F(OrderedMultiQueueTest, MergesByTime) {
  AddQueue(0, "a");
  AddQueue(0, "b");
  Add(0, "a", 4);
  Add(0, "a", 6);
  EXPECT_TRUE(out_.empty());
  EXPECT_EQ(queue_.GetBlocker().sensor_id, "b");
  Add(0, "b", 4);
  // Equal times: by name.
  EXPECT_EQ(out_, (Texts{"0a4", "0b4"}));
  Add(0, "b", 5);
  Add(0, "b", 9);
  EXPECT_EQ(out_, (Texts{"0a4", "0b4", "0b5", "0a6"}));
  EXPECT_EQ(queue_.GetBlocker().sensor_id, "a");
  queue_.Flush();
  EXPECT_EQ(out_.back(), "0b9");
}

TEST_F(OrderedMultiQueueTest, FinishedQueuesAreNotWaitedFor) {
  AddQueue(0, "a");
  AddQueue(0, "b");
  Add(0, "a", 1);
  Add(0, "b", 1);
  Add(0, "a", 2);
  Add(0, "a", 3);
  queue_.MarkQueueAsFinished({0, "b"});
  EXPECT_EQ(out_, (Texts{"0a1", "0b1", "0a2", "0a3"}));
}

TEST_F(OrderedMultiQueueTest, StartsWhenAllSensorsHaveBegun) {
  AddQueue(0, "a");
  AddQueue(0, "b");
  for (const int64 ticks : {1, 2, 3, 4, 7}) Add(0, "a", ticks);
  Add(0, "b", 5);
  // Of a the last before 5 is kept.
  EXPECT_EQ(out_, (Texts{"0a4", "0b5"}));
  Add(0, "b", 8);
  EXPECT_EQ(out_, (Texts{"0a4", "0b5", "0a7"}));
}

TEST_F(OrderedMultiQueueTest, WaitsToKnowTheLastBeforeTheStart) {
  AddQueue(0, "a");
  AddQueue(0, "b");
  Add(0, "a", 1);
  Add(0, "b", 5);
  EXPECT_TRUE(out_.empty());
  EXPECT_EQ(queue_.GetBlocker().sensor_id, "a");
  Add(0, "a", 3);
  EXPECT_TRUE(out_.empty());
  Add(0, "a", 5);
  EXPECT_EQ(out_, (Texts{"0a5"}));
  Add(0, "a", 6);
  EXPECT_EQ(out_, (Texts{"0a5", "0b5"}));
}

TEST_F(OrderedMultiQueueTest, EarlyReadingOfAFinishedQueueIsPassedOn) {
  AddQueue(0, "a");
  AddQueue(0, "b");
  Add(0, "a", 1);
  Add(0, "b", 5);
  queue_.MarkQueueAsFinished({0, "a"});
  EXPECT_EQ(out_, (Texts{"0a1", "0b5"}));
}

TEST_F(OrderedMultiQueueTest, TrajectoriesStartOnTheirOwn) {
  AddQueue(0, "a");
  AddQueue(1, "a");
  AddQueue(1, "b");
  Add(0, "a", 1);
  Add(1, "a", 1);
  Add(1, "a", 2);
  Add(1, "b", 3);
  Add(1, "b", 9);
  EXPECT_EQ(out_, (Texts{"0a1"}));
  Add(0, "a", 9);
  EXPECT_EQ(out_, (Texts{"0a1"}));
  Add(1, "a", 4);
  EXPECT_EQ(out_, (Texts{"0a1", "1a2", "1b3", "1a4"}));
}

TEST_F(OrderedMultiQueueTest, UnknownQueuesAreIgnored) {
  AddQueue(0, "a");
  Add(0, "other", 1);
  Add(0, "a", 1);
  EXPECT_EQ(out_, (Texts{"0a1"}));
}

using OrderedMultiQueueDeathTest = OrderedMultiQueueTest;

TEST_F(OrderedMultiQueueDeathTest, Misuse) {
  AddQueue(0, "a");
  EXPECT_DEATH(AddQueue(0, "a"), "exists");
  EXPECT_DEATH(queue_.MarkQueueAsFinished({0, "b"}), "there is no queue");
  Add(0, "a", 5);
  Add(0, "a", 9);
  EXPECT_DEATH(Add(0, "a", 7), "not in order of time");
  EXPECT_DEATH(
      {
        OrderedMultiQueue unfinished;
        unfinished.AddQueue({0, "x"}, [](std::unique_ptr<Data>) {});
      },
      "unfinished");
}

}  // namespace
}  // namespace sensor
}  // namespace cartographer
