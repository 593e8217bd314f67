// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
#include "cartographer_ext/slam/open_recording.h"

#include <filesystem>
#include <fstream>

#include "absl/strings/match.h"
#include "absl/strings/str_cat.h"
#include "absl/strings/strip.h"
#include "cartographer_ext/io/pbstream/pbstream_records.h"
#include "cartographer_ext/simulation/world_source.h"

namespace cartographer_ext {
namespace evaluation {
namespace {

bool IsFinishedMap(const std::string& filename) {
  std::error_code error;
  // Reading from a pipe would wait.
  if (!std::filesystem::is_regular_file(filename, error)) return false;
  std::string head(io::PbstreamMagic().size(), '\0');
  std::ifstream file(filename, std::ios::binary);
  return file.read(&head[0], head.size()) && head == io::PbstreamMagic();
}

}  // namespace

absl::StatusOr<std::unique_ptr<io::SensorSource>> OpenRecording(
    const std::string& filename, const io::SensorSourceOptions& options,
    const uint64_t seed) {
  if (absl::EndsWith(filename, ".world")) {
    return simulation::OpenWorld(filename, seed);
  }
  if (IsFinishedMap(filename)) {
    return absl::InvalidArgumentError(
        absl::StrCat(filename, ": a finished map, not a recording"));
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
