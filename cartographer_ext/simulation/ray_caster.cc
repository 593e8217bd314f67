// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
#include "cartographer_ext/simulation/ray_caster.h"

#include <algorithm>
#include <cmath>
#include <utility>

namespace cartographer_ext {
namespace simulation {
namespace {

// Cells are about half a metre, but never more than a million of them.
constexpr double kPreferredCellSize = 0.5;
constexpr double kMaxCells = 1e6;

double Cross(const Eigen::Vector2d& a, const Eigen::Vector2d& b) {
  return a.x() * b.y() - a.y() * b.x();
}

// Whether the ray goes through a pane that it meets at a slant.
bool Passes(const Eigen::Vector2d& direction, const Segment& segment) {
  const Eigen::Vector2d edge = segment.b - segment.a;
  return std::abs(direction.dot(edge)) >
         std::sin(segment.echo_angle) * edge.norm();
}

int Clamp(const double value, const int low, const int high) {
  if (!(value > low)) return low;
  if (value > high) return high;
  return static_cast<int>(value);
}

}  // namespace

double RayToSegment(const Eigen::Vector2d& origin,
                    const Eigen::Vector2d& direction, const Segment& segment) {
  const Eigen::Vector2d edge = segment.b - segment.a;
  const Eigen::Vector2d to_start = segment.a - origin;
  const double denominator = Cross(direction, edge);
  if (denominator == 0.) {
    // Parallel: seen end-on when it lies on the ray, missed otherwise.
    if (Cross(direction, to_start) != 0.) return kNoHit;
    const double first = to_start.dot(direction);
    const double second = (segment.b - origin).dot(direction);
    if (std::max(first, second) < 0.) return kNoHit;
    return std::max(0., std::min(first, second));
  }
  const double u = Cross(to_start, direction) / denominator;
  if (u < 0. || u > 1.) return kNoHit;
  const double t = Cross(to_start, edge) / denominator;
  return t >= 0. ? t : kNoHit;
}

double RayToDisc(const Eigen::Vector2d& origin,
                 const Eigen::Vector2d& direction, const Disc& disc) {
  const Eigen::Vector2d offset = origin - disc.center;
  const double half_b = offset.dot(direction);
  const double c = offset.squaredNorm() - disc.radius * disc.radius;
  const double discriminant = half_b * half_b - c;
  if (discriminant < 0.) return kNoHit;
  const double root = std::sqrt(discriminant);
  if (-half_b - root >= 0.) return -half_b - root;
  return -half_b + root >= 0. ? -half_b + root : kNoHit;
}

double PointToSegment(const Eigen::Vector2d& point, const Segment& segment) {
  const Eigen::Vector2d edge = segment.b - segment.a;
  const double squared_length = edge.squaredNorm();
  if (squared_length == 0.) return (point - segment.a).norm();
  const double u = std::min(
      1., std::max(0., (point - segment.a).dot(edge) / squared_length));
  return (point - segment.a - u * edge).norm();
}

RayCaster::RayCaster(std::vector<Segment> segments, std::vector<Disc> discs)
    : segments_(std::move(segments)),
      discs_(std::move(discs)),
      min_(Eigen::Vector2d::Constant(kNoHit)),
      max_(Eigen::Vector2d::Constant(-kNoHit)) {
  for (const Segment& segment : segments_) {
    min_ = min_.cwiseMin(segment.a).cwiseMin(segment.b);
    max_ = max_.cwiseMax(segment.a).cwiseMax(segment.b);
  }
  for (const Disc& disc : discs_) {
    min_ = min_.cwiseMin(disc.center - Eigen::Vector2d::Constant(disc.radius));
    max_ = max_.cwiseMax(disc.center + Eigen::Vector2d::Constant(disc.radius));
  }
  const int num_shapes = static_cast<int>(segments_.size() + discs_.size());
  if (num_shapes == 0) return;
  const Eigen::Vector2d extent = max_ - min_;
  cell_size_ = kPreferredCellSize;
  const double area = (extent.x() + 1.) * (extent.y() + 1.);
  cell_size_ = std::max(cell_size_, std::sqrt(area / kMaxCells));
  // A long thin plan needs a bound of its own: even one row may have too many
  // cells.
  cell_size_ = std::max(cell_size_, extent.maxCoeff() / (kMaxCells / 4.));
  // A margin of one cell keeps shapes off the border.
  origin_ = min_ - Eigen::Vector2d::Constant(cell_size_);
  width_ = static_cast<int>(extent.x() / cell_size_) + 3;
  height_ = static_cast<int>(extent.y() / cell_size_) + 3;

  const int num_cells = width_ * height_;
  cell_begin_.assign(num_cells + 1, 0);
  for (int shape = 0; shape != num_shapes; ++shape) {
    VisitCells(shape, [this](const int cell) { ++cell_begin_[cell + 1]; });
  }
  for (int cell = 0; cell != num_cells; ++cell) {
    cell_begin_[cell + 1] += cell_begin_[cell];
  }
  cell_shapes_.resize(cell_begin_[num_cells]);
  std::vector<int32_t> next(cell_begin_.begin(), cell_begin_.end() - 1);
  for (int shape = 0; shape != num_shapes; ++shape) {
    VisitCells(shape, [this, shape, &next](const int cell) {
      cell_shapes_[next[cell]++] = shape;
    });
  }
}

template <typename Visitor>
void RayCaster::VisitCells(const int shape, const Visitor& visit) const {
  // Lines are padded, so that rounding cannot lose a cell they only touch.
  const double pad = 1e-6 * cell_size_ + 1e-9;
  const auto column = [this](const double x) {
    return Clamp(std::floor((x - origin_.x()) / cell_size_), 0, width_ - 1);
  };
  const auto row = [this](const double y) {
    return Clamp(std::floor((y - origin_.y()) / cell_size_), 0, height_ - 1);
  };
  if (shape < static_cast<int>(segments_.size())) {
    const Segment& segment = segments_[shape];
    const bool upwards = segment.a.y() <= segment.b.y();
    const Eigen::Vector2d low = upwards ? segment.a : segment.b;
    const Eigen::Vector2d high = upwards ? segment.b : segment.a;
    const double rise = high.y() - low.y();
    for (int y = row(low.y() - pad); y <= row(high.y() + pad); ++y) {
      // The part of the line inside this row of cells.
      double from = low.x(), to = high.x();
      if (rise > 0.) {
        const double slope = (high.x() - low.x()) / rise;
        const double row_low = origin_.y() + y * cell_size_ - pad;
        const double row_high = row_low + cell_size_ + 2. * pad;
        from = low.x() + slope * (std::max(low.y(), row_low) - low.y());
        to = low.x() + slope * (std::min(high.y(), row_high) - low.y());
      }
      if (from > to) std::swap(from, to);
      for (int x = column(from - pad); x <= column(to + pad); ++x) {
        visit(y * width_ + x);
      }
    }
    return;
  }
  const Disc& disc = discs_[shape - segments_.size()];
  for (int y = row(disc.center.y() - disc.radius - pad);
       y <= row(disc.center.y() + disc.radius + pad); ++y) {
    for (int x = column(disc.center.x() - disc.radius - pad);
         x <= column(disc.center.x() + disc.radius + pad); ++x) {
      // Only cells that the circle passes through: with a corner outside and a
      // point inside.
      const Eigen::Vector2d cell_min =
          origin_ + cell_size_ * Eigen::Vector2d(x, y);
      const Eigen::Vector2d cell_max =
          cell_min + Eigen::Vector2d::Constant(cell_size_);
      const double nearest =
          (disc.center - disc.center.cwiseMax(cell_min).cwiseMin(cell_max))
              .norm();
      const double farthest = (disc.center - cell_min)
                                  .cwiseAbs()
                                  .cwiseMax((cell_max - disc.center).cwiseAbs())
                                  .norm();
      if (nearest <= disc.radius + pad && farthest >= disc.radius - pad) {
        visit(y * width_ + x);
      }
    }
  }
}

double RayCaster::IntersectShape(const int shape, const Eigen::Vector2d& origin,
                                 const Eigen::Vector2d& direction) const {
  const int num_segments = static_cast<int>(segments_.size());
  if (shape >= num_segments) {
    return RayToDisc(origin, direction, discs_[shape - num_segments]);
  }
  const Segment& segment = segments_[shape];
  if (segment.echo_angle < kAnyAngle && Passes(direction, segment)) {
    return kNoHit;
  }
  return RayToSegment(origin, direction, segment);
}

RayHit RayCaster::Cast(const Eigen::Vector2d& origin,
                       const Eigen::Vector2d& direction,
                       const double max_range) const {
  RayHit hit;
  if (cell_shapes_.empty()) return hit;
  // The part of the ray inside the grid.
  double enter = 0., leave = max_range;
  const Eigen::Vector2d corner =
      origin_ + cell_size_ * Eigen::Vector2d(width_, height_);
  for (int axis = 0; axis != 2; ++axis) {
    if (direction[axis] == 0.) {
      if (origin[axis] < origin_[axis] || origin[axis] > corner[axis]) {
        return hit;
      }
      continue;
    }
    double first = (origin_[axis] - origin[axis]) / direction[axis];
    double second = (corner[axis] - origin[axis]) / direction[axis];
    if (first > second) std::swap(first, second);
    enter = std::max(enter, first);
    leave = std::min(leave, second);
  }
  if (enter > leave) return hit;

  const Eigen::Vector2d start =
      (origin + enter * direction - origin_) / cell_size_;
  int cell[2] = {Clamp(std::floor(start.x()), 0, width_ - 1),
                 Clamp(std::floor(start.y()), 0, height_ - 1)};
  const int size[2] = {width_, height_};
  int step[2];
  double next[2];   // ray parameter of the next border crossed on each axis
  double delta[2];  // ray parameter from border to border
  for (int axis = 0; axis != 2; ++axis) {
    step[axis] = direction[axis] < 0. ? -1 : 1;
    if (direction[axis] == 0.) {
      next[axis] = delta[axis] = kNoHit;
      continue;
    }
    const double border =
        origin_[axis] + cell_size_ * (cell[axis] + (step[axis] > 0));
    next[axis] = (border - origin[axis]) / direction[axis];
    delta[axis] = cell_size_ / std::abs(direction[axis]);
  }

  int nearest = -1;
  double best = kNoHit;
  while (true) {
    const int index = cell[1] * width_ + cell[0];
    for (int32_t i = cell_begin_[index]; i != cell_begin_[index + 1]; ++i) {
      const double range = IntersectShape(cell_shapes_[i], origin, direction);
      if (range < best) {
        best = range;
        nearest = cell_shapes_[i];
      }
    }
    const int axis = next[0] < next[1] ? 0 : 1;
    if (best <= next[axis] || next[axis] > leave) break;
    cell[axis] += step[axis];
    if (cell[axis] < 0 || cell[axis] >= size[axis]) break;
    next[axis] += delta[axis];
  }
  if (best > max_range) return hit;
  hit.range = best;
  const int num_segments = static_cast<int>(segments_.size());
  hit.reflectivity = nearest < num_segments
                         ? segments_[nearest].reflectivity
                         : discs_[nearest - num_segments].reflectivity;
  return hit;
}

double RayCaster::Clearance(const Eigen::Vector2d& point,
                            const double limit) const {
  double clearance = limit;
  if (cell_shapes_.empty()) return clearance;
  const Eigen::Vector2d low =
      (point - Eigen::Vector2d::Constant(limit) - origin_) / cell_size_;
  const Eigen::Vector2d high =
      (point + Eigen::Vector2d::Constant(limit) - origin_) / cell_size_;
  const int num_segments = static_cast<int>(segments_.size());
  for (int y = Clamp(std::floor(low.y()), 0, height_ - 1);
       y <= Clamp(std::floor(high.y()), 0, height_ - 1); ++y) {
    for (int x = Clamp(std::floor(low.x()), 0, width_ - 1);
         x <= Clamp(std::floor(high.x()), 0, width_ - 1); ++x) {
      const int index = y * width_ + x;
      for (int32_t i = cell_begin_[index]; i != cell_begin_[index + 1]; ++i) {
        const int shape = cell_shapes_[i];
        double distance;
        if (shape < num_segments) {
          distance = PointToSegment(point, segments_[shape]);
        } else {
          const Disc& disc = discs_[shape - num_segments];
          distance = std::abs((point - disc.center).norm() - disc.radius);
        }
        clearance = std::min(clearance, distance);
      }
    }
  }
  return clearance;
}

bool RayCaster::Visible(const Eigen::Vector2d& from,
                        const Eigen::Vector2d& to) const {
  const double distance = (to - from).norm();
  if (distance == 0.) return true;
  return Cast(from, (to - from) / distance, distance).range == kNoHit;
}

}  // namespace simulation
}  // namespace cartographer_ext
