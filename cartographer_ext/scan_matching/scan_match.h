// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
//
// Matches a scan with a grid of correspondence costs: the whole of the scan
// matcher, without the host.
//
//   1. minimise  w^2 / (2 n) sum c^2  +  prior            (pose_solver.h)
//   2. measure how fast that sum rises around the minimum (scan_curvature.h)
//   3. keep of the minimum what the scan determines, take the rest from the
//      prediction                                         (scan_information.h)
//
// The prior of step 1 is that of the stock matcher, (w_t |t - t_0|)^2 / 2 +
// (w_r (theta - theta_0))^2 / 2, where the prediction comes without covariance.
// With a covariance the prior is only a weak one that keeps the solver near its
// start (G eq. 16 has none), and step 3 weighs both.
#ifndef CARTOGRAPHER_EXT_SCAN_MATCHING_SCAN_MATCH_H_
#define CARTOGRAPHER_EXT_SCAN_MATCHING_SCAN_MATCH_H_

#include <algorithm>
#include <cmath>
#include <utility>
#include <vector>

#include "Eigen/Core"
#include "cartographer_ext/common/pose2.h"
#include "cartographer_ext/scan_matching/match_report.h"
#include "cartographer_ext/scan_matching/occupied_space_cost.h"
#include "cartographer_ext/scan_matching/pose_solver.h"
#include "cartographer_ext/scan_matching/scan_curvature.h"
#include "cartographer_ext/scan_matching/scan_information.h"

namespace cartographer_ext {
namespace scan_matching {

struct ScanMatchOptions {
  double occupied_space_weight = 1.;  // > 0, as the next two
  double translation_weight = 10.;
  double rotation_weight = 40.;
  PoseSolverOptions solver;
  bool remap = true;           // step 3
  double curvature_step = 2.;  // cells, > 0
  ScanInformationOptions information;
  // Standard deviations of a prediction whose covariance is not known; they
  // only enter the covariance that is reported.
  double prediction_translation_sigma = 0.1;  // metres, > 0
  double prediction_rotation_sigma = 0.05;    // radians, > 0
};

namespace internal {

// Of the weak prior, in curvature (squared cost per squared cell).
constexpr double kWeakPrior = 1e-3;

// By how much the standard deviation of a match is larger with a map of only a
// few scans. Measured as the noise of the match itself (scan_information.h):
// variances are 4 times as large with one scan, 1.3 times with two, as with
// many from the third on.
inline double YoungMapNoise(const int scans_in_map) {
  if (scans_in_map <= 0) return 1.;
  const double n = scans_in_map;
  return std::sqrt(1. + 3. / (n * n * n));
}

inline bool IsFinite(const Pose2& pose) {
  return std::isfinite(pose.x) && std::isfinite(pose.y) &&
         std::isfinite(pose.theta);
}

// Weights of a prior, squared, along x, y and theta, and where it pulls to.
struct Prior {
  Eigen::Vector3d weights;
  Pose2 pose;

