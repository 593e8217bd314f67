// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
#include "cartographer_ext/io/carmen/scan_stamps.h"

#include <algorithm>
#include <cstdlib>
#include <map>

namespace cartographer_ext {
namespace io {
namespace {

constexpr TimeNs kImplausibleGap = int64_t{3600} * 1000000000;
constexpr int64_t kMaxImplausible = 10;

}  // namespace

bool AreStampsLost(const std::vector<LineKey>& lines, const CarmenKind kind) {
  int64_t count = 0, num_equal = 0;
  TimeNs last = 0;
  for (const LineKey& line : lines) {
    if (line.kind != kind) continue;
    if (count++ > 0 && line.time == last) ++num_equal;
    last = line.time;
  }
  return count >= 5 && 2 * num_equal > count;
}

int64_t CountBackwards(const std::vector<LineKey>& lines,
                       const CarmenKind kind) {
  int64_t count = 0;
  TimeNs last = 0;
  for (const LineKey& line : lines) {
    if (line.kind != kind || !line.plausible) continue;
    if (line.time < last) ++count;
    last = line.time;
  }
  return count;
}

TimeNs LargestStepBack(const std::vector<LineKey>& lines,
                       const CarmenKind kind) {
  TimeNs largest = 0, last = 0;
  for (const LineKey& line : lines) {
    if (line.kind != kind || !line.plausible) continue;
    largest = std::max(largest, last - line.time);
    last = line.time;
  }
  return largest;
}

ImplausibleLines MarkImplausible(std::vector<LineKey>* const lines) {
  // In the order of the enumeration.
  std::map<CarmenKind, std::vector<size_t>> of_kinds;
  for (size_t i = 0; i < lines->size(); ++i) {
    of_kinds[(*lines)[i].kind].push_back(i);
  }
  ImplausibleLines implausible;
  for (const auto& kind : of_kinds) {
    const std::vector<size_t>& own = kind.second;
    const auto time = [&](const size_t i) { return (*lines)[own[i]].time; };
    size_t begin = 0;
    for (size_t end = 1; end <= own.size(); ++end) {
      if (end != own.size() &&
          std::abs(time(end) - time(end - 1)) <= kImplausibleGap) {
        continue;
      }
      const auto count = static_cast<int64_t>(end - begin);
      const bool is_few =
          count <= kMaxImplausible &&
          static_cast<double>(count) <=
              kMaxBackwardShare * static_cast<double>(own.size());
      for (size_t i = begin; is_few && i != end; ++i) {
        LineKey& line = (*lines)[own[i]];
        if (!line.plausible) continue;  // the line that is cut off
        line.plausible = false;
        if (implausible.count++ == 0 || own[i] < implausible.first) {
          implausible.first = own[i];
        }
      }
      begin = end;
    }
  }
  return implausible;
}

}  // namespace io
}  // namespace cartographer_ext
