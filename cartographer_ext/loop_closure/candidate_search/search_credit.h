// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
//
// Bounds what wide searches cost, per node and over the whole run.
//
// The cost of a search grows with its window: that of a whole submap takes a
// hundred times as long as a window of a metre, and longest where nothing is
// found. So wide searches are paid for with credit. Every node earns a little,
// so that the cost per node stays flat however long the run; it is saved up to
// a limit, for the place where it is needed; and where wide searches lead to
// accepted loops, they earn more.
//
// Depends on the sequence of calls only. Not thread-safe.
#ifndef CARTOGRAPHER_EXT_LOOP_CLOSURE_CANDIDATE_SEARCH_SEARCH_CREDIT_H_
#define CARTOGRAPHER_EXT_LOOP_CLOSURE_CANDIDATE_SEARCH_SEARCH_CREDIT_H_

#include <map>

#include "cartographer_ext/loop_closure/candidate_search/search_result.h"
#include "cartographer_ext/uncertainty/ids.h"

namespace cartographer_ext {
namespace loop_closure {

// What a search costs, in searches of a whole submap; 0 for a narrow one.
double SearchWork(const SearchPlan& plan);

class SearchCredit {
 public:
  // In searches of whole submaps.
  static constexpr double kCreditPerNode = 0.2;
  static constexpr double kMostCredit = 50.;
  static constexpr double kRewardFactor = 10.;

  // A node that may be searched. Each earns once; nodes of a trajectory come in
  // order.
  void AddNode(const uncertainty::NodeId& node);
  // False without enough credit; nothing is paid then.
  bool Pay(const SearchPlan& plan);
  // A search that was paid for led to an accepted loop.
  void Reward(const SearchPlan& plan);

  double credit() const { return credit_; }

 private:
  double credit_ = kMostCredit;
  std::map<int, int> newest_nodes_;  // by trajectory
};

}  // namespace loop_closure
}  // namespace cartographer_ext

#endif  // CARTOGRAPHER_EXT_LOOP_CLOSURE_CANDIDATE_SEARCH_SEARCH_CREDIT_H_
