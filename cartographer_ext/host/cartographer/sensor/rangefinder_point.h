// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
#ifndef CARTOGRAPHER_SENSOR_RANGEFINDER_POINT_H_
#define CARTOGRAPHER_SENSOR_RANGEFINDER_POINT_H_

#include <vector>

#include "Eigen/Core"
#include "cartographer/sensor/proto/sensor.pb.h"
#include "cartographer/transform/transform.h"
#include "glog/logging.h"

namespace cartographer {
namespace sensor {

struct RangefinderPoint {
  Eigen::Vector3f position;  // metres
};

struct TimedRangefinderPoint {
  Eigen::Vector3f position;  // metres
  float time;                // seconds relative to the cloud's stamp
};

template <class T>
inline RangefinderPoint operator*(const transform::Rigid3<T>& lhs,
                                  const RangefinderPoint& rhs) {
  return RangefinderPoint{lhs * rhs.position};
}

template <class T>
inline TimedRangefinderPoint operator*(const transform::Rigid3<T>& lhs,
                                       const TimedRangefinderPoint& rhs) {
  return TimedRangefinderPoint{lhs * rhs.position, rhs.time};
}

inline bool operator==(const RangefinderPoint& lhs,
                       const RangefinderPoint& rhs) {
  return lhs.position == rhs.position;
}

inline bool operator==(const TimedRangefinderPoint& lhs,
                       const TimedRangefinderPoint& rhs) {
  return lhs.time == rhs.time && lhs.position == rhs.position;
}

inline RangefinderPoint FromProto(
    const proto::RangefinderPoint& rangefinder_point_proto) {
  return {transform::ToEigen(rangefinder_point_proto.position())};
}

inline proto::RangefinderPoint ToProto(
    const RangefinderPoint& rangefinder_point) {
  proto::RangefinderPoint result;
  *result.mutable_position() = transform::ToProto(rangefinder_point.position);
  return result;
}

inline TimedRangefinderPoint FromProto(
    const proto::TimedRangefinderPoint& timed_rangefinder_point_proto) {
  return {transform::ToEigen(timed_rangefinder_point_proto.position()),
          timed_rangefinder_point_proto.time()};
}

inline proto::TimedRangefinderPoint ToProto(
    const TimedRangefinderPoint& timed_rangefinder_point) {
  proto::TimedRangefinderPoint result;
  *result.mutable_position() =
      transform::ToProto(timed_rangefinder_point.position);
  result.set_time(timed_rangefinder_point.time);
  return result;
}

inline RangefinderPoint ToRangefinderPoint(
    const TimedRangefinderPoint& timed_rangefinder_point) {
  return {timed_rangefinder_point.position};
}

inline TimedRangefinderPoint ToTimedRangefinderPoint(
    const RangefinderPoint& rangefinder_point, const float time) {
  return {rangefinder_point.position, time};
}

}  // namespace sensor
}  // namespace cartographer

#endif  // CARTOGRAPHER_SENSOR_RANGEFINDER_POINT_H_
