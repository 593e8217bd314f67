// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
//
// Bounds the cost of wide searches, per node and over the whole run.
//
// The cost of a search grows with its window, and is largest if there is no
// match. A window of 15 m takes a hundred times as long as one of a metre; a
// whole submap, in which the place is first searched roughly, a quarter of that.
// So wide searches consume credit. Every node earns a little, more where nodes
// are far apart, so that the cost per metre neither grows with the length of the
// run nor falls with the rate of the scans; credit is accumulated up to a limit,
// to be available where it is needed; and wide searches that lead to accepted
// loops earn more.
//
// Depends on the sequence of calls only. Not thread-safe.
#ifndef CARTOGRAPHER_EXT_LOOP_CLOSURE_CANDIDATE_SEARCH_SEARCH_CREDIT_H_
#define CARTOGRAPHER_EXT_LOOP_CLOSURE_CANDIDATE_SEARCH_SEARCH_CREDIT_H_

#include <map>

#include "absl/types/optional.h"
#include "cartographer_ext/loop_closure/candidate_search/search_result.h"
#include "cartographer_ext/uncertainty/ids.h"

namespace cartographer_ext {
namespace loop_closure {

// Cost of a search, in units of a search in the widest window; 0 for a narrow
// one.
double SearchWork(const SearchPlan& plan);

// Credit for wide searches, see above.
class SearchCredit {
 public:
  // In searches of the widest window.
  static constexpr double kCreditPerNode = 0.2;
  static constexpr double kCreditPerMetre = 1.;  // beyond the usual spacing
  static constexpr double kMostCredit = 50.;
  static constexpr double kRewardFactor = 10.;

  // Adds a node that may be searched, metres from the one before. Each earns once;
  // nodes of a trajectory must be added in order.
  void AddNode(const uncertainty::NodeId& node, double distance);
  // The newest node of a trajectory.
  absl::optional<uncertainty::NodeId> NewestNode(int trajectory_id) const;
  // Returns false, without paying, if there is not enough credit.
  bool Pay(const SearchPlan& plan);
  // Called when a paid search has led to an accepted loop.
  void Reward(const SearchPlan& plan);

  double credit() const { return credit_; }

 private:
  double credit_ = kMostCredit;
  std::map<int, int> newest_nodes_;  // by trajectory
};

}  // namespace loop_closure
}  // namespace cartographer_ext

#endif  // CARTOGRAPHER_EXT_LOOP_CLOSURE_CANDIDATE_SEARCH_SEARCH_CREDIT_H_
