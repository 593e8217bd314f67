// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
#include "cartographer_ext/map/switched_constraints.h"

#include <set>
#include <utility>

namespace cartographer_ext {
namespace evaluation {

std::vector<int> MarkSwitchedOff(
    const std::vector<optimization::SwitchedLoop>& off, MapGraph* const map) {
  std::set<std::pair<GraphId, GraphId>> names;
  for (const optimization::SwitchedLoop& loop : off) {
    names.insert({GraphId{loop.submap_trajectory, loop.submap_index},
                  GraphId{loop.node_trajectory, loop.node_index}});
  }
  std::vector<int> indices;
  for (size_t i = 0; i != map->constraints.size(); ++i) {
    GraphConstraint& constraint = map->constraints[i];
    constraint.switched_off =
        constraint.is_loop &&
        names.count({constraint.submap_id, constraint.node_id}) != 0;
    if (constraint.switched_off) indices.push_back(static_cast<int>(i));
  }
  return indices;
}

}  // namespace evaluation
}  // namespace cartographer_ext
