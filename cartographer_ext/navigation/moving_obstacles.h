// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
//
// Tracks moving obstacles: echoes that the map does not explain are joined into
// clusters, clusters into tracks with a velocity (alpha-beta filter). A track
// that is not seen is extrapolated for a while: for longer outside the field of
// view, as behind a robot whose laser covers 180 degrees.
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
  double gate = 0.6;           // metres from the predicted position
  double moving_speed = 0.3;   // m/s: slower is stationary
  double max_speed = 2.;       // m/s
  double memory_seconds = 2.;  // in view, but hidden or missed
  // Outside the field of view. A walking person overtakes the robot within this
  // time or has left.
  double unseen_memory_seconds = 5.;
  // Metres from where a track began; less may be a change of the visible side.
  double min_displacement = 0.15;
  // Seconds for which a moving track may be slow, as a person turning round.
  double slow_seconds = 1.;
  double old_seconds = 1.2;    // echoes of this age do not move
  double max_old_share = 0.3;  // of the echoes of a moving track
  int min_updates = 3;         // before a velocity is used
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

  // Whether a point (map frame) is in the field of view.
  using InView = std::function<bool(const Eigen::Vector2d& point)>;

  // Echoes that no wall explains, in order of their beams. Without `in_view`
  // the field of view is unlimited.
  void Update(const std::vector<Echo>& echoes, double time,
              const InView& in_view = nullptr);

  // The moving tracks at their positions at `time`.
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
