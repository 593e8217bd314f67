// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
//
// Whether the stamps of a CARMEN log can be used. Some tell nothing: all zero,
// or seconds since 1970 printed with six digits ("1.20012e+09"), which count in
// steps of three hours. Single ones may not belong to the log.
#ifndef CARTOGRAPHER_EXT_IO_CARMEN_SCAN_STAMPS_H_
#define CARTOGRAPHER_EXT_IO_CARMEN_SCAN_STAMPS_H_

#include <cstdint>
#include <vector>

#include "cartographer_ext/io/carmen/carmen_line.h"
#include "cartographer_ext/io/sensor_source.h"

namespace cartographer_ext {
namespace io {

// Instead of lost stamps: the lines of scans and odometry are this far apart,
// about the period of ODOM lines.
constexpr TimeNs kLineSpacing = 100000000;

// Share of all messages; clocks that occasionally step stay below it.
constexpr double kMaxBackwardShare = 0.01;

// A scan or ODOM line.
struct LineKey {
  TimeNs time = 0;
  int64_t number = 0;  // of the line
  CarmenKind kind = CarmenKind::kIgnored;
  bool plausible = true;
  bool repeats = false;  // ParticleFilterLog::Repeats
};

// Whether most lines of this kind have the stamp of the one before them.
bool AreStampsLost(const std::vector<LineKey>& lines, CarmenKind kind);

// Plausible lines of this kind with an earlier stamp than the one before them.
int64_t CountBackwards(const std::vector<LineKey>& lines, CarmenKind kind);

// By how much they are earlier at most.
TimeNs LargestStepBack(const std::vector<LineKey>& lines, CarmenKind kind);

// Makes lines implausible that have a gap of an hour to others of their kind on
// both sides, if they are few: a stamp that was cut off or is none. Kinds may
// have clocks of their own.
struct ImplausibleLines {
  int64_t count = 0;
  size_t first = 0;  // index
};
ImplausibleLines MarkImplausible(std::vector<LineKey>* lines);

}  // namespace io
}  // namespace cartographer_ext

#endif  // CARTOGRAPHER_EXT_IO_CARMEN_SCAN_STAMPS_H_
