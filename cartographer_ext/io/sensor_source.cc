// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
#include "cartographer_ext/io/sensor_source.h"

#include <sys/stat.h>

#include <cerrno>
#include <fstream>
#include <utility>

#include "absl/strings/match.h"
#include "absl/strings/str_cat.h"
#include "cartographer_ext/io/carmen/carmen_reader.h"
#include "cartographer_ext/io/ros/mcap_reader.h"
#include "cartographer_ext/io/ros/ros1/rosbag_reader.h"
#include "cartographer_ext/io/ros/rosbag2_reader.h"

namespace cartographer_ext {
namespace io {
namespace {

// The first bytes, for telling formats apart.
std::string ReadHead(const std::string& filename) {
  char head[32] = {};
  std::ifstream file(filename, std::ios::binary);
  file.read(head, sizeof(head));
  return std::string(head, static_cast<size_t>(file.gcount()));
}

absl::StatusOr<std::unique_ptr<SensorSource>> OpenRos2(
    const std::string& filename,
    absl::StatusOr<std::unique_ptr<RosContainer>> container,
    const SensorSourceOptions& options) {
  if (!container.ok()) return container.status();
  return OpenRosRecording(filename, std::move(*container), options);
}

}  // namespace

absl::StatusOr<std::unique_ptr<SensorSource>> OpenSensorSource(
    const std::string& filename, const SensorSourceOptions& options) {
  struct stat info;
  if (::stat(filename.c_str(), &info) != 0) {
    return absl::ErrnoToStatus(errno, absl::StrCat("cannot open ", filename));
  }
  if (S_ISDIR(info.st_mode)) {
    return OpenRos2(filename, OpenRosbag2Folder(filename), options);
  }
  if (!S_ISREG(info.st_mode)) {
    // Logs are read twice, which pipes and devices cannot give.
    return absl::InvalidArgumentError(
        absl::StrCat(filename, " is not a regular file"));
  }
  const std::string head = ReadHead(filename);
  if (head.empty()) {
    return absl::InvalidArgumentError(
        absl::StrCat(filename, " is empty or cannot be read"));
  }
  if (absl::StartsWith(head, "#ROSBAG V")) return OpenRosbag(filename, options);
  if (absl::EndsWith(filename, ".bag")) {
    return absl::InvalidArgumentError(
        absl::StrCat(filename, ": not a ROS 1 bag"));
  }
  if (absl::StartsWith(head, "\x89MCAP")) {
    return OpenRos2(filename, OpenMcap(filename), options);
  }
  if (absl::StartsWith(head, "SQLite format 3")) {
    return OpenRos2(filename, OpenDb3(filename), options);
  }
  return OpenCarmenLog(filename, options);
}

}  // namespace io
}  // namespace cartographer_ext
