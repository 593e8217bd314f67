// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
//
// Where in this map was this scan taken? The whole map is searched for the best
// pose; the search is exact, as Cartographer's, and several times faster.
#include <cmath>
#include <cstdio>
#include <utility>

#include "cartographer_ext/scan_matching/correlative_search/fast_correlative_search_2d.h"
#include "corridor.h"

using cartographer_ext::Pose2;
namespace scan_matching = cartographer_ext::scan_matching;

// The search takes cells of 8 bits, counted from the upper left end of the map
// as Cartographer counts them.
scan_matching::SearchGrid2D ToSearchGrid(const examples::Map& map) {
  scan_matching::SearchGrid2D grid;
  grid.num_x = map.height;
  grid.num_y = map.width;
  grid.resolution = map.resolution;
  grid.max_x = map.origin.x + map.width * map.resolution;
  grid.max_y = map.origin.y + map.height * map.resolution;
  grid.min_score = 0.1f;
  grid.max_score = 0.9f;
  grid.values.resize(static_cast<size_t>(grid.num_x) * grid.num_y);
  for (int j = 0; j < map.height; ++j) {
    for (int i = 0; i < map.width; ++i) {
      grid.values[grid.num_x * (map.width - 1 - i) + (map.height - 1 - j)] =
          static_cast<uint8_t>(255.f * map.at(i, j));
    }
  }
  return grid;
}

int main() {
  const Pose2 truth(12.3, 1.2, 0.4);
  scan_matching::PlanarCloud cloud;
  for (const Eigen::Vector2f& point : examples::Scan(truth)) {
    cloud.x.push_back(point.x());
    cloud.y.push_back(point.y());
  }
  const scan_matching::FastCorrelativeSearch2D search(
      ToSearchGrid(examples::Corridor()), {});
  const scan_matching::SearchResult result =
      search.MatchFullSubmap(cloud, 0.5f, {});
  if (!result.found) {
    std::printf("found nowhere\n");
    return 1;
  }
  std::printf(
      "taken at %.2f %.2f %.1f deg, found at %.2f %.2f %.1f deg, "
      "score %.3f\n",
      truth.x, truth.y, cartographer_ext::RadToDeg(truth.theta), result.pose.x,
      result.pose.y,
      cartographer_ext::RadToDeg(
          cartographer_ext::NormalizeAngle(result.pose.theta)),
      result.score);
  const Pose2 error = cartographer_ext::Between(truth, result.pose);
  return std::hypot(error.x, error.y) < 0.15 ? 0 : 1;
}
