// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
//
// Batch optimisation of a pose graph whose loops may be wrong: iteratively
// reweighted least squares inside Levenberg-Marquardt. In each iteration
//
//   (H + lambda diag H) dx = -g,   H = sum omega J'J,   g = sum omega J'r,
//
// with omega = rho'(chi2) at the current poses, and the step is accepted if it
// lowers the robust cost sum rho(chi2). Because omega belongs to the same rho
// that judges the step, this converges; weights that change without the
// solver's knowledge do not (Ceres stops after a few rejected steps and reports
// convergence).
//
// Pruned edges: an outlier with weight 1e-6 has no effect on the solution but
// causes fill in the factor. Loops whose weight is below `prune_weight` are
// removed from the pattern; all weights are recomputed in each iteration, and
// loops are added again as soon as their weight rises (10 to 20 times faster at
// 1000 outliers, same optimum). A loop that is added again often fits into the
// existing fill of the factor; only otherwise the elimination order is
// recomputed.
//
// Undecided edges: the weight of a loop near the gate depends on its residual
// and the residual on the weight, and both change a little in each iteration.
// Near the end, when few such loops remain, both are carried to their limit at
// once, on the linearised graph (robust_solver_undecided.cc).
//
// The first pose is fixed.
#ifndef CARTOGRAPHER_EXT_OPTIMIZATION_SOLVERS_ROBUST_SOLVER_H_
#define CARTOGRAPHER_EXT_OPTIMIZATION_SOLVERS_ROBUST_SOLVER_H_

#include <deque>
#include <utility>
#include <vector>

#include "cartographer_ext/optimization/graph/pose_graph.h"
#include "cartographer_ext/optimization/solvers/block_ldlt.h"
#include "cartographer_ext/optimization/solvers/kernels.h"

namespace cartographer_ext {
namespace optimization {

// Kernel and stopping rules of one solution.
struct SolverOptions {
  KernelOptions kernel;  // of the loops; other edges count in full
  int max_iterations = 100;
  // Ends when a step lowers the cost by less than this fraction.
  double cost_tolerance = 1e-7;
  // Ends when no pose moves more than this (metres or radians).
  double step_tolerance = 1e-7;
  // Larger values slow down the low-frequency modes of a trajectory, whose
  // curvature is far below the diagonal.
  double initial_lambda = 1e-9;
  bool prune = true;
  double prune_weight = 1e-4;
  // Empty, or one factor for each edge on top of the kernel's weight.
  std::vector<double> edge_weights;
};

// Summary of one solution.
struct SolverSummary {
  int iterations = 0;        // linear systems solved
  int factorizations = 0;    // of them, those with a factor of their own
  int analyses = 0;          // symbolic factorisations
  double initial_cost = 0.;  // sum of rho, that is without the usual factor 1/2
  double final_cost = 0.;
  bool converged = false;  // a tolerance was met before max_iterations
  size_t factor_blocks = 0;
  double cpu_seconds = 0.;
};

// Solves the same graph repeatedly, from different poses, with different
// kernels or edge weights, and reuses the factor's pattern where possible.
//
// A step near the end takes the factor of the step before as long as it still
// gains what that promises: a gradient and a substitution cost a third of a
// factorisation.
class RobustSolver {
 public:
  // The edges must refer to existing poses and outlive the solver. Which of
  // them are loops may change between solutions.
  struct LastPoseLast {};

  explicit RobustSolver(const std::vector<WhitenedEdge>& edges)
      : edges_(edges) {}
  // The same with the last pose last in the elimination order, where the next
  // one will be attached.
  RobustSolver(const std::vector<WhitenedEdge>& edges, LastPoseLast)
      : edges_(edges), last_pose_last_(true) {}

  // Memory of the factor of a solver that has ended: new memory takes as long as a
  // factorisation. Nothing else of it counts.
  void TakeMemory(BlockLdlt factor) {
    factor_ = std::move(factor);
    analysed_ = false;
  }
  BlockLdlt ReleaseMemory() { return std::move(factor_); }

  // Improves `poses` in place; their number is the same in all calls.
  SolverSummary Solve(const SolverOptions& options, std::vector<Pose2>* poses);

