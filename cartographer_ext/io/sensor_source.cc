// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
#include "cartographer_ext/io/sensor_source.h"

#include "cartographer_ext/io/carmen_reader.h"

namespace cartographer_ext {
namespace io {

absl::StatusOr<std::unique_ptr<SensorSource>> OpenSensorSource(
    const std::string& filename, const SensorSourceOptions& options) {
  return OpenCarmenLog(filename, options);
}

}  // namespace io
}  // namespace cartographer_ext
