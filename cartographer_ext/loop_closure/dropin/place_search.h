// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
//
// Looks for a run in the whole map of another run: a node is searched in all
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
#include <vector>

#include "Eigen/Core"
#include "cartographer/mapping/2d/submap_2d.h"
#include "cartographer/sensor/point_cloud.h"
#include "cartographer_ext/common/pose2.h"
#include "cartographer_ext/localization_options.pb.h"
#include "cartographer_ext/loop_closure/dropin/submap_matcher.h"
#include "cartographer_ext/loop_closure/relocalization/place_tracker.h"

namespace cartographer_ext {
namespace loop_closure {

// A submap of the map.
struct PlaceSubmap {
  int submap_index = 0;
  const SubmapMatcher* matcher = nullptr;
  const cartographer::mapping::Submap2D* submap = nullptr;
  // Searched as a whole; otherwise places are followed into it only.
  bool search = true;
};

struct PlaceNode {
  int node_index = 0;
  int64_t time = 0;  // host ticks
  Pose2 local_pose;  // (local <- node), gravity-aligned
  Pose2 from_robot;  // (gravity-aligned <- tracking frame), a rotation
  cartographer::sensor::PointCloud cloud;
};

// A node that belongs to the place that was decided for.
struct PlacedNode {
  int node_index = 0;
  // The first one that belongs to the place: the motion from those before may
  // be wrong.
  int first_node_index = 0;
  int64_t time = 0;
  Pose2 from_robot;
  int submap_index = 0;
  Pose2 matched;  // (local frame of the map <- node), gravity-aligned
  Pose2 refined;
  double score = 0.;
  Eigen::Matrix3d information = Eigen::Matrix3d::Zero();  // (submap frame)
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
  // Nodes of the decided place that were not given out before, each in the
  // submaps where it fits best.
  std::vector<PlacedNode> placed;
};

class PlaceSearch {
 public:
  // The pose of a cloud in the grid of a submap, refined, both (local frame of
  // the map <- cloud).
  using Refiner = std::function<Pose2(
      const cartographer::mapping::Submap2D& submap,
      const cartographer::sensor::PointCloud& cloud, const Pose2& pose)>;

  PlaceSearch(const proto::LocalizationOptions& options, double min_score);

  // The next node of the run; places are not followed to nodes that are older
  // than the one before. `is_known`: its place is thought to be known, and
  // this is to find out whether that is right; then fewer nodes decide, and
  // nothing is given out.
  PlaceResult Search(PlaceNode node, const std::vector<PlaceSubmap>& submaps,
                     bool is_known, const Refiner& refiner);

  bool IsSamePlace(const Pose2& a, const Pose2& b) const {
    return tracker_.IsSamePlace(a, b);
  }
  // Forgets nodes up to an index.
  void DeleteNodes(int last_node_index);

 private:
  const proto::LocalizationOptions options_;
  const double min_score_;
  PlaceTracker tracker_;
  std::map<int, PlaceNode> nodes_;  // those of the tracker
  int newest_node_ = -1;
  int last_given_out_ = -1;
};

}  // namespace loop_closure
}  // namespace cartographer_ext

#endif  // CARTOGRAPHER_EXT_LOOP_CLOSURE_DROPIN_PLACE_SEARCH_H_
