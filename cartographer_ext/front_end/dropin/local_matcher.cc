// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
#include "cartographer_ext/front_end/dropin/local_matcher.h"

#include <algorithm>
#include <cmath>
#include <vector>

#include "cartographer/transform/rigid_transform.h"
#include "cartographer_ext/common/dropin/pose_conversion.h"
#include "cartographer_ext/front_end/odometry/odometry_fault.h"
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
// Motions that differ by less are searched once.
constexpr double kSameMotionDistance = 0.02;  // metres
constexpr double kSameMotionAngle = 0.01;     // radians
// What a search finds this near an alternative motion confirms it.
constexpr double kConfirmedDistance = 0.125;  // metres
constexpr double kConfirmedAngle = 0.1;       // radians
// At most this many motions are searched around.
constexpr size_t kMaxSearches = 4;
// Scales the covariance of a motion after a search, so that the motion hardly
// constrains the match.
constexpr double kCovarianceScaleAfterSearch = 100.;

// The cost of a point has a slope within two cells of a wall, and walls are a
// cell or two thick. A prediction that puts points farther off than that leads
// to the next wall, if anywhere.
constexpr double kBasinCells = 3.;

// The best of some 150 candidate poses needs this much more log-likelihood.
constexpr double kLogPlaces = 5.;

// The block of the scan matcher, or its defaults.
proto::ScanMatcherOptions MatcherExtension(
    const stock_proto::CeresScanMatcherOptions2D& options) {
  proto::ScanMatcherOptions extension;
  if (!options::GetExtension(options, &extension)) {
    options::SetDefaults(&extension);
  }
  return extension;
}

// Whether the scan is evidence enough (scan_evidence.h) for `found` against the
// pose by odometry. Other predictions are guesses.
bool MayOverrule(const MotionPrediction& prediction, const double odds,
                 const Pose2& found, const Pose2& predicted,
                 const PointCloud& cloud, const Grid2D& grid) {
  return prediction.source != PredictionSource::kOdometry ||
         scan_matching::ScanEvidence(found, predicted, cloud, grid) >= odds;
}

