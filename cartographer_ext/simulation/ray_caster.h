// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
//
// A floor plan seen by a horizontal laser: line segments and circles, and the
// exact ray casting against them.
//
// A ray o + t d (|d| = 1) meets the segment a + u (b - a) where
//   t = cross(a - o, b - a) / cross(d, b - a),  u = cross(a - o, d) / cross(d,
//   b - a)
// with 0 <= u <= 1, and the circle |p - c| = r at the smaller non-negative root
// of t^2 + 2 t d.(o - c) + |o - c|^2 - r^2 = 0 (a circle can be hit from
// inside: it is a round room as well as a pillar).
//
// The shapes are sorted into a uniform grid, and a ray walks the grid cell by
// cell (Amanatides and Woo 1987) until the nearest hit found lies before the
// next cell. The result does not depend on the grid: it is the minimum over the
// same closed formulas.
#ifndef CARTOGRAPHER_EXT_SIMULATION_RAY_CASTER_H_
#define CARTOGRAPHER_EXT_SIMULATION_RAY_CASTER_H_

#include <cstdint>
#include <limits>
#include <vector>

#include "Eigen/Core"

namespace cartographer_ext {
namespace simulation {

// An echo angle that leaves no beam out, a quarter turn.
constexpr double kAnyAngle = 1.57079632679489662;

// Reflectivity is in (0, 1]: a surface of reflectivity q returns no echo beyond
// sqrt(q) times the laser's range, since the echo of a diffuse surface fades
// with q / range^2.
//
// Clear glass reflects like a mirror: a beam comes back when it meets the pane
// nearly at a right angle, and goes through otherwise. `echo_angle` is the
// largest angle, in radians from the normal, at which the segment stops a beam.
struct Segment {
  Eigen::Vector2d a = Eigen::Vector2d::Zero();  // metres, world frame
  Eigen::Vector2d b = Eigen::Vector2d::Zero();
  double reflectivity = 1.;
  double echo_angle = kAnyAngle;
};

struct Disc {
  Eigen::Vector2d center = Eigen::Vector2d::Zero();  // metres, world frame
  double radius = 0.;
  double reflectivity = 1.;
};

constexpr double kNoHit = std::numeric_limits<double>::infinity();

// Distance along the ray to a shape, kNoHit where it is missed. `direction` has
// length 1.
double RayToSegment(const Eigen::Vector2d& origin,
                    const Eigen::Vector2d& direction, const Segment& segment);
double RayToDisc(const Eigen::Vector2d& origin,
                 const Eigen::Vector2d& direction, const Disc& disc);
double PointToSegment(const Eigen::Vector2d& point, const Segment& segment);

struct RayHit {
  double range = kNoHit;  // metres
  double reflectivity = 1.;
};

class RayCaster {
 public:
  RayCaster(std::vector<Segment> segments, std::vector<Disc> discs);

  // The nearest shape within `max_range` metres that stops the ray; range kNoHit
  // where there is none. `direction` has length 1. Any thread.
  RayHit Cast(const Eigen::Vector2d& origin, const Eigen::Vector2d& direction,
              double max_range) const;

  // Distance from a point to the nearest line of the plan, at most `limit`.
  double Clearance(const Eigen::Vector2d& point, double limit) const;

  // Whether the straight line between two points is free; one looks through
  // glass.
  bool Visible(const Eigen::Vector2d& from, const Eigen::Vector2d& to) const;

  const std::vector<Segment>& segments() const { return segments_; }
  const std::vector<Disc>& discs() const { return discs_; }
  // Bounding box of all shapes; empty (min > max) without shapes.
  const Eigen::Vector2d& min() const { return min_; }
  const Eigen::Vector2d& max() const { return max_; }

 private:
  double IntersectShape(int shape, const Eigen::Vector2d& origin,
                        const Eigen::Vector2d& direction) const;
  // Calls visit(cell) for every cell a shape's line passes (or a few more).
  template <typename Visitor>
  void VisitCells(int shape, const Visitor& visit) const;

  std::vector<Segment> segments_;
  std::vector<Disc> discs_;
  Eigen::Vector2d min_;
  Eigen::Vector2d max_;
  Eigen::Vector2d origin_;  // lower left corner of the grid
  double cell_size_ = 1.;
  int width_ = 0;
  int height_ = 0;
  // Shapes of cell c: cell_shapes_[cell_begin_[c]] ... cell_begin_[c + 1].
  // Shape s is segment s, or disc s - segments_.size().
  std::vector<int32_t> cell_begin_;
  std::vector<int32_t> cell_shapes_;
};

}  // namespace simulation
}  // namespace cartographer_ext

#endif  // CARTOGRAPHER_EXT_SIMULATION_RAY_CASTER_H_
