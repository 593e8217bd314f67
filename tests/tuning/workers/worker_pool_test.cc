// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
#include "cartographer_ext/tuning/workers/worker_pool.h"

#include <errno.h>
#include <signal.h>
#include <unistd.h>

#include <cstdlib>
#include <iostream>
#include <set>

#include "glog/logging.h"
#include "gmock/gmock.h"
#include "gtest/gtest.h"

namespace cartographer_ext {
namespace tuning {
namespace {

using testing::HasSubstr;

nlohmann::json Act(const nlohmann::json& request) {
  const std::string what = request["what"].get<std::string>();
  if (what == "crash") raise(SIGSEGV);
  if (what == "exit") _exit(3);
  if (what == "killed") raise(SIGKILL);
  if (what == "check") {
    google::InstallFailureFunction([]() { std::_Exit(1); });
    CHECK_GT(1, 2) << "of all things";
  }
  if (what == "spin") {
    volatile int count = 0;
    while (true) count = count + 1;
  }
  if (what == "sleep") sleep(30);
  return {{"ok", true}, {"metrics", {{"twice", 2. * double(request["x"])}}}};
}

nlohmann::json Request(const std::string& what, const double x = 0.) {
  return {{"what", what}, {"x", x}};
}

TEST(LocalWorkerPoolTest, RunsSeveralAtATime) {
  LocalWorkerPool pool(3, 0., &Act);
  EXPECT_EQ(pool.num_workers(), 3);
  for (int i = 0; i < 3; ++i) pool.Start(i, Request("work", i));
  EXPECT_EQ(pool.num_running(), 3);
  std::set<int> ids;
  for (int i = 0; i < 3; ++i) {
    const auto result = pool.Wait(60.);
    ASSERT_TRUE(result.has_value());
    EXPECT_EQ(result->answer["ok"], true);
    EXPECT_EQ(result->answer["metrics"]["twice"], 2. * result->id);
    EXPECT_GE(result->answer["wall_seconds"].get<double>(), 0.);
    EXPECT_GE(result->answer["cpu_seconds"].get<double>(), 0.);
    ids.insert(result->id);
  }
  EXPECT_EQ(ids.size(), 3u);
  EXPECT_EQ(pool.num_running(), 0);
  EXPECT_FALSE(pool.Wait(0.01).has_value());
}

std::string MessageOf(const std::string& what, const double max_cpu_seconds) {
  LocalWorkerPool pool(1, max_cpu_seconds, &Act);
  pool.Start(7, Request(what));
  const auto result = pool.Wait(120.);
  if (!result.has_value()) return "nothing";
  EXPECT_EQ(result->id, 7);
  EXPECT_EQ(result->answer["ok"], false);
  return result->answer["message"].get<std::string>();
}

TEST(LocalWorkerPoolTest, WhatEndsARunIsItsFailure) {
  EXPECT_THAT(MessageOf("exit", 0.), HasSubstr("code 3"));
  EXPECT_THAT(MessageOf("check", 0.), HasSubstr("of all things"));
  EXPECT_THAT(MessageOf("spin", 1.), HasSubstr("limit of CPU time"));
  EXPECT_THAT(MessageOf("killed", 0.), HasSubstr("from outside"));
  // A sanitizer turns the signal into an exit code.
  EXPECT_THAT(MessageOf("crash", 0.),
              testing::AnyOf(HasSubstr("it crashed"), HasSubstr("code")));
}

TEST(LocalWorkerPoolTest, StopsWhatIsRunning) {
  LocalWorkerPool pool(2, 0., &Act);
  pool.Start(0, Request("sleep"));
  pool.Start(1, Request("sleep"));
  pool.StopAll();
  EXPECT_EQ(pool.num_running(), 0);
  pool.Start(2, Request("work", 4.));
  EXPECT_EQ(pool.Wait(60.)->answer["metrics"]["twice"], 8.);
}

}  // namespace
}  // namespace tuning
}  // namespace cartographer_ext
