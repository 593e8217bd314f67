// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
#include "cartographer_ext/experiments/robustness_sweep.h"

#include <cstdio>
#include <fstream>

#include "gmock/gmock.h"
#include "gtest/gtest.h"
#include "tests/test_data.h"

namespace cartographer_ext {
namespace experiments {
namespace {

using testing::HasSubstr;

// Our small square without outliers.
SweepOptions SquareOptions() {
  SweepOptions options;
  options.datasets = {test::OwnData("square.g2o")};
  options.kernels = {"dcs", "r_isam"};
  options.types = {"R"};
  options.counts = {"0"};
  options.seeds = 2;
  return options;
}

TEST(RobustnessSweepTest, NamesOfDataSets) {
  EXPECT_EQ(DatasetName("/a/b/intel.g2o.xz"), "intel");
  EXPECT_EQ(DatasetName("bicocca25b_0.800.g2o"), "bicocca25b_0.800");
  EXPECT_EQ(DatasetName("intel"), "intel");
}

TEST(RobustnessSweepTest, RunsAreWrittenAndReadUnchanged) {
  SweepRun run;
  run.dataset = "intel";
  run.kernel = "r_isam";
  run.type = "LG";
  run.requested_count = "50%";
  run.count = 12;
  run.seed = 3;
  run.ate = 0.25;
  run.step_p99 = 1.5;
  run.converged = true;
  SweepRun again;
  const nlohmann::json json = nlohmann::json::parse(ToJson(run).dump());
  ASSERT_TRUE(FromJson(json, &again));
  EXPECT_EQ(ToJson(again).dump(), ToJson(run).dump());
  nlohmann::json damaged = json;
  damaged["ate"] = "much";
  EXPECT_FALSE(FromJson(damaged, &again));
  damaged = json;
  damaged.erase("seed");
  EXPECT_FALSE(FromJson(damaged, &again));
  damaged = json;
  damaged["count"] = 1e300;
  EXPECT_FALSE(FromJson(damaged, &again));
  // A number that is not finite is written as null; earlier versions lack some.
  damaged = json;
  for (const char* const key : {"deviation", "right_truncated"}) {
    damaged[key] = nullptr;
  }
  damaged["undecidable"] = "yes";
  ASSERT_TRUE(FromJson(damaged, &again));
  EXPECT_EQ(again.deviation, -1.);
  EXPECT_EQ(again.right_truncated, 0.);
  EXPECT_FALSE(again.undecidable);
}

TEST(RobustnessSweepTest, RunsEveryCombinationInOrder) {
  const auto runs = RunSweep(SquareOptions());
  ASSERT_TRUE(runs.ok()) << runs.status();
  ASSERT_EQ(runs->size(), 4u);
  EXPECT_EQ((*runs)[0].seed, 1);
  EXPECT_EQ((*runs)[0].kernel, "dcs");
  EXPECT_EQ((*runs)[1].kernel, "r_isam");
  EXPECT_EQ((*runs)[2].seed, 2);
  for (const SweepRun& run : *runs) {
    EXPECT_EQ(run.dataset, "square");
    EXPECT_TRUE(run.success);
    EXPECT_LT(run.ate, 1e-3);
  }
}

TEST(RobustnessSweepTest, JournalIsContinued) {
  SweepOptions options = SquareOptions();
  options.journal_filename = testing::TempDir() + "robustness_sweep_test.jsonl";
  std::remove(options.journal_filename.c_str());
  const auto first = RunSweep(options);
  ASSERT_TRUE(first.ok()) << first.status();
  const auto second = RunSweep(options);
  ASSERT_TRUE(second.ok()) << second.status();
  ASSERT_EQ(second->size(), first->size());
  for (size_t i = 0; i != first->size(); ++i) {
    EXPECT_EQ(ToJson((*second)[i]).dump(), ToJson((*first)[i]).dump());
  }
  std::ofstream(options.journal_filename) << "something else\nand more\n";
  EXPECT_FALSE(RunSweep(options).ok());
  std::remove(options.journal_filename.c_str());
}

// Single loops and groups that a replay has refused come back at its end.
TEST(RobustnessSweepTest, AReplayEndsWithTheLoopsOfAllFloors) {
  SweepOptions options;
  options.families = {"floors"};
  options.kernels = {"r_isam"};
  options.types = {"R", "LG"};
  options.counts = {"50%"};
  options.first_seed = 411;
  options.seeds = 2;
  const auto runs = RunSweep(options);
  ASSERT_TRUE(runs.ok()) << runs.status();
  ASSERT_EQ(runs->size(), 4u);
  for (const SweepRun& run : *runs) {
    EXPECT_GT(run.recall, 0.95) << run.type << " " << run.seed;
  }
}

// All kernels agree on a map that is folded; a group of the loops that it has
// lost shows it.
TEST(RobustnessSweepTest, KernelsThatAgreeMayBeWrong) {
  SweepOptions options;
  options.families = {"floors"};
  options.kernels = {"auto"};
  options.types = {"R"};
  options.counts = {"80%"};
  options.first_seed = 406;
  const auto runs = RunSweep(options);
  ASSERT_TRUE(runs.ok()) << runs.status();
  ASSERT_EQ(runs->size(), 1u);
  EXPECT_TRUE(runs->front().success);
  EXPECT_GE(runs->front().recall, 0.99);
  EXPECT_LE(runs->front().truncated,
            runs->front().right_truncated * (1. + 1e-6));
}

TEST(RobustnessSweepTest, BadInputIsNamed) {
  SweepOptions options = SquareOptions();
  options.kernels = {"magic"};
  EXPECT_THAT(std::string(RunSweep(options).status().message()),
              HasSubstr("magic"));
  options = SquareOptions();
  options.counts = {"many"};
  EXPECT_THAT(std::string(RunSweep(options).status().message()),
              HasSubstr("many"));
  options = SquareOptions();
  options.datasets = {"nowhere.g2o"};
  EXPECT_THAT(std::string(RunSweep(options).status().message()),
              HasSubstr("nowhere.g2o"));
}

// `auto` on a ring with 80 % wrong loops of this type.
void ExpectRightMapOfRing(const std::string& type, const int seed) {
  SweepOptions options;
  options.families = {"ring"};
  options.kernels = {"auto"};
  options.types = {type};
  options.counts = {"80%"};
  options.first_seed = seed;
  const auto runs = RunSweep(options);
  ASSERT_TRUE(runs.ok()) << runs.status();
  EXPECT_TRUE(runs->front().success);
  EXPECT_LE(runs->front().truncated, runs->front().right_truncated);
}

// From chained odometry the kernels of the first round agree on a map without
// loops; what softer ones then find is another map and not agreed on.
TEST(RobustnessSweepTest, KernelsThatAgreeOnNothingDoNotEndTheSearch) {
  ExpectRightMapOfRing("R", 2010);
}

// So many wrong loops that groups are not searched where kernels find some map; here
// they find none with any loop.
TEST(RobustnessSweepTest, GroupsAreSearchedWhereNothingElseExplainsALoop) {
  ExpectRightMapOfRing("RG", 36001);
}

}  // namespace
}  // namespace experiments
}  // namespace cartographer_ext
