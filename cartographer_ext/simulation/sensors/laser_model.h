// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
//
// A scanning laser: exact ranges to the plan and the moving obstacles, then the
// errors of a real laser, in this order:
//   nearer than min_range, farther than sqrt(reflectivity) max_range: no echo
//   with probability `dropout`: no echo
//   with probability `outlier`: an echo anywhere before the surface
//   noise: N(0, noise^2 + (proportional_noise range)^2)
//   rounded to the resolution.
// A scan is taken in one instant unless `sweep` is set; then beam i is measured
// i / (beams - 1) * sweep after the first, from the pose of the robot at that
// time, and the scan has the stamp of its last beam.
#ifndef CARTOGRAPHER_EXT_SIMULATION_SENSORS_LASER_MODEL_H_
#define CARTOGRAPHER_EXT_SIMULATION_SENSORS_LASER_MODEL_H_

#include <cstdint>
#include <vector>

#include "cartographer_ext/common/random.h"
#include "cartographer_ext/io/sensor_source.h"
#include "cartographer_ext/simulation/drive.h"
#include "cartographer_ext/simulation/obstacle_motion.h"
#include "cartographer_ext/simulation/ray_caster.h"
#include "cartographer_ext/simulation/world.h"

namespace cartographer_ext {
namespace simulation {

class LaserModel {
 public:
  // All pointees must outlive the model.
  LaserModel(const LaserSettings& settings, const RayCaster* plan,
             const ObstacleMotion* obstacles, uint64_t seed);

  // The scan whose last beam is measured at `time` (seconds since the start of
  // the drive); its stamp is left to the caller.
  io::LaserScan Scan(const Drive& drive, double time);

  // A scan taken in one instant from a robot at that pose (world <- robot),
  // among these obstacles.
  io::LaserScan Snapshot(const Pose2& robot,
                         const std::vector<Disc>& obstacles);

  // Range of one beam without any error, kNoHit when nothing is in range.
  // `laser` is (world <- laser), `angle` in the laser frame.
  double ExactRange(const Pose2& laser, double angle,
                    const std::vector<Disc>& obstacles) const;

 private:
  io::LaserScan EmptyScan() const;
  float Measure(double range);

  const LaserSettings settings_;
  const RayCaster* const plan_;
  const ObstacleMotion* const obstacles_;
  Random random_;
};

}  // namespace simulation
}  // namespace cartographer_ext

#endif  // CARTOGRAPHER_EXT_SIMULATION_SENSORS_LASER_MODEL_H_