  // The weight of each edge at the end of the last solution.
  const std::vector<double>& weights() const { return weights_; }

  // The factorised system of the edges at these poses with these weights, one
  // per edge, and its right hand side. Null when it is not positive definite. What
  // was asked last is known.
  const BlockLdlt* Factor(const std::vector<Pose2>& poses,
                          const std::vector<double>& weights,
                          Eigen::VectorXd* rhs);

  // Replaces the poses by those of an earlier solution with these weights and
  // the plain kernel, noted by Remember(), if they cost no more; false if there
  // is none. Edges that have changed since then are noticed.
  bool Recall(const std::vector<double>& weights, std::vector<Pose2>* poses);
  void Remember(const std::vector<double>& weights,
                const std::vector<Pose2>& poses);

  const std::vector<WhitenedEdge>& edges() const { return edges_; }

  // What all solutions and factors so far have taken, in multiplications: unlike
  // time the same on every machine.
  double work() const { return work_; }
  // Factors that were made so far; what is known counts as work, too.
  int factorizations() const { return factorizations_; }

 private:
  // Weights and shapes of all edges at given poses.
  struct Evaluation {
    double cost = 0.;
    std::vector<double> weights;
    std::vector<double> shapes;  // of the literal ACS kernel only
  };

  // A solution with given weights.
  struct Solution {
    std::vector<double> weights;
    std::vector<Pose2> poses;
    double cost = 0.;
  };

  // State of one call of Solve().
  struct Descent {
    Evaluation now;
    Evaluation next;
    Eigen::VectorXd step;
    double lambda = 0.;
    double last_decrease = 0.;
    bool settling = false;
    bool factor_serves = false;  // for another step
    std::vector<int> undecided;  // loops about to be rejected or accepted
    bool done = false;
    SolverSummary summary;
  };

  void ComputeCovarianceNorms();
  bool TryLastFactor(const std::vector<Pose2>& from, Descent* descent);
  bool TryStep(const std::vector<Pose2>& from, Descent* descent);
  void Judge(double decrease, double largest, Descent* descent) const;
  void TakeNext(double decrease, Descent* descent);
  void SetPoses(const std::vector<Pose2>& poses);
  void Evaluate(const std::vector<double>* held_shapes, Evaluation* result);
  void Prolong(const std::vector<Pose2>& from, Eigen::VectorXd step,
               const std::vector<double>& held_shapes, Evaluation* reached);
  std::vector<int> UndecidedLoops(const std::vector<double>& before,
                                  const std::vector<double>& now) const;
  bool CarryToTheLimit(const std::vector<int>& loops, const Evaluation& now,
                       Eigen::VectorXd* step) const;
  void CountFactorization();
  bool Factorize(double lambda);
  bool UpdatePattern(const std::vector<double>& weights);
  void AddToPattern(const std::vector<int>& edges,
                    std::vector<std::pair<int, int>>* pairs);
  void Assemble(const std::vector<double>& weights);
  void AddToSystem(const WhitenedEdge& edge, double weight, int pair);
  double PredictedDecrease(const Eigen::VectorXd& step, double lambda) const;

