// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
//
// Keeps a run over a stored map beside the run that made the map, and tells
// where the two part.
//
// A run of the pose graph is chaotic: the clouds of a map are rounded to the
// millimetre, so a loop that is found again lies half a millimetre elsewhere,
// the graph moves with it, some later candidate comes to lie beyond the
// distance limit, and from there on the sampler, which counts candidates, picks
// other nodes. To see whether options find the loops of a map, and not how
// rounding adds up, a run can follow the record: the optimisation is given the
// stored loops that the run has found again and no others, with the stored
// poses where they lie at the stored place. So every search begins where the
// recorded one began, as long as the ones before found what the recorded ones
// found. Loops that the run does not find are not given to it, and loops that
// only the run finds are its result as any others; they just do not move the
// graph.
#ifndef CARTOGRAPHER_EXT_RERUN_RECORDED_TRACK_H_
#define CARTOGRAPHER_EXT_RERUN_RECORDED_TRACK_H_

#include <cstdint>
#include <map>
#include <memory>
#include <set>
#include <vector>

#include "cartographer/common/fixed_ratio_sampler.h"
#include "cartographer/mapping/internal/optimization/optimization_problem_2d.h"
#include "cartographer/mapping/pose_graph_interface.h"
#include "cartographer/mapping/proto/pose_graph_options.pb.h"
#include "cartographer/transform/rigid_transform.h"
#include "cartographer_ext/io/pbstream/pbstream_reader.h"
#include "cartographer_ext/map/map_graph.h"
#include "cartographer_ext/rerun/loop_fate.h"
#include "cartographer_ext/rerun/replay_ids.h"
#include "cartographer_ext/rerun/replay_plan.h"

namespace cartographer_ext {
namespace evaluation {

struct RecordedTrackOptions {
  bool follow = false;
  // A loop is at the stored place when it is this close to it.
  double translation_tolerance = 0.05;  // metres
  double rotation_tolerance = 0.05;     // radians
};

// Must outlive the pose graph. Used from one thread at a time, as the pose
// graph uses its optimisation problem.
class RecordedTrack {
 public:
  // `plan` must outlive it.
  RecordedTrack(
      const io::Pbstream& pbstream, const ReplayPlan& plan,
      const cartographer::mapping::proto::PoseGraphOptions& pose_graph_options,
      const RecordedTrackOptions& options);

  // For the pose graph of the run.
  std::unique_ptr<cartographer::mapping::optimization::OptimizationProblem2D>
  MakeOptimizationProblem();

  // Of the stored loops within a trajectory whose turn came, as stock's search
  // decides, by ids of the stored map. Whether loops between trajectories are
  // searched depends on more than distances, so they are not in it.
  const LoopFates& fates() const { return fates_; }

  // Loops that the last optimisation was given with their stored poses.
  int64_t num_followed() const { return num_followed_; }

 private:
  using Problem = cartographer::mapping::optimization::OptimizationProblem2D;
  using Constraint = cartographer::mapping::PoseGraphInterface::Constraint;
  class FollowingProblem;

  // The pose graph has placed the next node; its candidates' turn comes.
  void OnNode(const Problem& problem);
  void OnCandidate(const Problem& problem, const GraphId& submap_id,
                   const GraphId& node_id);
  std::vector<Constraint> Follow(const Problem& problem,
                                 const std::vector<Constraint>& constraints);

  const ReplayPlan& plan_;
  const ReplayIds ids_;
  const cartographer::mapping::proto::PoseGraphOptions pose_graph_options_;
  const RecordedTrackOptions options_;
  // (submap <- tracking), by ids of the stored map.
  std::map<LoopPair, cartographer::transform::Rigid3d> recorded_;

  size_t num_steps_ = 0;
  std::set<GraphId> finished_submaps_;  // ids of the run
  // Of each submap, as stock's search counts its candidates.
  std::map<GraphId, cartographer::common::FixedRatioSampler> samplers_;
  LoopFates fates_;
  int64_t num_followed_ = 0;
};

}  // namespace evaluation
}  // namespace cartographer_ext

#endif  // CARTOGRAPHER_EXT_RERUN_RECORDED_TRACK_H_
