// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
//
// The parts of the search that start anew: incremental replays, other initial
// poses, and groups of loops.
#include <algorithm>
#include <utility>

#include "absl/strings/str_cat.h"
#include "cartographer_ext/optimization/offline/decision_moves.h"
#include "cartographer_ext/optimization/offline/loop_growth.h"
#include "cartographer_ext/optimization/offline/portfolio.h"
#include "cartographer_ext/optimization/offline/readmission.h"
#include "cartographer_ext/optimization/offline/starts/joined_trajectories.h"
#include "cartographer_ext/optimization/offline/starts/starts.h"

namespace cartographer_ext {
namespace optimization {
namespace {

// chi2 of an odometry edge that the digits of a file leave.
constexpr double kRounding = 1e-3;
// Poses times loops up to which groups are forced in more than once: at the end
// of a replay, and from chordal relaxations.
constexpr double kMaxRepeatedWork = 2e6;
// Rounds of the search by groups, as long as each finds a loop.
constexpr int kMaxGroupRounds = 4;

// Whether the poses differ from chained odometry by rounding only.
bool AreChained(const std::vector<WhitenedEdge>& edges,
                const std::vector<Pose2>& poses) {
  for (const WhitenedEdge& edge : edges) {
    if (!edge.is_loop &&
        !(Chi2(edge, poses[edge.from], poses[edge.to]) < kRounding)) {
      return false;
    }
  }
  return true;
}

}  // namespace

void Portfolio::AddSolversOf(const Portfolio& other) {
  for (const std::vector<Pose2>& poses : other.results_of_solvers_) {
    const double cost = TruncatedCost(edges_, poses);
    lowest_of_solvers_ = std::min(lowest_of_solvers_, cost);
    if (cost < best().cost) Add("noise", poses);
    results_of_solvers_.push_back(poses);
  }
  ran_all_solvers_ = ran_all_solvers_ && other.ran_all_solvers_;
}

bool Portfolio::AddReplay(ReplayResult* const replay) {
  if (!Replay(graph_, options_.smoother, replay).ok()) return false;
  replayed_ = true;
  NoteSolver(replay->poses);
  Add("r_isam", replay->poses);
  if (Size() <= kMaxRepeatedWork && ReadmitGroups(graph_, replay)) {
    NoteSolver(replay->poses);
    Add("r_isam, readmitted", replay->poses);
  }
  return true;
}

bool Portfolio::SettleByReplay() {
  ReplayResult replay;
  return AddReplay(&replay) &&
         IsSettled(AddKernels("r_isam, ", replay.poses, false));
}

void Portfolio::AddReplays() {
  ReplayResult replay;
  const bool again = replayed_;
  if (again || AddReplay(&replay)) {
    if (!again) AddKernel("r_isam, ", KernelType::kDcs, replay.poses);
    if (graph_.poses.size() > kLargeGraph) return;
    // The failures of a softer and of a harder epoch kernel differ.
    SmootherOptions softer = options_.smoother;
    softer.epoch_kernel.parameter *= 4.;
    if (Replay(graph_, softer, &replay).ok()) Add("r_isam, soft", replay.poses);
  } else if (JoinTrajectories(graph_, options_.smoother, &replay.poses)) {
    Add("joined", replay.poses);
  }
}

void Portfolio::AddGrowth(const std::vector<Pose2>& start) {
  std::vector<Pose2> poses = start;
  std::vector<double> weights;
  if (!GrowLoops(support(), GrowthOptions(), &solver_, &poses, &weights)) {
    return;
  }
  Add("growth", poses);
  AddKernel("growth, ", KernelType::kDcs, poses);
}

void Portfolio::RunStarts(const bool with_full_kernels) {
  if (with_full_kernels && !ran_full_kernels_) {
    AddFullKernels("", graph_.poses);
  }
  AddReplays();
  const std::vector<Pose2> chained = ChainOdometry(graph_);
  const bool same = AreChained(edges_, graph_.poses);
  if (!same) AddKernels("odometry, ", chained, with_full_kernels);
  if (!CanKeepAllLoops()) return;
  if (!ran_gnc_) AddGnc("", graph_.poses);
  if (!same) AddGnc("odometry, ", chained);
  if (continued_) return;
  std::vector<Pose2> chordal = chained;
  if (RobustChordalPoses(edges_, &chordal)) {
    AddKernels("chordal, ", chordal, with_full_kernels);
    AddGnc("chordal, ", chordal);
  }
  const std::vector<Pose2> tree =
      SpanningTree(graph_, std::vector<double>(edges_.size(), 1.));
  AddKernels("tree of all, ", tree, with_full_kernels);
  AddGnc("tree of all, ", tree);
  // R-iSAM alone readmits groups in larger graphs than here.
  ran_all_solvers_ = Size() <= kMaxRepeatedWork || Size() > kMaxGrowthWork;
}

void Portfolio::RunGroups() {
  starts_alone_ = false;
  AddGrowth(ChainOdometry(graph_));
  AddKernel("tree, ", KernelType::kGemanMcClure,
            SpanningTree(graph_, DecideLoops(edges_, best().poses, kChi2Gate)));
  const std::vector<double> supported = SupportedLoops();
  for (int round = 0; round != kMaxGroupRounds; ++round) {
    const double before = best().cost;
    const std::vector<double> in_force =
        DecideLoops(edges_, best().poses, kChi2Gate);
    for (const auto* const weights : {&in_force, &supported}) {
      std::vector<Pose2> poses = best().poses;
      if (!ChordalPoses(edges_, *weights, &poses)) continue;
      AddKernel("relaxed, ", KernelType::kDcs, poses);
      AddKernel("relaxed, ", KernelType::kAcs, poses);
      if (CanKeepAllLoops()) AddGnc("relaxed, ", poses);
    }
    ForceOptions force;
    force.relax = Size() <= kMaxRepeatedWork;
    AddForced(best().name, force);
    Graduate(kNear);
    Graduate(kFar);
    if (best().cost > before - kChi2Gate) break;
  }
  std::vector<Pose2> poses = best().poses;
  if (RegrowGroups(support(), RegrowOptions(), &solver_, &poses,
                   &alternatives_) > 0) {
    Add(absl::StrCat(best().name, ", regrown"), std::move(poses));
  }
}

}  // namespace optimization
}  // namespace cartographer_ext
