// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
//
// What the tasks of VerifiedConstraintBuilder2D do: search a pair of a node and
// a submap, or a node in a whole map, and refine what was found. Nothing here
// has a memory of its own; a task touches nothing but its candidate or query,
// and what it was made to depend on.
#ifndef CARTOGRAPHER_EXT_LOOP_CLOSURE_DROPIN_PAIR_SEARCHER_H_
#define CARTOGRAPHER_EXT_LOOP_CLOSURE_DROPIN_PAIR_SEARCHER_H_

#include <cstdint>
#include <limits>
#include <memory>
#include <vector>

#include "Eigen/Core"
#include "cartographer/common/task.h"
#include "cartographer/mapping/2d/submap_2d.h"
#include "cartographer/mapping/internal/2d/scan_matching/ceres_scan_matcher_2d.h"
#include "cartographer/mapping/proto/pose_graph/constraint_builder_options.pb.h"
#include "cartographer/sensor/point_cloud.h"
#include "cartographer_ext/common/pose2.h"
#include "cartographer_ext/loop_closure/dropin/pair_planner.h"
#include "cartographer_ext/loop_closure/dropin/place_search.h"
#include "cartographer_ext/loop_closure/dropin/submap_matcher.h"
#include "cartographer_ext/loop_closure/verification/occupancy_view.h"

namespace cartographer_ext {
namespace loop_closure {

// What is kept of each submap between nodes.
struct SubmapEntry {
  static constexpr int kUnknownNode = std::numeric_limits<int>::max();

  const cartographer::mapping::Submap2D* submap = nullptr;
  Pose2 local_pose;  // (local <- submap)
  // The newest node of its trajectory when it was first offered, -1 without
  // one, and its time.
  int newest_node_at_first = -1;
  int64_t time_at_first = 0;
  int64_t first_group = 0;
  // No node of the submap is newer.
  int newest_node_bound = kUnknownNode;
  std::unique_ptr<const SubmapMatcher> matcher;  // null until the task ran
  std::weak_ptr<cartographer::common::Task> matcher_task;
  bool has_matcher = false;
  std::unique_ptr<const OccupancyView> view;
  bool has_view = false;
};

// A pair with its plan, and what its task finds.
struct PairCandidate {
  OfferedPair pair;
  SearchPlan plan;
  int64_t query = -1;  // searched together with others where not negative
  std::shared_ptr<SubmapEntry> entry;
  double floor_scale = 1.;  // of the smallest score that counts
  bool found = false;
  double score = 0.;
  Pose2 matched;  // (submap <- node), gravity-aligned
  Pose2 refined;
  Eigen::Matrix3d information = Eigen::Matrix3d::Zero();
  // CPU time, of a query an equal share of it.
  double search_seconds = 0.;
  double refinement_seconds = 0.;
};

// A node that is looked for in a whole map, and what its task finds.
struct PlaceQuery {
  std::vector<PairCandidate*> candidates;  // all of them, in their order
  PlaceSearch* places = nullptr;
  bool is_known = false;  // its place, as it seems
  int forget_up_to = -1;  // node index
  PlaceResult result;
};

class PairSearcher {
 public:
  explicit PairSearcher(
      const cartographer::mapping::constraints::proto::ConstraintBuilderOptions&
          options);

  // The matcher of the submap has to be there.
  void Search(PairCandidate* candidate) const;
  // Those of all submaps. The candidates that were searched are `found` where
  // the node has a place in them, with the reason why they are no loops.
  void SearchPlace(PlaceQuery* query) const;

 private:
  Pose2 Refine(const cartographer::mapping::Submap2D& submap,
               const cartographer::sensor::PointCloud& cloud,
               const Pose2& pose) const;

  const cartographer::mapping::constraints::proto::ConstraintBuilderOptions
      options_;
  const cartographer::mapping::scan_matching::CeresScanMatcher2D
      ceres_scan_matcher_;
};

}  // namespace loop_closure
}  // namespace cartographer_ext

#endif  // CARTOGRAPHER_EXT_LOOP_CLOSURE_DROPIN_PAIR_SEARCHER_H_
