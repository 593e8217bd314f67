// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
//
// What the commands do with maps whose stamps no clock can have, and with maps
// whose clock began with the count of the host, in the year 1.
#include <algorithm>
#include <cstdint>
#include <functional>
#include <limits>
#include <string>
#include <vector>

#include "absl/strings/str_cat.h"
#include "cartographer_ext/common/host_ticks.h"
#include "cartographer_ext/io/pbstream/pbstream_reader.h"
#include "cartographer_ext/io/pbstream/pbstream_writer.h"
#include "gmock/gmock.h"
#include "gtest/gtest.h"
#include "tests/tools/run_command.h"

namespace cartographer_ext {
namespace test {
namespace {

using testing::HasSubstr;
using Change = std::function<int64_t(int64_t)>;

constexpr int64_t kMin = std::numeric_limits<int64_t>::min();
constexpr int64_t kMax = std::numeric_limits<int64_t>::max();

void ChangeNode(const size_t index, const Change& change,
                io::Pbstream* const map) {
  auto* const node = map->pose_graph.mutable_trajectory(0)->mutable_node(index);
  node->set_timestamp(change(node->timestamp()));
  map->nodes[index].mutable_node_data()->set_timestamp(node->timestamp());
}

void ChangeOdometry(const size_t index, const Change& change,
                    io::Pbstream* const map) {
  auto* const data = map->odometry_data[index].mutable_odometry_data();
  data->set_timestamp(change(data->timestamp()));
}

class StampsTest : public testing::Test {
 protected:
  static void SetUpTestSuite() {
    folder_ = new TemporaryFolder;
    WriteRoomMap(*folder_, 120);
  }
  static void TearDownTestSuite() { delete folder_; }

  static std::string File(const std::string& name) { return *folder_ / name; }

  static io::Pbstream Map() {
    auto map = io::ReadPbstream(File("room.pbstream"));
    EXPECT_TRUE(map.ok()) << map.status();
    return *std::move(map);
  }

  // What reads the map below.
  static std::vector<CommandResult> RunAll() {
    const std::string map = File("changed.pbstream");
    return {RunCommand("evaluate", {map}),
            RunCommand("evaluate", {map, "-rerun_configuration_directory",
                                    "configuration_files"}),
            RunCommand("repair", {map, "-dry_run"}),
            RunCommand("slam", {"-input_filename", File("room.clf"),
                                "-load_state_filename", map,
                                "-trajectory_filename", File("later.tum")})};
  }

  static void ExpectRefused(const io::Pbstream& map,
                            const std::string& problem) {
    ASSERT_TRUE(io::WritePbstream(map, File("changed.pbstream")).ok());
    for (const CommandResult& result : RunAll()) {
      EXPECT_EQ(result.exit_code, 1) << problem;
      EXPECT_THAT(result.error, HasSubstr("changed.pbstream"));
      EXPECT_THAT(result.error, HasSubstr(problem));
    }
  }

  static TemporaryFolder* folder_;
};

TemporaryFolder* StampsTest::folder_ = nullptr;

TEST_F(StampsTest, NodesThatNoClockHas) {
  for (const int64_t time : {kMin, kMax}) {
    io::Pbstream map = Map();
    const size_t index = time == kMin ? 0 : map.nodes.size() - 1;
    ChangeNode(
        index, [time](int64_t) { return time; }, &map);
    ExpectRefused(map, absl::StrCat("node (0, ", index, ") is at ", time));
  }
}

TEST_F(StampsTest, ReadingsThatNoClockHas) {
  for (const int64_t time : {kMin, kMax}) {
    io::Pbstream map = Map();
    ASSERT_FALSE(map.odometry_data.empty());
    ChangeOdometry(
        time == kMin ? 0 : map.odometry_data.size() - 1,
        [time](int64_t) { return time; }, &map);
    ExpectRefused(
        map, absl::StrCat("the odometry reading of trajectory 0 at ", time));
  }
}

TEST_F(StampsTest, Backwards) {
  io::Pbstream map = Map();
  const int64_t first = map.nodes[0].node_data().timestamp();
  ChangeNode(
      1, [first](int64_t) { return first - 1; }, &map);
  ExpectRefused(map, "node (0, 1) is older than the node before it");
}

// The farthest that are allowed.
TEST_F(StampsTest, AnyTimesOfAClock) {
  io::Pbstream far = Map();
  const auto first = [](int64_t) { return int64_t{0}; };
  ChangeNode(0, first, &far);
  ChangeOdometry(0, first, &far);
  const auto last = [](int64_t) { return kMaxHostTicks; };
  ChangeNode(far.nodes.size() - 1, last, &far);
  ChangeOdometry(far.odometry_data.size() - 1, last, &far);

  // A clock that began in the year 1 is set while the robot drives.
  io::Pbstream set = Map();
  const auto before = [](const int64_t time) {
    return kEraTicks - (kMaxHostTicks - time) / 1000;
  };
  for (size_t i = 0; i != set.nodes.size() / 2; ++i) {
    ChangeNode(i, before, &set);
  }
  for (size_t i = 0; i != set.odometry_data.size() / 2; ++i) {
    ChangeOdometry(i, before, &set);
  }
  for (const io::Pbstream* const map : {&far, &set}) {
    ASSERT_TRUE(io::WritePbstream(*map, File("changed.pbstream")).ok());
    for (const CommandResult& result : RunAll()) {
      EXPECT_EQ(result.exit_code, 0) << (map == &far) << result.error;
    }
  }
}

TEST_F(StampsTest, AClockThatBeganWithTheMap) {
  io::Pbstream map = Map();
  const int64_t start =
      std::min(map.nodes[0].node_data().timestamp(),
               map.odometry_data[0].odometry_data().timestamp());
  const auto shift = [start](const int64_t time) { return time - start; };
  for (size_t i = 0; i != map.nodes.size(); ++i) ChangeNode(i, shift, &map);
  for (size_t i = 0; i != map.odometry_data.size(); ++i) {
    ChangeOdometry(i, shift, &map);
  }
  ASSERT_TRUE(io::WritePbstream(map, File("changed.pbstream")).ok());
  for (const CommandResult& result : RunAll()) {
    EXPECT_EQ(result.exit_code, 0) << result.error;
  }
  // Its figures are those of the map as it was.
  nlohmann::json figures[2];
  for (const bool changed : {false, true}) {
    const CommandResult result = RunCommand(
        "evaluate",
        {File(changed ? "changed.pbstream" : "room.pbstream"), "-json", "-"});
    ASSERT_EQ(result.exit_code, 0) << result.error;
    figures[changed] = ParseJson(result.out);
    figures[changed].erase("pbstream");
  }
  EXPECT_GT(figures[0]["trajectory_metres"], 3.);
  EXPECT_EQ(figures[0], figures[1]);
}

}  // namespace
}  // namespace test
}  // namespace cartographer_ext
