// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
//
// Where in a map is a run, when places look alike? One scan does not decide it,
// a sequence of scans does: several places are followed at a time.
//
//   track      A place that the search of the whole map has found for a node,
//              and what follows from it for the nodes before and after by the
//              motion of the run: at each of them the best match nearby.
//   decision   The track with the best mean score, once it is ahead of every
//              other place significantly. With d_k the difference of the scores
//              of node k in the two tracks, over the newest n nodes,
//
//                mean(d) >= z max(std(d), s) / sqrt(n)
//
//              The same scans are compared with two places, so that whatever
//              else makes scores good or bad (people, clutter, a poor map) is
//              common to both and drops out.
//
// Where the search finds a node to fit far better than any track expected, and
// the node before does not fit there, the motion between the two cannot be
// right (the robot was carried, or local SLAM went astray); what was before is
// forgotten.
//
// Of tracks at the same place the better one is kept. Bounded: the newest nodes
// and the best tracks are kept. Not thread-safe; depends on the calls in their
// order only.
#ifndef CARTOGRAPHER_EXT_LOOP_CLOSURE_RELOCALIZATION_PLACE_TRACKER_H_
#define CARTOGRAPHER_EXT_LOOP_CLOSURE_RELOCALIZATION_PLACE_TRACKER_H_

#include <cstddef>
#include <deque>
#include <functional>
#include <vector>

#include "absl/types/optional.h"
#include "cartographer_ext/common/pose2.h"

namespace cartographer_ext {
namespace loop_closure {

// Limits and tolerances of the tracks.
struct PlaceTrackerOptions {
  // Nodes along which places are followed and compared, > 0. More separate
  // places that look very much alike, and cost more.
  int max_nodes = 16;
  int max_tracks = 10;        // > 0
  int min_nodes = 4;          // of a decision, > 0
  double significance = 3.;   // z above, >= 0
  double sigma_floor = 0.01;  // s above, > 0
  // Poses closer than this are the same place, metres and radians. Submaps of
  // several visits are a little off each other before the map is optimised.
  double same_metres = 1.2;
  double same_radians = 0.15;
  // Scores that differ by more show that the motion was wrong.
  double break_margin = 0.1;
  // Of a node that has no match where a track says it is.
  double score_without_match = 0.3;
};

// Where a node fits.
struct PlaceMatch {
  int submap_index = 0;
  Pose2 pose;  // (local frame of the map <- node)
  double score = 0.;
};

// Tracks hypotheses of the place of a run, see above.
class PlaceTracker {
 public:
  // The best match of a kept node near a guess (local frame of the map <-
  // node), if the map has one.
  using Matcher = std::function<absl::optional<PlaceMatch>(int node_index,
                                                           const Pose2& guess)>;

  explicit PlaceTracker(const PlaceTrackerOptions& options)
      : options_(options) {}

  // The next node of the run, (local frame of the run <- node), and where the
  // search of the whole map has found it.
  void AddNode(int node_index, const Pose2& local_pose,
               const std::vector<PlaceMatch>& found, const Matcher& matcher);

  struct Decision {
    bool decided = false;
    // Lead of the best place over the next one: mean difference of the scores,
    // and in standard deviations; infinite if there is no other one.
    double lead = 0.;
    double significance = 0.;
    // Of the best place, with the newest node last. Nodes without a match are
    // missing.
    std::vector<int> nodes;
    std::vector<PlaceMatch> matches;
  };
  // Over the newest `max_nodes` nodes.
  Decision Decide(int max_nodes) const;

  bool IsSamePlace(const Pose2& a, const Pose2& b) const;

  // Drops nodes up to an index, and places supported only by them.
  void DeleteNodes(int last_node_index);
  // Index of the oldest node that is kept, -1 if none.
  int oldest_node() const;
  int num_nodes() const { return static_cast<int>(nodes_.size()); }
  int num_tracks() const { return static_cast<int>(tracks_.size()); }

 private:
  struct Node {
    int index;
    Pose2 local_pose;
  };
  struct Step {
    Pose2 pose;  // of the match, or where the track expected it
    absl::optional<PlaceMatch> match;
  };
  struct Track {
    std::deque<Step> steps;  // as nodes_
  };

  Step Follow(const Step& from, const Node& from_node, const Node& to_node,
              const Matcher& matcher) const;
  double Score(const Step& step) const;
  double MeanScore(const Track& track, int max_nodes) const;
  Track StartTrack(const PlaceMatch& found, const Matcher& matcher) const;
  void ForgetBefore(size_t node);
  void Prune();

  const PlaceTrackerOptions options_;
  std::deque<Node> nodes_;
  std::vector<Track> tracks_;
};

}  // namespace loop_closure
}  // namespace cartographer_ext

#endif  // CARTOGRAPHER_EXT_LOOP_CLOSURE_RELOCALIZATION_PLACE_TRACKER_H_
