// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
//
// Return to an earlier map. Where wrong loops that agree outweigh the few right
// ones of the time, the map that they bend contradicts nearly all loops that
// follow, and none of these becomes a hypothesis, as the factor holds the wrong
// ones to be certain. From the map of an epoch before, the wrong group and all
// loops since then are hypotheses alike.
#include <algorithm>
#include <utility>

#include "cartographer_ext/optimization/solvers/incremental_smoother.h"
#include "cartographer_ext/optimization/solvers/refused_loops.h"

namespace cartographer_ext {
namespace optimization {
namespace {

// Earlier maps that are kept, those of the last epochs.
constexpr size_t kMaxEarlierMaps = 8;
// So few accepted loops are no matter of chance.
constexpr double kNotByChance = 0.001;

}  // namespace

bool IncrementalSmoother::MayReturn() const {
  return options_.late_rejection && options_.readmission &&
         options_.max_hypotheses > 0 &&
         2 * num_poses() <= options_.two_step_map;
}

void IncrementalSmoother::KeepMap() {
  if (!MayReturn()) {
    earlier_maps_.clear();
    return;
  }
  if (earlier_maps_.size() == kMaxEarlierMaps) earlier_maps_.pop_front();
  earlier_maps_.push_back({poses_, accepted_});
}

// The earlier map to return to: since the next one far fewer loops are accepted
// than before, most significantly, and wrong ones may have entered by that. Null
// if that may be chance.
const IncrementalSmoother::EarlierMap* IncrementalSmoother::MapBeforeRefusals()
    const {
  const EarlierMap* result = nullptr;
  double smallest = kNotByChance;
  for (size_t k = 0; k != earlier_maps_.size(); ++k) {
    const std::vector<bool>& accepted = earlier_maps_[k].accepted;
    const double chance = ChanceOfSoFew(
        CountAccepted(edges_, accepted, 0, accepted.size()),
        CountAccepted(edges_, accepted_, accepted.size(), edges_.size()));
    if (chance >= smallest) continue;
    smallest = chance;
    result = &earlier_maps_[k == 0 ? 0 : k - 1];
  }
  return result;
}

// The earlier map, continued by odometry, with its loops in force.
bool IncrementalSmoother::ReturnTo(const EarlierMap& map,
                                   RobustSolver* const batch) {
  const size_t known = map.poses.size();
  std::copy(map.poses.begin(), map.poses.end(), poses_.begin());
  std::vector<bool> reached(poses_.size() - known, false);
  for (size_t i = 0; i != edges_.size(); ++i) {
    const WhitenedEdge& edge = edges_[i];
    if (i < map.accepted.size()) {
      accepted_[i] = map.accepted[i];
      continue;
    }
    accepted_[i] = !edge.is_loop;
    const size_t newest = std::max(edge.from, edge.to);
    if (edge.is_loop || reached[newest - known]) continue;
    reached[newest - known] = true;
    const Pose2 motion(edge.measurement.x(), edge.measurement.y(),
                       edge.measurement.z());
    poses_[newest] = edge.to > edge.from ? poses_[edge.from] * motion
                                         : poses_[edge.to] * motion.Inverse();
  }
  return Relinearize(batch);
}

bool IncrementalSmoother::TryEarlierMap(RobustSolver* const batch) {
  if (!MayReturn()) return false;
  const EarlierMap* const map = MapBeforeRefusals();
  if (map == nullptr) return false;
  const EarlierMap present = {poses_, accepted_};
  if (!ReturnTo(*map, batch)) return false;
  const bool improved =
      TryHypotheses(map->accepted.size(), 0., present.poses, batch);
  accepted_ = present.accepted;
  if (improved) {
    // The later ones are those of the map that is given up.
    while (&earlier_maps_.back() != map) earlier_maps_.pop_back();
    return true;
  }
  poses_ = present.poses;
  Relinearize(batch);
  return false;
}

}  // namespace optimization
}  // namespace cartographer_ext
