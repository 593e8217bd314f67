// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
//
// All options of local SLAM, those of its parts together. The initial values
// here and in the parts are the defaults; those of them that are keys of the
// Lua block are repeated in the option message, and a test compares the two.
#ifndef CARTOGRAPHER_EXT_FRONT_END_FRONT_END_OPTIONS_H_
#define CARTOGRAPHER_EXT_FRONT_END_FRONT_END_OPTIONS_H_

#include <string>

#include "cartographer_ext/front_end/motion_predictor.h"
#include "cartographer_ext/front_end/point_cloud/adaptive_features.h"
#include "cartographer_ext/front_end/point_cloud/wall_filling.h"
#include "cartographer_ext/front_end_options.pb.h"

namespace cartographer_ext {
namespace front_end {

// The correlative search around predictions that may be wrong.
struct LocalSearchOptions {
  bool enabled = true;
  // Search when the mean probability under the points is this much below its
  // running mean.
  double score_drop = 0.12;
  // Search when chi2 of the match against the prediction exceeds this: 0.999
  // for 3 degrees of freedom.
  double gate = 16.;
  // By how much the mean probability has to grow for another place to be taken.
  double min_gain = 0.03;
  // So much more for a place that is inconsistent with a prediction that is
  // considered certain. Odometry is seldom wrong, and a poor fit has many
  // places nearly as good.
  double contradiction_gain = 0.12;
  // Half widths, to which half of the translation and all of the rotation since
  // the last scan are added, and the largest ones; metres and radians. The cost
  // of a search grows with the square of the linear window.
  double linear_window = 0.15;
  double max_linear_window = 0.5;
  double angular_window = 0.15;
  double max_angular_window = 0.7;
};

// The options of local SLAM.
struct FrontEndOptions {
  MotionPredictorOptions prediction;
  // After a gap in the scans over which odometry is missing, too, scans are
  // skipped for at most this long until odometry has measured the motion in the
  // gap; 0: the first scan is matched at once. Seconds, about what messages are
  // late.
  double max_wait_after_gap = 0.5;
  LocalSearchOptions search;
  bool match_features_only = false;
  AdaptiveFeatureOptions features;
  bool fill_walls = true;
  WallFillingOptions wall_filling;
  bool smooth_ranges = true;
  bool estimate_beam_order = true;
  // Folder of records that are written while the program runs; empty: none.
  std::string log_directory;
};

// Of the Lua block.
FrontEndOptions ToFrontEndOptions(const proto::FrontEndOptions& message);

// `resolution` of the grid, metres. If disabled, max_gap is 0.
WallFillingOptions WallFillingFor(const FrontEndOptions& options,
                                  double resolution);

}  // namespace front_end
}  // namespace cartographer_ext

#endif  // CARTOGRAPHER_EXT_FRONT_END_FRONT_END_OPTIONS_H_
