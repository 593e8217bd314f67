// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
#include "cartographer_ext/navigation/costmap.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "absl/strings/str_format.h"
#include "cartographer_ext/common/distance_transform.h"

namespace cartographer_ext {
namespace navigation {
namespace {

constexpr int kMaxSide = 20000;
constexpr size_t kMaxCells = 100000000;

absl::Status CheckOptions(const CostmapOptions& options) {
  const double max_weight = double{kMaxWeight} / kMinWeight - 1.;
  if (!(options.inscribed_radius > 0.) || !(options.padding >= 0.) ||
      !std::isfinite(options.inscribed_radius + options.padding)) {
    return absl::InvalidArgumentError(absl::StrFormat(
        "the robot's radius %g m and padding %g m make no sense",
        options.inscribed_radius, options.padding));
  }
  if (!(options.tight >= 0.) ||
      !(options.inflation_radius >=
        options.inscribed_radius + options.padding + options.tight)) {
    return absl::InvalidArgumentError(absl::StrFormat(
        "the inflation radius %g m is less than the robot's radius and padding",
        options.inflation_radius));
  }
  if (!(options.clearance_weight >= 0.) ||
      !(options.clearance_weight <= max_weight)) {
    return absl::InvalidArgumentError(
        absl::StrFormat("the clearance weight %g is not in [0, %g]",
                        options.clearance_weight, max_weight));
  }
  if (!(options.occupied_probability > 0.) ||
      !(options.occupied_probability <= 1.)) {
    return absl::InvalidArgumentError(absl::StrFormat(
        "the probability %g of an occupied cell is not in (0, 1]",
        options.occupied_probability));
  }
  return absl::OkStatus();
}

absl::Status CheckMap(const io::OccupancyMap& map) {
  if (map.width <= 0 || map.height <= 0 ||
      map.occupancy.size() != static_cast<size_t>(map.width) * map.height) {
    return absl::InvalidArgumentError("the map is empty");
  }
  if (map.width > kMaxSide || map.height > kMaxSide ||
      map.occupancy.size() > kMaxCells) {
    return absl::InvalidArgumentError(
        absl::StrFormat("a map of %d x %d cells is too large for navigation",
                        map.width, map.height));
  }
  if (!(map.resolution > 0.) || !std::isfinite(map.resolution) ||
      !std::isfinite(map.origin.x) || !std::isfinite(map.origin.y) ||
      !std::isfinite(map.origin.theta)) {
    return absl::InvalidArgumentError(
        "the resolution or origin of the map is not a number");
  }
  return absl::OkStatus();
}

}  // namespace

absl::StatusOr<Costmap> Costmap::Create(const io::OccupancyMap& map,
                                        const CostmapOptions& options) {
  absl::Status status = CheckOptions(options);
  if (status.ok()) status = CheckMap(map);
  if (!status.ok()) return status;
  Costmap costmap;
  costmap.options_ = options;
  costmap.geometry_ = GridGeometry(map);
  const size_t size = map.occupancy.size();
  costmap.states_.resize(size);
  std::vector<uint8_t> occupied(size), obstacle(size);
  bool any_free = false;
  for (size_t i = 0; i != size; ++i) {
    const float probability = map.occupancy[i];
    CellState& state = costmap.states_[i];
    state = std::isnan(probability)                       ? CellState::kUnknown
            : probability >= options.occupied_probability ? CellState::kOccupied
                                                          : CellState::kFree;
    occupied[i] = state == CellState::kOccupied;
    obstacle[i] = occupied[i] ||
                  (state == CellState::kUnknown && !options.unknown_is_free);
    any_free = any_free || state == CellState::kFree;
  }
  if (!any_free) {
    return absl::InvalidArgumentError("the map has no free space");
  }
  costmap.wall_distances_ =
      DistanceTransform(occupied, map.width, map.height, map.resolution);
  costmap.obstacle_distances_ =
      options.unknown_is_free
          ? costmap.wall_distances_
          : DistanceTransform(obstacle, map.width, map.height, map.resolution);
  costmap.weights_.width = map.width;
  costmap.weights_.height = map.height;
  costmap.weights_.weights.resize(size);
  for (size_t i = 0; i != size; ++i) {
    costmap.weights_.weights[i] =
        costmap.WeightAt(costmap.obstacle_distances_[i]);
  }
  return costmap;
}

CellState Costmap::state(const Cell& cell) const {
  return geometry_.Contains(cell) ? states_[geometry_.Index(cell)]
                                  : CellState::kUnknown;
}

double Costmap::ObstacleDistance(const Cell& cell) const {
  return geometry_.Contains(cell) ? obstacle_distances_[geometry_.Index(cell)]
                                  : 0.;
}

double Costmap::WallDistance(const Cell& cell) const {
  return geometry_.Contains(cell) ? wall_distances_[geometry_.Index(cell)]
                                  : std::numeric_limits<double>::infinity();
}

double Costmap::WallDistance(const Eigen::Vector2d& point) const {
  return WallDistance(geometry_.CellAt(point));
}

uint8_t Costmap::WeightAt(const double distance) const {
  const double inner = options_.inscribed_radius + options_.padding;
  // Distances are of single precision.
  if (distance <= inner + 1e-6) return kBlocked;
  if (distance >= options_.inflation_radius) return kMinWeight;
  const double roomy = inner + options_.tight;
  if (distance <= roomy + 1e-6) return kMaxWeight;
  const double ratio = (options_.inflation_radius - distance) /
                       (options_.inflation_radius - roomy);
  return static_cast<uint8_t>(std::lround(
      kMinWeight * (1. + options_.clearance_weight * ratio * ratio)));
}

}  // namespace navigation
}  // namespace cartographer_ext
