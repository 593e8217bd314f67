// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
//
// Lets a re-run of a stored map follow the run that made the map, and records
// where the two differ.
//
// A run of the pose graph is sensitive to rounding: the clouds of a map are
// rounded to the millimetre, so a reproduced loop differs by half a millimetre,
// the graph changes with it, some later candidate is beyond the distance limit,
// and from then on the sampler, which counts candidates, selects other nodes.
// To test whether options reproduce the loops of a map, without accumulated
// rounding, a run can follow the record: the optimisation uses only the stored
// loops that the run has reproduced, with the stored poses if they agree. So
// every search starts from the same pose as the recorded one, as long as the
// previous ones had the same results. Loops that the run does not reproduce are
// not used, and loops found only by the run are part of its result but do not
// affect the graph.
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
#include "cartographer_ext/rerun/loop_outcome.h"
#include "cartographer_ext/rerun/replay_ids.h"
#include "cartographer_ext/rerun/replay_plan.h"

namespace cartographer_ext {
namespace evaluation {

struct RecordedTrackOptions {
  bool follow = false;
  // Tolerances for a loop to agree with the stored one.
  double translation_tolerance = 0.05;  // metres
  double rotation_tolerance = 0.05;     // radians
};

// Must outlive the pose graph. Used by one thread at a time, like the
// optimisation problem of the pose graph.
class RecordedTrack {
 public:
  // `plan` must outlive this object.
  RecordedTrack(
      const io::Pbstream& pbstream, const ReplayPlan& plan,
      const cartographer::mapping::proto::PoseGraphOptions& pose_graph_options,
      const RecordedTrackOptions& options);

  // The optimisation problem for the pose graph of the run.
  std::unique_ptr<cartographer::mapping::optimization::OptimizationProblem2D>
  MakeOptimizationProblem();

  // Outcomes of the stored loops within a trajectory that were due, by the
  // rules of stock's search, by ids of the stored map. Inter-trajectory loops
  // are not included, because their search depends on more than distances.
  const LoopOutcomes& outcomes() const { return outcomes_; }

  // Number of loops that the last optimisation used with their stored poses.
  int64_t num_followed() const { return num_followed_; }

 private:
  using Problem = cartographer::mapping::optimization::OptimizationProblem2D;
  using Constraint = cartographer::mapping::PoseGraphInterface::Constraint;
  class FollowingProblem;

  // Called when the pose graph has added the next node and its candidates are
  // due.
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
  // Sampler of each submap, counting candidates as stock's search does.
  std::map<GraphId, cartographer::common::FixedRatioSampler> samplers_;
  LoopOutcomes outcomes_;
  int64_t num_followed_ = 0;
};

}  // namespace evaluation
}  // namespace cartographer_ext

#endif  // CARTOGRAPHER_EXT_RERUN_RECORDED_TRACK_H_