  // The angle is not wrapped, as in the stock matcher.
  double Cost(const Pose2& at) const {
    return 0.5 * weights.dot(Difference(at).cwiseAbs2());
  }
  Eigen::Vector3d Difference(const Pose2& at) const {
    return Eigen::Vector3d(at.x - pose.x, at.y - pose.y, at.theta - pose.theta);
  }
};

}  // namespace internal

// Returns X_f (grid <- node), its angle on the same turn as the initial one.
// `prediction.covariance` as in match_report.h; `initial` is where the solver
// starts. Points that are not finite are left out; a prediction or initial pose
// that is not finite is replaced by the other. `cells` as in
// occupied_space_cost.h. `report` may be null.
template <typename Cells>
Pose2 MatchScan(const ScanMatchOptions& options, const Prediction& prediction,
                const Pose2& initial, std::vector<Eigen::Vector2d> points,
                const Cells& cells, MatchReport* report);

// The angle nearest to `reference` that is the same direction as `angle`.
inline double UnwrapAngle(const double angle, const double reference) {
  return reference + NormalizeAngle(angle - reference);
}

template <typename Cells>
Pose2 MatchScan(const ScanMatchOptions& options, const Prediction& prediction,
                const Pose2& initial, std::vector<Eigen::Vector2d> points,
                const Cells& cells, MatchReport* const report) {
  points.erase(std::remove_if(points.begin(), points.end(),
                              [](const Eigen::Vector2d& point) {
                                return !point.allFinite();
                              }),
               points.end());
  Pose2 start = internal::IsFinite(initial) ? initial : prediction.pose;
  if (!internal::IsFinite(start)) start = Pose2();
  Pose2 predicted =
      internal::IsFinite(prediction.pose) ? prediction.pose : start;
  // One branch for all angles.
  predicted.theta = UnwrapAngle(predicted.theta, start.theta);
  Eigen::Matrix3d prediction_information;
  const bool covariance_is_known =
      InvertCovariance(prediction.covariance, &prediction_information);

  const int num_points = static_cast<int>(points.size());
  const double weight2 =
      options.occupied_space_weight * options.occupied_space_weight;
  const double scale = num_points == 0 ? 0. : weight2 / num_points;
  OccupiedSpaceCost<Cells> cost(&cells, std::move(points));
  const ScaledMotion motion_at_start(cost.points(), cells.resolution(), start);

  const double translation2 =
      options.translation_weight * options.translation_weight;
  const double rotation2 = options.rotation_weight * options.rotation_weight;
  const internal::Prior stock_prior{
      Eigen::Vector3d(translation2, translation2, rotation2), predicted};
  internal::Prior prior = stock_prior;
  if (covariance_is_known && options.remap) {
    prior.weights = internal::kWeakPrior * weight2 *
                    motion_at_start.FromPose().diagonal().cwiseAbs2();
    // A start that a search has found may be far from the prediction.
    prior.pose = start;
  }
  bool is_first = true;
  double squares_at_start = 0.;
  const auto evaluate = [&](const Pose2& pose) {
    const OccupiedSpaceSums sums = cost.Evaluate(pose);
    if (is_first) squares_at_start = sums.squares;
    is_first = false;
    PoseCost result;
    result.cost = 0.5 * scale * sums.squares + prior.Cost(pose);
    result.gradient = scale * sums.gradient +
                      prior.weights.cwiseProduct(prior.Difference(pose));
    result.hessian = scale * sums.hessian;
    result.hessian.diagonal() += prior.weights;
    return result;
  };
  const PoseSolution solution = SolvePose(options.solver, start, evaluate);
  Pose2 match = solution.pose;
  if (!internal::IsFinite(match)) match = start;

  if (!options.remap && report == nullptr && !covariance_is_known) return match;
  ScanInformation scan = NoInformation();
  if (num_points > 0) {
    const ScaledMotion motion(cost.points(), cells.resolution(), match);
    // The Gauss-Newton part alone, without the prior.
    Eigen::Matrix3d hessian = solution.at_pose.hessian;
    hessian.diagonal() -= prior.weights;
    const double per_point = 0.5 / num_points;
    const auto half_mean_squares = [&](const Eigen::Vector3d& step) {
      return per_point * cost.LinearSquares(motion.Moved(step));
    };
    ScanInformationOptions information = options.information;
    const double noise = internal::YoungMapNoise(prediction.scans_in_map);
    information.map_noise *= noise;
    information.point_noise *= noise;
    scan = AnalyzeScan(information, motion,
                       MeasureCurvature(half_mean_squares,
                                        motion.ToPose().transpose() * hessian *
                                            motion.ToPose(),
                                        options.curvature_step),
                       num_points, hessian);
  }
  Pose2 result = match;
  if (options.remap) {
    const bool by_covariance =
        covariance_is_known &&
        options.information.mode == DegeneracyMode::kNoiseFloor;
    result = by_covariance
                 ? Fuse(scan, predicted, prediction_information, match)
                 : Remap(scan, options.information.mode, predicted, match);
  }
  result.theta = UnwrapAngle(result.theta, start.theta);
  if (report == nullptr) return result;

  report->degeneracy = scan.degeneracy;
  report->scan_information = scan.information;
  if (!covariance_is_known) {
    prediction_information.setZero();
    const double t = options.prediction_translation_sigma;
    const double r = options.prediction_rotation_sigma;
    prediction_information.diagonal() << 1. / (t * t), 1. / (t * t),
        1. / (r * r);
  }
  report->information = scan.information + prediction_information;
  if (!InvertCovariance(report->information, &report->covariance)) {
    report->information = prediction_information;
    if (!InvertCovariance(report->information, &report->covariance)) {
      report->information.setIdentity();
      report->covariance.setIdentity();
    }
  }
  report->initial_cost =
      0.5 * scale * squares_at_start + stock_prior.Cost(start);
  report->final_cost =
      0.5 * scale * cost.Evaluate(result).squares + stock_prior.Cost(result);
  report->iterations = solution.iterations;
  report->converged = solution.converged;
  report->match = Pose2(match.x, match.y, NormalizeAngle(match.theta));
  Compare(scan, predicted,
          covariance_is_known ? &prediction.covariance : nullptr, match,
          report);
  return result;
}

}  // namespace scan_matching
}  // namespace cartographer_ext

#endif  // CARTOGRAPHER_EXT_SCAN_MATCHING_SCAN_MATCH_H_
