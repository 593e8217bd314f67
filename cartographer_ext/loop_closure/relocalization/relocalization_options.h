// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
#ifndef CARTOGRAPHER_EXT_LOOP_CLOSURE_RELOCALIZATION_RELOCALIZATION_OPTIONS_H_
#define CARTOGRAPHER_EXT_LOOP_CLOSURE_RELOCALIZATION_RELOCALIZATION_OPTIONS_H_

#include "cartographer_ext/loop_closure/relocalization/map_localization.h"
#include "cartographer_ext/loop_closure/relocalization/place_tracker.h"

namespace cartographer_ext {
namespace loop_closure {

// Finding the place of a run in the finished map of another one.
struct RelocalizationOptions {
  // Otherwise whole submaps are searched one by one as the host proposes them.
  bool enabled = true;
  MapLocalizationOptions map;
  // Hard cap on submaps searched for one node, which bounds the work of a node
  // whatever the size of the map; the next node gets the others. > 0
  int max_submaps_per_query = 100;
  // Of the matches of one query the best, so many, are refined and followed,
  // since the true place need not be the best match of one scan. > 0
  int places_per_query = 6;
  PlaceTrackerOptions tracker;
};

}  // namespace loop_closure
}  // namespace cartographer_ext

#endif  // CARTOGRAPHER_EXT_LOOP_CLOSURE_RELOCALIZATION_RELOCALIZATION_OPTIONS_H_
