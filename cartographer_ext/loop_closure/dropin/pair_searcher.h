// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
//
// The work of the search tasks: matching a node against a submap, or against
// all submaps of a map, and refining the match. Stateless; a task accesses only
// its job or query and their dependencies.
#ifndef CARTOGRAPHER_EXT_LOOP_CLOSURE_DROPIN_PAIR_SEARCHER_H_
#define CARTOGRAPHER_EXT_LOOP_CLOSURE_DROPIN_PAIR_SEARCHER_H_

#include <memory>
#include <vector>

#include "cartographer/mapping/2d/submap_2d.h"
#include "cartographer/mapping/internal/2d/scan_matching/ceres_scan_matcher_2d.h"
#include "cartographer/mapping/proto/pose_graph/constraint_builder_options.pb.h"
#include "cartographer/mapping/trajectory_node.h"
#include "cartographer/sensor/point_cloud.h"
#include "cartographer_ext/common/pose2.h"
#include "cartographer_ext/loop_closure/dropin/place_search.h"
#include "cartographer_ext/loop_closure/dropin/submap_store.h"
#include "cartographer_ext/loop_closure/loop_candidate.h"
#include "cartographer_ext/loop_closure/loop_options.h"

namespace cartographer_ext {
namespace loop_closure {

// A candidate with the host's data that its search needs.
struct SearchJob {
  LoopCandidate candidate;
  const cartographer::mapping::TrajectoryNode::Data* node = nullptr;
  std::shared_ptr<SubmapEntry> entry;
  // Factor on the minimum scores (typical_fit.h).
  double score_scale = 1.;
};

// A node that is relocalised in a whole map, and the result of its task.
struct PlaceQuery {
  std::vector<SearchJob*> jobs;  // its candidates, in their order
  std::shared_ptr<PlaceSearch> places;
  bool is_known = false;  // its place is presumably known
  int forget_up_to = -1;  // node index
  PlaceResult result;
};

// Searches pairs, see above. Thread-safe.
class PairSearcher {
 public:
  PairSearcher(
      const cartographer::mapping::constraints::proto::ConstraintBuilderOptions&
          options,
      const LoopOptions& extension, SubmapCache* cache);

  // Fills `match` of the candidate.
  void Search(SearchJob* job) const;
  // The same for all submaps of the query. The searched candidates are
  // rejected: loops come from the selected place only.
  void SearchPlace(PlaceQuery* query) const;

 private:
  std::shared_ptr<const SubmapMatcher> Matcher(const SubmapEntry& entry) const;
  double MinScore(const SearchJob& job) const;
  // The best match in the window or in the whole submap; (frame of the grid <-
  // node).
  SubmapMatch SearchExactly(SearchJob* job) const;
  // `found` in a window, or a match nearer to the prediction that is likelier.
  SubmapMatch Likeliest(const SearchJob& job, const SubmapMatcher& matcher,
                        const SubmapMatch& found) const;
  // The same in the whole submap by way of its best place.
  SubmapMatch SearchPlaces(SearchJob* job) const;
  // (grid <- node) `refined` is that of the match.
  double SlideOddsOf(const SearchJob& job, const Pose2& refined) const;

  const cartographer::mapping::constraints::proto::ConstraintBuilderOptions
      options_;
  const bool slide_test_;
  // Enabled: whole submaps are searched by places, and windows for likelier
  // matches; otherwise the best score is searched exactly.
  const SearchPlannerOptions search_options_;
  const cartographer::mapping::scan_matching::CeresScanMatcher2D
      ceres_scan_matcher_;
  SubmapCache* const cache_;
};

}  // namespace loop_closure
}  // namespace cartographer_ext

#endif  // CARTOGRAPHER_EXT_LOOP_CLOSURE_DROPIN_PAIR_SEARCHER_H_
