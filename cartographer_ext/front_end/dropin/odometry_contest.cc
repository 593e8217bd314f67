// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
#include "cartographer_ext/front_end/dropin/odometry_contest.h"

#include <algorithm>

#include "cartographer_ext/front_end/odometry/odometry_fault.h"
#include "cartographer_ext/front_end/odometry/odometry_monitor.h"
#include "cartographer_ext/scan_matching/dropin/scan_evidence.h"

namespace cartographer_ext {
namespace front_end {
namespace {

using cartographer::mapping::Grid2D;
using cartographer::sensor::PointCloud;
using scan_matching::Prediction;

// Scans that contradict the odometry in succession see the same walls: of the
// evidence of those before this part is new.
constexpr double kEvidenceKept = 0.5;
constexpr double kEvidenceOfMotionKept = 0.8;  // if the motion does, too

// A laser that sees no more than this may see hardly anything but one object: one of
// a metre, a metre ahead, is half of it. Radians.
constexpr double kFewObjects = 1.85;

// Of the motion of a rival between two matches, square metres and radians.
const Eigen::Vector3d kRivalVariances(2e-4, 2e-4, 1e-4);

}  // namespace

bool OdometryContest::IsRival(const Pose2& found, const Pose2& motion) const {
  return has_rival_ && IsOnePlace(found, Expected(motion));
}

double OdometryContest::FaultOdds(const MotionPrediction& prediction) const {
  // It is unlikely, unless the odometry was overruled before: wheels that slip
  // do so for a while.
  return prediction.is_uncertain || is_overruled_ ? 0.
                                                  : kLogOddsOfOdometryFault;
}

void OdometryContest::Drop() {
  has_rival_ = false;
  evidence_ = evidence_of_rest_ = 0.;
}

void OdometryContest::Agree() {
  Drop();
  is_overruled_ = false;
}

void OdometryContest::Overrule(const bool is_lasting) {
  Drop();
  is_overruled_ = is_lasting;
}

Eigen::Matrix3d OdometryContest::StepCovariance(
    const Eigen::Matrix3d& covariance) const {
  // It grows from scan to scan until one is inserted into the map.
  const bool has_grown = covariance(2, 2) >= rival_covariance_(2, 2);
  Eigen::Vector3d variances = covariance.diagonal();
  if (has_grown) {
    variances = (variances - rival_covariance_.diagonal()).cwiseMax(0.);
  }
  return (variances + kRivalVariances).asDiagonal();
}

OdometryContest::Evidence OdometryContest::BestEvidence(
    const MotionPrediction& prediction, const Prediction& predicted,
    const LocalMatch& consistent, const std::vector<Rival>& rivals,
    const PointCloud& cloud, const Grid2D& grid) const {
  Evidence result;
  if (rivals.empty()) return result;
  const Pose2 expected =
      has_rival_ ? Expected(prediction.motion) : predicted.pose;
  scan_matching::PoseEvidence of_scan(predicted.pose, cloud, grid,
                                      scan_matching::PosePrecision::kCell);
  for (const Rival& rival : rivals) {
    const Pose2& pose = rival.match.pose;
    if (rival.match.score <= consistent.score) continue;
    of_scan.SetPose(pose);
    double evidence = of_scan.Against(consistent.pose);
    if (SeeTheSame(prediction.motion)) {
      const Pose2 beyond = Beyond(consistent.pose, pose);
      evidence = std::min(evidence, of_scan.Against(beyond));
      evidence -= rival.log_places +
                  FaultCost(Between(expected, pose), prediction.motion);
    }
    if (result.best != nullptr && evidence <= result.of_scan) continue;
    result.best = &rival;
    result.of_scan = evidence;
  }
  if (result.best != nullptr && field_of_view_ < kFewObjects) {
    of_scan.SetPose(result.best->match.pose);
    result.of_rest = of_scan.AgainstWithoutObject(consistent.pose);
  }
  return result;
}

LocalMatch OdometryContest::Decide(
    const MotionPrediction& prediction, const Prediction& predicted,
    const LocalMatch& consistent, const std::vector<Rival>& rivals,
    const double least_score, const PointCloud& cloud, const Grid2D& grid) {
  const bool was_open = has_rival_;
  const Evidence found =
      BestEvidence(prediction, predicted, consistent, rivals, cloud, grid);
  const Rival* const best = found.best;
  has_rival_ = false;
  LocalMatch result = consistent;
  if (best != nullptr) {
    // Had only the matches been wrong, and by the same, their motion would
    // still agree with the odometry.
    const bool is_moving =
        was_open &&
        ChiSquare(ToPrediction(rival_, prediction.motion,
                               StepCovariance(prediction.covariance)),
                  best->match.pose) > gate_;
    const double kept = is_moving ? kEvidenceOfMotionKept : kEvidenceKept;
    const double evidence = kept * evidence_ + found.of_scan;
    evidence_of_rest_ = kept * evidence_of_rest_ + found.of_rest;
    const bool is_held =
        field_of_view_ >= kFewObjects || evidence_of_rest_ > 0.;
    if (evidence >= FaultOdds(prediction) && is_held) {
      Overrule(SeeTheSame(prediction.motion));
      result = best->match;
      result.ends_contest = was_open;
      if (was_open) result.rival_motion = Between(rival_, result.pose);
      return result;
    }
    evidence_ = std::max(0., evidence);
    has_rival_ = evidence > 0. && SeeTheSame(prediction.motion);
    rival_ = best->match.pose;
    rival_covariance_ = prediction.covariance;
    result.contested = has_rival_ && is_held && result.score < least_score;
  } else {
    evidence_ = evidence_of_rest_ = 0.;
  }
  if (!prediction.is_uncertain) {
    is_overruled_ = is_overruled_ && result.score < least_score;
  }
  return result;
}

}  // namespace front_end
}  // namespace cartographer_ext
