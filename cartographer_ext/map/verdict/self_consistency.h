// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
//
// Verdict on a map without ground truth. A wrong map nearly always contradicts
// itself: scans of one visit cross walls of another, walls are doubled, loops
// do not agree, local SLAM turned where the wheels did not. None of this is
// proof, and a map can be wrong without any contradiction (a corridor of the
// wrong length that was driven once); "sound" means that no contradiction was
// found.
//
// Criteria:
// * contradicted path pieces: at least `min_severe_nodes` consecutive nodes
//   whose scans have a share of `severe_fraction` in the free space or behind
//   the walls of a submap of another visit. People, doors and furniture do not
//   reach that. Where the submap is of the same visit (IsOneVisit), this alone
//   means doubtful: it is what local SLAM has aligned.
// * wrong turns: from one node to the next local SLAM and odometry differ by
//   more than `wrong_turn`, and at least half of it is left some seconds later
//   (lasting_rotation). Either may be wrong, so this alone means doubtful.
// * displaced nodes: at least `displaced_share` of the nodes that revisit a place
//   fit it better some decimetres away (revisit_displacement.h). Doubtful.
// * loose places: at least `loose_share` of the path may lie elsewhere against
//   the rest, on or beside it, without anything showing it (loose_places.h).
//   Doubtful: the map may be right, but it cannot vouch for itself.
// A map is broken if contradicted path pieces make up `broken_share` of the
// nodes that come back to a place (of at least `judged_share` of all nodes), or
// `doubtful_share` of them together with a wrong turn. Without any of this it is sound if `judged_share` of the nodes revisit a
// place and `tied_share` of the path is tied together; otherwise unknown, for a
// map torn apart has hardly any overlap, and so no contradictions.
#ifndef CARTOGRAPHER_EXT_MAP_VERDICT_SELF_CONSISTENCY_H_
#define CARTOGRAPHER_EXT_MAP_VERDICT_SELF_CONSISTENCY_H_

#include <map>
#include <string>
#include <vector>

#include "cartographer_ext/map/map_contents.h"
#include "cartographer_ext/map/verdict/loop_cycles.h"
#include "cartographer_ext/map/verdict/loose_places.h"
#include "cartographer_ext/map/verdict/map_sharpness.h"
#include "cartographer_ext/map/verdict/motion_disagreement.h"
#include "cartographer_ext/map/verdict/revisit_displacement.h"
#include "cartographer_ext/map/verdict/scan_contradiction.h"
#include "nlohmann/json.hpp"

namespace cartographer_ext {
namespace evaluation {

struct SelfConsistencyOptions {
  ContradictionOptions contradiction;
  DisplacementOptions displacement;
  LoosePlaceOptions loose;
  SharpnessOptions sharpness;
  LoopCycleOptions cycles;
  double severe_fraction = 0.6;
  int min_severe_nodes = 8;
  double wrong_turn = DegToRad(30.);          // radians
  io::TimeNs same_turn = 5LL * 1000000000LL;  // closer steps are one event
  double broken_share = 0.08;
  double doubtful_share = 0.01;
  double displaced_share = 0.07;
  double loose_share = 0.03;
  double judged_share = 0.15;
  double tied_share = 0.5;
};

struct SelfConsistency {
  Contradictions contradictions;
  RevisitDisplacements displacements;
  LoosePlaces loose;
  Sharpness sharpness;
  MotionDisagreement motion;
  LoopCycles cycles;
  // What decides the verdict: the severe path pieces, worst (most nodes) first;
  // those that contradict the same visit; then, if there are enough, the
  // displaced ones, which contradict no rays.
  std::vector<PathPiece> places;
  double severe_share = 0.;          // of the nodes that come back to a place
  double severe_passing_share = 0.;  // of those that see the same visit again
  std::vector<MotionStep> wrong_turns;

  // "sound", "doubtful", "broken" or "unknown".
  std::string word;
  // Sentences without full stop: what, how much, where and when.
  std::vector<std::string> reasons;
};

// Whether so much of the path is loose that the map cannot vouch for itself.
bool IsLoose(double loose_share, const SelfConsistencyOptions& options);

// Trajectories of which no node is tied to a submap are left out, and a reason
// says so.
SelfConsistency AssessSelfConsistency(const MapGraph& graph,
                                      const MapContents& contents,
                                      const std::map<int, Trajectory>& odometry,
                                      const SelfConsistencyOptions& options);

nlohmann::ordered_json ToJson(const SelfConsistency& consistency);

// A few lines of text, with a final line break.
std::string ToText(const SelfConsistency& consistency);

}  // namespace evaluation
}  // namespace cartographer_ext

#endif  // CARTOGRAPHER_EXT_MAP_VERDICT_SELF_CONSISTENCY_H_
