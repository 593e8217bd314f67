// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
#ifndef CARTOGRAPHER_EXT_NAVIGATION_CLOSED_LOOP_RUN_ANIMATION_H_
#define CARTOGRAPHER_EXT_NAVIGATION_CLOSED_LOOP_RUN_ANIMATION_H_

#include <string>

#include "absl/status/status.h"
#include "cartographer_ext/navigation/closed_loop/navigation_run.h"

namespace cartographer_ext {
namespace navigation {

// One HTML file that fetches nothing: the frames of the run on a canvas. Needs
// NavigationRunOptions::record_frames.
absl::Status WriteRunAnimation(const NavigationRun& run,
                               const std::string& title,
                               const std::string& filename);

}  // namespace navigation
}  // namespace cartographer_ext

#endif  // CARTOGRAPHER_EXT_NAVIGATION_CLOSED_LOOP_RUN_ANIMATION_H_
