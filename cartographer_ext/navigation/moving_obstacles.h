// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
//
// Follows what moves: echoes that the map does not explain are joined into
// clusters, clusters into tracks with a velocity (alpha-beta filter). A track
// that is out of sight goes on with its velocity for a while.
#ifndef CARTOGRAPHER_EXT_NAVIGATION_MOVING_OBSTACLES_H_
#define CARTOGRAPHER_EXT_NAVIGATION_MOVING_OBSTACLES_H_

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
  double memory_seconds = 2.;  // out of sight
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

  // Echoes that no wall explains, in order of their beams.
  void Update(const std::vector<Echo>& echoes, double time);

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
    double seen = 0.;  // time of the last cluster
    int updates = 1;
    bool is_stationary = false;
  };

  std::vector<Cluster> FindClusters(const std::vector<Echo>& echoes) const;

  const MovingObstacleOptions options_;
  std::vector<Track> tracks_;
};

}  // namespace navigation
}  // namespace cartographer_ext

#endif  // CARTOGRAPHER_EXT_NAVIGATION_MOVING_OBSTACLES_H_
