// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
//
// R-iSAM: incremental smoothing that is robust against wrong loops (Zhang, Yao,
// Yue, Sun 2015). Poses arrive one at a time with their odometry and with the
// loops that end in them.
//
//   Each step (eq. 14-16): the new measurements update the factor. For a loop
//   the switch alone is estimated together with the poses,
//     min over X, s   (all else)  +  s^2 chi2(X) + w (1 - s)^2,
//   which for the linearised rest is a search in one dimension: with r the
//   whitened innovation and Q = J H^-1 J' the covariance of its prediction,
//     g(s) = sum_i u_i^2 s^2 / (1 + s^2 q_i) + w (1 - s)^2,  Q = V diag(q) V',
//   u = V' r. The loop enters with weight s^2.
//
//   Every `epoch_poses` poses (eq. 17-19): relinearise, reorder and solve the
//   whole graph with a robust kernel, then decide each loop by the gate
//   chi2 < 11.345: accepted loops count in full, others not at all.
//
// A loop that closes after a long drift has a huge chi2 and would never be
// accepted. So at the end of an epoch the rejected loops that are compatible
// with the uncertainty of the poses (innovation chi2 inside the gate) are
// tried: the best supported ones, at most `max_hypotheses`, are each forced in,
// the graph is solved and the loop released again. The truncated cost decides,
// and must decrease by more than the gate.
//
// Wrong loops that agree may still enter, where they outweigh the few right ones
// of the time. Then the map contradicts most loops that follow, by certainty, and
// none of these is a hypothesis. So if far fewer stretches with loops are accepted
// since one of the last epochs than before, which chance would bring about once in
// a thousand times (refused_loops.h), the end of the epoch tries hypotheses from
// the map before that one (incremental_smoother_return.cc).
//
// The paper decides each loop once. Here every epoch re-evaluates all loops, so
// that a wrong loop accepted early is rejected later (late rejection) and a
// true one is accepted again (readmission); both can be disabled.
//
// On a map of more than `large_map` poses epochs are long, and a loop costs a path through most of the
// factor and fills it. There
//   - a loop that is far from the current poses is predicted as soon as it
//     comes, so that the map does not lag behind until hypotheses, of which most
//     loops would have to agree, cannot help any more: if the uncertainty of the
//     poses explains the loop and a wrong one would hardly be there by chance
//     (loop_evidence.h), it enters with its full weight, and the end of the
//     epoch is solved with it in force before it is judged with all others;
//   - a loop that agrees waits for the end of the epoch while odometry since the
//     last one is less uncertain than its own measurement;
//   - an epoch ends early when its steps have taken as much work as the end of
//     the last one.
//
// A step is bounded: at most `max_loops_per_step` loops are tested, the rest
// are deferred to the next steps. Beyond `two_step_map` the end of an epoch takes two
// steps: the last one of the epoch begins to solve the graph, and the next one ends
// that, rebuilds the factor and tries hypotheses before its pose is added.
#ifndef CARTOGRAPHER_EXT_OPTIMIZATION_SOLVERS_INCREMENTAL_SMOOTHER_H_
#define CARTOGRAPHER_EXT_OPTIMIZATION_SOLVERS_INCREMENTAL_SMOOTHER_H_

#include <deque>
#include <memory>
#include <vector>

#include "absl/status/status.h"
#include "cartographer_ext/optimization/graph/pose_graph.h"
#include "cartographer_ext/optimization/solvers/incremental_factor.h"
#include "cartographer_ext/optimization/solvers/robust_solver.h"
#include "cartographer_ext/uncertainty/uncertain_pose.h"

