// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
//
// Relocalises a run in the whole map of another run: a node is searched in all
// submaps, and the places found are followed by PlaceTracker until one of them
// is decided for. Keeps copies of the clouds of the nodes it follows; the host
// guarantees its own only until the callback.
//
// One object for a run in a map, used by one task after the other.
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
  // Asked for where it is used, as it may be built then.
  std::function<std::shared_ptr<const SubmapMatcher>()> matcher;
  const cartographer::mapping::Submap2D* submap = nullptr;
  // Searched as a whole; otherwise places are followed into it only.
  bool search = true;
};

struct PlaceNode {
  int node_index = 0;
  int64_t time = 0;             // host ticks
  Pose2 local_pose;             // (local <- node), gravity-aligned
  Pose2 aligned_from_tracking;  // a rotation
  cartographer::sensor::PointCloud cloud;
};

struct PlaceResult {
  // Of the submaps searched, in their order: score, 0 where nothing was found.
  std::vector<double> scores;
  // Others have fitted better, so that this one was not looked at to the end.
  std::vector<bool> outscored;
  bool decided = false;
  double significance = 0.;
  // Of the newest node, (local frame of the map <- node).
  Pose2 decided_pose;
  int decided_submap = -1;
  // Nodes of the decided place that were not returned before, each in the
  // submaps where it fits best: candidates with a match and without
  // trajectories.
  std::vector<LoopCandidate> placed;
};

class PlaceSearch {
 public:
  // The pose of a cloud in the grid of a submap, refined, both (local frame of
  // the map <- cloud).
  using Refiner = std::function<Pose2(
      const cartographer::mapping::Submap2D& submap,
      const cartographer::sensor::PointCloud& cloud, const Pose2& pose)>;

  PlaceSearch(const RelocalizationOptions& options, double min_score);

  // The next node of the run; places are not followed to nodes that are older
  // than the one before. `is_known`: its place is thought to be known, and the
  // search is to confirm that; then fewer nodes decide, and no candidates are
  // returned.
  PlaceResult Search(PlaceNode node, const std::vector<PlaceSubmap>& submaps,
                     bool is_known, const Refiner& refiner);

  bool IsSamePlace(const Pose2& a, const Pose2& b) const {
    return tracker_.IsSamePlace(a, b);
  }
  // Forgets nodes up to an index.
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
  // The same in the submap where it fits best.
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
