// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
//
// Follows what moves: echoes that the map does not explain are joined into
// clusters, clusters into tracks with a velocity (alpha-beta filter). A track
// that is out of sight goes on with its velocity for a while: for longer where
// the laser does not look, as behind a robot whose laser sees half a turn.
#ifndef CARTOGRAPHER_EXT_NAVIGATION_MOVING_OBSTACLES_H_
#define CARTOGRAPHER_EXT_NAVIGATION_MOVING_OBSTACLES_H_

#include <functional>
#include <vector>

#include "Eigen/Core"

namespace cartographer_ext {
namespace navigation {

struct MovingObstacleOptions {
  double join_distance = 0.3;  // metres between echoes of one cluster
  double max_extent = 1.2;     // metres; larger clusters are not people
  double gate = 0.6;           // metres from the predicted place
  double moving_speed = 0.3;   // m/s: slower is taken for standing
  double max_speed = 2.;       // m/s
  double memory_seconds = 2.;  // in view, but hidden or missed
  // Where no beam goes. At a walking pace somebody overtakes a robot within
  // this time or has turned elsewhere.
  double unseen_memory_seconds = 5.;
  // Metres from where a track began: less is a change of the aspect.
  double min_displacement = 0.15;
  // Somebody who turns round is slow for a moment.
  double slow_seconds = 1.;
  double old_seconds = 1.2;    // echoes of this age do not move
  double max_old_share = 0.3;  // of the echoes of what moves
  int min_updates = 3;         // before a velocity is believed
  double position_gain = 0.7;  // alpha
  double velocity_gain = 0.4;  // beta
  int max_tracks = 100;
};

struct MovingDisc {
  Eigen::Vector2d position = Eigen::Vector2d::Zero();  // metres, map frame
  Eigen::Vector2d velocity = Eigen::Vector2d::Zero();  // m/s
  double radius = 0.;

  Eigen::Vector2d At(const double seconds) const {
    return position + seconds * velocity;
  }
};

class MovingObstacles {
 public:
  explicit MovingObstacles(const MovingObstacleOptions& options)
      : options_(options) {}

  struct Echo {
    Eigen::Vector2d point;  // map frame
    // Seconds for which there has been an echo at this place.
    double age = 0.;
  };

  // Whether a beam of the scan goes towards a point (map frame).
  using InView = std::function<bool(const Eigen::Vector2d& point)>;

  // Echoes that no wall explains, in order of their beams. Without `in_view`
  // the laser looks everywhere.
  void Update(const std::vector<Echo>& echoes, double time,
              const InView& in_view = nullptr);

  // The tracks that move, where they are at `time`.
  std::vector<MovingDisc> Moving(double time) const;

 private:
  struct Cluster {
    Eigen::Vector2d center = Eigen::Vector2d::Zero();
    double radius = 0.;
    double old_share = 0.;
  };
  struct Track {
    MovingDisc disc;
    Eigen::Vector2d begin = Eigen::Vector2d::Zero();  // first cluster
    double seen = 0.;        // time of the last cluster
    double missed = 0.;      // seconds in view without being seen
    double fast = -1e9;      // time when it was last faster than `moving_speed`
    bool has_moved = false;  // by more than `min_displacement`
    int updates = 1;
    bool is_stationary = false;
  };

  std::vector<Cluster> FindClusters(const std::vector<Echo>& echoes) const;
  void Correct(const Cluster& cluster, double time, Track* track) const;
  // Adds to the time that a track is missed in view.
  bool IsForgotten(double time, const InView& in_view, Track* track) const;

  const MovingObstacleOptions options_;
  std::vector<Track> tracks_;
  double updated_ = 0.;  // time of the last update
};

}  // namespace navigation
}  // namespace cartographer_ext

#endif  // CARTOGRAPHER_EXT_NAVIGATION_MOVING_OBSTACLES_H_
