// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
#include "cartographer_ext/loop_closure/consensus/drift_learner.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <utility>
#include <vector>

#include "cartographer_ext/common/squared.h"
#include "cartographer_ext/loop_closure/consensus/path_agreement.h"
#include "glog/logging.h"

namespace cartographer_ext {
namespace loop_closure {
namespace {

using uncertainty::CommonDrift;
using uncertainty::CovarianceParts;
using uncertainty::DriftCycle;
using uncertainty::DriftEstimate;
using uncertainty::DriftFactors;
using uncertainty::DriftStretch;
using uncertainty::LoopEdge;
using uncertainty::VertexId;

// Nearer loops see the same errors of the match and too little of the path;
// farther ones are no longer of one revisit. Metres along the path.
constexpr double kNearestLoop = 3.;
constexpr double kFarthestLoop = 15.;
// Loops remembered of a trajectory, oldest forgotten first.
constexpr size_t kMaxLoops = 500;
// Over long paths, the oldest forgotten first.
constexpr size_t kMaxLongLoops = 100;
// Least factors of the rotation where many matches are wrong, and the shares of
// wrong ones that are few and many.
constexpr double kLeastFactor = 0.2;
constexpr double kFewWrong = 0.2;
constexpr double kManyWrong = 0.5;
// Change of the logarithm of a factor that matters.
constexpr double kNoticeableChange = 0.1;
// Of the relative error of the rotations along a run.
constexpr double kTurningChanges = 0.005;
// Cycles are worth another fit when there are this many times those before.
constexpr double kLeastGrowth = 1.1;

bool Differ(const double a, const double b) {
  return std::abs(std::log(a / b)) > kNoticeableChange;
}

bool Differ(const DriftFactors& a, const DriftFactors& b) {
  return Differ(a.translation, b.translation) ||
         Differ(a.rotation, b.rotation) || Differ(a.turning, b.turning);
}

// Against how well it is known.
bool Differ(const CommonDrift& a, const CommonDrift& b) {
  for (int i = 0; i < 3; ++i) {
    const double sigma = std::sqrt(a.covariance(i, i));
    const double other_sigma = std::sqrt(b.covariance(i, i));
    if (std::abs(a.mean(i) - b.mean(i)) > 0.3 * sigma ||
        std::abs(sigma - other_sigma) > 2. * kNoticeableChange * sigma) {
      return true;
    }
  }
  return false;
}

// See the head of drift_learner.h.
double LeastFactor(const double share_wrong) {
  const double many = (share_wrong - kFewWrong) / (kManyWrong - kFewWrong);
  return std::pow(kLeastFactor, std::min(1., std::max(0., many)));
}

// Of one stretch of the path and another one that may overlap.
bool Overlap(const LoopEdge& u, const LoopEdge& v) {
  return std::max(u.a.index(), v.a.index()) >
         std::min(u.b.index(), v.b.index());
}

}  // namespace

DriftLearner::Trajectory::Trajectory()
    : estimator(uncertainty::DriftEstimatorOptions()) {}

DriftLearner::DriftLearner(const uncertainty::PathNoiseOptions& prior,
                           uncertainty::PathUncertainty* const paths)
    : prior_(prior), paths_(CHECK_NOTNULL(paths)) {}

absl::optional<DriftStretch> DriftLearner::Stretch(const VertexId& from,
                                                   const VertexId& to) const {
  const absl::optional<CovarianceParts> parts = paths_->Parts(from, to);
  if (!parts.has_value()) return absl::nullopt;
  DriftStretch stretch;
  stretch.pose = Between(*paths_->LocalPose(from), *paths_->LocalPose(to));
  stretch.parts = *parts;
  return stretch;
}

absl::optional<DriftCycle> DriftLearner::CycleWithPath(
    const LoopEdge& loop) const {
  const absl::optional<double> travelled = paths_->Travelled(loop.a, loop.b);
  if (!travelled.has_value() || *travelled > kLongPath) return absl::nullopt;
  return CycleOfLoop(loop.pose, *Stretch(loop.b, loop.a));
}

absl::optional<DriftCycle> DriftLearner::CycleWithLoop(
    const LoopEdge& u, const LoopEdge& v) const {
  const absl::optional<DriftStretch> path_b = Stretch(u.b, v.b);
  const absl::optional<DriftStretch> path_a = Stretch(v.a, u.a);
  if (!path_a.has_value() || !path_b.has_value()) return absl::nullopt;
  return CycleOfLoops(u.pose, *path_b, v.pose, *path_a);
}

void DriftLearner::AddLongLoop(const LoopEdge& loop,
                               Trajectory* const trajectory) {
  const absl::optional<double> travelled = paths_->Travelled(loop.a, loop.b);
  if (!travelled.has_value() || *travelled <= kLongPath) return;
  for (const LongLoop& other : trajectory->long_loops) {
    const absl::optional<double> a = paths_->Travelled(other.edge.a, loop.a);
    const absl::optional<double> b = paths_->Travelled(other.edge.b, loop.b);
    if (a.has_value() && b.has_value() && std::max(*a, *b) < kFarthestLoop) {
      return;
    }
  }
  LongLoop found;
  found.edge = loop;
  found.heading = HeadingOfLoop(loop.pose, *Stretch(loop.b, loop.a));
  found.heading.length = *travelled;
  trajectory->long_loops.push_back(found);
  if (trajectory->long_loops.size() > kMaxLongLoops) {
    trajectory->long_loops.pop_front();
  }
}

void DriftLearner::DropForgotten(std::deque<LongLoop>* const loops) const {
  loops->erase(
      std::remove_if(loops->begin(), loops->end(),
                     [this](const LongLoop& loop) {
                       return !paths_->LocalPose(loop.edge.a).has_value() ||
                              !paths_->LocalPose(loop.edge.b).has_value();
                     }),
      loops->end());
}

double DriftLearner::Driven(const Trajectory& trajectory) const {
  const VertexId* first = nullptr;
  const VertexId* last = nullptr;
  for (const LongLoop& loop : trajectory.long_loops) {
    for (const VertexId* const end : {&loop.edge.a, &loop.edge.b}) {
      if (first == nullptr || end->index() < first->index()) first = end;
      if (last == nullptr || end->index() > last->index()) last = end;
    }
  }
  return first == nullptr ? 0. : paths_->Travelled(*first, *last).value_or(0.);
}

void DriftLearner::Add(const LoopEdge& loop, const double window) {
  if (!loop.a.InSequenceWith(loop.b)) return;
  Trajectory& trajectory = trajectories_[loop.b.trajectory_id()];
  AddLongLoop(loop, &trajectory);
  // The nearest loop of the same revisit.
  const FoundLoop* nearest = nullptr;
  double nearest_distance = kFarthestLoop;
  for (const FoundLoop& other : trajectory.loops) {
    const absl::optional<double> a = paths_->Travelled(other.edge.a, loop.a);
    const absl::optional<double> b = paths_->Travelled(other.edge.b, loop.b);
    if (!a.has_value() || !b.has_value()) continue;
    const double distance = std::max(*a, *b);
    if (distance >= nearest_distance) continue;
    nearest_distance = distance;
    nearest = &other;
  }
  if (nearest != nullptr && nearest_distance < kNearestLoop) return;
  absl::optional<DriftCycle> cycle = CycleWithPath(loop);
  if (cycle.has_value()) {
    cycle->window = window;
  } else if (nearest != nullptr && !Overlap(nearest->edge, loop)) {
    cycle = CycleWithLoop(nearest->edge, loop);
    if (cycle.has_value()) cycle->window = std::max(nearest->window, window);
  }
  if (cycle.has_value()) trajectory.estimator.Add(*cycle);
  trajectory.loops.push_back(FoundLoop{loop, window});
  if (trajectory.loops.size() > kMaxLoops) trajectory.loops.pop_front();
}

void DriftLearner::Fit(Trajectory* const trajectory) {
  // Headings alone tell nothing of the translation.
  const int num_short = trajectory->estimator.num_cycles();
  if (num_short == 0) return;
  DropForgotten(&trajectory->long_loops);
  const int num_cycles =
      num_short + static_cast<int>(trajectory->long_loops.size());
  if (num_cycles < kLeastGrowth * trajectory->num_fitted + 1) return;
  trajectory->num_fitted = num_cycles;
  std::vector<uncertainty::HeadingCycle> headings;
  for (const LongLoop& loop : trajectory->long_loops) {
    headings.push_back(loop.heading);
  }
  trajectory->estimator.SetHeadings(std::move(headings), Driven(*trajectory));
  trajectory->fit = trajectory->estimator.Fit();
}

bool DriftLearner::Update(const double share_wrong) {
  bool any = false;
  for (auto& entry : trajectories_) {
    Trajectory& trajectory = entry.second;
    Fit(&trajectory);
    if (trajectory.num_fitted == 0) continue;
    const double least = LeastFactor(share_wrong);
    DriftFactors factors = trajectory.fit.upper;
    factors.translation = std::max(1., factors.translation);
    factors.rotation = std::max(least, factors.rotation);
    factors.turning = std::max(least, factors.turning);
    // Nothing is as constant as the model says.
    CommonDrift common = trajectory.fit.common;
    Eigen::Matrix3d changes = PriorCommonDrift(prior_).covariance;
    changes(0, 0) *= Squared(std::min(1., factors.rotation));
    changes(1, 1) = Squared(kTurningChanges);
    common.covariance += changes;
    if (!Differ(factors, paths_->Drift(entry.first)) &&
        !Differ(common, paths_->Common(entry.first))) {
      continue;
    }
    paths_->SetDrift(entry.first, factors, common);
    any = true;
  }
  return any;
}

DriftEstimate DriftLearner::Estimate(const int trajectory_id) const {
  DriftEstimate estimate;
  estimate.mean = prior_;
  estimate.upper = Scaled(prior_, paths_->Drift(trajectory_id));
  estimate.common = paths_->Common(trajectory_id);
  const auto found = trajectories_.find(trajectory_id);
  if (found == trajectories_.end()) return estimate;
  estimate.mean = Scaled(prior_, found->second.fit.mean);
  estimate.num_cycles =
      found->second.num_fitted == 0 ? 0 : found->second.estimator.num_cycles();
  return estimate;
}

std::map<int, DriftEstimate> DriftLearner::Estimates() const {
  std::map<int, DriftEstimate> estimates;
  for (const auto& entry : trajectories_) {
    estimates[entry.first] = Estimate(entry.first);
  }
  return estimates;
}

void DriftLearner::DeleteTrajectory(const int trajectory_id) {
  trajectories_.erase(trajectory_id);
}

}  // namespace loop_closure
}  // namespace cartographer_ext
