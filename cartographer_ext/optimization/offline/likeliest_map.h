// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
//
// The map that a search reports. The truncated cost, by which it is led, counts each
// loop for itself, and lets a loop in for the gate however far odometry has to bend. A
// group of wrong loops that agree with each other fits into some map as one, and the
// less is known of the path the more of them do. Of maps that may be reported the
// evidence decides (map_evidence.h), in which a group is one.
#ifndef CARTOGRAPHER_EXT_OPTIMIZATION_OFFLINE_LIKELIEST_MAP_H_
#define CARTOGRAPHER_EXT_OPTIMIZATION_OFFLINE_LIKELIEST_MAP_H_

#include <vector>

#include "cartographer_ext/optimization/offline/portfolio.h"

namespace cartographer_ext {
namespace optimization {

// Of the members that cost at most `limit`, that with the lowest cost by the gate of the
// odds, or where another map is likelier by odds of 1000, the same of what differs from
// that near the gate only.
// What is found on the way is added to the portfolio: single decisions changed in a
// map that is not the best, and groups of loops released that speak against a map.
const Portfolio::Member& LikeliestMember(double limit, Portfolio* portfolio);

// Of all members, whatever they cost, the likeliest map if it is likelier than `map` by
// odds of 1000 and decides loops otherwise than near the gate; empty if there is none.
// Not asked of large graphs.
std::vector<Pose2> FindLikelierMap(const std::vector<Pose2>& map,
                                   Portfolio* portfolio);

}  // namespace optimization
}  // namespace cartographer_ext

#endif  // CARTOGRAPHER_EXT_OPTIMIZATION_OFFLINE_LIKELIEST_MAP_H_
