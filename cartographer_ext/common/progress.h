// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
//
// A progress line with the time left on standard error, shown only if that is a
// terminal.
#ifndef CARTOGRAPHER_EXT_COMMON_PROGRESS_H_
#define CARTOGRAPHER_EXT_COMMON_PROGRESS_H_

#include <chrono>
#include <cstdint>
#include <string>

namespace cartographer_ext {

// "1:05" or "2:00:07"; negative counts as zero.
std::string FormatDuration(double seconds);

// One line: label, counts, share and time left (elapsed time where `total` is
// unknown or reached), note. The time left is extrapolated from the counts
// unless `seconds_left` is given (>= 0).
std::string FormatProgress(const std::string& label, int64_t done,
                           int64_t total, double elapsed_seconds,
                           const std::string& note, double seconds_left = -1.);

// The progress line of one step. Not thread-safe.
class Progress {
 public:
  // `total` <= 0: unknown; shows counts and elapsed time only, or just the
  // label before the first count.
  Progress(std::string label, int64_t total);
  // Clears the line.
  ~Progress();
  // `done` of total; redraws at most ten times a second. `note` is appended.
  // `seconds_left` as in FormatProgress.
  void Update(int64_t done, const std::string& note = "",
              double seconds_left = -1.);
  void Finish();

 private:
  const std::string label_;
  const int64_t total_;
  const bool on_terminal_;
  bool drawn_ = false;
  std::chrono::steady_clock::time_point start_;
  std::chrono::steady_clock::time_point last_draw_;
};

}  // namespace cartographer_ext

#endif  // CARTOGRAPHER_EXT_COMMON_PROGRESS_H_
