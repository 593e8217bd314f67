// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
#ifndef CARTOGRAPHER_MAPPING_INTERNAL_2D_SCAN_MATCHING_INTERPOLATED_TSDF_2D_H_
#define CARTOGRAPHER_MAPPING_INTERNAL_2D_SCAN_MATCHING_INTERPOLATED_TSDF_2D_H_

#include <cmath>

#include "Eigen/Core"
#include "cartographer/mapping/internal/2d/tsdf_2d.h"

namespace cartographer {
namespace mapping {
namespace scan_matching {

// Bilinear interpolation of distances and weights between cell centres, at a
// world point (x, y) in metres; T is double or ceres::Jet<double, N>.
class InterpolatedTSDF2D {
 public:
  explicit InterpolatedTSDF2D(const TSDF2D& grid) : tsdf_(grid) {}
  InterpolatedTSDF2D(const InterpolatedTSDF2D&) = delete;
  InterpolatedTSDF2D& operator=(const InterpolatedTSDF2D&) = delete;

  // The maximum cost, without gradient, when one of the four cells has no
  // weight.
  template <typename T>
  T GetCorrespondenceCost(const T& x, const T& y) const {
    const Square<T> square = SquareAround(x, y);
    float corners[4];
    for (int i = 0; i != 4; ++i) {
      const Eigen::Array2i cell = square.Corner(i);
      if (tsdf_.GetWeight(cell) == 0.f) {
        return T(tsdf_.GetMaxCorrespondenceCost());
      }
      corners[i] = tsdf_.GetCorrespondenceCost(cell);
    }
    return square.Interpolate(corners);
  }

  template <typename T>
  T GetWeight(const T& x, const T& y) const {
    const Square<T> square = SquareAround(x, y);
    float corners[4];
    for (int i = 0; i != 4; ++i) {
      corners[i] = tsdf_.GetWeight(square.Corner(i));
    }
    return square.Interpolate(corners);
  }

 private:
  // Four neighbouring cell centres and where the point lies between them: `x`
  // and `y` in [0, 1) from the corner with the lowest coordinates.
  template <typename T>
  struct Square {
    Eigen::Array2i lowest;
    T x;
    T y;

    // Bit 0 steps up in world y, bit 1 in world x; indices run backwards.
    Eigen::Array2i Corner(const int i) const {
      return lowest - Eigen::Array2i(i & 1, i >> 1);
    }
    T Interpolate(const float (&corners)[4]) const {
      const T low = T(corners[0]) + y * T(corners[1] - corners[0]);
      const T high = T(corners[2]) + y * T(corners[3] - corners[2]);
      return low + x * (high - low);
    }
  };

  template <typename T>
  Square<T> SquareAround(const T& x, const T& y) const {
    const MapLimits& limits = tsdf_.limits();
    // Indices with fractions: whole numbers are cell centres.
    const T row = (limits.max().x() - x) / T(limits.resolution()) - T(0.5);
    const T column = (limits.max().y() - y) / T(limits.resolution()) - T(0.5);
    const double lowest_row = std::ceil(Scalar(row));
    const double lowest_column = std::ceil(Scalar(column));
    return {Eigen::Array2i(static_cast<int>(lowest_column),
                           static_cast<int>(lowest_row)),
            T(lowest_row) - row, T(lowest_column) - column};
  }

  static double Scalar(const double value) { return value; }
  template <typename Jet>
  static double Scalar(const Jet& value) {
    return value.a;
  }

  const TSDF2D& tsdf_;
};

}  // namespace scan_matching
}  // namespace mapping
}  // namespace cartographer

#endif  // CARTOGRAPHER_MAPPING_INTERNAL_2D_SCAN_MATCHING_INTERPOLATED_TSDF_2D_H_
