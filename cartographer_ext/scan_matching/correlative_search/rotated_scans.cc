// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
#include "cartographer_ext/scan_matching/correlative_search/rotated_scans.h"

#include <algorithm>
#include <cmath>

#include "Eigen/Geometry"

namespace cartographer_ext {
namespace scan_matching {
namespace {

constexpr double kMostRotations = 1 << 24;
constexpr double kMostCells = 1e8;
constexpr double kMostStored = 2147483647.;

void SetRotation(const float angle, CellFrame* const frame) {
  const Eigen::Quaternionf rotation(
      Eigen::AngleAxisf(angle, Eigen::Vector3f::UnitZ()));
  frame->w = rotation.w();
  frame->z = rotation.z();
}

// The product of quaternion and vector as in search_kernels.cc.
void Turn(const CellFrame& frame, std::vector<float>* const point_x,
          std::vector<float>* const point_y) {
  const float w = frame.w;
  const float z = frame.z;
  for (size_t i = 0; i != point_x->size(); ++i) {
    const float x = (*point_x)[i];
    const float y = (*point_y)[i];
    float u = -(z * y);
    float v = z * x;
    u += u;
    v += v;
    (*point_x)[i] = (x + w * u) - z * v;
    (*point_y)[i] = (y + w * v) + z * u;
  }
}

// NaN and negative numbers become 0.
double NotNegative(const double value) { return value > 0. ? value : 0.; }

}  // namespace

RotatedScans::RotatedScans(const PlanarCloud& cloud, const Pose2& initial,
                           const double linear, const double angular,
                           const GridGeometry& geometry,
                           const SearchKernels& kernels, const RangeOf range_of)
    : initial_(initial), geometry_(geometry), kernels_(kernels) {
  const double resolution = geometry.resolution;
  float largest_range = 3.f * resolution;
  turned_x_.reserve(cloud.size());
  turned_y_.reserve(cloud.size());
  for (int first = 0; first != kNumParts; ++first) {
    first_of_turn_[first] = num_points();
    for (size_t i = first; i < cloud.size(); i += kNumParts) {
      turned_x_.push_back(cloud.x[i]);
      turned_y_.push_back(cloud.y[i]);
    }
  }
  if (range_of == RangeOf::kCloud) FindRanges();
  CellFrame turn;
  SetRotation(static_cast<float>(initial.theta), &turn);
  Turn(turn, &turned_x_, &turned_y_);
  if (range_of == RangeOf::kTurnedCloud) FindRanges();
  for (const float range : ranges_) {
    largest_range = std::max(largest_range, range);
  }
  largest_range_ = largest_range;
  // Sizes are multiples of the vector size, except at the end.
  for (int part = 0; part != kNumParts; ++part) {
    part_begin_[part] = static_cast<int>(static_cast<int64_t>(num_points()) *
                                         part / kNumParts / 8 * 8);
  }
  part_begin_[kNumParts] = num_points();
  angular_step_ =
      0.999 * std::acos(1. - resolution * resolution /
                                 (2. * (largest_range * largest_range)));
  const double num_steps = std::ceil(NotNegative(angular) / angular_step_);
  const double num_cells = std::ceil(NotNegative(linear) / resolution);
  const double num_rotations = 2. * num_steps + 1.;
  const double world = std::max(std::abs(initial.x), std::abs(initial.y));
  if (!(num_rotations <= kMostRotations) || !(num_cells <= kMostCells) ||
      !(num_rotations * 2. * cloud.size() <= kMostStored) ||
      !std::isfinite(initial.theta) || !(world < kMostCells * resolution)) {
    return;
  }
  valid_ = true;
  linear_cells_ = static_cast<int>(num_cells);

  const int half = static_cast<int>(num_steps);
  angles_.reserve(2 * half + 1);
  // Summed up, not multiplied: rounding decides between cells.
  double angle = -half * angular_step_;
  for (int i = 0; i != 2 * half + 1; ++i) {
    angles_.push_back(static_cast<float>(angle));
    angle += angular_step_;
  }
  scans_.resize(angles_.size());
}

void RotatedScans::FindRanges() {
  ranges_.reserve(turned_x_.size());
  for (size_t i = 0; i != turned_x_.size(); ++i) {
    const float range =
        std::sqrt(turned_x_[i] * turned_x_[i] + turned_y_[i] * turned_y_[i]);
    // A point that is not finite is outside the grid at any offset.
    ranges_.push_back(std::isfinite(range) ? range : -1.f);
    if (ranges_.back() < 0.f) all_finite_ = false;
  }
}

double RotatedScans::CellsPerStep(const int point) const {
  // A chord is shorter than its arc; the factor covers rounding of the range.
  return NotNegative(ranges_[point]) * (1. + 1e-6) * angular_step_ /
         geometry_.resolution;
}

double RotatedScans::RoundingCells() const {
  // Each coordinate takes about twenty operations with values up to twice the
  // range, and a last one with a value up to range plus translation; counted
  // for both rotations.
  constexpr double kHalfUnit = 1. / (1 << 24);
  const double world = std::max(std::abs(initial_.x), std::abs(initial_.y));
  return kHalfUnit * (48. * largest_range_ + 4. * world) / geometry_.resolution;
}

void RotatedScans::FindCells(const int rotation, int32_t* const x,
                             int32_t* const y) const {
  CellFrame frame;
  SetRotation(angles_[rotation], &frame);
  frame.translation_x = static_cast<float>(initial_.x);
  frame.translation_y = static_cast<float>(initial_.y);
  frame.max_x = geometry_.max_x;
  frame.max_y = geometry_.max_y;
  frame.resolution = geometry_.resolution;
  kernels_.find_cells(frame, turned_x_.data(), turned_y_.data(), num_points(),
                      x, y);
}

const RotatedScan& RotatedScans::Get(const int rotation) {
  RotatedScan& scan = scans_[rotation];
  if (scan.x != nullptr) return scan;
  const size_t count = turned_x_.size();
  if (storage_left_ < 2 * count) {
    // Not initialised, as most of it may never be used.
    storage_left_ = 2 * count * std::min<size_t>(64, scans_.size());
    storage_.emplace_back(new int32_t[storage_left_]);
    next_storage_ = storage_.back().get();
  }
  int32_t* const x = next_storage_;
  int32_t* const y = x + count;
  next_storage_ += 2 * count;
  storage_left_ -= 2 * count;
  FindCells(rotation, x, y);
  scan.x = x;
  scan.y = y;
  const OffsetBounds cells = CellBounds(x, y);
  scan.cells = cells;
  scan.offsets = BoundsFor(cells);
  return scan;
}

OffsetBounds RotatedScans::CellBounds(const int32_t* const x,
                                      const int32_t* const y) const {
  const int count = num_points();
  if (all_finite_) {
    int min_x = x[0], max_x = x[0], min_y = y[0], max_y = y[0];
    for (int i = 1; i < count; ++i) {
      min_x = std::min<int>(min_x, x[i]);
      max_x = std::max<int>(max_x, x[i]);
      min_y = std::min<int>(min_y, y[i]);
      max_y = std::max<int>(max_y, y[i]);
    }
    return OffsetBounds{min_x, max_x, min_y, max_y};
  }
  int first = 0;
  while (first + 1 < count && ranges_[first] < 0.f) ++first;
  if (ranges_[first] < 0.f) return OffsetBounds{0, 0, 0, 0};
  OffsetBounds cells = OffsetBounds{x[first], x[first], y[first], y[first]};
  for (int i = first + 1; i < count; ++i) {
    if (ranges_[i] < 0.f) continue;
    cells.min_x = std::min(cells.min_x, x[i]);
    cells.max_x = std::max(cells.max_x, x[i]);
    cells.min_y = std::min(cells.min_y, y[i]);
    cells.max_y = std::max(cells.max_y, y[i]);
  }
  return cells;
}

OffsetBounds RotatedScans::BoundsFor(const OffsetBounds& cells) const {
  OffsetBounds bounds;
  bounds.min_x = std::max(-linear_cells_, std::min(0, -cells.max_x));
  bounds.min_y = std::max(-linear_cells_, std::min(0, -cells.max_y));
  bounds.max_x =
      std::min(linear_cells_, std::max(0, geometry_.num_x - 1 - cells.min_x));
  bounds.max_y =
      std::min(linear_cells_, std::max(0, geometry_.num_y - 1 - cells.min_y));
  return bounds;
}

Pose2 RotatedScans::PoseOf(const int rotation, const int offset_x,
                           const int offset_y) const {
  const int half = num_rotations() / 2;
  Pose2 pose;
  pose.x = initial_.x + -offset_y * geometry_.resolution;
  pose.y = initial_.y + -offset_x * geometry_.resolution;
  pose.theta = initial_.theta + (rotation - half) * angular_step_;
  return pose;
}

}  // namespace scan_matching
}  // namespace cartographer_ext
