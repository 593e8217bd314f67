// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
//
// Smooths the ranges of a laser along the surfaces that it sees.
//
// A laser with 1 % of noise sees a wall ten metres away as a band of half a metre.
// Scans are thinned out before they are matched, so that most of the beams on a wall
// do nothing against it; and in the grid free rays eat the near side of the band, so
// that walls are too far away, old ones more than new ones, which turns the robot.
//
// So the range of a beam becomes that of the line (range_noise.h) through it and
// its neighbours, by least squares. The window grows on both sides by turns as long
// as
//
//   * the points are on the line: chi2 of the residuals with the noise learnt;
//   * the range agrees with those of all smaller windows (intersection of confidence
//     intervals; Goldenshluger and Nemirovski 1997, "On spatially adaptive
//     estimation of nonparametric regression").
//
// Corners, edges and posts are left as they are, up to about the noise. Points whose
// noise is small, as half a cell of a grid, do not change.
#ifndef CARTOGRAPHER_EXT_FRONT_END_POINT_CLOUD_RANGE_SMOOTHER_H_
#define CARTOGRAPHER_EXT_FRONT_END_POINT_CLOUD_RANGE_SMOOTHER_H_

#include <vector>

#include "Eigen/Core"
#include "cartographer_ext/front_end/point_cloud/range_noise.h"

namespace cartographer_ext {
namespace front_end {

// Smooths scan by scan with the noise of those before. Not thread-safe.
class RangeSmoother {
 public:
  // Points with a smaller standard deviation of their range stay, metres >= 0.
  explicit RangeSmoother(double least_noise) : least_noise_(least_noise) {}

  // Returns of one laser in any order, from the laser, metres; those that are not
  // finite or zero are no returns. Gives factors of the ranges: 1 where
  // a point stays.
  std::vector<float> Smooth(const std::vector<Eigen::Vector2f>& returns);

  const RangeNoise& noise() const { return noise_; }

 private:
  // Whether none of the points would change.
  bool IsQuiet(const std::vector<Eigen::Vector2f>& points) const;

  const double least_noise_;
  RangeNoise noise_;
};

}  // namespace front_end
}  // namespace cartographer_ext

#endif  // CARTOGRAPHER_EXT_FRONT_END_POINT_CLOUD_RANGE_SMOOTHER_H_
