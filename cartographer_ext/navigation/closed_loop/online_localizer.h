// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
//
// Localisation in a finished map by the host, fed sensor by sensor as by a ROS
// node. After a scan whose node starts an optimisation the caller waits for its
// result, as if the back end took no time. A run therefore depends neither on
// the speed of the machine nor on the number of threads.
#ifndef CARTOGRAPHER_EXT_NAVIGATION_CLOSED_LOOP_ONLINE_LOCALIZER_H_
#define CARTOGRAPHER_EXT_NAVIGATION_CLOSED_LOOP_ONLINE_LOCALIZER_H_

#include <memory>
#include <string>

#include "absl/status/statusor.h"
#include "absl/types/optional.h"
#include "cartographer_ext/common/pose2.h"
#include "cartographer_ext/io/sensor_source.h"

namespace cartographer_ext {
namespace evaluation {
struct SlamConfiguration;
}  // namespace evaluation

namespace navigation {

struct PoseEstimate {
  io::TimeNs time = 0;  // stamp of the scan
  Pose2 map_from_robot;
};

class OnlineLocalizer {
 public:
  // Errors: those of the state file and of the initial pose.
  static absl::StatusOr<std::unique_ptr<OnlineLocalizer>> Create(
      const evaluation::SlamConfiguration& configuration,
      const std::string& pbstream_filename, const Pose2& initial_pose);
  ~OnlineLocalizer();
  OnlineLocalizer(const OnlineLocalizer&) = delete;
  OnlineLocalizer& operator=(const OnlineLocalizer&) = delete;

  // In order of time. A scan is matched once the odometry after it has come.
  void Add(const io::OdometryReading& reading);
  void Add(const io::LaserScan& scan);

  // Of the newest scan that was matched.
  absl::optional<PoseEstimate> Latest() const;
  // Optimisations that did not end in time; 0 unless the machine hangs.
  int timeouts() const;

 private:
  class Implementation;
  explicit OnlineLocalizer(std::unique_ptr<Implementation> implementation);

  const std::unique_ptr<Implementation> implementation_;
};

}  // namespace navigation
}  // namespace cartographer_ext

#endif  // CARTOGRAPHER_EXT_NAVIGATION_CLOSED_LOOP_ONLINE_LOCALIZER_H_