bool IsNear(const Pose2& a, const Pose2& b, const double distance,
            const double angle) {
  return (a.translation() - b.translation()).norm() < distance &&
         std::abs(NormalizeAngle(a.theta - b.theta)) < angle;
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

// Whether scan and prediction together favour `a` over `b` by the difference of
// their log-likelihoods. It must fit better, too: a scan turned towards what was
// never seen contradicts nothing.
bool IsLikelier(const LocalMatch& a, const LocalMatch& b,
                const Prediction& predicted, const PointCloud& cloud,
                const Grid2D& grid) {
  return a.score > b.score &&
         scan_matching::PoseEvidence(a.pose, cloud, grid,
                                     scan_matching::PosePrecision::kExact)
                 .Against(b.pose) > 0.5 * (ChiSquare(predicted, a.pose) -
                                           ChiSquare(predicted, b.pose));
}

std::vector<float> Ranges(const PointCloud& cloud) {
  std::vector<float> ranges;
  ranges.reserve(cloud.size());
  for (const auto& point : cloud) {
    ranges.push_back(point.position.head<2>().norm());
  }
  return ranges;
}

// In case of doubt odometry is right more often than the match; its rotation is
// that of the match if that is likelier and does not contradict the odometry.
LocalMatch AtPrediction(const LocalMatch& matched, const Prediction& predicted,
                        const double gate, const PointCloud& cloud,
                        const Grid2D& grid) {
  LocalMatch result = matched;
  result.report.covariance = predicted.covariance;
  result.report.scan_information.setZero();
  result.pose = predicted.pose;
  result.score = scan_matching::MeanScore(result.pose, cloud, grid);
  LocalMatch turned = result;
  turned.pose.theta = matched.pose.theta;
  turned.score = scan_matching::MeanScore(turned.pose, cloud, grid);
  const bool is_consistent = ChiSquare(predicted, turned.pose) <= gate;
  return is_consistent && IsLikelier(turned, result, predicted, cloud, grid)
             ? turned
             : result;
}

// What a search has to beat: where the match contradicts the odometry, the pose of
// that, or anything that agrees with it would be taken.
LocalMatch BeforeSearch(const LocalMatch& matched,
                        const MotionPrediction& prediction,
                        const Prediction& predicted, const double gate,
                        const PointCloud& cloud, const Grid2D& grid) {
  return prediction.source == PredictionSource::kOdometry &&
                 !prediction.is_uncertain && matched.report.mahalanobis > gate
             ? AtPrediction(matched, predicted, gate, cloud, grid)
             : matched;
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
      is_new = is_new && !IsNear(motion, other.motion, kSameMotionDistance,
                                 kSameMotionAngle);
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
      matcher_(matcher_options, MatcherExtension(matcher_options)),
      contest_(options.gate) {}

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

scan_matching::SearchWindow LocalMatcher::ConsistentWindow(
    const Prediction& predicted) const {
  const double farthest = std::sqrt(options_.gate);
  return {std::min(options_.max_linear_window,
                   farthest * uncertainty::WorstTranslationSigma(
                                  predicted.covariance)),
          std::min(options_.max_angular_window,
                   farthest * std::sqrt(predicted.covariance(2, 2)))};
}

Pose2 LocalMatcher::SearchConsistent(const Prediction& predicted,
                                     const PointCloud& cloud,
                                     const Grid2D& grid) const {
  const double sigma_translation =
      uncertainty::WorstTranslationSigma(predicted.covariance);
  const double sigma_rotation = std::sqrt(predicted.covariance(2, 2));
  // A log-likelihood of n ln(score) - chi2 / 2, divided by n.
  const double n = std::max(1, scan_matching::NumPatches(cloud));
  const double weight = 1. / std::sqrt(2. * n);
  return SearchAround(predicted.pose, ConsistentWindow(predicted),
                      weight / std::max(sigma_translation, kLeastSigma),
                      weight / std::max(sigma_rotation, kLeastSigma), cloud,
                      grid);
}

LocalMatch LocalMatcher::Match(const Pose2& last_pose,
                               const MotionPrediction& prediction,
                               const PointCloud& cloud,
                               const mapping::Submap2D& submap) {
  const Grid2D& grid = *submap.grid();
  Prediction predicted =
      ToPrediction(last_pose, prediction.motion, prediction.covariance);
  predicted.scans_in_map = submap.num_range_data();
  sight_.Add(last_pose, Ranges(cloud));
  predicted.limit_of_sight = sight_.Limit();
  LocalMatch match = MatchFrom(predicted, predicted.pose, cloud, grid);
  if (options_.enabled &&
      (contest_.is_open() || IsDoubtful(match, prediction, cloud, grid))) {
    match =
        MatchWithSearch(last_pose, prediction, predicted, cloud, grid, match);
  } else {
    contest_.Agree();
  }
  match.overrules_odometry = contest_.is_overruled();
  if (has_mean_score_) match.doubt = MatchDoubt(match.score, mean_score_);
  mean_score_ +=
      (has_mean_score_ ? kScoreRate : 1.) * (match.score - mean_score_);
  has_mean_score_ = true;
  return match;
}

LocalMatch LocalMatcher::MatchAfter(const Pose2& last_pose, const Pose2& motion,
                                    const MotionPrediction& prediction,
                                    const Prediction& predicted,
                                    const Pose2& found, const PointCloud& cloud,
                                    const Grid2D& grid) const {
  Prediction start = ToPrediction(
      last_pose, motion, kCovarianceScaleAfterSearch * prediction.covariance);
  start.scans_in_map = predicted.scans_in_map;
  start.limit_of_sight = predicted.limit_of_sight;
  LocalMatch match = MatchFrom(start, found, cloud, grid);
  match.relocated = true;
  return match;
}

double LocalMatcher::LogPlacesOf(const Pose2& found, const Pose2& last_pose,
                                 const Pose2& motion, const bool is_alternative,
                                 const MotionPrediction& prediction) const {
  const bool is_confirmed =
      is_alternative && SeeTheSame(prediction.motion) &&
      IsNear(found, last_pose * motion, kConfirmedDistance, kConfirmedAngle);
  return is_confirmed || contest_.IsRival(found, prediction.motion)
             ? 0.
             : kLogPlaces;
}

LocalMatch LocalMatcher::MatchWithSearch(const Pose2& last_pose,
                                         const MotionPrediction& prediction,
                                         const Prediction& predicted,
                                         const PointCloud& cloud,
                                         const Grid2D& grid,
                                         const LocalMatch& matched) {
  LocalMatch best =
      BeforeSearch(matched, prediction, predicted, options_.gate, cloud, grid);
  const size_t num_plain = matched.report.mahalanobis > options_.gate ? 1 : 0;
  std::vector<Rival> rivals(num_plain, Rival{matched, 0.});
  double to_beat = matched.score + options_.min_gain;
  // Matches from there; returns whether the result is consistent with the
  // prediction.
  const auto try_consistent = [&](const Pose2& found, const double log_places) {
    LocalMatch match = MatchFrom(predicted, found, cloud, grid);
    match.relocated = true;
    if (match.report.mahalanobis > options_.gate ||
        ChiSquare(predicted, match.pose) > options_.gate) {
      rivals.push_back({match, log_places});
      return false;
    }
    if (!IsLikelier(match, best, predicted, cloud, grid)) {
      rivals.push_back({match, log_places});
      return true;
    }
    best = match;
    to_beat = best.score + options_.min_gain;
    return true;
  };
  const auto match_after = [&](const Pose2& motion, const Pose2& found) {
    return MatchAfter(last_pose, motion, prediction, predicted, found, cloud,
                      grid);
  };
  if (contest_.is_open()) {
    const Pose2 expected = contest_.Expected(prediction.motion);
    const Pose2 found =
        SearchAround(expected, {kSamePlaceDistance, kSamePlaceAngle},
                     kSearchPenalty, kSearchPenalty, cloud, grid);
    rivals.push_back({match_after(Between(last_pose, expected), found), 0.});
  }
  if (!prediction.is_uncertain) {
    const scan_matching::SearchWindow window = ConsistentWindow(predicted);
    try_consistent(SearchConsistent(predicted, cloud, grid),
                   LogPlaces(window.linear, window.angular));
  }
  const std::vector<SearchedMotion> motions = MotionsToSearch(prediction);
  for (const SearchedMotion& searched : motions) {
    const Pose2& motion = searched.motion;
    if (searched.is_hint &&
        (motion.translation() - prediction.motion.translation()).norm() >
            LinearWindow(prediction.motion, prediction)) {
      continue;
    }
    const Pose2 found =
        Search(last_pose * motion, motion, prediction, cloud, grid);
    const double log_places = LogPlacesOf(
        found, last_pose, motion, &searched != &motions.front(), prediction);
    if (!prediction.is_uncertain && try_consistent(found, log_places)) continue;
    if (searched.is_hint) continue;
    const LocalMatch match = match_after(motion, found);
    rivals.push_back({match, log_places});
    const double doubt = prediction.is_uncertain
                             ? 0.
                             : Inconsistency(predicted.pose, match.pose);
    const double gain = options_.min_gain + options_.contradiction_gain * doubt;
    if (match.score <= std::max(to_beat, matched.score + gain)) continue;
    if (!MayOverrule(prediction, contest_.FaultOdds(prediction) + log_places,
                     match.pose, predicted.pose, cloud, grid)) {
      continue;
    }
    to_beat = match.score;
    best = match;
  }
  // What is uncertain is searched widely anyhow.
  if (prediction.is_uncertain || !SeeTheSame(prediction.motion)) {
    rivals.resize(num_plain);
  }
  return Decide(prediction, predicted, best, rivals, cloud, grid);
}

LocalMatch LocalMatcher::Decide(const MotionPrediction& prediction,
                                const Prediction& predicted,
                                const LocalMatch& best,
                                const std::vector<Rival>& rivals,
                                const PointCloud& cloud, const Grid2D& grid) {
  LocalMatch result = best;
  if (prediction.source == PredictionSource::kOdometry) {
    const bool is_consistent = best.report.mahalanobis <= options_.gate;
    if (best.relocated &&
        (!is_consistent || ChiSquare(predicted, best.pose) > options_.gate)) {
      contest_.Overrule(Inconsistency(predicted.pose, best.pose) >= 1.);
    } else if (!best.relocated || SeeTheSame(prediction.motion)) {
      result = contest_.Decide(
          prediction, predicted,
          is_consistent
              ? best
              : AtPrediction(best, predicted, options_.gate, cloud, grid),
          rivals, mean_score_ - options_.score_drop, cloud, grid);
    }
  } else {
    contest_.Drop();
  }
  result.searched = true;
  return result;
}

}  // namespace front_end
}  // namespace cartographer_ext
