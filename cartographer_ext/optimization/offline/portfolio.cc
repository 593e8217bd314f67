// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
#include "cartographer_ext/optimization/offline/portfolio.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "Eigen/Cholesky"
#include "absl/strings/match.h"
#include "absl/strings/str_cat.h"
#include "cartographer_ext/common/thinned.h"
#include "cartographer_ext/optimization/offline/decision_moves.h"
#include "cartographer_ext/optimization/offline/loop_growth.h"
#include "cartographer_ext/optimization/offline/noise/loops_by_chance.h"
#include "cartographer_ext/optimization/solvers/edges_in_force.h"

namespace cartographer_ext {
namespace optimization {
namespace {

// Relative difference of truncated costs of one and the same optimum.
constexpr double kSame = 1e-6;
// Of a solution that is polished anyway, where the rest does not search to the last
// loop either.
constexpr double kRoughly = 1e-4;
// Loops by which solvers differ that decide only what is near the gate
// differently.
constexpr double kNearlySame = 3.;
// Wrong loops that may fit into a map by chance, or be expected in force in one that
// kernels do not agree on, for the search to end early.
constexpr double kFewByChance = 1.;
// Rejected loops whose innovation is looked at.
constexpr size_t kMaxInnovations = 200;
// Groups that are forced in where the kernels agree on a map that these
// contradict, which may be folded.
constexpr int kMaxTrialsOfSettled = 3;
// A graph of fewer poses times loops is searched from all starts in any case.
constexpr double kSmallGraph = 2.5e5;
// Multiplications of one factorisation that cost nothing worth mentioning.
constexpr double kLittleWork = 3e6;

// Names what was improved in the same way twice only once.
std::string Suffixed(const std::string& name, const std::string& suffix) {
  return absl::EndsWith(name, suffix) ? name : absl::StrCat(name, suffix);
}

}  // namespace

Portfolio::Portfolio(PoseGraph graph, const PortfolioOptions& options)
    : graph_(std::move(graph)),
      options_(options),
      edges_(Whiten(graph_.edges)),
      solver_(edges_),
      lowest_of_solvers_(std::numeric_limits<double>::infinity()) {
  num_loops_ = CountLoops(edges_);
}

double Portfolio::Size() const {
  return static_cast<double>(graph_.poses.size()) * num_loops_;
}

FlipOptions Portfolio::flip_options() const {
  FlipOptions options;
  if (graph_.poses.size() > kLargeGraph) options.max_trials = 2;
  return options;
}

void Portfolio::Count(const SolverSummary& summary) {
  iterations_ += summary.iterations;
  converged_ = summary.converged;
}

void Portfolio::Add(const std::string& name, std::vector<Pose2> poses) {
  Member member;
  member.name = name;
  member.poses = std::move(poses);
  Count(PolishTruncated(kChi2Gate, kFullPolishRounds, &solver_, &member.poses,
                        nullptr));
  member.cost = TruncatedCost(edges_, member.poses);
  members_.push_back(std::move(member));
  if (members_.back().cost < members_[best_].cost) best_ = members_.size() - 1;
}

void Portfolio::NoteSolver(const std::vector<Pose2>& poses) {
  if (!starts_alone_) return;
  lowest_of_solvers_ =
      std::min(lowest_of_solvers_, TruncatedCost(edges_, poses));
  results_of_solvers_.push_back(poses);
}

void Portfolio::AddKernel(const std::string& start_name, const KernelType type,
                          const std::vector<Pose2>& start) {
  SolverOptions options;
  options.kernel = DefaultKernel(type);
  options.max_iterations = options_.max_iterations;
  std::vector<Pose2> poses = start;
  Count(solver_.Solve(options, &poses));
  NoteSolver(poses);
  Add(absl::StrCat(start_name, KernelName(type)), std::move(poses));
}

size_t Portfolio::AddKernels(const std::string& start_name,
                             const std::vector<Pose2>& start,
                             const bool with_full_kernels) {
  const size_t first = members_.size();
  AddKernel(start_name, KernelType::kDcs, start);
  AddOtherKernels(start_name, start, with_full_kernels);
  return first;
}

void Portfolio::AddOtherKernels(const std::string& start_name,
                                const std::vector<Pose2>& start,
                                const bool with_full_kernels) {
  AddKernel(start_name, KernelType::kGemanMcClure, start);
  AddKernel(start_name, KernelType::kAcs, start);
  if (with_full_kernels) AddFullKernels(start_name, start);
}

void Portfolio::AddFullKernels(const std::string& start_name,
                               const std::vector<Pose2>& start) {
  AddKernel(start_name, KernelType::kHuber, start);
  AddKernel(start_name, KernelType::kNone, start);
  ran_full_kernels_ = true;
}

void Portfolio::AddGnc(const std::string& start_name,
                       const std::vector<Pose2>& start) {
  std::vector<Pose2> poses = start;
  Count(SolveGnc(GncOptions(), &solver_, &poses, nullptr));
  NoteSolver(poses);
  Add(absl::StrCat(start_name, "gnc_tls"), std::move(poses));
}

double Portfolio::FullWork() {
  if (!full_work_.has_value()) {
    full_work_ = WorkOf(std::vector<double>(edges_.size(), 1.));
  }
  return *full_work_;
}

bool Portfolio::CanKeepAllLoops() { return FullWork() <= kAffordableWork; }

double Portfolio::WorkOf(const std::vector<double>& weights) const {
  return FactorWork(edges_, weights, graph_.poses.size());
}

int Portfolio::CountRejected() const {
  int result = 0;
  for (const WhitenedEdge& edge : edges_) {
    result += edge.is_loop && Chi2(edge, best().poses[edge.from],
                                   best().poses[edge.to]) >= kChi2Gate;
  }
  return result;
}

const LoopSupport& Portfolio::support() {
  if (!support_.has_value()) {
    support_ = FindLoopSupport(graph_, LoopSupportOptions());
  }
  return *support_;
}

size_t Portfolio::RunQuick() {
  quick_ = AddKernels("", graph_.poses, false);
  // With few wrong loops the solvers that keep all of them cost little more.
  if (!continued_ && CountRejected() <= 0.1 * num_loops_ &&
      FullWork() <= kLittleWork) {
    AddFullKernels("", graph_.poses);
  }
  return *quick_;
}

bool Portfolio::DecideAlike(const size_t first) const {
  for (size_t m = first; m != first + kQuickKernels; ++m) {
    if (!DifferNearGateOnly(edges_, best().poses, members_[m].poses)) {
      return false;
    }
  }
  return true;
}

bool Portfolio::EndsAsFromGivenPoses(const size_t first) const {
  if (!quick_.has_value() || *quick_ == first) return false;
  for (size_t k = 0; k != kQuickKernels; ++k) {
    const double cost = members_[*quick_ + k].cost;
    if (std::abs(members_[first + k].cost - cost) >
        kSame * cost + kNearlySame * kChi2Gate) {
      return false;
    }
  }
  return true;
}

bool Portfolio::AllAreFolded(const size_t first) const {
  const auto begin = members_.begin() + first;
  return std::all_of(begin, begin + kQuickKernels,
                     [this](const Member& member) {
                       return member.cost > best().cost + kFolded * kChi2Gate;
                     });
}

bool Portfolio::IsSettled(const size_t first) {
  double highest = 0.;
  for (size_t i = first; i != first + kQuickKernels; ++i) {
    highest = std::max(highest, members_[i].cost);
  }
  const auto same_cost = [&] {
    return highest <= best().cost * (1. + kSame) + kNearlySame * kChi2Gate;
  };
  const bool alike = EndsAsFromGivenPoses(first);
  if (!same_cost()) {
    if (!alike && !DecideAlike(first)) return false;
    Graduate(kNear);
  }
  const bool most_were_rejected = MostAreRejected();
  Improve();
  // What softer kernels have found may be another map than that agreed on, and
  // where most loops are wrong, or were in that, one of many.
  if (!alike && !same_cost() && !DecideAlike(first) &&
      (MostAreRejected() ||
       (most_were_rejected && WrongByChance() >= kFewByChance))) {
    return false;
  }
  // Where odometry is weak, all kernels may reject nearly all loops from any start. Of a
  // graph of ordinary size groups of loops show that.
  if (Size() > kMaxGrowthWork && AllAreFolded(first)) return false;
  if (!RejectedContradict()) return false;
  // Of a smaller graph other starts show whether that is another map.
  if (continued_ || Size() <= options_.large_search) return true;
  const double before = best().cost;
  return RecoversParts() || best().cost >= before - kNearlySame * kChi2Gate;
}

double Portfolio::WrongByChance() {
  return WrongInForce(
      {best().poses, DecideLoops(edges_, best().poses, kChi2Gate)}, support(),
      &solver_);
}

double Portfolio::FitsByChance() const {
  const double log_area = LogArea(best().poses);
  double result = 0.;
  for (const WhitenedEdge& edge : edges_) {
    if (!edge.is_loop || Chi2(edge, best().poses[edge.from],
                              best().poses[edge.to]) < kChi2Gate) {
      continue;
    }
    result += ChanceToFit(edge, log_area, kChi2Gate);
  }
  return result;
}

bool Portfolio::ExplainsNothing() const {
  return num_loops_ - CountRejected() <= FitsByChance();
}

bool Portfolio::HasLostNearlyAll() {
  return ShareInForce(SupportedLoops()) < kHardlyAny;
}

bool Portfolio::FindsLostGroup(const absl::optional<PartOfPath>& part) {
  ForceOptions force;
  force.part = part;
  force.max_trials = kMaxTrialsOfSettled;
  force.min_members = kSupported + 1;
  force.relax = false;  // the price of a graph that is settled
  force.max_rise = 1.;  // a right group lowers the cost, or nearly so
  const double before = best().cost;
  // Less is a matter of loops near the gate.
  return AddForced(best().name, force) &&
         best().cost < before - kNearlySame * kChi2Gate;
}

bool Portfolio::GncFindsAnother() {
  if (continued_ || FullWork() > kLittleWork) return false;
  const double before = best().cost;
  AddGnc("", graph_.poses);
  ran_gnc_ = true;
  if (best().cost < before * (1. - kSame)) Improve();
  return best().cost < before - kNearlySame * kChi2Gate;
}

bool Portfolio::AddForced(const std::string& start_name,
                          const ForceOptions& options) {
  std::vector<Pose2> poses = best().poses;
  if (ForceGroups(support(), options, &edges_, &solver_, &poses,
                  &alternatives_) == 0) {
    return false;
  }
  Add(absl::StrCat(start_name, ", groups"), std::move(poses));
  return true;
}

bool Portfolio::RejectsAGroup() {
  const std::vector<double> decisions =
      DecideLoops(edges_, best().poses, kChi2Gate);
  for (const std::vector<int>& group : support().groups) {
    size_t rejected = 0;
    for (const int i : group) rejected += decisions[i] == 0.;
    if (rejected > 2 * kSupported && 2 * rejected >= group.size()) return true;
  }
  return false;
}

bool Portfolio::OtherStartIsLower() {
  if (continued_ || replayed_) return false;
  if (!RejectsAGroup()) return false;
  const double before = best().cost;
  std::string name = "supported, ";
  std::vector<double> supported;
  std::vector<Pose2> start;
  if (!StartFromSupport(&supported, &start)) {
    ReplayResult replay;
    if (!AddShortReplay(&replay)) return false;
    // A folded map says nothing about another one.
    if (members_.back().cost > before + kFolded * kChi2Gate &&
        !AddReplay(&replay)) {
      return false;
    }
    name = replayed_ ? "r_isam, " : "r_isam, short, ";
    start = replay.poses;
  }
  const size_t first = members_.size();
  AddKernel(name, KernelType::kDcs, start);
  if (best().cost >= before - kNearlySame * kChi2Gate) return false;
  AddOtherKernels(name, start, false);
  return !IsSettled(first);
}

bool Portfolio::RejectedContradict() {
  const std::vector<Pose2>& poses = best().poses;
  const std::vector<double> weights = DecideLoops(edges_, poses, kChi2Gate);
  std::vector<int> rejected;
  for (size_t i = 0; i != edges_.size(); ++i) {
    if (weights[i] == 0.) rejected.push_back(i);
  }
  if (rejected.empty()) return true;
  if (ExplainsNothing()) return false;
  const std::vector<Innovation> innovations = PredictLoops(
      Thinned(rejected, kMaxInnovations), weights, poses, &solver_);
  return !innovations.empty() && !MorePossibleThanByChance(innovations);
}

void Portfolio::Run() {
  const double size = Size();
  // What else there is would take minutes on a large graph.
  if (graph_.poses.size() > kLargeGraph && AddCertain()) return;
  const bool large = size > options_.large_search;
  if (large && SettleBySupport()) return;
  if (continued_ && size > kMaxGrowthWork) {
    // Other starts have had their part in the last search.
    RunQuick();
    Graduate(kNear);
    Graduate(kFar);
    Improve();
    return;
  }
  bool settled = IsSettled(RunQuick());
  if (settled) {
    settled = size > kMaxGrowthWork
                  ? !OtherStartIsLower()
                  : !FindsLostGroup(absl::nullopt) && !GncFindsAnother();
  }
  if (settled && (continued_ || size > kMaxGrowthWork ||
                  (size > kSmallGraph && FitsByChance() < kFewByChance))) {
    if (size <= kMaxGrowthWork) Graduate(kNear);
    return;
  }
  if (size > kMaxGrowthWork && (SettleBySupport() || SettleByReplay())) return;
  // Where many loops contradict a map that the robust kernels agree on, or that
  // is the best so far of a graph on which each solution counts, the solvers
  // that keep them all are far off.
  RunStarts(!continued_ && CanKeepAllLoops() &&
            ((!settled && size <= kMaxGrowthWork) ||
             CountRejected() <= 0.25 * num_loops_));
  if (!settled && (size <= kMaxGrowthWork || ExplainsNothing() ||
                   (!AddCertain() && HasLostNearlyAll()))) {
    RunGroups();
  } else {
    Graduate(kNear);
    Graduate(kFar);
    // Kernels agree on what they reject alike, too.
    if (settled && size <= kSmallGraph) Regrow();
  }
  Improve();
}

void Portfolio::Continue(const std::vector<Member>& known) {
  continued_ = true;
  std::vector<double> costs;
  for (const Member& member : known) {
    // One and the same optimum.
    const bool again =
        std::any_of(costs.begin(), costs.end(), [&](const double cost) {
          return std::abs(member.cost - cost) <= kSame * cost;
        });
    if (again) continue;
    costs.push_back(member.cost);
    Add(member.name, member.poses);
  }
  Run();
}

void Portfolio::Soften() {
  // Wide enough for what lies just beyond the gate to count.
  for (const KernelType type : {KernelType::kDcs, KernelType::kGemanMcClure}) {
    SolverOptions options;
    options.kernel = DefaultKernel(type);
    options.kernel.parameter = kChi2Gate;
    if (Size() > kMaxGrowthWork) options.cost_tolerance = kRoughly;
    std::vector<Pose2> poses = best().poses;
    Count(solver_.Solve(options, &poses));
    Add(Suffixed(best().name, ", softened"), std::move(poses));
  }
}

void Portfolio::Graduate(const double reach) {
  GncOptions options;
  options.reach = reach * kChi2Gate;
  std::vector<Pose2> poses = best().poses;
  Count(SolveGnc(options, &solver_, &poses, nullptr));
  Add(Suffixed(best().name, ", graduated"), std::move(poses));
}

void Portfolio::Improve() {
  Soften();
  std::vector<Pose2> poses = best().poses;
  if (FlipLoops(flip_options(), &solver_, &poses) > 0) {
    Add(absl::StrCat(best().name, ", moved"), std::move(poses));
  }
  // To the last digit, which decisions near the gate may depend on.
  SolverOptions options;
  options.edge_weights = DecideLoops(edges_, best().poses, kChi2Gate);
  options.cost_tolerance = 1e-12;
  options.max_iterations = options_.max_iterations;
  poses = best().poses;
  Count(solver_.Solve(options, &poses));
  Add(best().name, std::move(poses));
}

}  // namespace optimization
}  // namespace cartographer_ext
