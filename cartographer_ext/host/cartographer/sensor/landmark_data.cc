// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
#include "cartographer/sensor/landmark_data.h"

#include <algorithm>
#include <iterator>

#include "cartographer/transform/transform.h"

namespace cartographer {
namespace sensor {

namespace {

using ObservationProto = proto::LandmarkData::LandmarkObservation;

void Write(const LandmarkObservation& observation,
           ObservationProto* const proto) {
  proto->set_rotation_weight(observation.rotation_weight);
  proto->set_translation_weight(observation.translation_weight);
  *proto->mutable_landmark_to_tracking_transform() =
      transform::ToProto(observation.landmark_to_tracking_transform);
  proto->set_id(observation.id);
}

LandmarkObservation Read(const ObservationProto& proto) {
  LandmarkObservation observation;
  observation.id = proto.id();
  observation.rotation_weight = proto.rotation_weight();
  observation.translation_weight = proto.translation_weight();
  observation.landmark_to_tracking_transform =
      transform::ToRigid3(proto.landmark_to_tracking_transform());
  return observation;
}

}  // namespace

proto::LandmarkData ToProto(const LandmarkData& landmark_data) {
  proto::LandmarkData proto;
  for (const LandmarkObservation& seen : landmark_data.landmark_observations) {
    Write(seen, proto.add_landmark_observations());
  }
  proto.set_timestamp(common::ToUniversal(landmark_data.time));
  return proto;
}

LandmarkData FromProto(const proto::LandmarkData& proto) {
  LandmarkData landmark_data;
  landmark_data.time = common::FromUniversal(proto.timestamp());
  std::transform(proto.landmark_observations().begin(),
                 proto.landmark_observations().end(),
                 std::back_inserter(landmark_data.landmark_observations), Read);
  return landmark_data;
}

}  // namespace sensor
}  // namespace cartographer
