// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
#include "cartographer_ext/common/progress.h"

#include <fcntl.h>
#include <poll.h>
#include <stdlib.h>
#include <unistd.h>

#include <string>

#include "absl/strings/match.h"
#include "gmock/gmock.h"
#include "gtest/gtest.h"

namespace cartographer_ext {
namespace {

TEST(ProgressTest, FormatsDurations) {
  EXPECT_EQ(FormatDuration(-3.), "0:00");
  EXPECT_EQ(FormatDuration(5.4), "0:05");
  EXPECT_EQ(FormatDuration(65.), "1:05");
  EXPECT_EQ(FormatDuration(7207.), "2:00:07");
  EXPECT_EQ(FormatDuration(1e300), "99:59:59");
}

TEST(ProgressTest, FormatsLines) {
  // 25 of 100 in 10 s: 30 s left.
  EXPECT_EQ(FormatProgress("scans", 25, 100, 10., ""),
            "scans 25/100  25 %, 0:30 left");
  EXPECT_EQ(FormatProgress("scans", 100, 100, 40., "done"),
            "scans 100/100 100 %, 0:40, done");
  EXPECT_EQ(FormatProgress("scans", 7, 0, 61., "x"), "scans 7, 1:01, x");
  EXPECT_EQ(FormatProgress("judging the map", 0, 0, 3., ""),
            "judging the map ...");
  EXPECT_EQ(FormatProgress("scans", 25, 100, 10., "", 70.),
            "scans 25/100  25 %, 1:10 left");
  EXPECT_EQ(FormatProgress("judging the map", 0, 0, 3., "", 8.),
            "judging the map ..., about 0:08 left");
}

TEST(ProgressTest, SilentWithoutTerminal) {
  ::testing::internal::CaptureStderr();
  {
    Progress progress("scans", 10);
    for (int i = 0; i <= 10; ++i) progress.Update(i);
    progress.Finish();
  }
  EXPECT_EQ(::testing::internal::GetCapturedStderr(), "");
}

TEST(ProgressTest, DrawsAndErasesOnATerminal) {
  const int terminal = ::posix_openpt(O_RDWR | O_NOCTTY);
  if (terminal < 0 || ::grantpt(terminal) != 0 || ::unlockpt(terminal) != 0) {
    GTEST_SKIP() << "no pseudo terminal";
  }
  const int other_end = ::open(::ptsname(terminal), O_RDWR | O_NOCTTY);
  ASSERT_GE(other_end, 0);
  const int saved = ::dup(STDERR_FILENO);
  ::dup2(other_end, STDERR_FILENO);
  {
    Progress progress("scans", 10);
    progress.Update(5, "note");
    progress.Update(6, "too soon to draw");
  }
  ::dup2(saved, STDERR_FILENO);
  ::close(saved);
  // What was written in pieces may be read in pieces.
  std::string text;
  pollfd ready = {terminal, POLLIN, 0};
  const auto is_complete = [&text]() {
    return absl::StrContains(text, "note") && absl::EndsWith(text, "\r\033[K");
  };
  while (!is_complete() && ::poll(&ready, 1, 2000) > 0) {
    char buffer[256];
    const ssize_t size = ::read(terminal, buffer, sizeof(buffer));
    if (size <= 0) break;
    text.append(buffer, size);
  }
  ::close(other_end);
  ::close(terminal);
  EXPECT_THAT(text, ::testing::HasSubstr("scans 5/10  50 %"));
  EXPECT_THAT(text, ::testing::HasSubstr("note"));
  EXPECT_THAT(text, ::testing::Not(::testing::HasSubstr("too soon")));
  EXPECT_THAT(text, ::testing::EndsWith("\r\033[K"));
}

}  // namespace
}  // namespace cartographer_ext
