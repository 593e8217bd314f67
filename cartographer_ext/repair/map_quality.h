// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
//
// Compares two versions of a map, first by evidence. A node that sees a place
// mapped at another time either agrees with it or contradicts it (also where it
// is displaced); the others say nothing. The evidence is the logarithm of the likelihood ratio of a right
// map to a wrong one, in units of one agreeing node:
//
//   agreeing nodes - w * contradicted nodes
//
// In right maps 97 % of the nodes that are judged agree, in wrong ones a third;
// so w = -ln(0.03 / 0.67) / ln(0.97 / 0.33), about 3.
//
// Tearing a map apart also removes contradictions, because parts that do not
// overlap cannot contradict. So a contradicted node that no longer sees another
// visit is not resolved: it counts as contradicted in both versions. A map is
// better by agreement, not by absence of evidence.
//
// Nodes that are judged only in the new version are held against what the old one
// is worth where it is judged. Above one contradicted node in 1 + w each further
// place speaks against a map on average, so of two folded maps the one that is
// judged at fewer places would win, although the other is right more often. Such
// places count by how much better they do than those of the old version.
//
// A version of which more may lie elsewhere without contradicting anything
// (loose_places.h) is not better either if it rests on fewer nodes that see a
// place of another time: what it no longer compares is not known to lie apart.
// Otherwise it must gain more nodes than came loose, because of those nothing
// tells whether they agree at the right place.
//
// Versions of equal evidence are compared by the measures of the verdict: the
// share of severely contradicted nodes, contradicted rays, open cycles of loops,
// distance of the loops from the map, and map entropy.
#ifndef CARTOGRAPHER_EXT_REPAIR_MAP_QUALITY_H_
#define CARTOGRAPHER_EXT_REPAIR_MAP_QUALITY_H_

#include <map>
#include <string>

#include "cartographer_ext/map/map_graph.h"
#include "cartographer_ext/map/verdict/self_consistency.h"

namespace cartographer_ext {
namespace repair {

struct MapQuality {
  std::string verdict;
  double severe_share = 0.;
  double loose_share = 0.;        // of the path
  double contradicted_rays = 0.;  // share
  double open_cycles = 0.;        // share
  double loop_residual = 0.;  // mean distance of a loop from the map, metres
  double entropy = 0.;        // nats
  // Of the nodes that see a place mapped at another time, whether they
  // contradict it.
  std::map<evaluation::GraphId, bool> is_contradicted;

  int num_contradicted() const;
  int num_agreeing() const;
};

MapQuality QualityOf(const evaluation::MapGraph& graph,
                     const evaluation::SelfConsistency& consistency);

// By how much `candidate` has more evidence than `current`, in agreeing nodes.
double GainOfEvidence(const MapQuality& current, const MapQuality& candidate);

// Empty if `candidate` is better than `current`; otherwise a clause with the
// reason why it is not.
std::string WhyNotBetter(const MapQuality& current,
                         const MapQuality& candidate);

// Empty if the result of a repair is to be written, otherwise a clause. It must
// be better than the input, and neither broken (of two broken maps the one with
// more evidence need not be nearer to the truth) nor unknown nor loose (what
// agrees may be the smaller part).
std::string WhyNotWritten(const MapQuality& input, const MapQuality& result);

// "broken, 12.3 % severe, 4.5 % of rays contradicted, entropy -1.52".
std::string ToText(const MapQuality& quality);

}  // namespace repair
}  // namespace cartographer_ext

#endif  // CARTOGRAPHER_EXT_REPAIR_MAP_QUALITY_H_