namespace cartographer_ext {
namespace optimization {

// How the switch of a new loop is estimated.
enum class SwitchEstimate {
  kJoint,      // the minimum of g(s), with the uncertainty of the poses
  kPointwise,  // s = w / (w + chi2) at the current poses
};

// Options of steps and epochs.
struct SmootherOptions {
  int epoch_poses = 100;
  // An epoch is at least as long as this share of the poses.
  double epoch_share = 0.025;
  // With more poses than this the end of an epoch takes two steps. With more than
  // half as many none returns to an earlier map, which takes as long once more.
  int two_step_map = 7000;
  // With more poses than this an epoch is as long as a tenth of them unless its
  // work ends it earlier, and loops are predicted or wait, see above.
  int large_map = 12000;
  // Pointwise is the default: the joint estimate closes larger gaps at once,
  // but accepts whatever the uncertainty allows, and fails when nine out of ten
  // loops are wrong.
  SwitchEstimate switch_estimate = SwitchEstimate::kPointwise;
  // w of the switch penalty. Pointwise: the papers' 1. For the joint estimate
  // kChi2Gate is the sensible value: 1 would reject most true loops, whose chi2
  // has mean 3.
  double switch_penalty = 1.;
  // Loops with s^2 below this are not added before the next epoch.
  double skip_weight = 1e-3;
  double gate = kChi2Gate;
  KernelOptions epoch_kernel = DefaultKernel(KernelType::kGemanMcClure);
  int max_epoch_iterations = 10;
  double epoch_cost_tolerance = 1e-3;
  bool late_rejection = true;
  bool readmission = true;
  // At the end, narrow the gate if the data indicate it (AdaptiveGate).
  bool adaptive_gate = true;
  int max_loops_per_step = 50;
  // Rounds of deciding and solving (PolishTruncated) after the kernel.
  int polish_rounds = 3;
  int max_hypotheses = 3;  // at the end of an epoch; 0: as in the paper
  // At the end, solve with wider kernels and polish. Where the poses are a start
  // for other solvers, these do that.
  bool polish_at_end = true;
};

// Cost and result of one step.
struct StepReport {
  double cpu_seconds = 0.;
  int loops_tested = 0;
  int loops_entered = 0;
  bool epoch = false;
  int batch_iterations = 0;  // for the end of an epoch
};

// R-iSAM, see above. Not thread-safe.
class IncrementalSmoother {
 public:
  // The first pose is fixed at `origin`.
  IncrementalSmoother(const SmootherOptions& options, const Pose2& origin);
  IncrementalSmoother(const IncrementalSmoother&) = delete;
  IncrementalSmoother& operator=(const IncrementalSmoother&) = delete;

  // Adds pose number num_poses(). `edges` end in it: `from` or `to` is the new
  // number and the other end exists. At least one is not a loop; the first such
  // gives the pose's initial estimate. An invalid argument leaves the smoother
  // unchanged. If information matrices are so badly scaled that the factor is
  // lost to rounding, this and all later calls return an internal error.
  absl::Status AddPose(const std::vector<PoseGraphEdge>& edges,
                       StepReport* report);

  // Ends the current epoch now.
  void EndEpoch();
  // Call at the end of the data: ends the epoch and tries hypotheses, then decides
  // and solves alternately until the decisions no longer change (PolishTruncated).
  // With late rejection and readmission both off, as in the paper, only ends the
  // epoch.
  void Finish();

  int num_poses() const { return poses_.size(); }
  // Current estimate of all poses. Computed on demand; the steps themselves
  // need only the newest pose and the ends of its loops.
  const std::vector<Pose2>& poses() const;
  // All edges in order of arrival, and which loops are in force.
  const std::vector<WhitenedEdge>& edges() const { return edges_; }
  const std::vector<bool>& accepted() const { return accepted_; }
  // Loops that changed from accepted to rejected, and back, at an epoch's end.
  int num_late_rejections() const { return num_late_rejections_; }
  int num_readmissions() const { return num_readmissions_; }
  // Hypotheses tried so far.
  int num_hypotheses() const { return num_hypotheses_; }
  // Not OK if the factor is lost.
  const absl::Status& status() const { return status_; }
  size_t factor_blocks() const { return factor_.num_blocks(); }
  const IncrementalFactor& factor() const { return factor_; }

 private:
  // A rejected loop that the uncertainty of the poses would allow.
  struct Candidate {
    int edge = 0;
    LinearFactor factor;
    Eigen::Vector3d gain;    // (I + Q)^-1 r
    double innovation = 0.;  // r' (I + Q)^-1 r
  };

  // Poses and decisions at the end of an epoch.
  struct EarlierMap {
    std::vector<Pose2> poses;
    std::vector<bool> accepted;
  };

