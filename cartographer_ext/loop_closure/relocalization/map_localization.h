// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
//
// State of the localisation of a run in the map of another run, and when the
// whole map is searched.
//
//   unknown   From the first node on without a prediction, and once the run is
//             lost. All submaps of the map are searched for a node every
//             `query_spacing` metres, and the hypotheses are tracked
//             (PlaceTracker).
//   given     From the first node on with a prediction (an operator's), for
//             `lost_distance` metres. Searched around the prediction.
//   known     From the first accepted loop on, as long as others follow within
//             `lost_distance` metres. Searched around the prediction; every
//             `watch_spacing` metres the whole map is searched as well,
//             because the search around a wrong prediction may keep finding
//             a look-alike place.
//
// A run whose place was known becomes lost when no loop is accepted for too
// long a distance, or when all but one of the last `watches` + 1 decisions
// about its place were for a different place. Earlier loops then no longer
// locate it, because the robot may have been carried.
//
// Keyed by the trajectory of the run and that of the map. Depends on the calls
// in their order only. Not thread-safe.
#ifndef CARTOGRAPHER_EXT_LOOP_CLOSURE_RELOCALIZATION_MAP_LOCALIZATION_H_
#define CARTOGRAPHER_EXT_LOOP_CLOSURE_RELOCALIZATION_MAP_LOCALIZATION_H_

#include <deque>
#include <map>
#include <utility>

#include "absl/types/optional.h"
#include "cartographer_ext/uncertainty/path_uncertainty.h"

namespace cartographer_ext {
namespace loop_closure {

// Distances between searches, and limits.
struct MapLocalizationOptions {
  // Half the spacing at which revisits count as evidence, so that every second
  // query may fail.
  double query_spacing = 2.5;  // metres, >= 0
  // Larger is cheaper and detects a wrong place later.
  double watch_spacing = 5.;   // metres, >= 0
  double lost_distance = 15.;  // metres, > 0: three revisits without a loop
  // Tolerates one wrong decision.
  int watches = 2;  // >= 1
};

// State of runs localised in maps, see above.
class MapLocalization {
 public:
  // How the pairs of a node with the submaps of a map are searched.
  struct Plan {
    bool around_prediction = false;
    bool everywhere = false;
    // Whether the run has just become lost, and whether because of decisions.
    bool newly_lost = false;
    bool by_decisions = false;
  };

  // `paths` must outlive this object and contain the nodes.
  MapLocalization(const MapLocalizationOptions& options,
                  const uncertainty::PathUncertainty* paths);

  // To be called in order for each node proposed with submaps of
  // `map_trajectory_id`. `is_predicted`: the host has a prediction.
  Plan PlanNode(const uncertainty::NodeId& node, int map_trajectory_id,
                bool is_predicted);

  // Returns true if this loop relocalises the run after it was lost.
  bool AddAcceptedLoop(const uncertainty::NodeId& node, int map_trajectory_id);
  // Adds a decision: whether it agrees with the prediction.
  void AddDecision(const uncertainty::NodeId& node, int map_trajectory_id,
                   bool agrees);

  bool IsKnown(int trajectory_id, int map_trajectory_id) const;
  // The last node from before the run was lost, -1 without.
  int LastNodeBeforeLost(int trajectory_id, int map_trajectory_id) const;

  // Frees the data of a run, and of runs localised in it.
  void DeleteTrajectory(int trajectory_id);

 private:
  struct State {
    bool known = false;
    bool was_known = false;
    int first_node = 0;
    int last_accepted = -1;  // node index
    int last_searched = -1;  // everywhere
    // Of the last decisions, whether they agreed with the prediction.
    std::deque<bool> decisions;
    int last_before_lost = -1;
  };

  bool Farther(const uncertainty::NodeId& node, int before,
               double distance) const;
  void BecomeLost(State* state) const;

  const MapLocalizationOptions options_;
  const uncertainty::PathUncertainty* const paths_;
  std::map<std::pair<int, int>, State> states_;
};

}  // namespace loop_closure
}  // namespace cartographer_ext

#endif  // CARTOGRAPHER_EXT_LOOP_CLOSURE_RELOCALIZATION_MAP_LOCALIZATION_H_
