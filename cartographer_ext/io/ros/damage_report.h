// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
//
// What of a recording could not be read, because its file is damaged in the
// middle (bad disk, interrupted copy): how many parts, where, how much.
#ifndef CARTOGRAPHER_EXT_IO_ROS_DAMAGE_REPORT_H_
#define CARTOGRAPHER_EXT_IO_ROS_DAMAGE_REPORT_H_

#include <cstdint>
#include <string>

#include "absl/status/status.h"
#include "cartographer_ext/io/sensor_source.h"

namespace cartographer_ext {
namespace io {

// Of one reading of the file from its beginning to its end.
class DamageReport {
 public:
  // `bytes` of the file were left out because of `problem`, in its `chunk`th
  // chunk (from 1; 0: not in a chunk). Further damage in the same chunk is not
  // counted again.
  void AddDamage(int64_t chunk, uint64_t bytes, const absl::Status& problem);
  // A message that was read, in the order of the file; `time` is when it was
  // recorded. The time between the messages around damage is what is lost.
  void AddMessage(TimeNs time);

  bool empty() const { return num_damaged_ == 0; }
  bool any_message() const { return any_message_; }
  // OK if there was no damage.
  const absl::Status& first_problem() const { return first_problem_; }

  // "left out 1 damaged part (in chunk 3), 0.8 of 24.1 MB and 2.1 s of
  // messages; what is whole around it is read".
  std::string Text(uint64_t file_size) const;

 private:
  int64_t num_damaged_ = 0;
  uint64_t bytes_ = 0;
  double lost_seconds_ = 0.;
  int64_t first_chunk_ = 0;
  int64_t last_chunk_ = 0;
  absl::Status first_problem_;
  bool any_message_ = false;
  bool since_damage_ = false;  // no message was read behind the last damage
  TimeNs last_time_ = 0;
};

}  // namespace io
}  // namespace cartographer_ext

#endif  // CARTOGRAPHER_EXT_IO_ROS_DAMAGE_REPORT_H_