  // The two parts of the end of an epoch, the batch solution and the new factor; the
  // second does nothing without the first. In two steps, what the solution takes
  // beyond its first iterations is left to the second.
  void SolveEpoch();
  void TakeOverEpoch();
  void AppendPose(const PoseGraphEdge& odometry);
  bool EpochIsDue() const;
  // Counts the work of the last update of the factor and its success.
  void NoteUpdate(bool succeeded);
  LinearFactor LinearizeEdge(const WhitenedEdge& edge) const;
  Eigen::Vector3d Offset(int pose) const;
  // Estimates the switch of a loop and adds it. Returns whether it was added.
  bool TestLoop(int edge_index);
  // Whether odometry since the last loop that has entered is less uncertain than
  // the loop, seen from the newest pose.
  bool SaysLittle(const WhitenedEdge& edge, const LinearFactor& factor) const;
  // Whether the uncertainty of the poses explains the residual of a right loop,
  // while a wrong one would hardly come as close.
  bool IsCertain(const WhitenedEdge& edge, const LinearFactor& factor,
                 const Eigen::Vector3d& residual);
  double EstimateSwitch(const LinearFactor& factor,
                        const Eigen::Vector3d& residual) const;
  void UpdateEstimate() const;
  // Updates the estimate of one pose.
  void RefreshPose(int pose);
  SolverOptions EpochSolverOptions() const;
  // The same with the edges that the batch solution may take in.
  SolverOptions BatchOptions() const;
  void SolveOn(const SolverOptions& options, RobustSolver* batch);
  // Solves the rest and decides the loops.
  void FinishBatch(RobustSolver* batch);
  void SolveWithPredicted(const SolverOptions& options);
  void DecideLoops();
  void RebuildFactor(RobustSolver* batch);
  // The same, and the estimate by it; false where the factor is lost.
  bool Relinearize(RobustSolver* batch);
  std::vector<Candidate> FindCandidates(int first_edge, double majority) const;
  std::vector<int> ChooseSeeds(std::vector<Candidate> candidates) const;
  // If the information matrices are realistic, true loops have chi2 around 3;
  // the epochs' kernel then downweights them and rejects some. True if most
  // loops agree and have less than half their weight on average.
  bool KernelIsNarrow() const;
  // At the end, where rejected loops are within reach.
  void TryWiderKernels(RobustSolver* solver);
  // Whether at least `majority` of all loops support `poses` as a hypothesis that
  // explains more than the present map.
  bool IsSupported(const std::vector<Pose2>& poses,
                   const std::vector<Pose2>& present, double majority) const;
  // Returns whether a hypothesis was accepted, against the present map.
  bool TryHypotheses(int first_edge, double majority,
                     const std::vector<Pose2>& present, RobustSolver* solver);
  // The rest is about earlier maps, incremental_smoother_return.cc.
  bool MayReturn() const;
  void KeepMap();
  const EarlierMap* MapBeforeRefusals() const;
  // False where the factor is lost.
  bool ReturnTo(const EarlierMap& map, RobustSolver* batch);
  // Hypotheses from the map of an earlier epoch, where loops since then are
  // refused; returns whether one was accepted.
  bool TryEarlierMap(RobustSolver* batch);

  const SmootherOptions options_;
  std::vector<WhitenedEdge> edges_;
  std::vector<bool> accepted_;
  std::vector<bool> decided_;            // loops that went through an epoch
  std::deque<int> waiting_;              // loops not yet tested
  std::deque<EarlierMap> earlier_maps_;  // of the last epochs
  std::vector<int> predicted_;  // loops of this epoch that entered as certain
  int num_rejected_ = 0;        // loops that are not in force
  // Of each pose when it was new. More loops only make a pose more certain.
  std::vector<Eigen::Matrix3d> covariances_;
  // Motion by odometry since the last loop that has entered.
  uncertainty::UncertainPose drift_;
  double log_area_ = 0.;  // LogArea() at the end of the last epoch
  mutable std::vector<Pose2> poses_;
  std::vector<Pose2> linearization_poses_;
  IncrementalFactor factor_;
  mutable bool estimate_outdated_ = false;
  absl::Status status_;
  int poses_in_epoch_ = 0;
  int first_edge_of_epoch_ = 0;
  // Multiplications.
  double work_of_steps_ = 0.;  // in this epoch
  double work_of_last_end_ = 0.;
  std::unique_ptr<RobustSolver> batch_;  // of an epoch whose factor is to come
  BlockLdlt memory_;                     // for the next one
  int iterations_left_ = 0;              // of its solution
  int batch_iterations_ = 0;             // in this step
  int num_late_rejections_ = 0;
  int num_readmissions_ = 0;
  int num_hypotheses_ = 0;
};

// Result of replaying a graph.
struct ReplayResult {
  std::vector<Pose2> poses;
  std::vector<double> step_seconds;  // processor time of every AddPose
  std::vector<bool> accepted;        // per edge of the graph; true for odometry
  double cpu_seconds = 0.;
};

// Replays a whole graph pose by pose, as if it were recorded now: pose k
// arrives with all edges to earlier poses. Uses no initial pose but the first.
// An error if a pose has no odometry edge to an earlier one.
absl::Status Replay(const PoseGraph& graph, const SmootherOptions& options,
                    ReplayResult* result);

// argmin over s in [0, 1] of sum u_i^2 s^2/(1 + s^2 q_i) + w (1 - s)^2.
double MinimizeSwitch(const Eigen::Vector3d& squared_innovation,
                      const Eigen::Vector3d& predicted_variance,
                      double penalty);

}  // namespace optimization
}  // namespace cartographer_ext

#endif  // CARTOGRAPHER_EXT_OPTIMIZATION_SOLVERS_INCREMENTAL_SMOOTHER_H_
