// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
#include "cartographer_ext/front_end/dropin/local_matcher.h"

#include <algorithm>
#include <cmath>
#include <functional>
#include <limits>
#include <vector>

#include "cartographer/transform/rigid_transform.h"
#include "cartographer_ext/common/dropin/pose_conversion.h"
#include "cartographer_ext/common/planar_matrix.h"
#include "cartographer_ext/options/extension_field.h"
#include "cartographer_ext/options/option_description.h"
#include "cartographer_ext/scan_matching/dropin/mean_score.h"
#include "cartographer_ext/scan_matching/dropin/real_time_matcher_2d.h"
#include "cartographer_ext/scan_matching/dropin/scan_evidence.h"
#include "cartographer_ext/uncertainty/uncertain_pose.h"

namespace cartographer_ext {
namespace front_end {
namespace {

using cartographer::mapping::Grid2D;
using cartographer::sensor::PointCloud;
using cartographer::transform::Rigid2d;
using scan_matching::Prediction;

namespace mapping = cartographer::mapping;
namespace stock_proto = cartographer::mapping::scan_matching::proto;

// Weight of a new score in the running mean.
constexpr double kScoreRate = 0.02;
// Penalties of the search, per metre and radian: only to break ties.
constexpr double kSearchPenalty = 0.1;
// Of a prediction, metres and radians; smaller ones are taken for this.
constexpr double kLeastSigma = 1e-6;
// The share of steps off by more than 0.04 rad where scans are a metre apart (20,000
// steps of twelve recordings) is 1, 2, 9, 31, 70 % at 0.8, 0.68, 0.52, 0.38, 0.25
// of the usual score.
constexpr double kEvenRatio = 0.3;
constexpr double kDoubtSlope = 9.;
constexpr double kLeastDoubtedRatio = 0.75;
// Limits of Inconsistency().
constexpr double kConsistentTranslation = 0.05;            // metres
constexpr double kInconsistentTranslation = 0.15;          // metres
constexpr double kConsistentRotation = 2. * kPi / 180.;    // radians
constexpr double kInconsistentRotation = 5. * kPi / 180.;  // radians
// At most this many motions are searched around.
constexpr size_t kMaxSearches = 4;
// Scales the covariance of a motion after a search, so that the motion hardly
// constrains the match.
constexpr double kCovarianceScaleAfterSearch = 100.;

// The cost of a point has a slope within two cells of a wall, and walls are a
// cell or two thick. A prediction that puts points farther off than that leads
// to the next wall, if anywhere.
constexpr double kBasinCells = 3.;

// The walls of a submap end where the sight of the scans before did, which are
// inserted every 0.2 m; the laser may be half of this off the robot's origin.
constexpr double kLimitZone = 0.5;  // metres
// Longer ranges of a scan, of which there are at least this many, are no
// outliers.
constexpr size_t kMinFarthest = 3;
// This many scans, this far from each other, distinguish the limit of a laser
// from the size of a room.
constexpr int kMinScansAtLimit = 50;
constexpr double kRangeStep = 0.2;  // metres

// The best of some 150 candidate poses needs this much more log-likelihood.
constexpr double kLogPlaces = 5.;

// Scans that contradict the odometry in succession see the same walls: of the
// evidence of those before this part is new.
constexpr double kEvidenceKept = 0.5;

// The block of the scan matcher, or its defaults.
proto::ScanMatcherOptions MatcherExtension(
    const stock_proto::CeresScanMatcherOptions2D& options) {
  proto::ScanMatcherOptions extension;
  if (!options::GetExtension(options, &extension)) {
    options::SetDefaults(&extension);
  }
  return extension;
}

// Logarithm of the odds against a fault of the odometry: it is unlikely, unless
// the odometry was overruled before: wheels that slip do so for a while.
double FaultOdds(const MotionPrediction& prediction, const bool was_overruled) {
  return prediction.is_uncertain || was_overruled ? 0.
                                                  : kLogOddsOfOdometryFault;
}

// Whether the scan is evidence enough (scan_evidence.h) for `found` against the
// pose by odometry. Other predictions are guesses.
bool MayOverrule(const MotionPrediction& prediction, const bool was_overruled,
                 const Pose2& found, const Pose2& predicted,
                 const PointCloud& cloud, const Grid2D& grid) {
  if (prediction.source != PredictionSource::kOdometry) return true;
  return scan_matching::ScanEvidence(found, predicted, cloud, grid) >=
         FaultOdds(prediction, was_overruled) + kLogPlaces;
}

// In the local frame.
Prediction ToPrediction(const Pose2& last_pose, const Pose2& motion,
                        const Eigen::Matrix3d& covariance) {
  const Eigen::Matrix3d rotation = PlanarRotation(last_pose.theta);
  Prediction prediction;
  prediction.pose = last_pose * motion;
  prediction.covariance = rotation * covariance * rotation.transpose();
  return prediction;
}

bool IsNear(const Pose2& a, const Pose2& b) {
  return std::hypot(a.x - b.x, a.y - b.y) < 0.02 &&
         std::abs(NormalizeAngle(a.theta - b.theta)) < 0.01;
}

// Standard deviation of the position of a point of the cloud, metres: the root
// mean square over the cloud, along the worst direction.
double PointSpread(const Eigen::Matrix3d& covariance, const PointCloud& cloud) {
  double squares = 0.;
  for (const auto& point : cloud)
    squares += point.position.head<2>().squaredNorm();
  squares /= std::max<size_t>(1, cloud.size());
  return std::hypot(uncertainty::WorstTranslationSigma(covariance),
                    std::sqrt(squares * covariance(2, 2)));
}

// The best pose around `initial` by score * exp(-(w_t |translation| + w_r
// |rotation|)^2).
Pose2 SearchAround(const Pose2& initial,
                   const scan_matching::SearchWindow& window,
                   const double translation_weight,
                   const double rotation_weight, const PointCloud& cloud,
                   const Grid2D& grid) {
  stock_proto::RealTimeCorrelativeScanMatcherOptions options;
  options.set_linear_search_window(window.linear);
  options.set_angular_search_window(window.angular);
  options.set_translation_delta_cost_weight(translation_weight);
  options.set_rotation_delta_cost_weight(rotation_weight);
  const scan_matching::RealTimeMatcher2D search(options);
  Rigid2d found = ToRigid2d(initial);
  search.Match(ToRigid2d(initial), cloud, grid, &found);
  return ToPose2(found);
}

// chi2 of a pose by a prediction, whatever the scan determines of it: along a
// corridor a match is consistent with its prediction wherever it ends.
double ChiSquare(const Prediction& predicted, const Pose2& pose) {
  const Eigen::Vector3d off(pose.x - predicted.pose.x,
                            pose.y - predicted.pose.y,
                            NormalizeAngle(pose.theta - predicted.pose.theta));
  return off.dot(predicted.covariance.ldlt().solve(off));
}

// Whether scan and prediction together favour `a` over `b` by the difference of
// their log-likelihoods. It must fit better, too: a scan turned towards what was
// never seen contradicts nothing.
bool IsLikelier(const LocalMatch& a, const LocalMatch& b,
                const Prediction& predicted, const PointCloud& cloud,
                const Grid2D& grid) {
  return a.score > b.score &&
         scan_matching::ScanEvidence(a.pose, b.pose, cloud, grid) >
             0.5 *
                 (ChiSquare(predicted, a.pose) - ChiSquare(predicted, b.pose));
}

struct SearchedMotion {
  Pose2 motion;
  bool is_hint;
};

// The predicted motion, its alternatives and the hints, without near duplicates.
std::vector<SearchedMotion> MotionsToSearch(
    const MotionPrediction& prediction) {
  std::vector<SearchedMotion> motions = {{prediction.motion, false}};
  const auto add = [&](const Pose2& motion, const bool is_hint) {
    bool is_new = motions.size() < kMaxSearches;
    for (const SearchedMotion& other : motions) {
      is_new = is_new && !IsNear(motion, other.motion);
    }
    if (is_new) motions.push_back({motion, is_hint});
  };
  for (const Pose2& motion : prediction.alternatives) add(motion, false);
  for (const Pose2& motion : prediction.hints) add(motion, true);
  return motions;
}

}  // namespace

double MatchDoubt(const double score, const double usual) {
  if (!(usual > 0.)) return 0.;
  const double ratio = score / usual;
  if (ratio > kLeastDoubtedRatio) return 0.;
  return 1. / (1. + std::exp(kDoubtSlope * (ratio - kEvenRatio)));
}

double Inconsistency(const Pose2& predicted, const Pose2& found) {
  const Pose2 off = Between(predicted, found);
  const double translation =
      (std::hypot(off.x, off.y) - kConsistentTranslation) /
      (kInconsistentTranslation - kConsistentTranslation);
  const double rotation = (std::abs(off.theta) - kConsistentRotation) /
                          (kInconsistentRotation - kConsistentRotation);
  return std::min(1., std::max({0., translation, rotation}));
}

LocalMatcher::LocalMatcher(
    const LocalSearchOptions& options,
    const stock_proto::CeresScanMatcherOptions2D& matcher_options)
    : options_(options),
      matcher_(matcher_options, MatcherExtension(matcher_options)) {}

LocalMatch LocalMatcher::MatchFrom(const Prediction& prediction,
                                   const Pose2& initial,
                                   const PointCloud& cloud,
                                   const Grid2D& grid) const {
  LocalMatch match;
  Rigid2d pose = ToRigid2d(initial);
  matcher_.MatchWithPrediction(prediction, ToRigid2d(initial), cloud, grid,
                               &pose, &match.report);
  match.pose = ToPose2(pose);
  match.score = scan_matching::MeanScore(match.pose, cloud, grid);
  return match;
}

bool LocalMatcher::IsDoubtful(const LocalMatch& match,
                              const MotionPrediction& prediction,
                              const PointCloud& cloud,
                              const Grid2D& grid) const {
  return prediction.is_uncertain ||
         PointSpread(prediction.covariance, cloud) >
             kBasinCells * grid.limits().resolution() ||
         (has_mean_score_ && match.score < mean_score_ - options_.score_drop) ||
         match.report.mahalanobis > options_.gate;
}

void LocalMatcher::UpdateRange(const Pose2& pose, const PointCloud& cloud) {
  if (cloud.size() < kMinFarthest) return;
  if (scans_ > 0 &&
      std::hypot(pose.x - range_pose_.x, pose.y - range_pose_.y) < kRangeStep)
    return;
  range_pose_ = pose;
  std::vector<float> squares;
  squares.reserve(cloud.size());
  for (const auto& point : cloud)
    squares.push_back(point.position.head<2>().squaredNorm());
  std::nth_element(squares.begin(), squares.begin() + (kMinFarthest - 1),
                   squares.end(), std::greater<float>());
  const double range = std::sqrt(squares[kMinFarthest - 1]);
  if (range > range_ + kLimitZone) scans_ = scans_at_limit_ = 0;
  range_ = std::max(range_, range);
  ++scans_;
  scans_at_limit_ += range > range_ - kLimitZone ? 1 : 0;
}

double LocalMatcher::LimitOfSight() const {
  // Otherwise the size of the building limits the range.
  const bool is_limit =
      scans_ >= kMinScansAtLimit && 2 * scans_at_limit_ >= scans_;
  return is_limit ? std::max(0., range_ - kLimitZone)
                  : std::numeric_limits<double>::infinity();
}

double LocalMatcher::LinearWindow(const Pose2& motion,
                                  const MotionPrediction& prediction) const {
  return std::min(
      options_.max_linear_window,
      std::max(prediction.search_radius,
               options_.linear_window + 0.5 * std::hypot(motion.x, motion.y)));
}

Pose2 LocalMatcher::Search(const Pose2& center, const Pose2& motion,
                           const MotionPrediction& prediction,
                           const PointCloud& cloud, const Grid2D& grid) const {
  const double angular_window =
      std::max(prediction.search_angle,
               std::min(options_.max_angular_window,
                        options_.angular_window + std::abs(motion.theta)));
  return SearchAround(center,
                      {LinearWindow(motion, prediction), angular_window},
                      kSearchPenalty, kSearchPenalty, cloud, grid);
}

Pose2 LocalMatcher::SearchConsistent(const Prediction& predicted,
                                     const PointCloud& cloud,
                                     const Grid2D& grid) const {
  const double sigma_translation =
      uncertainty::WorstTranslationSigma(predicted.covariance);
  const double sigma_rotation = std::sqrt(predicted.covariance(2, 2));
  const double farthest = std::sqrt(options_.gate);
  const scan_matching::SearchWindow window = {
      std::min(options_.max_linear_window, farthest * sigma_translation),
      std::min(options_.max_angular_window, farthest * sigma_rotation)};
  // A log-likelihood of n ln(score) - chi2 / 2, divided by n.
  const double n = std::max(1, scan_matching::NumPatches(cloud));
  const double weight = 1. / std::sqrt(2. * n);
  return SearchAround(
      predicted.pose, window, weight / std::max(sigma_translation, kLeastSigma),
      weight / std::max(sigma_rotation, kLeastSigma), cloud, grid);
}

bool LocalMatcher::IsOverruled(const MotionPrediction& prediction,
                               const Pose2& found, const Pose2& predicted,
                               const PointCloud& cloud, const Grid2D& grid) {
  if (prediction.source != PredictionSource::kOdometry) return true;
  const double evidence =
      kEvidenceKept * earlier_evidence_ +
      scan_matching::ScanEvidence(found, predicted, cloud, grid);
  const bool is_overruled = evidence >= FaultOdds(prediction, is_overruled_);
  earlier_evidence_ = is_overruled ? 0. : std::max(0., evidence);
  return is_overruled;
}

LocalMatch LocalMatcher::Match(const Pose2& last_pose,
                               const MotionPrediction& prediction,
                               const PointCloud& cloud,
                               const mapping::Submap2D& submap) {
  const Grid2D& grid = *submap.grid();
  Prediction predicted =
      ToPrediction(last_pose, prediction.motion, prediction.covariance);
  predicted.scans_in_map = submap.num_range_data();
  UpdateRange(last_pose, cloud);
  predicted.limit_of_sight = LimitOfSight();
  LocalMatch match = MatchFrom(predicted, predicted.pose, cloud, grid);
  if (match.report.mahalanobis <= options_.gate) earlier_evidence_ = 0.;
  if (options_.enabled && IsDoubtful(match, prediction, cloud, grid)) {
    match =
        MatchWithSearch(last_pose, prediction, predicted, cloud, grid, match);
    if (!match.relocated && match.report.mahalanobis > options_.gate &&
        !IsOverruled(prediction, match.pose, predicted.pose, cloud, grid)) {
      // In that case odometry is right more often than the match.
      match.pose = predicted.pose;
      match.report.covariance = predicted.covariance;
      match.report.scan_information.setZero();
      match.score = scan_matching::MeanScore(match.pose, cloud, grid);
    }
  }
  if (prediction.source == PredictionSource::kOdometry) {
    is_overruled_ =
        match.relocated
            ? Inconsistency(predicted.pose, match.pose) >= 1.
            : is_overruled_ && match.score < mean_score_ - options_.score_drop;
  }
  if (has_mean_score_) match.doubt = MatchDoubt(match.score, mean_score_);
  mean_score_ +=
      (has_mean_score_ ? kScoreRate : 1.) * (match.score - mean_score_);
  has_mean_score_ = true;
  return match;
}

LocalMatch LocalMatcher::MatchWithSearch(const Pose2& last_pose,
                                         const MotionPrediction& prediction,
                                         const Prediction& predicted,
                                         const PointCloud& cloud,
                                         const Grid2D& grid,
                                         const LocalMatch& matched) const {
  LocalMatch best = matched;
  best.searched = true;
  double to_beat = matched.score + options_.min_gain;
  // Matches from there; returns whether the result is consistent with the
  // prediction.
  const auto try_consistent = [&](const Pose2& found) {
    const LocalMatch match = MatchFrom(predicted, found, cloud, grid);
    if (match.report.mahalanobis > options_.gate ||
        ChiSquare(predicted, match.pose) > options_.gate) {
      return false;
    }
    if (!IsLikelier(match, best, predicted, cloud, grid)) return true;
    best = match;
    best.searched = best.relocated = true;
    to_beat = best.score + options_.min_gain;
    return true;
  };
  if (!prediction.is_uncertain) {
    try_consistent(SearchConsistent(predicted, cloud, grid));
  }
  for (const SearchedMotion& searched : MotionsToSearch(prediction)) {
    const Pose2& motion = searched.motion;
    if (searched.is_hint &&
        (motion.translation() - prediction.motion.translation()).norm() >
            LinearWindow(prediction.motion, prediction)) {
      continue;
    }
    const Pose2 found =
        Search(last_pose * motion, motion, prediction, cloud, grid);
    if (!prediction.is_uncertain && try_consistent(found)) continue;
    if (searched.is_hint) continue;
    Prediction start = ToPrediction(
        last_pose, motion, kCovarianceScaleAfterSearch * prediction.covariance);
    start.scans_in_map = predicted.scans_in_map;
    start.limit_of_sight = predicted.limit_of_sight;
    const LocalMatch match = MatchFrom(start, found, cloud, grid);
    const double gain = options_.min_gain +
                        (prediction.is_uncertain
                             ? 0.
                             : options_.contradiction_gain *
                                   Inconsistency(predicted.pose, match.pose));
    if (match.score <= std::max(to_beat, matched.score + gain)) continue;
    if (!MayOverrule(prediction, is_overruled_, match.pose, predicted.pose,
                     cloud, grid)) {
      continue;
    }
    to_beat = match.score;
    best = match;
    best.searched = true;
    best.relocated = true;
  }
  return best;
}

}  // namespace front_end
}  // namespace cartographer_ext
