// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
//
// Results of the first stage of loop closure, candidate search: whether and in
// which window a candidate is searched (search_planner.h), and the match.
#ifndef CARTOGRAPHER_EXT_LOOP_CLOSURE_CANDIDATE_SEARCH_SEARCH_RESULT_H_
#define CARTOGRAPHER_EXT_LOOP_CLOSURE_CANDIDATE_SEARCH_SEARCH_RESULT_H_

#include <cstdint>
#include <limits>

#include "Eigen/Core"
#include "cartographer_ext/common/pose2.h"
#include "cartographer_ext/loop_decision.pb.h"

namespace cartographer_ext {
namespace loop_closure {

// Whether and in which window a candidate is searched.
struct SearchPlan {
  // NONE: to be searched. Otherwise why not.
  proto::LoopDecision::Reason skipped = proto::LoopDecision::NONE;
  // Beyond the largest window, or one of many of which one is recorded: not a
  // candidate.
  bool out_of_reach = false;
  bool full_submap = false;
  double linear_window = 0.;   // metres, half width
  double angular_window = 0.;  // radians, half width
  // Standard deviations of the prediction; 0: unknown.
  double translation_sigma = 0.;  // metres, in the worst direction
  double rotation_sigma = 0.;     // radians
  // Its covariance, frame of the node's tracking frame; zero: unknown.
  Eigen::Matrix3d covariance = Eigen::Matrix3d::Zero();
  // Candidates with equal numbers >= 0 are matched together, to relocalise
  // their node in a whole map. Skipped ones are included because hypotheses are
  // tracked into their submaps.
  int64_t query = -1;
  // Submaps that were proposed for the node, this one included: as many places
  // where it may be if the prediction does not hold, > 0.
  int num_places = 1;

  bool is_searched() const {
    return skipped == proto::LoopDecision::NONE && !out_of_reach;
  }
};

// Result of the correlative search and of the refinement started from it.
struct SearchMatch {
  bool found = false;
  double score = 0.;  // S_g, mean probability under the points, in [0, 1]
  // (submap <- node), gravity-aligned; only the score is known of a candidate
  // of a query.
  bool has_pose = false;
  Pose2 matched;
  Pose2 refined;
  // Of the refined pose from the scan alone, (submap <- node), metres and
  // radians; zero where it is not known.
  Eigen::Matrix3d information = Eigen::Matrix3d::Zero();
  // Log-odds against another pose along the least observable direction.
  double slide_odds = std::numeric_limits<double>::infinity();
};

}  // namespace loop_closure
}  // namespace cartographer_ext

#endif  // CARTOGRAPHER_EXT_LOOP_CLOSURE_CANDIDATE_SEARCH_SEARCH_RESULT_H_
