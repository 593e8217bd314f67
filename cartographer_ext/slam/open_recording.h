// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
#ifndef CARTOGRAPHER_EXT_SLAM_OPEN_RECORDING_H_
#define CARTOGRAPHER_EXT_SLAM_OPEN_RECORDING_H_

#include <cstdint>
#include <memory>
#include <string>

#include "absl/status/statusor.h"
#include "absl/strings/string_view.h"
#include "cartographer_ext/configuration/slam_configuration.h"
#include "cartographer_ext/io/sensor_source.h"

namespace cartographer_ext {
namespace evaluation {

// Opens a log, a bag, or a world file (*.world), which is simulated with that
// seed while it is read.
absl::StatusOr<std::unique_ptr<io::SensorSource>> OpenRecording(
    const std::string& filename, const io::SensorSourceOptions& options,
    uint64_t seed);

// The options of the configuration for reading a recording.
io::SensorSourceOptions ToSourceOptions(const SensorSettings& settings);

// The name of a recording without folder and ending, for files made from it:
// "logs/run.clf.gz" and "logs/run/" are "run".
std::string RecordingStem(absl::string_view filename);

}  // namespace evaluation
}  // namespace cartographer_ext

#endif  // CARTOGRAPHER_EXT_SLAM_OPEN_RECORDING_H_
