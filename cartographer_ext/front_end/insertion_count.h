// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
//
// For how many scans of an ordinary recording one scan stands.
//
// A submap is full after a number of scans, and a cell is believed after some
// hits. Both count scans and mean metres: the motion filter lets one scan
// through every 0.2 m, a submap of 90 is 20 m long, and a wall is hit by many.
// A slow laser or a fast robot leaves a metre between two scans. Then a submap
// is 100 m long and bent by the drift within, cells stay next to unknown, and
// neither local SLAM nor loop closure finds anything in it. So such a scan is
// inserted as often as the motion filter would have let scans through.
#ifndef CARTOGRAPHER_EXT_FRONT_END_INSERTION_COUNT_H_
#define CARTOGRAPHER_EXT_FRONT_END_INSERTION_COUNT_H_

#include "cartographer_ext/common/pose2.h"

namespace cartographer_ext {
namespace front_end {

// 1 to 10: one scan does not stand for a gap. `motion` since the last scan that
// was inserted. `spacing`, at which the motion filter lets scans through,
// metres; without one (not > 0) only rotation counts.
int InsertionCount(const Pose2& motion, double spacing);

}  // namespace front_end
}  // namespace cartographer_ext

#endif  // CARTOGRAPHER_EXT_FRONT_END_INSERTION_COUNT_H_
