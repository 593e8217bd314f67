// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
//
// Whether scans overrule the odometry.
//
// Odometry is seldom wrong, and a scan that fits badly fits better somewhere
// else. So a pose that contradicts the odometry, a rival, needs more evidence
// (scan_evidence.h) than a narrow scan has: wheels that slip for seconds would
// turn the map before one scan refutes them. Therefore a rival is followed from
// scan to scan while the robot moves little. Its evidence is added up, in part
// only while it stays where it was relative to the odometry, since matches that
// are wrong all by the same see the same walls; in full while its motion, too,
// contradicts the odometry. Meanwhile the poses are those of the odometry, and
// contested: what they saw must not go into the map, which would then agree
// with them.
//
// One thing alone is not enough for a laser that sees little: somebody who walks ahead of the robot is where
// they were in the scan before, as if it stood still. So the rest of the scans must
// speak for the rival, too (PoseEvidence::AgainstWithoutObject); otherwise neither
// is the odometry overruled nor a scan kept out of the map.
//
// Along a corridor a robot that fell behind fits better than one that sees new
// walls, so a rival must also fit better than the place beyond it
// (odometry_fault.h).
#ifndef CARTOGRAPHER_EXT_FRONT_END_DROPIN_ODOMETRY_CONTEST_H_
#define CARTOGRAPHER_EXT_FRONT_END_DROPIN_ODOMETRY_CONTEST_H_

#include <vector>

#include "Eigen/Core"
#include "cartographer/mapping/2d/grid_2d.h"
#include "cartographer/sensor/point_cloud.h"
#include "cartographer_ext/common/pose2.h"
#include "cartographer_ext/front_end/dropin/local_match.h"
#include "cartographer_ext/front_end/motion_predictor.h"
#include "cartographer_ext/scan_matching/match_report.h"

namespace cartographer_ext {
namespace front_end {

// A match that contradicts the odometry, and the logarithm of the number of
// places of which it is the best.
struct Rival {
  LocalMatch match;
  double log_places = 0.;
};

// Decides scan by scan, see above. Not thread-safe.
class OdometryContest {
 public:
  // chi2 beyond which a pose contradicts the odometry.
  explicit OdometryContest(double gate) : gate_(gate) {}

  // How wide the laser sees, radians; all around before it is known.
  void SetFieldOfView(const double angle) { field_of_view_ = angle; }

  // Whether scans spoke for a rival that did not have evidence enough.
  bool is_open() const { return has_rival_; }
  // Where the rival is after `motion`; only while the contest is open.
  Pose2 Expected(const Pose2& motion) const { return rival_ * motion; }
  // Whether `found` is the rival.
  bool IsRival(const Pose2& found, const Pose2& motion) const;

  // Scans overruled the odometry, and no match has agreed with it since.
  bool is_overruled() const { return is_overruled_; }
  // Logarithm of the odds against a fault of odometry.
  double FaultOdds(const MotionPrediction& prediction) const;

  // The scan agrees with the odometry without a search.
  void Agree();
  // Something else than the odometry predicts: there is nothing to contest.
  void Drop();
  // A search alone was evidence enough; `is_lasting` as is_overruled().
  void Overrule(bool is_lasting);

  // The best of `rivals` if the evidence is enough, else `consistent`.
  // `predicted` is the prediction in the local frame, by odometry; a score
  // below `least_score` is a bad one.
  LocalMatch Decide(const MotionPrediction& prediction,
                    const scan_matching::Prediction& predicted,
                    const LocalMatch& consistent,
                    const std::vector<Rival>& rivals, double least_score,
                    const cartographer::sensor::PointCloud& cloud,
                    const cartographer::mapping::Grid2D& grid);

 private:
  // Of a scan for the best rival, and without the object that speaks most for it.
  struct Evidence {
    const Rival* best = nullptr;  // null if there is none
    double of_scan = 0.;
    double of_rest = 0.;
  };
  Evidence BestEvidence(const MotionPrediction& prediction,
                        const scan_matching::Prediction& predicted,
                        const LocalMatch& consistent,
                        const std::vector<Rival>& rivals,
                        const cartographer::sensor::PointCloud& cloud,
                        const cartographer::mapping::Grid2D& grid) const;

  // Of the odometry since the last scan and of the matches, for a prediction
  // with this covariance.
  Eigen::Matrix3d StepCovariance(const Eigen::Matrix3d& covariance) const;

  const double gate_;
  double field_of_view_ = 2. * kPi;
  bool is_overruled_ = false;
  // Against the odometry, of scans that were not enough by themselves.
  double evidence_ = 0.;
  // The same without one object in each scan.
  double evidence_of_rest_ = 0.;
  bool has_rival_ = false;
  Pose2 rival_;                       // (local <- robot) at the last scan
  Eigen::Matrix3d rival_covariance_;  // of the prediction there
};

}  // namespace front_end
}  // namespace cartographer_ext

#endif  // CARTOGRAPHER_EXT_FRONT_END_DROPIN_ODOMETRY_CONTEST_H_
