// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
#include "cartographer_ext/configuration/fatal_guard.h"

#include <csignal>
#include <cstdlib>
#include <iostream>

#include "glog/logging.h"
#include "gmock/gmock.h"
#include "gtest/gtest.h"

namespace cartographer_ext {
namespace evaluation {
namespace {

TEST(FatalGuardTest, FineBodiesAreFineAndLeaveNoTrace) {
  int value = 1;
  EXPECT_TRUE(TryInChildProcess([&value] { value = 2; }).ok());
  EXPECT_EQ(value, 1);
}

TEST(FatalGuardTest, AFailedCheckBecomesAnError) {
  const int keys = 0;
  const absl::Status status = TryInChildProcess(
      [keys] { CHECK_GT(keys, 0) << "min_score is missing"; });
  EXPECT_EQ(status.code(), absl::StatusCode::kInvalidArgument);
  EXPECT_THAT(std::string(status.message()),
              testing::HasSubstr("min_score is missing"));
}

TEST(FatalGuardTest, LongMessagesArriveWhole) {
  const std::string text(200000, 'x');
  const absl::Status status =
      TryInChildProcess([&text] { LOG(FATAL) << text << " end"; });
  EXPECT_EQ(status.code(), absl::StatusCode::kInvalidArgument);
  // glog keeps messages of up to 30000 characters.
  EXPECT_GT(status.message().size(), 20000u);
}

TEST(FatalGuardTest, WarningsAreNoErrors) {
  EXPECT_TRUE(TryInChildProcess([] { LOG(ERROR) << "not fatal"; }).ok());
}

TEST(FatalGuardTest, ACrashIsAnotherKindOfError) {
  const absl::Status status = TryInChildProcess([] { std::raise(SIGKILL); });
  EXPECT_EQ(status.code(), absl::StatusCode::kInternal);
}

TEST(FatalGuardTest, AnotherExitCodeIsAnErrorToo) {
  const absl::Status status = TryInChildProcess([] { std::_Exit(7); });
  EXPECT_EQ(status.code(), absl::StatusCode::kInternal);
  EXPECT_THAT(std::string(status.message()), testing::HasSubstr("7"));
}

TEST(FatalGuardTest, EndingTheProgramIsNoSuccess) {
  const absl::Status status = TryInChildProcess([] { std::_Exit(0); });
  EXPECT_EQ(status.code(), absl::StatusCode::kInvalidArgument);
  EXPECT_THAT(std::string(status.message()), testing::HasSubstr("os.exit"));
}

TEST(FatalGuardTest, WorkThatDoesNotEndIsStopped) {
  const absl::Status status = TryInChildProcess(
      [] {
        for (volatile int i = 0;; i = 1 - i) {
        }
      },
      1);
  EXPECT_EQ(status.code(), absl::StatusCode::kInvalidArgument);
  EXPECT_THAT(std::string(status.message()),
              testing::HasSubstr("more than 1 s"));
}

}  // namespace
}  // namespace evaluation
}  // namespace cartographer_ext
