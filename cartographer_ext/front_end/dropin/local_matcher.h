// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
//
// Matches one scan against one grid: the degeneracy-aware match from the
// prediction, and where that is not enough, a correlative search around the
// motions that the robot may have made.
//
// A match finds the nearest minimum only. Where the prediction may be farther
// off than that reaches (a slow laser, a sharp turn), other minima are searched
// for: first the likeliest pose, scan and prediction together, among those that
// are consistent with the prediction, then the best score in a window, which may be
// inconsistent with it. Where scans fit badly some wrong place nearly always has
// the best score, so the second search alone would hide the right one. One that is
// consistent with the prediction is taken if it is likelier.
//
// Elsewhere the search only provides initial poses. Each of them is matched with
// the motion it came from as prediction, so that along a direction that the scan
// does not determine (a corridor) the result is still that motion and not where
// the search happened to score best. The result with the highest score wins if
// its score exceeds that of the match without search by a margin, which is
// larger where the result is inconsistent with a prediction that was considered
// certain: odometry is seldom wrong, and a scan that fits badly finds many
// places that score nearly as high. What contradicts the odometry and does not
// win is followed from scan to scan (odometry_contest.h).
#ifndef CARTOGRAPHER_EXT_FRONT_END_DROPIN_LOCAL_MATCHER_H_
#define CARTOGRAPHER_EXT_FRONT_END_DROPIN_LOCAL_MATCHER_H_

#include <vector>

#include "cartographer/mapping/2d/grid_2d.h"
#include "cartographer/mapping/2d/submap_2d.h"
#include "cartographer/mapping/proto/scan_matching/ceres_scan_matcher_options_2d.pb.h"
#include "cartographer/sensor/point_cloud.h"
#include "cartographer_ext/common/pose2.h"
#include "cartographer_ext/front_end/dropin/local_match.h"
#include "cartographer_ext/front_end/dropin/odometry_contest.h"
#include "cartographer_ext/front_end/front_end_options.h"
#include "cartographer_ext/front_end/motion_predictor.h"
#include "cartographer_ext/front_end/sight_limit.h"
#include "cartographer_ext/scan_matching/dropin/degeneracy_aware_scan_matcher_2d.h"
#include "cartographer_ext/scan_matching/dropin/real_time_matcher_2d.h"
#include "cartographer_ext/scan_matching/match_report.h"

namespace cartographer_ext {
namespace front_end {

// Matches scans with a grid, see above. Not thread-safe.
class LocalMatcher {
 public:
  LocalMatcher(const LocalSearchOptions& options,
               const cartographer::mapping::scan_matching::proto::
                   CeresScanMatcherOptions2D& matcher_options);

  // As of OdometryContest.
  void SetFieldOfView(const double angle) { contest_.SetFieldOfView(angle); }

  // `last_pose` is (local <- robot) at the scan before. Updates the mean score
  // that later scans are compared with.
  LocalMatch Match(const Pose2& last_pose, const MotionPrediction& prediction,
                   const cartographer::sensor::PointCloud& cloud,
                   const cartographer::mapping::Submap2D& submap);

 private:
  LocalMatch MatchFrom(const scan_matching::Prediction& prediction,
                       const Pose2& initial,
                       const cartographer::sensor::PointCloud& cloud,
                       const cartographer::mapping::Grid2D& grid) const;
  bool IsDoubtful(const LocalMatch& match, const MotionPrediction& prediction,
                  const cartographer::sensor::PointCloud& cloud,
                  const cartographer::mapping::Grid2D& grid) const;
  // The best of `matched` and the matches started from searches.
  LocalMatch MatchWithSearch(const Pose2& last_pose,
                             const MotionPrediction& prediction,
                             const scan_matching::Prediction& predicted,
                             const cartographer::sensor::PointCloud& cloud,
                             const cartographer::mapping::Grid2D& grid,
                             const LocalMatch& matched);
  // Matches from `found` as if the robot had made `motion`.
  LocalMatch MatchAfter(const Pose2& last_pose, const Pose2& motion,
                        const MotionPrediction& prediction,
                        const scan_matching::Prediction& predicted,
                        const Pose2& found,
                        const cartographer::sensor::PointCloud& cloud,
                        const cartographer::mapping::Grid2D& grid) const;
  // Logarithm of the number of places of which `found` is the best in a search
  // around `motion`, zero where it confirms an alternative or a rival.
  double LogPlacesOf(const Pose2& found, const Pose2& last_pose,
                     const Pose2& motion, bool is_alternative,
                     const MotionPrediction& prediction) const;
  // Between `best` and those that contradict the odometry.
  LocalMatch Decide(const MotionPrediction& prediction,
                    const scan_matching::Prediction& predicted,
                    const LocalMatch& best, const std::vector<Rival>& rivals,
                    const cartographer::sensor::PointCloud& cloud,
                    const cartographer::mapping::Grid2D& grid);
  // Half width of the window around a motion, metres.
  double LinearWindow(const Pose2& motion,
                      const MotionPrediction& prediction) const;
  // The part of a prediction up to the gate.
  scan_matching::SearchWindow ConsistentWindow(
      const scan_matching::Prediction& predicted) const;
  // The likeliest pose by scan and prediction: the best by
  //   score exp(-chi2 / (2 n)),
  // chi2 that of the difference from the prediction, up to the gate, n the number
  // of independent parts of the scan (NumPatches).
  Pose2 SearchConsistent(const scan_matching::Prediction& predicted,
                         const cartographer::sensor::PointCloud& cloud,
                         const cartographer::mapping::Grid2D& grid) const;
  // The best score around `center`, the end of `motion`, in a window that covers
  // the uncertainty of the prediction.
  Pose2 Search(const Pose2& center, const Pose2& motion,
               const MotionPrediction& prediction,
               const cartographer::sensor::PointCloud& cloud,
               const cartographer::mapping::Grid2D& grid) const;

  const LocalSearchOptions options_;
  const scan_matching::DegeneracyAwareScanMatcher2D matcher_;
  double mean_score_ = 0.;
  bool has_mean_score_ = false;
  OdometryContest contest_;
  SightLimit sight_;
};

// Probability that a match is wrong, from what its score is of the usual one: 2 %
// at three quarters of it, a third at four tenths. Zero for better matches.
double MatchDoubt(double score, double usual);

// How inconsistent `found` is with `predicted`, from 0 (within 5 cm and 2
// degrees) to 1 (15 cm or 5 degrees and more).
double Inconsistency(const Pose2& predicted, const Pose2& found);

}  // namespace front_end
}  // namespace cartographer_ext

#endif  // CARTOGRAPHER_EXT_FRONT_END_DROPIN_LOCAL_MATCHER_H_
