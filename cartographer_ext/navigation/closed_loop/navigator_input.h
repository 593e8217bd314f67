// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
//
// Converts a recorded scan for the navigator.
#ifndef CARTOGRAPHER_EXT_NAVIGATION_CLOSED_LOOP_NAVIGATOR_INPUT_H_
#define CARTOGRAPHER_EXT_NAVIGATION_CLOSED_LOOP_NAVIGATOR_INPUT_H_

#include "cartographer_ext/io/sensor_source.h"
#include "cartographer_ext/navigation/navigator.h"

namespace cartographer_ext {
namespace navigation {

// The points of a scan in the robot frame. A beam without an echo is free over
// its first two metres only.
NavigatorScan ToNavigatorScan(const io::LaserScan& scan);

}  // namespace navigation
}  // namespace cartographer_ext

#endif  // CARTOGRAPHER_EXT_NAVIGATION_CLOSED_LOOP_NAVIGATOR_INPUT_H_
