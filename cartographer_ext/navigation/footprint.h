// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
//
// The outline of a robot as a union of discs in its frame: contact is decided
// by one lookup in a distance map for each disc. A rectangle is covered by
// discs that extend beyond it by at most a fifth of its half width.
#ifndef CARTOGRAPHER_EXT_NAVIGATION_FOOTPRINT_H_
#define CARTOGRAPHER_EXT_NAVIGATION_FOOTPRINT_H_

#include <algorithm>
#include <cmath>
#include <limits>
#include <vector>

#include "Eigen/Core"
#include "cartographer_ext/common/pose2.h"

namespace cartographer_ext {
namespace navigation {

struct Footprint {
  struct Part {
    Eigen::Vector2d center = Eigen::Vector2d::Zero();  // metres, robot frame
    double radius = 0.;
  };
  std::vector<Part> parts;

  static Footprint Disc(const double radius) {
    Footprint footprint;
    footprint.parts.push_back({Eigen::Vector2d::Zero(), radius});
    return footprint;
  }

  // Reaches from -rear to front along x and half_width to both sides.
  static Footprint Rectangle(const double front, const double rear,
                             const double half_width) {
    Footprint footprint;
    const double radius = 1.2 * half_width;
    // Discs this far apart meet where they cut the long sides.
    const double reach = std::sqrt(radius * radius - half_width * half_width);
    const double length = std::max(0., front + rear - 2. * reach);
    const int count = 1 + static_cast<int>(std::ceil(length / (2. * reach)));
    for (int i = 0; i != count; ++i) {
      const double ratio = count == 1 ? 0.5 : i / (count - 1.);
      footprint.parts.push_back(
          {Eigen::Vector2d(-rear + reach + ratio * length, 0.), radius});
    }
    return footprint;
  }

  // Of the largest disc around the origin inside the outline: the robot cannot
  // be nearer to an obstacle than this, whatever its heading.
  double inscribed_radius() const {
    double radius = 0.;
    for (const Part& part : parts) {
      radius = std::max(radius, part.radius - part.center.norm());
    }
    return radius;
  }

  // Of the smallest disc around the origin that holds the outline.
  double circumscribed_radius() const {
    double radius = 0.;
    for (const Part& part : parts) {
      radius = std::max(radius, part.radius + part.center.norm());
    }
    return radius;
  }

  // Metres from the outline at `pose` to a point in the frame that the pose is
  // in; negative inside. Infinite without parts.
  double Distance(const Pose2& pose, const Eigen::Vector2d& point) const {
    double distance = std::numeric_limits<double>::infinity();
    for (const Part& part : parts) {
      distance =
          std::min(distance, (pose * part.center - point).norm() - part.radius);
    }
    return distance;
  }
};

}  // namespace navigation
}  // namespace cartographer_ext

#endif  // CARTOGRAPHER_EXT_NAVIGATION_FOOTPRINT_H_
