// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
//
// One scan against one grid: the degeneracy-aware match from the prediction,
// and where that is not enough, a correlative search around everything the
// robot may have done.
//
// The search only offers starting points. Every starting point is matched with
// the motion it came from as prediction, so that along a direction that the
// scan does not determine (a corridor) the outcome is still that motion and not
// where the search happened to score best. Of the outcomes the one under whose
// points the grid is most probable wins, if it is clearly better than the match
// without search, and by more than that if it contradicts a prediction that was
// held for certain: odometry is seldom wrong, and a scan that fits badly finds
// many places nearly as good.
#ifndef CARTOGRAPHER_EXT_FRONT_END_DROPIN_LOCAL_MATCHER_H_
#define CARTOGRAPHER_EXT_FRONT_END_DROPIN_LOCAL_MATCHER_H_

#include "cartographer/mapping/2d/grid_2d.h"
#include "cartographer/mapping/2d/submap_2d.h"
#include "cartographer/mapping/proto/scan_matching/ceres_scan_matcher_options_2d.pb.h"
#include "cartographer/sensor/point_cloud.h"
#include "cartographer_ext/common/pose2.h"
#include "cartographer_ext/front_end/motion_predictor.h"
#include "cartographer_ext/front_end_options.pb.h"
#include "cartographer_ext/scan_matching/dropin/degeneracy_aware_scan_matcher_2d.h"
#include "cartographer_ext/scan_matching/match_report.h"

namespace cartographer_ext {
namespace front_end {

struct LocalMatch {
  Pose2 pose;  // (local <- robot)
  scan_matching::MatchReport report;
  // Mean probability under the points, 0 to 1.
  double score = 0.;
  bool searched = false;
  // The search found another place than the match from the prediction.
  bool relocated = false;
};

class LocalMatcher {
 public:
  LocalMatcher(const proto::FrontEndOptions& options,
               const cartographer::mapping::scan_matching::proto::
                   CeresScanMatcherOptions2D& matcher_options);

  // `last_pose` is (local <- robot) at the scan before. Remembers how well
  // scans fit.
  LocalMatch Match(const Pose2& last_pose, const MotionPrediction& prediction,
                   const cartographer::sensor::PointCloud& cloud,
                   const cartographer::mapping::Submap2D& submap);

 private:
  LocalMatch MatchFrom(const scan_matching::Prediction& prediction,
                       const Pose2& initial,
                       const cartographer::sensor::PointCloud& cloud,
                       const cartographer::mapping::Grid2D& grid) const;
  bool IsDoubtful(const LocalMatch& match,
                  const MotionPrediction& prediction) const;
  // Around `center`, where `motion` leads, in a window for all that is not
  // known of it.
  Pose2 Search(const Pose2& center, const Pose2& motion,
               const MotionPrediction& prediction,
               const cartographer::sensor::PointCloud& cloud,
               const cartographer::mapping::Grid2D& grid) const;

  const proto::FrontEndOptions::Search options_;
  const scan_matching::DegeneracyAwareScanMatcher2D matcher_;
  double mean_score_ = 0.;
  bool has_mean_score_ = false;
};

// How far `found` contradicts `predicted`, from 0 (less than 5 cm and 2 degrees
// off) to 1 (15 cm or 5 degrees and more).
double Contradiction(const Pose2& predicted, const Pose2& found);

}  // namespace front_end
}  // namespace cartographer_ext

#endif  // CARTOGRAPHER_EXT_FRONT_END_DROPIN_LOCAL_MATCHER_H_
