// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
//
// What the neighbours of a match say about it. Each of them was searched where
// the match predicts it, and found or missed. The shares of neighbours that are
// found differ from place to place, so they are integrated over Beta
// distributions, which have the ratio of the marginal likelihoods of f found and
// m missed in closed form:
//
//                              L(2, 1)
//   odds(f, m) = ---------------------------------,
//                (1 - w) L(1, b) + w L(2, 1)
//
//   L(a, b) = B(a + f, b + m) / B(a, b),
//
// with B the beta function. At the right place most neighbours are found, at a
// wrong one few of them, b = 4, or more, b = 2, where passing verification is
// enough to be found; except that w of the wrong places look like the right one
// as far as the robot sees: no number of neighbours gives more than the odds
// 1 / w. How many those are depends on the building and on what the laser sees
// of it; matches that are certainly wrong tell.
#ifndef CARTOGRAPHER_EXT_LOOP_CLOSURE_CONSENSUS_NEIGHBOUR_ODDS_H_
#define CARTOGRAPHER_EXT_LOOP_CLOSURE_CONSENSUS_NEIGHBOUR_ODDS_H_

namespace cartographer_ext {
namespace loop_closure {

// How many neighbours of a match, of those where the robot had been, were found
// where it predicts them (dropin/second_look.h).
struct FollowedMatch {
  int num_found = 0;
  int num_missed = 0;
  // Whether neighbours that are verified, but rather false than true, count as
  // found. Where a place is seen from another side than before, or from a bent
  // path, right ones are no better.
  bool by_verification = false;
};

// The share w of wrong places that look like the right one.
class ShareAlike {
 public:
  // Adds the neighbours of a wrong match, if there are any.
  void AddWrong(const FollowedMatch& followed);
  // The mean of its distribution: a tenth before wrong matches are known, which
  // weighs as much as five of them.
  double Mean() const;
  int num_wrong() const { return num_wrong_; }

 private:
  int num_wrong_ = 0;
  int num_alike_ = 0;
};

// Factor on the odds that a match is right; 1 without neighbours. `share_alike`
// in [0, 1].
double OddsOfNeighbours(const FollowedMatch& followed, double share_alike);

}  // namespace loop_closure
}  // namespace cartographer_ext

#endif  // CARTOGRAPHER_EXT_LOOP_CLOSURE_CONSENSUS_NEIGHBOUR_ODDS_H_
