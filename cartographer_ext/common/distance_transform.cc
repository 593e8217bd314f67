// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
#include "cartographer_ext/common/distance_transform.h"

#include <algorithm>
#include <cmath>

#include "glog/logging.h"

namespace cartographer_ext {
namespace {

// Farther than any cell of a permitted grid, and its square still fits.
constexpr int32_t kFar = 30000;

// First phase: distance to the nearest occupied cell of the same column.
std::vector<int32_t> ColumnDistances(const std::vector<uint8_t>& occupied,
                                     const int width, const int height) {
  std::vector<int32_t> distances(occupied.size(), kFar);
  for (int y = 0; y != height; ++y) {
    const size_t row = static_cast<size_t>(y) * width;
    for (int x = 0; x != width; ++x) {
      if (occupied[row + x]) {
        distances[row + x] = 0;
      } else if (y > 0) {
        distances[row + x] = std::min(kFar, distances[row - width + x] + 1);
      }
    }
  }
  for (int y = height - 2; y >= 0; --y) {
    const size_t row = static_cast<size_t>(y) * width;
    for (int x = 0; x != width; ++x) {
      distances[row + x] =
          std::min(distances[row + x], distances[row + width + x] + 1);
    }
  }
  return distances;
}

}  // namespace

std::vector<int32_t> SquaredDistanceTransform(
    const std::vector<uint8_t>& occupied, const int width, const int height) {
  CHECK_GE(width, 0);
  CHECK_GE(height, 0);
  CHECK_LE(std::max(width, height), 20000);
  CHECK_EQ(occupied.size(), static_cast<size_t>(width) * height);
  std::vector<int32_t> result = ColumnDistances(occupied, width, height);
  // Second phase: the lower envelope of the parabolas (x - s)^2 + g(s)^2 along
  // each row. segment i begins at start[i] and belongs to column site[i].
  std::vector<int32_t> site(width), start(width), column(width);
  for (int y = 0; y != height; ++y) {
    int32_t* const row = result.data() + static_cast<size_t>(y) * width;
    std::copy(row, row + width, column.begin());
    const auto f = [&column](const int64_t x, const int64_t s) {
      return (x - s) * (x - s) + int64_t{column[s]} * column[s];
    };
    int last = -1;
    for (int u = 0; u != width; ++u) {
      while (last >= 0 && f(start[last], site[last]) > f(start[last], u)) {
        --last;
      }
      if (last < 0) {
        last = 0;
        site[0] = u;
        start[0] = 0;
        continue;
      }
      // The first column from which on u is nearer than the last site.
      const int64_t i = site[last];
      const int64_t numerator = int64_t{u} * u - i * i +
                                int64_t{column[u]} * column[u] -
                                int64_t{column[i]} * column[i];
      const int64_t begin = 1 + numerator / (2 * (u - i));
      if (begin < width) {
        ++last;
        site[last] = u;
        start[last] = static_cast<int32_t>(begin);
      }
    }
    for (int x = width - 1; last >= 0 && x >= 0; --x) {
      const int64_t squared = f(x, site[last]);
      row[x] = squared >= int64_t{kFar} * kFar ? kNoOccupiedCell
                                               : static_cast<int32_t>(squared);
      if (x == start[last]) --last;
    }
  }
  return result;
}

std::vector<float> DistanceTransform(const std::vector<uint8_t>& occupied,
                                     const int width, const int height,
                                     const double resolution) {
  const std::vector<int32_t> squared =
      SquaredDistanceTransform(occupied, width, height);
  std::vector<float> distances(squared.size());
  for (size_t i = 0; i != squared.size(); ++i) {
    distances[i] =
        squared[i] == kNoOccupiedCell
            ? std::numeric_limits<float>::infinity()
            : static_cast<float>(resolution * std::sqrt(double(squared[i])));
  }
  return distances;
}

}  // namespace cartographer_ext
