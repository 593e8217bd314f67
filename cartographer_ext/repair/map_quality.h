// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
//
// Which of two versions of a map is the better one, by the verdict's own
// measures and in its order: the share of nodes that contradict the map
// severely, then rays that contradict it, cycles of loops that do not close,
// and how sharp the walls are.
//
// A map can also be made free of contradictions by tearing it apart: what does
// not overlap does not contradict. So what was seen again and agrees must not
// become less.
#ifndef CARTOGRAPHER_EXT_REPAIR_MAP_QUALITY_H_
#define CARTOGRAPHER_EXT_REPAIR_MAP_QUALITY_H_

#include <string>

#include "cartographer_ext/map/verdict/self_consistency.h"

namespace cartographer_ext {
namespace repair {

struct MapQuality {
  std::string verdict;
  double severe_share = 0.;
  double contradicted_rays = 0.;  // share
  double open_cycles = 0.;        // share
  double entropy = 0.;            // nats, of the walls
  double agreeing_nodes = 0.;     // that see a place again without conflict
};

MapQuality QualityOf(const evaluation::SelfConsistency& consistency);

// An empty reason means `candidate` is better than `current`; otherwise the
// reason says, in a clause for people, why it is not.
std::string WhyNotBetter(const MapQuality& current,
                         const MapQuality& candidate);

// "broken, 12.3 % severe, 4.5 % of rays against it, entropy -1.52".
std::string ToText(const MapQuality& quality);

}  // namespace repair
}  // namespace cartographer_ext

#endif  // CARTOGRAPHER_EXT_REPAIR_MAP_QUALITY_H_
