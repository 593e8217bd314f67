// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
//
// Whether the pose of a run in the map of another run is known, and when the
// run is searched in the whole map.
//
//   unknown   From the first node on without a prediction, and once the run is
//             lost. All submaps of the map are searched for a node every
//             `query_spacing` metres, and the places found are followed
//             (PlaceTracker).
//   given     From the first node on with a prediction (an operator's), for
//             `lost_distance` metres. Searched around the prediction.
//   known     From the first accepted loop on, as long as others follow within
//             `lost_distance` metres. Searched around the prediction; every
//             `watch_spacing` metres the whole map is searched nevertheless,
//             for the search around a wrong prediction may go on finding a
//             place that looks alike.
//
// A run whose place was known becomes lost when no loop is accepted for too
// long a distance, or when of the last `watches` + 1 decisions about its place
// all but one were for another one. Loops from before then do not locate it any
// more: somebody may have carried the robot.
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

struct MapLocalizationOptions {
  // Places half as far apart as revisits count as evidence, so that one query
  // in two may find nothing.
  double query_spacing = 2.5;  // metres, >= 0
  // Larger is cheaper and detects a wrong place later.
  double watch_spacing = 5.;   // metres, >= 0
  double lost_distance = 15.;  // metres, > 0: three revisits without a loop
  // One decision for another place may be wrong.
  int watches = 2;  // >= 1
};

class MapLocalization {
 public:
  // How the pairs of a node with the submaps of a map are to be searched.
  struct Plan {
    bool around_prediction = false;
    bool everywhere = false;
    // The run has just become lost, and whether it is by decisions.
    bool newly_lost = false;
    bool by_decisions = false;
  };

  // `paths` has to outlive this and to know the nodes.
  MapLocalization(const MapLocalizationOptions& options,
                  const uncertainty::PathUncertainty* paths);

  // For each node that is offered to submaps of `map_trajectory_id`, in order.
  // `is_predicted`: the host says where it is.
  Plan PlanNode(const uncertainty::NodeId& node, int map_trajectory_id,
                bool is_predicted);

  // True when the run knows its place again, by this loop, after it was lost.
  bool AddAcceptedLoop(const uncertainty::NodeId& node, int map_trajectory_id);
  // Whether it was decided for the place that was predicted.
  void AddDecision(const uncertainty::NodeId& node, int map_trajectory_id,
                   bool agrees);

  bool IsKnown(int trajectory_id, int map_trajectory_id) const;
  // The last node from before the run was lost, -1 without.
  int LastNodeBeforeLost(int trajectory_id, int map_trajectory_id) const;

  // Frees what is remembered of a run, and of runs in it as a map.
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
