// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
//
// Is a map right, without any truth? A map that is wrong somewhere nearly
// always contradicts itself: scans of one visit lie across walls of another,
// walls are doubled, loops do not agree, local SLAM turned where the wheels did
// not. None of it is proof, and a map can be wrong without leaving a trace
// (a corridor of the wrong length that was driven once); "sound" means that
// nothing speaks against the map.
//
// What decides, and why:
// * contradicted stretches: at least `min_severe_nodes` successive nodes whose
//   scans lie to `severe_fraction` in the free space or behind the walls of a
//   submap of another time. People, doors and furniture do not reach that.
// * wrong turns: from one node to the next local SLAM and odometry differ by
//   more than `wrong_turn`. Either may be wrong, so this alone is doubt.
// A map counts as broken when contradicted stretches make up `broken_share` of
// the nodes that see a place of another time, or `doubtful_share` of them and
// there is a wrong turn.
#ifndef CARTOGRAPHER_EXT_MAP_VERDICT_SELF_CONSISTENCY_H_
#define CARTOGRAPHER_EXT_MAP_VERDICT_SELF_CONSISTENCY_H_

#include <map>
#include <string>
#include <vector>

#include "cartographer_ext/map/map_contents.h"
#include "cartographer_ext/map/verdict/loop_cycles.h"
#include "cartographer_ext/map/verdict/map_sharpness.h"
#include "cartographer_ext/map/verdict/motion_disagreement.h"
#include "cartographer_ext/map/verdict/scan_contradiction.h"
#include "nlohmann/json.hpp"

namespace cartographer_ext {
namespace evaluation {

struct SelfConsistencyOptions {
  ContradictionOptions contradiction;
  SharpnessOptions sharpness;
  LoopCycleOptions cycles;
  double severe_fraction = 0.6;
  int min_severe_nodes = 8;
  double wrong_turn = DegToRad(30.);          // radians
  io::TimeNs same_turn = 5LL * 1000000000LL;  // steps nearer are one event
  double broken_share = 0.05;
  double doubtful_share = 0.01;
};

struct SelfConsistency {
  Contradictions contradictions;
  Sharpness sharpness;
  MotionDisagreement motion;
  LoopCycles cycles;
  // The stretches that are severe, worst (most nodes) first.
  std::vector<ConflictStretch> severe;
  double severe_share = 0.;  // of the nodes that see a place of another time
  std::vector<MotionStep> wrong_turns;

  // "sound", "doubtful", "broken", or "unknown" where no place was seen twice.
  std::string word;
  // Each a sentence without full stop: what, how much, where and when.
  std::vector<std::string> reasons;
};

SelfConsistency AssessSelfConsistency(const MapGraph& graph,
                                      const MapContents& contents,
                                      const std::map<int, Trajectory>& odometry,
                                      const SelfConsistencyOptions& options);

nlohmann::ordered_json ToJson(const SelfConsistency& consistency);

// A few lines for people, the last one ended.
std::string ToText(const SelfConsistency& consistency);

}  // namespace evaluation
}  // namespace cartographer_ext

#endif  // CARTOGRAPHER_EXT_MAP_VERDICT_SELF_CONSISTENCY_H_
