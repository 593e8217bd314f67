// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
#include "cartographer_ext/loop_closure/verification/temporal_verification.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "cartographer_ext/loop_closure/verification/dtw.h"
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

// What the maps say at the reference poses, compared with scans.
class LocalCosts {
 public:
  LocalCosts(const TemporalVerificationOptions& options,
             const std::vector<ReferenceMap>& maps)
      : options_(options), maps_(maps) {}

  // Adds a reference pose, (frame of the candidate <- robot).
  void Add(const Pose2& pose) {
    if (options_.comparison == ScanComparison::kSectors) {
      signatures_.push_back(Predict(options_.signature, maps_, pose));
    } else {
      placed_.emplace_back(maps_, pose);
    }
    ++size_;
  }
  int size() const { return size_; }

  // Of a node against the reference pose of that number; NaN where the maps do
  // not know enough.
  double Exact(const HistoryNode& node, const int reference) const {
    return options_.comparison == ScanComparison::kSectors
               ? SignatureCost(options_.signature, node.signature,
                               signatures_[reference])
               : placed_[reference].Disagreement(options_.beams, node.beams);
  }
  // Not above the exact cost, and cheap.
  double Least(const HistoryNode& node, const int reference) const {
    return options_.comparison == ScanComparison::kSectors
               ? Exact(node, reference)
               : placed_[reference].LeastDisagreement(options_.beams,
                                                      node.beams);
  }

 private:
  const TemporalVerificationOptions& options_;
  const std::vector<ReferenceMap>& maps_;
  std::vector<RangeSignature> signatures_;
  std::vector<PlacedMaps> placed_;
  int size_ = 0;
};

// The matrix of local costs, of which most elements are only bounded from below
// until they matter.
class CostMatrix {
 public:
  CostMatrix(const LocalCosts& costs,
             const std::vector<const HistoryNode*>& query, const int first,
             const int num_reference, const int oversampling, const double band)
      : costs_(costs),
        query_(query),
        first_(first),
        num_reference_(num_reference),
        oversampling_(oversampling),
        band_(band),
        values_((query.size() - static_cast<size_t>(first)) *
                    static_cast<size_t>(num_reference),
                std::numeric_limits<double>::quiet_NaN()),
        exact_(values_.size(), false) {}

  const std::vector<double>& values() const { return values_; }
  int num_query() const { return static_cast<int>(query_.size()) - first_; }

  void Set(const int i, const int j, const double value) {
    values_[Index(i, j)] = value;
    exact_[Index(i, j)] = true;
  }
  // Fills the band, exactly or from below.
  void Fill(const bool exactly) {
    for (int i = 0; i < num_query(); ++i) {
      for (int j = 0; j < num_reference_; ++j) {
        if (exact_[Index(i, j)] ||
            (band_ >= 0. && std::abs(j - i * oversampling_) > band_)) {
          continue;
        }
        if (exactly) {
          MakeExact(i, j);
        } else {
          values_[Index(i, j)] =
              costs_.Least(*query_[first_ + i], num_reference_ - 1 - j);
        }
      }
    }
  }
  // False when it was.
  bool MakeExact(const int i, const int j) {
    if (exact_[Index(i, j)]) return false;
    Set(i, j, costs_.Exact(*query_[first_ + i], num_reference_ - 1 - j));
    return true;
  }

 private:
  size_t Index(const int i, const int j) const {
    return static_cast<size_t>(i) * num_reference_ + j;
  }

  const LocalCosts& costs_;
  const std::vector<const HistoryNode*>& query_;
  const int first_;
  const int num_reference_;
  const int oversampling_;
  const double band_;
  std::vector<double> values_;
  std::vector<bool> exact_;
};

// The result is that of the exact matrix: where the cheapest warping path over
// lower bounds turns out to consist of exact costs, no other path is cheaper.
absl::optional<DtwResult> WarpLazily(const int num_reference, const double band,
                                     const int max_advance,
                                     CostMatrix* const matrix) {
  matrix->Fill(false);
  std::vector<int> path;
  while (true) {
    const absl::optional<DtwResult> warped =
        AsymmetricTimeWarping(matrix->num_query(), num_reference,
                              matrix->values(), band, max_advance, &path);
    if (!warped.has_value()) return warped;
    bool changed = false;
    for (int i = 0; i < matrix->num_query(); ++i) {
      changed = matrix->MakeExact(i, path[i]) || changed;
    }
    if (!changed) return warped;
  }
}

}  // namespace

void DescribeScan(const TemporalVerificationOptions& options,
                  const std::vector<Eigen::Vector2f>& points,
                  HistoryNode* const node) {
  if (options.comparison == ScanComparison::kSectors) {
    node->signature = SignatureFromPoints(options.signature, points);
  } else {
    node->beams = BeamsFromPoints(options.beams, points);
  }
}

TemporalResult VerifySequence(const TemporalVerificationOptions& options,
                              const std::vector<const HistoryNode*>& query,
                              const Pose2& candidate,
                              const std::vector<ReferenceMap>& maps) {
  CHECK_GT(options.oversampling, 0);
  TemporalResult result;
  const int length = static_cast<int>(query.size());
  if (length < std::max(options.minimum_length, 1)) return result;

  // From the newest node backwards, as far as the maps know the path. Reference
  // 0 belongs to the newest node.
  const Pose2 submap_from_local =
      candidate * query.back()->local_pose.Inverse();
  LocalCosts costs(options, maps);
  std::vector<double> unwarped;
  for (int k = length - 1; k >= 0; --k) {
    const Pose2& pose = query[k]->local_pose;
    if (k < length - 1) {
      const Pose2& newer = query[k + 1]->local_pose;
      for (int s = 1; s < options.oversampling; ++s) {
        const double ratio = static_cast<double>(s) / options.oversampling;
        costs.Add(submap_from_local * Interpolate(newer, pose, ratio));
      }
    }
    costs.Add(submap_from_local * pose);
    const double cost = costs.Exact(*query[k], costs.size() - 1);
    if (std::isnan(cost)) break;
    unwarped.push_back(cost);
  }
  const int used = static_cast<int>(unwarped.size());
  result.outcome = TemporalOutcome::kPathUnknown;
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
  const bool symmetric = options.step == WarpingStep::kSymmetric;
  const double band =
      options.band < 0.
          ? options.band
          : std::max(options.band, symmetric ? 0.5 : 0.) * options.oversampling;
  CostMatrix matrix(costs, query, first, num_reference, options.oversampling,
                    band);
  for (int i = 0; i < used; ++i) {
    matrix.Set(i, i * options.oversampling, unwarped[used - 1 - i]);
  }
  absl::optional<DtwResult> warped;
  if (symmetric) {
    matrix.Fill(true);
    warped = DynamicTimeWarping(used, num_reference, matrix.values(), band);
  } else {
    warped = WarpLazily(num_reference, band, 2 * options.oversampling, &matrix);
  }
  if (!warped.has_value()) return result;
  result.outcome = TemporalOutcome::kScored;
  result.score = std::min(1., std::max(0., warped->score()));
  return result;
}

}  // namespace loop_closure
}  // namespace cartographer_ext
