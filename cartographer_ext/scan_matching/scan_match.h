// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
//
// Matches a scan with a grid of correspondence costs: the complete scan
// matcher, independent of the host.
//
//   1. minimise  w^2 / (2 n) sum c^2  +  prior            (pose_solver.h)
//   2. measure how fast that sum rises around the minimum (scan_curvature.h)
//   3. keep of the minimum what the scan observes, take the rest from the
//      prediction                                         (scan_information.h)
//
// Without a covariance of the prediction, the prior of step 1 is that of the
// stock matcher,
//
//   (w_t |t - t_0|)^2 / 2 + (w_r (theta - theta_0))^2 / 2.
//
// With a covariance it is a weak prior that keeps the solver near its start (G
// eq. 16 has none), and step 3 combines both by their information.
#ifndef CARTOGRAPHER_EXT_SCAN_MATCHING_SCAN_MATCH_H_
#define CARTOGRAPHER_EXT_SCAN_MATCHING_SCAN_MATCH_H_

#include <algorithm>
#include <cmath>
#include <utility>
#include <vector>

#include "Eigen/Core"
#include "cartographer_ext/common/pose2.h"
#include "cartographer_ext/scan_matching/cost_curvature.h"
#include "cartographer_ext/scan_matching/match_report.h"
#include "cartographer_ext/scan_matching/occupied_space_cost.h"
#include "cartographer_ext/scan_matching/pose_solver.h"
#include "cartographer_ext/scan_matching/scan_information.h"
#include "cartographer_ext/scan_matching/wall_normals.h"
#include "cartographer_ext/uncertainty/scan_curvature.h"
#include "cartographer_ext/uncertainty/uncertain_pose.h"

namespace cartographer_ext {
namespace scan_matching {

// Weights as those of the stock matcher, and options of the steps above.
struct ScanMatchOptions {
  double occupied_space_weight = 1.;  // > 0, as the next two
  double translation_weight = 10.;
  double rotation_weight = 40.;
  PoseSolverOptions solver;
  bool remap = true;  // step 3
  // Step by which the scan is moved to measure the curvature of its cost,
  // cells, > 0. Shorter steps measure the noise of single cells, longer ones
  // miss small structures.
  double curvature_step = 2.;
  ScanInformationOptions information;
  // Standard deviations of a prediction with unknown covariance; used in the
  // reported covariance only.
  double prediction_translation_sigma = 0.1;  // metres, > 0
  double prediction_rotation_sigma = 0.05;    // radians, > 0
};

namespace internal {

// Curvature of the weak prior (squared cost per squared cell).
constexpr double kWeakPrior = 1e-3;

// Factor on the standard deviation of a match in a map of only a few scans.
// Measured as the noise of the match itself (scan_information.h): variances are
// 4 times as large with one scan, 1.3 times with two, as with many from the
// third on.
inline double YoungMapNoise(const int scans_in_map) {
  if (scans_in_map <= 0) return 1.;
  const double n = scans_in_map;
  return std::sqrt(1. + 3. / (n * n * n));
}

// Whether all components are finite.
inline bool IsFinite(const Pose2& pose) {
  return std::isfinite(pose.x) && std::isfinite(pose.y) &&
         std::isfinite(pose.theta);
}

// A prior: squared weights along x, y and theta, and the pose it pulls to.
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

// Returns X_f (grid <- node), its angle within half a turn of the initial one.
// `prediction.covariance` as in match_report.h; `initial` is where the solver
// starts. Points that are not finite are ignored; a prediction or initial pose
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

namespace internal {

// A scan match in progress. `Cells` as in occupied_space_cost.h.
template <typename Cells>
class ScanMatch {
 public:
  // Points, prediction and initial pose are finite.
  ScanMatch(const ScanMatchOptions& options, const Prediction& prediction,
            const Pose2& initial, std::vector<Eigen::Vector2d> points,
            const PointsAtLimit& at_limit, const Cells& cells)
      : options_(options),
        covariance_(prediction.covariance),
        scans_in_map_(prediction.scans_in_map),
        predicted_(prediction.pose),
        start_(initial),
        num_points_(static_cast<int>(points.size())),
        weight2_(options.occupied_space_weight * options.occupied_space_weight),
        scale_(num_points_ == 0 ? 0. : weight2_ / num_points_),
        resolution_(cells.resolution()),
        cost_(&cells, std::move(points), BestBicubicKernels(), at_limit) {
    covariance_is_known_ =
        uncertainty::InvertCovariance(covariance_, &prediction_information_);
    const double translation2 =
        options.translation_weight * options.translation_weight;
    const double rotation2 = options.rotation_weight * options.rotation_weight;
    stock_prior_ = Prior{Eigen::Vector3d(translation2, translation2, rotation2),
                         predicted_};
    prior_ = stock_prior_;
    if (covariance_is_known_ && options.remap) {
      const uncertainty::ScaledMotion motion(cost_.points(), resolution_,
                                             start_);
      prior_.weights =
          kWeakPrior * weight2_ * motion.FromPose().diagonal().cwiseAbs2();
      // A start found by a search may be far from the prediction.
      prior_.pose = start_;
    }
  }

