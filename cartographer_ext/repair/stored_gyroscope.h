// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
//
// What a 2D map of Cartographer still tells of its gyroscope. The readings of the
// IMU are not stored. But the gravity alignment of a node is the orientation of
// Cartographer's IMU tracker, whose rotation about the vertical axis is the
// integral of the gyroscope since the start: no match ever corrects it. So the
// differences from node to node are the rotations that the gyroscope measured,
// independent of local SLAM and of the wheels.
#ifndef CARTOGRAPHER_EXT_REPAIR_STORED_GYROSCOPE_H_
#define CARTOGRAPHER_EXT_REPAIR_STORED_GYROSCOPE_H_

#include <map>
#include <vector>

#include "cartographer/sensor/imu_data.h"
#include "cartographer_ext/io/pbstream/pbstream_reader.h"

namespace cartographer_ext {
namespace repair {

// IMU readings of the trajectories whose local SLAM used an IMU, by trajectory
// and in order of time: from node to node the mean rate of turning about the
// vertical axis, rad/s, and gravity without horizontal acceleration, m/s^2, which
// the front end takes for unknown. Without trajectories whose alignment hardly
// turns, as those of our own local SLAM, which aligns with gravity alone.
std::map<int, std::vector<cartographer::sensor::ImuData>>
StoredGyroscopeReadings(const io::Pbstream& pbstream);

}  // namespace repair
}  // namespace cartographer_ext

#endif  // CARTOGRAPHER_EXT_REPAIR_STORED_GYROSCOPE_H_
