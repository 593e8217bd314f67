// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
#include "cartographer_ext/io/carmen/scan_stamps.h"

#include <cstdlib>

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

ImplausibleLines MarkImplausible(std::vector<LineKey>* const lines) {
  ImplausibleLines implausible;
  size_t begin = 0;
  for (size_t end = 1; end <= lines->size(); ++end) {
    if (end != lines->size() &&
        std::abs((*lines)[end].time - (*lines)[end - 1].time) <=
            kImplausibleGap) {
      continue;
    }
    const auto count = static_cast<int64_t>(end - begin);
    const bool is_few =
        count <= kMaxImplausible &&
        static_cast<double>(count) <=
            kMaxBackwardShare * static_cast<double>(lines->size());
    for (size_t i = begin; is_few && i != end; ++i) {
      if (!(*lines)[i].plausible) continue;  // the line that is cut off
      (*lines)[i].plausible = false;
      if (implausible.count++ == 0) implausible.first = i;
    }
    begin = end;
  }
  return implausible;
}

}  // namespace io
}  // namespace cartographer_ext
