// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
#include "cartographer_ext/io/ros/damage_report.h"

#include <algorithm>

#include "absl/strings/str_cat.h"
#include "absl/strings/str_format.h"

namespace cartographer_ext {
namespace io {
namespace {

std::string Megabytes(const uint64_t bytes) {
  return absl::StrFormat("%.3g", static_cast<double>(bytes) * 1e-6);
}

}  // namespace

void DamageReport::AddDamage(const int64_t chunk, const uint64_t bytes,
                             const absl::Status& problem) {
  if (num_damaged_ == 0) {
    first_chunk_ = chunk;
    first_problem_ = problem;
  }
  if (chunk == 0 || chunk != last_chunk_) {
    ++num_damaged_;
    bytes_ += bytes;
  }
  last_chunk_ = chunk;
  since_damage_ = true;
}

void DamageReport::AddMessage(const TimeNs time) {
  if (since_damage_ && any_message_) {
    lost_seconds_ += std::max(0., ToSeconds(time - last_time_));
  }
  since_damage_ = false;
  any_message_ = true;
  last_time_ = time;
}

std::string DamageReport::Text(const uint64_t file_size) const {
  const bool one = num_damaged_ == 1;
  return absl::StrCat(
      "left out ", num_damaged_, one ? " damaged part" : " damaged parts",
      first_chunk_ > 0
          ? absl::StrCat(one ? " (in chunk " : " (the first in chunk ",
                         first_chunk_, ")")
          : "",
      ", ", Megabytes(bytes_), " of ", Megabytes(file_size), " MB",
      lost_seconds_ > 0.
          ? absl::StrFormat(" and %.1f s of messages", lost_seconds_)
          : "",
      "; what is whole around ", one ? "it" : "them", " is read");
}

}  // namespace io
}  // namespace cartographer_ext