  const std::vector<WhitenedEdge>& edges_;
  const bool last_pose_last_ = false;
  SolverOptions options_;
  std::vector<Pose2> poses_;
  std::vector<Eigen::Vector2d> rotations_;  // cosine and sine of each pose
  std::vector<double> covariance_norms_;    // per edge, literal ACS
  std::vector<double> weights_;
  bool analysed_ = false;
  std::vector<bool> in_pattern_;
  std::vector<std::pair<int, int>> pattern_;  // (edge, pair of factor_ or -1)
  int num_pairs_ = 0;
  BlockLdlt factor_;
  std::deque<Solution> solutions_;  // the last ones that are remembered
  // What the factor is that of, after Factor(); no poses after another one.
  std::vector<Pose2> factored_poses_;
  std::vector<double> factored_weights_;
  Eigen::VectorXd factored_gradient_;
  size_t ordered_blocks_ = 0;  // of the factor when it was last ordered
  double work_ = 0.;
  int factorizations_ = 0;
  Eigen::VectorXd gradient_;
  Eigen::VectorXd diagonal_;
};

// One solution.
SolverSummary SolveRobust(const std::vector<WhitenedEdge>& edges,
                          const SolverOptions& options,
                          std::vector<Pose2>* poses);

// Schedule of graduated non-convexity.
struct GncOptions {
  double truncation = kChi2Gate;  // c: chi2 beyond which a loop is an outlier
  double mu_step = 1.4;
  int max_outer_iterations = 100;
  int inner_iterations = 4;
  // Each round starts from the given poses instead of the last solution, which
  // with many outliers is folded in the first rounds.
  bool restart = true;
  // Chi2 at the given poses up to which a loop is used in the first round. 0:
  // all loops are used, after one solution with full weights.
  double reach = 0.;
  // CPU time. Checked after each round, so that the first rounds with full
  // graphs may exceed it; a solution stopped by it has not converged.
  double max_seconds = 1e9;
};

// Graduated non-convexity with truncated least squares (Yang et al. 2020), with
// trusted odometry. Weights are returned one per edge.
SolverSummary SolveGnc(const std::vector<WhitenedEdge>& edges,
                       const GncOptions& options, std::vector<Pose2>* poses,
                       std::vector<double>* weights);
// The same with an existing solver.
SolverSummary SolveGnc(const GncOptions& options, RobustSolver* solver,
                       std::vector<Pose2>* poses, std::vector<double>* weights);

// 1 for odometry and for loops whose chi2 is below the gate, 0 for the others.
std::vector<double> DecideLoops(const std::vector<WhitenedEdge>& edges,
                                const std::vector<Pose2>& poses, double gate);

// Rounds of the polishes below for offline use.
constexpr int kFullPolishRounds = 30;

// Alternates between deciding each loop by `gate` on chi2 (weight 1 inside, 0
// outside) and solving with those weights, until the decisions no longer
// change. Each half-step lowers the truncated cost, so this terminates;
// rejected loops are accepted again when the poses have moved towards them.
// Where a fold opens, each round takes in the next few loops only; from the
// sixth on they come in together, by a Geman-McClure kernel as wide as the gate,
// if that lowers the cost.
// `weights`, if not null, receives one value per edge.
SolverSummary PolishTruncated(const std::vector<WhitenedEdge>& edges,
                              double gate, int max_rounds,
                              std::vector<Pose2>* poses,
                              std::vector<double>* weights);
// The same with an existing solver.
SolverSummary PolishTruncated(double gate, int max_rounds, RobustSolver* solver,
                              std::vector<Pose2>* poses,
                              std::vector<double>* weights);

// A gate that is narrower if the information matrices are conservative: chi2 of
// the loops inside kChi2Gate is compared with its expected distribution, by its
// median and, for heavy tails, by its 98th percentile; the gate is four times
// (two standard deviations) the larger of the two estimates, and at most
// kChi2Gate. In the simulated sets true loops have a median of 0.02 instead of
// 2.4, so that an "accepted" chi2 of 1 is an outlier.
double AdaptiveGate(const std::vector<WhitenedEdge>& edges,
                    const std::vector<Pose2>& poses);

// PolishTruncated with the adapted gate, repeated as long as the rejected loops
// narrow the gate.
SolverSummary PolishAdapted(const std::vector<WhitenedEdge>& edges,
                            int max_rounds, std::vector<Pose2>* poses,
                            std::vector<double>* weights);
// The same with an existing solver.
SolverSummary PolishAdapted(int max_rounds, RobustSolver* solver,
                            std::vector<Pose2>* poses,
                            std::vector<double>* weights);

// Truncated cost: chi2 of the odometry plus sum over loops of min(chi2, gate).
// Comparable between kernels, and the criterion that distinguishes a folded map
// from a right one: every rejected true loop costs the gate.
double TruncatedCost(const std::vector<WhitenedEdge>& edges,
                     const std::vector<Pose2>& poses, double gate = kChi2Gate);

}  // namespace optimization
}  // namespace cartographer_ext

#endif  // CARTOGRAPHER_EXT_OPTIMIZATION_SOLVERS_ROBUST_SOLVER_H_
