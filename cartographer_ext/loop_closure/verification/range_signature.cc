// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
#include "cartographer_ext/loop_closure/verification/range_signature.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "glog/logging.h"

namespace cartographer_ext {
namespace loop_closure {
namespace {

constexpr float kUnknown = std::numeric_limits<float>::quiet_NaN();

// Lower median of the known ranges of each sector's rays; one ray that is known
// suffices.
RangeSignature SectorMedians(const RangeSignatureOptions& options,
                             const std::vector<float>& rays) {
  RangeSignature signature(options.num_sectors, kUnknown);
  std::vector<float> known;
  for (int m = 0; m < options.num_sectors; ++m) {
    known.clear();
    for (int r = 0; r < options.rays_per_sector; ++r) {
      const float range = rays[m * options.rays_per_sector + r];
      if (!std::isnan(range)) known.push_back(range);
    }
    if (known.empty()) continue;
    const auto middle = known.begin() + (known.size() - 1) / 2;
    std::nth_element(known.begin(), middle, known.end());
    signature[m] = *middle;
  }
  return signature;
}

}  // namespace

RangeSignature SignatureFromPoints(const RangeSignatureOptions& options,
                                   const std::vector<Eigen::Vector2f>& points) {
  CHECK_GT(options.num_sectors, 0);
  CHECK_GT(options.rays_per_sector, 0);
  const int num_rays = options.num_sectors * options.rays_per_sector;
  std::vector<float> rays(num_rays, kUnknown);
  for (const Eigen::Vector2f& point : points) {
    const double range = point.cast<double>().norm();
    if (!std::isfinite(range) || range < options.min_range || range == 0.) {
      continue;
    }
    double angle = std::atan2(point.y(), point.x());
    if (angle < 0.) angle += 2. * kPi;
    // An angle just below zero may round up to a full turn.
    const int ray =
        static_cast<int>(std::floor(angle * num_rays / (2. * kPi))) % num_rays;
    const float clipped =
        static_cast<float>(std::min(range, options.max_range));
    if (std::isnan(rays[ray]) || clipped < rays[ray]) rays[ray] = clipped;
  }
  return SectorMedians(options, rays);
}

RangeSignature PredictSignature(const RangeSignatureOptions& options,
                                const OccupancyView& view, const Pose2& pose) {
  CHECK_GT(options.num_sectors, 0);
  CHECK_GT(options.rays_per_sector, 0);
  RayOptions ray_options;
  ray_options.max_range = options.max_range;
  ray_options.max_unknown = options.max_unknown;
  const int num_rays = options.num_sectors * options.rays_per_sector;
  std::vector<float> rays(num_rays, kUnknown);
  for (int ray = 0; ray < num_rays; ++ray) {
    const double angle = pose.theta + 2. * kPi * (ray + 0.5) / num_rays;
    rays[ray] = static_cast<float>(
        CastRay(view, pose.translation(), angle, ray_options));
  }
  return SectorMedians(options, rays);
}

int NumKnownSectors(const RangeSignature& signature) {
  return static_cast<int>(
      std::count_if(signature.begin(), signature.end(),
                    [](const float range) { return !std::isnan(range); }));
}

void FillUnknownSectors(const RangeSignature& other,
                        RangeSignature* const signature) {
  CHECK_EQ(other.size(), signature->size());
  for (size_t m = 0; m < other.size(); ++m) {
    if (std::isnan((*signature)[m])) (*signature)[m] = other[m];
  }
}

double SignatureCost(const RangeSignatureOptions& options,
                     const RangeSignature& query,
                     const RangeSignature& reference) {
  CHECK_EQ(query.size(), reference.size());
  CHECK_GT(options.clip, 0.);
  int num_query = 0;
  int num_both = 0;
  double sum = 0.;
  for (size_t m = 0; m < query.size(); ++m) {
    if (std::isnan(query[m])) continue;
    ++num_query;
    if (std::isnan(reference[m])) continue;
    ++num_both;
    const double difference =
        std::abs(static_cast<double>(query[m]) - reference[m]);
    sum += std::min(difference, options.clip) / options.clip;
  }
  if (num_both == 0 || num_both < options.minimum_overlap * num_query) {
    return std::numeric_limits<double>::quiet_NaN();
  }
  return sum / num_both;
}

}  // namespace loop_closure
}  // namespace cartographer_ext
