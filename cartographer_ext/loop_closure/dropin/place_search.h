// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
//
// Relocalises a run in the whole map of another run: a node is searched in all
// submaps, and PlaceTracker tracks the hypotheses until one of them is
// selected. Keeps copies of the clouds of the tracked nodes, because the host
// guarantees its own only until the callback.
//
// One object per run and map, used by one task at a time.
#ifndef CARTOGRAPHER_EXT_LOOP_CLOSURE_DROPIN_PLACE_SEARCH_H_
#define CARTOGRAPHER_EXT_LOOP_CLOSURE_DROPIN_PLACE_SEARCH_H_

#include <cstdint>
#include <functional>
#include <map>
#include <memory>
#include <vector>

#include "absl/types/optional.h"
#include "cartographer/mapping/2d/submap_2d.h"
#include "cartographer/sensor/point_cloud.h"
#include "cartographer_ext/common/pose2.h"
#include "cartographer_ext/loop_closure/dropin/submap_matcher.h"
#include "cartographer_ext/loop_closure/loop_candidate.h"
#include "cartographer_ext/loop_closure/relocalization/place_tracker.h"
#include "cartographer_ext/loop_closure/relocalization/relocalization_options.h"

namespace cartographer_ext {
namespace loop_closure {

// A submap of the map.
struct PlaceSubmap {
  int submap_index = 0;
  // Called on use, because the matcher may have to be built.
  std::function<std::shared_ptr<const SubmapMatcher>()> matcher;
  const cartographer::mapping::Submap2D* submap = nullptr;
  // Whether it is searched as a whole; otherwise hypotheses are only tracked
  // into it.
  bool search = true;
};

// A node of the run that is searched.
struct PlaceNode {
  int node_index = 0;
  int64_t time = 0;             // host ticks
  Pose2 local_pose;             // (local <- node), gravity-aligned
  Pose2 aligned_from_tracking;  // a rotation
  cartographer::sensor::PointCloud cloud;
};

// Scores and decision for one node.
struct PlaceResult {
  // Scores in the searched submaps, in their order; 0: no match.
  std::vector<double> scores;
  // Whether the search was abandoned because others matched better.
  std::vector<bool> outscored;
  bool decided = false;
  double significance = 0.;
  // Of the newest node, (local frame of the map <- node).
  Pose2 decided_pose;
  int decided_submap = -1;
  // Nodes of the selected place that were not returned before, each in the
  // submaps with the best match: candidates with a match and without
  // trajectories.
  std::vector<LoopCandidate> placed;
};

// Relocalises one run in one map, see above. Not thread-safe.
class PlaceSearch {
 public:
  // The pose of a cloud in the grid of a submap, refined, both (local frame of
  // the map <- cloud).
  using Refiner = std::function<Pose2(
      const cartographer::mapping::Submap2D& submap,
      const cartographer::sensor::PointCloud& cloud, const Pose2& pose)>;

  PlaceSearch(const RelocalizationOptions& options, double min_score);

  // Processes the next node of the run; nodes older than the previous one are
  // not tracked. `is_known`: its place is presumably known and the search
  // should confirm it; then fewer nodes are needed for a decision, and no
  // candidates are returned.
  PlaceResult Search(PlaceNode node, const std::vector<PlaceSubmap>& submaps,
                     bool is_known, const Refiner& refiner);

  bool IsSamePlace(const Pose2& a, const Pose2& b) const {
    return tracker_.IsSamePlace(a, b);
  }
  // Drops nodes up to an index.
  void DeleteNodes(int last_node_index);

 private:
  // Matches the node in the submaps to be searched; scores into the result.
  std::vector<PlaceMatch> FindPlaces(const PlaceNode& node,
                                     const std::vector<PlaceSubmap>& submaps,
                                     PlaceResult* result) const;
  // A kept node in one submap near a guess, (local frame of the map <- node).
  absl::optional<PlaceMatch> MatchNearby(int node_index, const Pose2& guess,
                                         const PlaceSubmap& submap,
                                         double min_score) const;
  // The same in the submap with the best match.
  absl::optional<PlaceMatch> Follow(
      int node_index, const Pose2& guess,
      const std::vector<PlaceSubmap>& submaps) const;
  // The candidates of a kept node at a place, refined.
  void AppendCandidates(int node_index, const Pose2& place,
                        const std::vector<PlaceSubmap>& submaps,
                        const Refiner& refiner,
                        std::vector<LoopCandidate>* candidates) const;

  const RelocalizationOptions options_;
  const double min_score_;
  PlaceTracker tracker_;
  std::map<int, PlaceNode> nodes_;  // those of the tracker
  int newest_node_ = -1;
  int last_returned_ = -1;
};

}  // namespace loop_closure
}  // namespace cartographer_ext

#endif  // CARTOGRAPHER_EXT_LOOP_CLOSURE_DROPIN_PLACE_SEARCH_H_
