// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
#ifndef CARTOGRAPHER_EXT_NAVIGATION_CLOSED_LOOP_SHADOW_LOCALIZATION_H_
#define CARTOGRAPHER_EXT_NAVIGATION_CLOSED_LOOP_SHADOW_LOCALIZATION_H_

#include <string>
#include <vector>

#include "absl/status/statusor.h"
#include "cartographer_ext/configuration/slam_configuration.h"
#include "cartographer_ext/navigation/closed_loop/localization_error.h"
#include "cartographer_ext/navigation/closed_loop/navigation_run.h"

namespace cartographer_ext {
namespace navigation {

// The errors of another localisation on the readings of a run.
struct ShadowLocalization {
  std::vector<LocalizationError> errors;
  int jumps = 0;
  double cpu_seconds = 0.;
};
absl::StatusOr<ShadowLocalization> LocalizeAgain(
    const NavigationRun& run,
    const evaluation::SlamConfiguration& configuration,
    const std::string& pbstream_filename);

}  // namespace navigation
}  // namespace cartographer_ext

#endif  // CARTOGRAPHER_EXT_NAVIGATION_CLOSED_LOOP_SHADOW_LOCALIZATION_H_
