// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
#include "cartographer_ext/slam/open_recording.h"

#include "absl/strings/match.h"
#include "absl/strings/strip.h"
#include "cartographer_ext/simulation/world_source.h"

namespace cartographer_ext {
namespace evaluation {

absl::StatusOr<std::unique_ptr<io::SensorSource>> OpenRecording(
    const std::string& filename, const io::SensorSourceOptions& options,
    const uint64_t seed) {
  if (absl::EndsWith(filename, ".world")) {
    return simulation::OpenWorld(filename, seed);
  }
  return io::OpenSensorSource(filename, options);
}

io::SensorSourceOptions ToSourceOptions(const SensorSettings& settings) {
  io::SensorSourceOptions options;
  options.tracking_frame = settings.tracking_frame;
  options.odometry_source = settings.odometry_source;
  return options;
}

std::string RecordingStem(absl::string_view filename) {
  while (absl::ConsumeSuffix(&filename, "/")) {
  }
  filename.remove_prefix(filename.rfind('/') + 1);
  for (const char* packed : {".gz", ".xz", ".bz2"}) {
    if (absl::ConsumeSuffix(&filename, packed)) break;
  }
  for (const char* ending :
       {".clf", ".log", ".bag", ".mcap", ".db3", ".world"}) {
    if (absl::ConsumeSuffix(&filename, ending)) break;
  }
  return filename.empty() ? "map" : std::string(filename);
}

}  // namespace evaluation
}  // namespace cartographer_ext