  // Steps 1 to 3 of the file comment.
  Pose2 Match(MatchReport* const report) {
    const PoseSolution solution =
        SolvePose(options_.solver, start_,
                  [this](const Pose2& pose) { return Evaluate(pose); });
    Pose2 match = solution.pose;
    if (!IsFinite(match)) match = start_;
    if (!options_.remap && report == nullptr && !covariance_is_known_) {
      return match;
    }
    ScanInformation scan = NoInformation();
    if (num_points_ > 0) {
      // The Gauss-Newton part alone, without the prior.
      Eigen::Matrix3d hessian = solution.at_pose.hessian;
      hessian.diagonal() -= prior_.weights;
      scan = Analyze(match, hessian);
    }
    Pose2 result = match;
    if (options_.remap) {
      result =
          Remap(scan, covariance_is_known_ ? &prediction_information_ : nullptr,
                predicted_, match);
    }
    result.theta = UnwrapAngle(result.theta, start_.theta);
    if (report != nullptr) Report(solution, scan, match, result, report);
    return result;
  }

 private:
  PoseCost Evaluate(const Pose2& pose) {
    const OccupiedSpaceSums sums = cost_.Evaluate(pose);
    if (is_first_) squares_at_start_ = sums.squares;
    is_first_ = false;
    PoseCost result;
    result.cost = 0.5 * scale_ * sums.squares + prior_.Cost(pose);
    result.gradient = scale_ * sums.gradient +
                      prior_.weights.cwiseProduct(prior_.Difference(pose));
    result.hessian = scale_ * sums.hessian;
    result.hessian.diagonal() += prior_.weights;
    return result;
  }

  ScanInformation Analyze(const Pose2& match,
                          const Eigen::Matrix3d& hessian) const {
    const uncertainty::ScaledMotion motion(cost_.points(), resolution_, match);
    ScanInformationOptions information = options_.information;
    const double noise = YoungMapNoise(scans_in_map_);
    information.map_noise *= noise;
    information.point_noise *= noise;
    return AnalyzeScan(
        information, motion,
        MeasureCurvature(cost_, motion, hessian, options_.curvature_step),
        num_points_, hessian);
  }

  void Report(const PoseSolution& solution, const ScanInformation& scan,
              const Pose2& match, const Pose2& result,
              MatchReport* const report) {
    report->degeneracy = scan.degeneracy;
    report->scan_information = scan.information;
    if (!covariance_is_known_) {
      prediction_information_.setZero();
      const double t = options_.prediction_translation_sigma;
      const double r = options_.prediction_rotation_sigma;
      prediction_information_.diagonal() << 1. / (t * t), 1. / (t * t),
          1. / (r * r);
    }
    report->information = scan.information + prediction_information_;
    if (!uncertainty::InvertCovariance(report->information,
                                       &report->covariance)) {
      report->information = prediction_information_;
      if (!uncertainty::InvertCovariance(report->information,
                                         &report->covariance)) {
        report->information.setIdentity();
        report->covariance.setIdentity();
      }
    }
    report->initial_cost =
        0.5 * scale_ * squares_at_start_ + stock_prior_.Cost(start_);
    report->final_cost = 0.5 * scale_ * cost_.Evaluate(result).squares +
                         stock_prior_.Cost(result);
    report->iterations = solution.iterations;
    report->converged = solution.converged;
    report->match = Pose2(match.x, match.y, NormalizeAngle(match.theta));
    Compare(scan, predicted_, covariance_is_known_ ? &covariance_ : nullptr,
            match, report);
  }

  const ScanMatchOptions& options_;
  const Eigen::Matrix3d covariance_;  // of the prediction
  const int scans_in_map_;
  const Pose2 predicted_;
  const Pose2 start_;
  const int num_points_;
  const double weight2_;  // of the occupied space
  const double scale_;
  const double resolution_;
  OccupiedSpaceCost<Cells> cost_;
  bool covariance_is_known_ = false;
  Eigen::Matrix3d prediction_information_;
  Prior stock_prior_;
  Prior prior_;
  bool is_first_ = true;
  double squares_at_start_ = 0.;
};

}  // namespace internal

template <typename Cells>
Pose2 MatchScan(const ScanMatchOptions& options, const Prediction& prediction,
                const Pose2& initial, std::vector<Eigen::Vector2d> points,
                const Cells& cells, MatchReport* const report) {
  points.erase(std::remove_if(points.begin(), points.end(),
                              [](const Eigen::Vector2d& point) {
                                return !point.allFinite();
                              }),
               points.end());
  PointsAtLimit at_limit;
  if (std::isfinite(prediction.limit_of_sight)) {
    const auto limit = std::stable_partition(
        points.begin(), points.end(), [&](const Eigen::Vector2d& point) {
          return point.norm() < prediction.limit_of_sight;
        });
    at_limit.normals =
        WallNormals(points, static_cast<int>(limit - points.begin()));
  }
  Pose2 start = internal::IsFinite(initial) ? initial : prediction.pose;
  if (!internal::IsFinite(start)) start = Pose2();
  Prediction predicted = prediction;
  if (!internal::IsFinite(predicted.pose)) predicted.pose = start;
  // One branch for all angles.
  predicted.pose.theta = UnwrapAngle(predicted.pose.theta, start.theta);
  at_limit.initial = start;
  internal::ScanMatch<Cells> match(options, predicted, start, std::move(points),
                                   at_limit, cells);
  return match.Match(report);
}

}  // namespace scan_matching
}  // namespace cartographer_ext

#endif  // CARTOGRAPHER_EXT_SCAN_MATCHING_SCAN_MATCH_H_
