// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
#ifndef CARTOGRAPHER_SENSOR_LANDMARK_DATA_H_
#define CARTOGRAPHER_SENSOR_LANDMARK_DATA_H_

#include <string>
#include <vector>

#include "cartographer/common/time.h"
#include "cartographer/sensor/proto/sensor.pb.h"
#include "cartographer/transform/rigid_transform.h"

namespace cartographer {
namespace sensor {

struct LandmarkObservation {
  std::string id;
  transform::Rigid3d landmark_to_tracking_transform;  // (tracking <- landmark)
  double translation_weight;
  double rotation_weight;
};

struct LandmarkData {
  common::Time time;
  std::vector<LandmarkObservation> landmark_observations;
};

proto::LandmarkData ToProto(const LandmarkData& landmark_data);
LandmarkData FromProto(const proto::LandmarkData& proto);

}  // namespace sensor
}  // namespace cartographer

#endif  // CARTOGRAPHER_SENSOR_LANDMARK_DATA_H_
