// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
#include "cartographer_ext/loop_closure/candidate_search/search_credit.h"

#include <algorithm>

namespace cartographer_ext {
namespace loop_closure {
namespace {

// Half widths of windows, square metres times radians: up to the first a search
// costs nothing worth counting, from the second on as much as any.
constexpr double kNarrowWindow = 10.;
constexpr double kWidestWindow = 200.;
constexpr double kWorkOfWholeSubmap = 0.25;
// Nodes are usually nearer to each other than this, and no two are paid for more,
// metres.
constexpr double kUsualSpacing = 0.5;
constexpr double kWidestSpacing = 5.;

}  // namespace

constexpr double SearchCredit::kCreditPerNode;
constexpr double SearchCredit::kCreditPerMetre;
constexpr double SearchCredit::kMostCredit;
constexpr double SearchCredit::kRewardFactor;

double SearchWork(const SearchPlan& plan) {
  if (plan.full_submap) return kWorkOfWholeSubmap;
  const double window =
      plan.linear_window * plan.linear_window * plan.angular_window;
  return window <= kNarrowWindow ? 0. : std::min(1., window / kWidestWindow);
}

absl::optional<uncertainty::NodeId> SearchCredit::NewestNode(
    const int trajectory_id) const {
  const auto found = newest_nodes_.find(trajectory_id);
  if (found == newest_nodes_.end()) return absl::nullopt;
  return uncertainty::NodeId{trajectory_id, found->second};
}

void SearchCredit::AddNode(const uncertainty::NodeId& node,
                           const double distance) {
  const auto added = newest_nodes_.emplace(node.trajectory_id, node.node_index);
  if (!added.second) {
    if (added.first->second >= node.node_index) return;
    added.first->second = node.node_index;
  }
  const double beyond =
      std::max(0., std::min(kWidestSpacing, distance) - kUsualSpacing);
  credit_ = std::min(kMostCredit,
                     credit_ + kCreditPerNode + kCreditPerMetre * beyond);
}

bool SearchCredit::Pay(const SearchPlan& plan) {
  const double work = SearchWork(plan);
  if (work > credit_) return false;
  credit_ -= work;
  return true;
}

void SearchCredit::Reward(const SearchPlan& plan) {
  credit_ = std::min(kMostCredit, credit_ + kRewardFactor * SearchWork(plan));
}

}  // namespace loop_closure
}  // namespace cartographer_ext
