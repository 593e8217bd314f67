// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
#include "cartographer_ext/tuning/trial_run.h"

#include <fstream>
#include <iterator>

#include "gmock/gmock.h"
#include "gtest/gtest.h"
#include "tests/tuning/temporary_file.h"

namespace cartographer_ext {
namespace tuning {
namespace {

using testing::HasSubstr;

// A quick drive of three corners in a small room.
constexpr char kWorld[] = R"(world room
rectangle 0 0 6 5
rectangle 2.5 2 3.2 3
laser beams=90 fov=360 max_range=10 noise=0.01 rate=5
odometry rate=10 noise=0.002
robot radius=0.2 speed=0.8
start 1 1 0
goto 5 1
goto 5 4
goto 1 4
goto 1 1
wait 1
revisit start 1 1
)";

class RunTrialTest : public testing::Test {
 protected:
  RunRequest Request() const {
    RunRequest request;
    std::ifstream stream("configuration_files/stock.lua");
    request.code = std::string(std::istreambuf_iterator<char>(stream), {});
    request.name = "stock.lua";
    request.directories = {"configuration_files"};
    request.input = *ParseInput(folder_.Write("room.world", kWorld) + "#3");
    request.wants_self_consistency = true;
    return request;
  }
  const test::Folder folder_;
};

TEST_F(RunTrialTest, MeasuresAWorldAgainstItsTruth) {
  const auto metrics = RunTrial(Request());
  ASSERT_TRUE(metrics.ok()) << metrics.status();
  for (const char* name :
       {"relations", "relations_median", "relations_rotation",
        "broken_fraction", "ate", "rpe", "wall_seconds", "cpu_seconds",
        "loop_search_cpu_seconds", "self_consistency", "wall_doubling", "nodes",
        "submaps", "loops"}) {
    EXPECT_EQ(metrics->count(name), 1u) << name;
  }
  EXPECT_LT(metrics->at("relations"), 0.1);
  EXPECT_LT(metrics->at("ate"), 0.1);
  EXPECT_EQ(metrics->at("broken_fraction"), 0.);
  EXPECT_GE(metrics->at("self_consistency"), 0.);
  EXPECT_LT(metrics->at("self_consistency"), 0.5);
}

TEST_F(RunTrialTest, RunsAPartOfTheRecording) {
  RunRequest request = Request();
  const auto whole = RunTrial(request);
  request.fidelity = 0.5;
  const auto half = RunTrial(request);
  ASSERT_TRUE(whole.ok() && half.ok());
  EXPECT_GT(half->at("nodes"), 0.2 * whole->at("nodes"));
  EXPECT_LT(half->at("nodes"), 0.8 * whole->at("nodes"));
}

TEST_F(RunTrialTest, IsRepeatable) {
  const auto first = RunTrial(Request());
  const auto second = RunTrial(Request());
  ASSERT_TRUE(first.ok() && second.ok());
  for (const char* name : {"relations", "ate", "nodes", "self_consistency"}) {
    EXPECT_EQ(first->at(name), second->at(name)) << name;
  }
}

TEST_F(RunTrialTest, RequestsSurviveTheWayToAWorker) {
  RunRequest request = Request();
  request.fidelity = 0.25;
  request.odometry_source = "odom";
  request.num_threads = 3;
  const auto copy =
      RequestFromJson(nlohmann::json::parse(ToJson(request).dump()));
  ASSERT_TRUE(copy.ok());
  EXPECT_EQ(ToJson(*copy), ToJson(request));
  EXPECT_EQ(copy->input.seed, 3u);
  EXPECT_EQ(copy->fidelity, 0.25);
  EXPECT_FALSE(RequestFromJson(nlohmann::json::object()).ok());
}

TEST_F(RunTrialTest, BadInputIsAnError) {
  RunRequest request = Request();
  request.code = "return { map_builder = 3 }";
  EXPECT_THAT(std::string(RunTrial(request).status().message()),
              HasSubstr("stock.lua"));
  request = Request();
  request.input = *ParseInput(folder_.Write("empty.clf", "# nothing\n"));
  EXPECT_FALSE(RunTrial(request).ok());
  request.input = *ParseInput(folder_.Write("bad.pbstream", "nonsense"));
  EXPECT_THAT(std::string(RunTrial(request).status().message()),
              HasSubstr("bad.pbstream"));
  request = Request();
  request.input = *ParseInput(folder_.Write("bad.world", "worl x"));
  EXPECT_FALSE(RunTrial(request).ok());
}

TEST(TrialRunTest, BadRequestsAreFailures) {
  EXPECT_EQ(AnswerRequest(nlohmann::json("x"))["ok"], false);
  EXPECT_EQ(
      AnswerRequest({{"code", "return {"}, {"input", {{"name", "a"}}}})["ok"],
      false);
}

}  // namespace
}  // namespace tuning
}  // namespace cartographer_ext
