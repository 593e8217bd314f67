// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
//
// How far a laser sees, learnt from its scans. Where the longest ranges of most
// scans are the same, wherever the robot is, the laser limits them and not the
// building: what lies there is the end of sight and no wall.
#ifndef CARTOGRAPHER_EXT_FRONT_END_SIGHT_LIMIT_H_
#define CARTOGRAPHER_EXT_FRONT_END_SIGHT_LIMIT_H_

#include <vector>

#include "cartographer_ext/common/pose2.h"

namespace cartographer_ext {
namespace front_end {

// Not thread-safe.
class SightLimit {
 public:
  // A scan from near `pose` with these ranges, metres, all finite.
  void Add(const Pose2& pose, std::vector<float> ranges);

  // Metres from where on points are at the limit of sight, infinity where that
  // is not known.
  double Limit() const;

 private:
  // The longest range so far, metres; of the scans since, one every
  // kRangeStep, how many there are and how many reach as far.
  double range_ = 0.;
  int scans_ = 0, scans_at_limit_ = 0;
  Pose2 pose_;  // of the last of them
};

}  // namespace front_end
}  // namespace cartographer_ext

#endif  // CARTOGRAPHER_EXT_FRONT_END_SIGHT_LIMIT_H_
