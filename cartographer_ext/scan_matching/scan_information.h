// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
//
// Combination of scan match X_s and prediction X_0 (paper G, improved graph
// optimisation 2024, section 3.3, eq. 19):
//
//   X_f = X_0 + K (X_s - X_0)
//
// The gain K follows the match along observable directions and the prediction
// along the others. There are three gains, all applied by `Remap`:
//
//   information   The default, where the prediction has a covariance P. With L
//                 the information of the match (match_information.h),
//
//                   K = (L + P^-1)^-1 L,
//
//                 the Kalman gain: along a corridor L vanishes and the
//                 prediction is kept; in between both are weighed by their
//                 information.
//                 Place and heading are corrected together, so that in a round
//                 room the walls still fit after the heading was corrected.
//   directions    Where P is not known: K = sum of w_i v_i v_i^T over the
//                 directions v_i of translation, with belief w_i in [0, 1]. The
//                 heading is then that of the match, which has the prior of the
//                 stock matcher in it: a scan in a round room with little
//                 information about its heading is treated no worse than
//                 there. For the same
//                 reason the directions are judged with the heading given (no
//                 Schur complement).
//   as printed    kPaperLiteral: the same sum over the eigenvectors of eq. 17
//                 with w_i = 0 or 1 (degeneracy.h).
#ifndef CARTOGRAPHER_EXT_SCAN_MATCHING_SCAN_INFORMATION_H_
#define CARTOGRAPHER_EXT_SCAN_MATCHING_SCAN_INFORMATION_H_

#include "Eigen/Core"
#include "cartographer_ext/common/pose2.h"
#include "cartographer_ext/scan_matching/degeneracy.h"
#include "cartographer_ext/scan_matching/match_report.h"
#include "cartographer_ext/uncertainty/match_information.h"

namespace cartographer_ext {
namespace scan_matching {

// Options of the analysis of a scan and of its combination with the prediction.
struct ScanInformationOptions : uncertainty::MatchInformationOptions {
  DegeneracyMode mode = DegeneracyMode::kNoiseFloor;
  // Threshold of kPaperLiteral, > 1: the paper gives no value. Noise along a
  // blank wall keeps the ratio near 2 to 4 in a corridor.
  double paper_ratio = 2.;
};

// Information of a scan match with its degenerate directions.
struct ScanInformation : uncertainty::MatchInformation {
  DegeneracyMode mode = DegeneracyMode::kNoiseFloor;
  // In the frame of the grid, real units: eigenvalues are 1/m^2 and 1/rad^2.
  DegeneracyResult degeneracy;
  // Directions of translation for the heading of the match, as columns, and
  // their weights.
  Eigen::Matrix2d directions = Eigen::Matrix2d::Identity();
  Eigen::Vector2d direction_weights = Eigen::Vector2d::Zero();
};

// `gauss_newton` (any unit) is used in kPaperLiteral only.
ScanInformation AnalyzeScan(const ScanInformationOptions& options,
                            const uncertainty::ScaledMotion& motion,
                            const uncertainty::ScanCurvature& curvature,
                            int num_points,
                            const Eigen::Matrix3d& gauss_newton);

// The result of a scan without information.
ScanInformation NoInformation();

// X_f of G eq. 19. `prior` is P^-1, positive definite, or null where the
// covariance of the prediction is not known.
Pose2 Remap(const ScanInformation& scan, const Eigen::Matrix3d* prior,
            const Pose2& prediction, const Pose2& match);

// Sets disagreement, Mahalanobis distance and degrees of freedom. `covariance`
// of the prediction may be null.
void Compare(const ScanInformation& scan, const Pose2& prediction,
             const Eigen::Matrix3d* covariance, const Pose2& match,
             MatchReport* report);

}  // namespace scan_matching
}  // namespace cartographer_ext

#endif  // CARTOGRAPHER_EXT_SCAN_MATCHING_SCAN_INFORMATION_H_
