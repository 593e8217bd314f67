// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
#include "cartographer_ext/metrics/localization_metrics.h"

#include <cmath>
#include <cstddef>

#include "absl/status/status.h"
#include "absl/strings/str_cat.h"

namespace cartographer_ext {
namespace evaluation {
namespace {

struct PoseError {
  Eigen::Vector2d translation;  // in the frame of the map
  double rotation;              // radians, not negative
};

PoseError ErrorOf(const PosePair& pair) {
  PoseError error;
  error.translation =
      pair.estimate.translation() - pair.reference.translation();
  error.rotation =
      std::abs(NormalizeAngle(pair.estimate.theta - pair.reference.theta));
  return error;
}

double Distance(const PosePair& from, const PosePair& to) {
  return (to.reference.translation() - from.reference.translation()).norm();
}

// The scans [first, last) of `pairs` as one segment.
LocalizationSegment ComputeSegment(const std::vector<PosePair>& pairs,
                                   const size_t first, const size_t last,
                                   const LocalizationOptions& options) {
  LocalizationSegment segment;
  segment.begin = pairs[first].time;
  segment.end = pairs[last - 1].time;
  std::vector<PoseError> errors;
  for (size_t i = first; i < last; ++i) errors.push_back(ErrorOf(pairs[i]));
  const auto within = [&](const size_t i) {
    const PoseError& error = errors[i - first];
    return error.translation.norm() <= options.translation_tolerance &&
           error.rotation <= options.rotation_tolerance;
  };
  // When the pose came within the tolerance, unless it has left it since.
  size_t localized = last;
  for (size_t i = first; i < last; ++i) {
    if (!within(i)) {
      localized = last;
      continue;
    }
    if (localized == last) localized = i;
    if (io::ToSeconds(pairs[i].time - pairs[localized].time) >=
        options.hold_seconds) {
      break;
    }
  }
  segment.localized = localized < last;
  if (segment.localized) {
    segment.seconds = io::ToSeconds(pairs[localized].time - segment.begin);
    for (size_t i = first; i < localized; ++i) {
      segment.metres += Distance(pairs[i], pairs[i + 1]);
    }
  }
  for (size_t i = first + 1; i < last; ++i) {
    const PoseError& error = errors[i - first];
    const double jump =
        (error.translation - errors[i - first - 1].translation).norm();
    if (jump <= options.jump_distance ||
        io::ToSeconds(pairs[i].time - segment.begin) < options.settle_seconds) {
      continue;
    }
    if (i > localized) ++segment.jumps;
    if (error.translation.norm() > options.jump_distance ||
        error.rotation > options.wrong_rotation) {
      ++segment.wrong_jumps;
    }
  }
  std::vector<double> translations, degrees;
  int64_t num_within = 0;
  for (size_t i = localized; i < last; ++i) {
    translations.push_back(errors[i - first].translation.norm());
    degrees.push_back(RadToDeg(errors[i - first].rotation));
    num_within += within(i) ? 1 : 0;
  }
  if (segment.localized) {
    segment.fraction_within = static_cast<double>(num_within) /
                              static_cast<double>(translations.size());
  }
  segment.translation_error = ComputeStatistics(translations);
  segment.rotation_error_degrees = ComputeStatistics(degrees);
  return segment;
}

}  // namespace

int LocalizationMetrics::num_localized() const {
  int count = 0;
  for (const LocalizationSegment& segment : segments) {
    count += segment.localized ? 1 : 0;
  }
  return count;
}

int LocalizationMetrics::num_jumps() const {
  int count = 0;
  for (const LocalizationSegment& segment : segments) count += segment.jumps;
  return count;
}

int LocalizationMetrics::num_wrong_jumps() const {
  int count = 0;
  for (const LocalizationSegment& segment : segments) {
    count += segment.wrong_jumps;
  }
  return count;
}

absl::StatusOr<LocalizationMetrics> ComputeLocalizationMetrics(
    const std::vector<PosePair>& pairs, const LocalizationOptions& options) {
  if (pairs.size() < 2) {
    return absl::InvalidArgumentError(
        absl::StrCat("only ", pairs.size(), " poses have a ground truth pose"));
  }
  LocalizationMetrics metrics;
  metrics.num_scans = static_cast<int64_t>(pairs.size());
  size_t first = 0;
  for (size_t i = 1; i <= pairs.size(); ++i) {
    if (i < pairs.size() &&
        Distance(pairs[i - 1], pairs[i]) <= options.carried_distance) {
      continue;
    }
    metrics.segments.push_back(ComputeSegment(pairs, first, i, options));
    first = i;
  }
  return metrics;
}

}  // namespace evaluation
}  // namespace cartographer_ext
