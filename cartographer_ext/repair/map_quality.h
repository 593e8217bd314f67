// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
//
// Compares two versions of a map by the measures of the verdict, in this order:
// the share of severely contradicted nodes, contradicted rays, open cycles of
// loops, and map entropy.
//
// Tearing a map apart also removes contradictions, because parts that do not
// overlap cannot contradict. So the number of nodes that agree with scans of
// another time must not decrease.
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
  double entropy = 0.;            // nats
  double agreeing_nodes = 0.;     // that revisit a place without conflict
};

MapQuality QualityOf(const evaluation::SelfConsistency& consistency);

// Empty if `candidate` is better than `current`; otherwise a clause with the
// reason why it is not.
std::string WhyNotBetter(const MapQuality& current,
                         const MapQuality& candidate);

// "broken, 12.3 % severe, 4.5 % of rays contradicted, entropy -1.52".
std::string ToText(const MapQuality& quality);

}  // namespace repair
}  // namespace cartographer_ext

#endif  // CARTOGRAPHER_EXT_REPAIR_MAP_QUALITY_H_
