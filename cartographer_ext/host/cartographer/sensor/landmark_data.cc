// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
#include "cartographer/sensor/landmark_data.h"

#include "cartographer/transform/transform.h"

namespace cartographer {
namespace sensor {

proto::LandmarkData ToProto(const LandmarkData& landmark_data) {
  proto::LandmarkData proto;
  proto.set_timestamp(common::ToUniversal(landmark_data.time));
  for (const LandmarkObservation& seen : landmark_data.landmark_observations) {
    auto* const observation = proto.add_landmark_observations();
    observation->set_id(seen.id);
    *observation->mutable_landmark_to_tracking_transform() =
        transform::ToProto(seen.landmark_to_tracking_transform);
    observation->set_translation_weight(seen.translation_weight);
    observation->set_rotation_weight(seen.rotation_weight);
  }
  return proto;
}

LandmarkData FromProto(const proto::LandmarkData& proto) {
  LandmarkData result;
  result.time = common::FromUniversal(proto.timestamp());
  for (const auto& observation : proto.landmark_observations()) {
    result.landmark_observations.push_back(
        {observation.id(),
         transform::ToRigid3(observation.landmark_to_tracking_transform()),
         observation.translation_weight(), observation.rotation_weight()});
  }
  return result;
}

}  // namespace sensor
}  // namespace cartographer
