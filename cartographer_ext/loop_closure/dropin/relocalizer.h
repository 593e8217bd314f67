// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
//
// Relocalisation of runs in the maps of other trajectories: one PlaceSearch per
// run and map, its queries in order, and the handling of their results.
// MapLocalization, which decides when the whole map is searched, is notified
// whether the places agree with the predictions; the nodes of a selected place
// become candidates.
//
// Not thread-safe.
#ifndef CARTOGRAPHER_EXT_LOOP_CLOSURE_DROPIN_RELOCALIZER_H_
#define CARTOGRAPHER_EXT_LOOP_CLOSURE_DROPIN_RELOCALIZER_H_

#include <map>
#include <memory>
#include <utility>
#include <vector>

#include "cartographer/common/task.h"
#include "cartographer_ext/loop_closure/dropin/pair_searcher.h"
#include "cartographer_ext/loop_closure/dropin/place_search.h"
#include "cartographer_ext/loop_closure/relocalization/map_localization.h"
#include "cartographer_ext/loop_closure/relocalization/relocalization_options.h"

namespace cartographer_ext {
namespace loop_closure {

// Relocalises runs in maps, see above.
class Relocalizer {
 public:
  // `min_score`: minimum score of a match anywhere in a submap.
  Relocalizer(const RelocalizationOptions& options, double min_score);

  // The query of the candidates of one node in one map.
  PlaceQuery MakeQuery(const std::vector<SearchJob*>& jobs,
                       const MapLocalization& localization);
  // The task of the last query of the same run in the same map: queries run one
  // after the other.
  std::weak_ptr<cartographer::common::Task>* LastTask(const PlaceQuery& query);

  // To be called for a query whose task has run: reports whether the place
  // agrees with the prediction.
  void ReportDecision(const PlaceQuery& query,
                      MapLocalization* localization) const;

  // Drops the places of a run up to a node: in one map, because it was lost, or
  // in all, because nodes are deleted. Takes effect with the next query.
  void ForgetPlaces(int trajectory_id, int map_trajectory_id, int last_node);
  void DeleteNodes(int trajectory_id, int last_node);
  void DeleteTrajectory(int trajectory_id);

 private:
  using RunAndMap = std::pair<int, int>;  // trajectory ids
  struct State {
    std::shared_ptr<PlaceSearch> places;
    std::weak_ptr<cartographer::common::Task> last_task;
  };

  static RunAndMap KeyOf(const PlaceQuery& query);

  const RelocalizationOptions options_;
  const double min_score_;
  std::map<RunAndMap, State> states_;
  // Up to these nodes places are to be forgotten.
  std::map<RunAndMap, int> forget_up_to_;
};

}  // namespace loop_closure
}  // namespace cartographer_ext

#endif  // CARTOGRAPHER_EXT_LOOP_CLOSURE_DROPIN_RELOCALIZER_H_
