// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
//
// The pose graph of a re-run renumbers nodes and submaps; converts its ids to
// those of the stored map.
#ifndef CARTOGRAPHER_EXT_RERUN_REPLAY_IDS_H_
#define CARTOGRAPHER_EXT_RERUN_REPLAY_IDS_H_

#include <map>
#include <vector>

#include "cartographer_ext/map/map_graph.h"
#include "cartographer_ext/rerun/replay_plan.h"

namespace cartographer_ext {
namespace evaluation {

class ReplayIds {
 public:
  explicit ReplayIds(const ReplayPlan& plan);

  // Id in the stored map of an id of the run.
  GraphId StoredNode(const GraphId& id) const;
  // The index is negative for placeholders.
  GraphId StoredSubmap(const GraphId& id) const;

  // Ids of the run for a step of the plan and for a position in its submaps.
  const GraphId& NodeOfStep(size_t step) const { return step_nodes_[step]; }
  const GraphId& SubmapAt(int position) const {
    return position_submaps_[position];
  }

 private:
  // Stored indices in the order of those of the run, for each trajectory.
  std::map<int, std::vector<int>> nodes_, submaps_;
  std::vector<GraphId> step_nodes_, position_submaps_;
};

}  // namespace evaluation
}  // namespace cartographer_ext

#endif  // CARTOGRAPHER_EXT_RERUN_REPLAY_IDS_H_
