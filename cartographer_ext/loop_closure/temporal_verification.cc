// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
#include "cartographer_ext/loop_closure/temporal_verification.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "cartographer_ext/loop_closure/dtw.h"
#include "glog/logging.h"

namespace cartographer_ext {
namespace loop_closure {
namespace {

RangeSignature Predict(const RangeSignatureOptions& options,
                       const std::vector<ReferenceMap>& maps,
                       const Pose2& pose) {
  RangeSignature signature(options.num_sectors,
                           std::numeric_limits<float>::quiet_NaN());
  for (const ReferenceMap& map : maps) {
    if (NumKnownSectors(signature) == options.num_sectors) break;
    FillUnknownSectors(
        PredictSignature(options, *map.view, map.view_from_submap * pose),
        &signature);
  }
  return signature;
}

}  // namespace

TemporalResult VerifySequence(const TemporalVerificationOptions& options,
                              const std::vector<const HistoryNode*>& query,
                              const Pose2& candidate,
                              const std::vector<ReferenceMap>& maps) {
  CHECK_GT(options.oversampling, 0);
  TemporalResult result;
  const int length = static_cast<int>(query.size());
  if (length < std::max(options.minimum_length, 1)) return result;

  // From the newest node backwards, as far as the maps know the way. Element
  // 0 of `backwards` belongs to the newest node.
  const Pose2 submap_from_local =
      candidate * query.back()->local_pose.Inverse();
  std::vector<RangeSignature> backwards;
  int used = 0;
  for (int k = length - 1; k >= 0; --k) {
    const Pose2& pose = query[k]->local_pose;
    if (k < length - 1) {
      const Pose2& newer = query[k + 1]->local_pose;
      for (int s = 1; s < options.oversampling; ++s) {
        const double ratio = static_cast<double>(s) / options.oversampling;
        backwards.push_back(
            Predict(options.signature, maps,
                    submap_from_local * Interpolate(newer, pose, ratio)));
      }
    }
    backwards.push_back(
        Predict(options.signature, maps, submap_from_local * pose));
    if (std::isnan(SignatureCost(options.signature, query[k]->signature,
                                 backwards.back()))) {
      break;
    }
    ++used;
  }
  result.outcome = TemporalOutcome::kUnknownWay;
  if (used < options.minimum_length) return result;

  const int num_reference = (used - 1) * options.oversampling + 1;
  result.num_query = used;
  result.num_reference = num_reference;
  const int first = length - used;
  for (int k = first + 1; k < length; ++k) {
    result.travelled += (query[k]->local_pose.translation() -
                         query[k - 1]->local_pose.translation())
                            .norm();
  }
  std::vector<double> cost;
  cost.reserve(static_cast<size_t>(used) * num_reference);
  for (int i = 0; i < used; ++i) {
    for (int j = 0; j < num_reference; ++j) {
      cost.push_back(SignatureCost(options.signature,
                                   query[first + i]->signature,
                                   backwards[num_reference - 1 - j]));
    }
  }
  const bool symmetric = options.step == WarpingStep::kSymmetric;
  const double band =
      options.band < 0.
          ? options.band
          : std::max(options.band, symmetric ? 0.5 : 0.) * options.oversampling;
  const absl::optional<DtwResult> warped =
      symmetric ? DynamicTimeWarping(used, num_reference, cost, band)
                : AsymmetricTimeWarping(used, num_reference, cost, band,
                                        2 * options.oversampling);
  if (!warped.has_value()) return result;
  result.outcome = TemporalOutcome::kScored;
  result.score = std::min(1., std::max(0., warped->score()));
  return result;
}

}  // namespace loop_closure
}  // namespace cartographer_ext
