// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
#include "cartographer_ext/loop_closure/verification/beam_agreement.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <limits>

#include "glog/logging.h"

namespace cartographer_ext {
namespace loop_closure {
namespace {

constexpr double kUnknown = std::numeric_limits<double>::quiet_NaN();

// Distances by their squares, in cells.
struct Distances {
  Distances() {
    for (size_t i = 0; i < roots.size(); ++i) {
      roots[i] = std::sqrt(static_cast<double>(i));
    }
    roots[OccupancyView::kFar] = std::numeric_limits<double>::infinity();
  }
  std::array<double, OccupancyView::kFar + 1> roots;
};
const Distances kDistances;

}  // namespace

std::vector<Beam> BeamsFromPoints(const BeamAgreementOptions& options,
                                  const std::vector<Eigen::Vector2f>& points) {
  CHECK_GT(options.max_beams, 0);
  std::vector<Beam> all;
  all.reserve(points.size());
  for (const Eigen::Vector2f& point : points) {
    const float range = point.norm();
    if (!std::isfinite(range) || range < options.min_range || range == 0.f) {
      continue;
    }
    all.push_back(Beam{point, range});
  }
  const size_t most = static_cast<size_t>(options.max_beams);
  if (all.size() <= most) return all;
  std::vector<Beam> beams;
  beams.reserve(most);
  for (size_t i = 0; i < most; ++i) {
    beams.push_back(all[i * all.size() / most]);
  }
  return beams;
}

int DistanceReach(const BeamAgreementOptions& options,
                  const double resolution) {
  CHECK_GT(resolution, 0.);
  return static_cast<int>(std::min<double>(
      OccupancyView::kMaxReach,
      std::ceil(options.tolerance + options.clip / resolution)));
}

PlacedMaps::PlacedMaps(const std::vector<ReferenceMap>& maps,
                       const Pose2& pose) {
  places_.reserve(maps.size());
  for (const ReferenceMap& map : maps) {
    const Pose2 in_view = map.view_from_submap * pose;
    const double cells = 1. / map.view->resolution();
    Place place;
    place.view = map.view;
    place.start = in_view.translation();
    place.cos = std::cos(in_view.theta);
    place.sin = std::sin(in_view.theta);
    place.cell = cells * (place.start - map.view->origin());
    place.cos_cells = cells * place.cos;
    place.sin_cells = cells * place.sin;
    places_.push_back(place);
  }
}

double PlacedMaps::EndDisagreement(const Beam& beam,
                                   const double tolerance) const {
  const double end_x = beam.end.x();
  const double end_y = beam.end.y();
  for (const Place& place : places_) {
    const double x =
        place.cell.x() + place.cos_cells * end_x - place.sin_cells * end_y;
    const double y =
        place.cell.y() + place.sin_cells * end_x + place.cos_cells * end_y;
    // False for NaN as well.
    if (!(x >= 0. && y >= 0. && x < place.view->num_x() &&
          y < place.view->num_y())) {
      continue;
    }
    const int i = static_cast<int>(x);
    const int j = static_cast<int>(y);
    const double distance = place.view->resolution() *
                            kDistances.roots[place.view->SquaredDistance(i, j)];
    if (distance <= tolerance || place.view->At(i, j) != CellState::kUnknown) {
      return distance;
    }
  }
  return kUnknown;
}

PlacedMaps::Sums PlacedMaps::Sum(const BeamAgreementOptions& options,
                                 const std::vector<Beam>& beams,
                                 const bool predict) const {
  CHECK_GT(options.clip, 0.);
  Sums sums;
  if (places_.empty()) return sums;
  const double tolerance =
      options.tolerance * places_.front().view->resolution();
  RayOptions ray_options;
  ray_options.max_range = options.max_range;
  ray_options.max_unknown = options.max_unknown;
  for (const Beam& beam : beams) {
    double disagreement = beam.range <= options.max_range
                              ? EndDisagreement(beam, tolerance)
                              : kUnknown;
    if (std::isnan(disagreement)) {
      if (!predict) {
        ++sums.num_open;
        continue;
      }
      // Behind a wall, or where nobody has been?
      const Eigen::Vector2d end = beam.end.cast<double>() / beam.range;
      double predicted = kUnknown;
      for (size_t k = 0; k < places_.size() && std::isnan(predicted); ++k) {
        const Place& place = places_[k];
        predicted =
            CastRay(*place.view, place.start,
                    Eigen::Vector2d(place.cos * end.x() - place.sin * end.y(),
                                    place.sin * end.x() + place.cos * end.y()),
                    ray_options);
      }
      if (std::isnan(predicted)) continue;
      disagreement =
          std::abs(predicted - std::min<double>(beam.range, options.max_range));
    }
    ++sums.num_known;
    sums.disagreement +=
        std::min(options.clip, std::max(0., disagreement - tolerance));
  }
  return sums;
}

double PlacedMaps::Disagreement(const BeamAgreementOptions& options,
                                const std::vector<Beam>& beams) const {
  const Sums sums = Sum(options, beams, true);
  if (sums.num_known == 0 ||
      sums.num_known <
          options.minimum_overlap * static_cast<double>(beams.size())) {
    return kUnknown;
  }
  return sums.disagreement / (options.clip * sums.num_known);
}

double PlacedMaps::LeastDisagreement(const BeamAgreementOptions& options,
                                     const std::vector<Beam>& beams) const {
  const Sums sums = Sum(options, beams, false);
  if (sums.disagreement == 0.) return 0.;
  return sums.disagreement / (options.clip * (sums.num_known + sums.num_open));
}

}  // namespace loop_closure
}  // namespace cartographer_ext
