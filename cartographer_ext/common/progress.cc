// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
#include "cartographer_ext/common/progress.h"

#include <unistd.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <utility>

#include "absl/strings/str_cat.h"
#include "absl/strings/str_format.h"

namespace cartographer_ext {
namespace {

// Back to the first column, erasing the old text.
constexpr char kEraseLine[] = "\r\033[K";
constexpr double kSecondsBetweenDrawings = 0.1;

double Seconds(std::chrono::steady_clock::duration duration) {
  return std::chrono::duration<double>(duration).count();
}

}  // namespace

std::string FormatDuration(double seconds) {
  // An estimate of days is meaningless; the bound also keeps the conversion
  // defined.
  const int64_t whole = std::llround(std::min(std::max(seconds, 0.), 359999.));
  if (whole < 3600) return absl::StrFormat("%d:%02d", whole / 60, whole % 60);
  return absl::StrFormat("%d:%02d:%02d", whole / 3600, whole / 60 % 60,
                         whole % 60);
}

std::string FormatProgress(const std::string& label, int64_t done,
                           int64_t total, double elapsed_seconds,
                           const std::string& note, const double seconds_left) {
  std::string line = absl::StrCat(label, " ", done);
  if (total <= 0 && done == 0) {
    line = absl::StrCat(label, " ...");
    if (seconds_left >= 0.) {
      absl::StrAppend(&line, ", about ", FormatDuration(seconds_left), " left");
    }
  } else if (total > 0) {
    const double share =
        std::min(1., std::max(0., static_cast<double>(done) / total));
    absl::StrAppendFormat(&line, "/%d %3.0f %%", total, 100. * share);
    if (done > 0 && done < total) {
      const double in_proportion =
          elapsed_seconds * (static_cast<double>(total) / done - 1.);
      absl::StrAppend(
          &line, ", ",
          FormatDuration(seconds_left >= 0. ? seconds_left : in_proportion),
          " left");
    } else {
      absl::StrAppend(&line, ", ", FormatDuration(elapsed_seconds));
    }
  } else {
    absl::StrAppend(&line, ", ", FormatDuration(elapsed_seconds));
  }
  if (!note.empty()) absl::StrAppend(&line, ", ", note);
  return line;
}

Progress::Progress(std::string label, int64_t total)
    : label_(std::move(label)),
      total_(total),
      on_terminal_(::isatty(STDERR_FILENO) == 1),
      start_(std::chrono::steady_clock::now()) {}

Progress::~Progress() { Finish(); }

void Progress::Update(int64_t done, const std::string& note,
                      const double seconds_left) {
  if (!on_terminal_) return;
  const auto now = std::chrono::steady_clock::now();
  if (drawn_ && Seconds(now - last_draw_) < kSecondsBetweenDrawings) return;
  drawn_ = true;
  last_draw_ = now;
  std::fputs(absl::StrCat(kEraseLine, FormatProgress(label_, done, total_,
                                                     Seconds(now - start_),
                                                     note, seconds_left))
                 .c_str(),
             stderr);
  std::fflush(stderr);
}

void Progress::Finish() {
  if (!drawn_) return;
  std::fputs(kEraseLine, stderr);
  std::fflush(stderr);
  drawn_ = false;
}

}  // namespace cartographer_ext
