// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0

#include "cartographer_ext/io/ros/ros_event.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>
#include <vector>

#include "absl/strings/match.h"
#include "cartographer_ext/common/pose2.h"

namespace cartographer_ext {
namespace io {
namespace {

// The frame of REP 105, possibly with the namespace of a robot.
bool IsOdometryFrame(const std::string& frame) {
  return frame == "odom" || absl::EndsWith(frame, "/odom");
}

// The scan's time becomes that of the last point.
void TakePointTimes(const RosPointCloud& cloud, LaserScan* scan) {
  if (cloud.times.empty()) return;
  const double last = *std::max_element(cloud.times.begin(), cloud.times.end());
  scan->time += FromSeconds(last);
  for (const double time : cloud.times)
    scan->point_times.push_back(static_cast<float>(time - last));
}

}  // namespace

bool RosEventDecoder::Decode(const RosMessage& message,
                             RosEvent* const decoded) const {
  RosHeader header;
  bool valid;
  decoded->cloud = RosPointCloud();
  if (topics_.transforms.count(message.topic) > 0)
    return FindOdometry(message, decoded);
  if (topics_.scans.count(message.topic) > 0) {
    decoded->rank = kScanRank;
    valid = DecodeScan(message, &header, decoded);
  } else if (message.topic == topics_.imu) {
    decoded->rank = kImuRank;
    ImuReading reading;
    valid = DecodeImu(encoding_, message.data, &header, &reading);
    decoded->frame = header.frame;
    decoded->event = reading;
  } else {
    decoded->rank = kOdometryRank;
    OdometryReading reading;
    valid = DecodeOdometry(encoding_, message.data, &header, &decoded->frame,
                           &decoded->odometry);
    reading.time = header.time;
    decoded->event = reading;
  }
  if (valid && header.time == 0) {
    const TimeNs received = message.received;
    absl::visit([received](auto& event) { event.time += received; },
                decoded->event);
  }
  return valid;
}

bool RosEventDecoder::DecodeScan(const RosMessage& message,
                                 RosHeader* const header,
                                 RosEvent* const decoded) const {
  LaserScan scan;
  bool valid = false;
  switch (topics_.scans.at(message.topic)) {
    case RosScanType::kLaserScan:
      valid = DecodeLaserScan(encoding_, message.data, header, &scan);
      break;
    case RosScanType::kMultiEchoLaserScan:
      valid = DecodeMultiEchoLaserScan(encoding_, message.data, header, &scan);
      break;
    case RosScanType::kPointCloud2:
      valid =
          DecodePointCloud2(encoding_, message.data, header, &decoded->cloud);
      scan.time = header->time;
      scan.range_max = std::numeric_limits<double>::infinity();
      TakePointTimes(decoded->cloud, &scan);
      break;
  }
  if (valid && timing_.IsImpossible(message.topic, header->frame)) {
    scan.time = header->time;
    scan.time_increment = 0.;
    scan.point_times.clear();
  }
  scan.range_max =
      std::min(scan.range_max, codes_.RangeMax(message.topic, header->frame));
  if (topics_.scans.size() > 1) scan.sensor_id = message.topic;
  decoded->frame = header->frame;
  decoded->event = std::move(scan);
  return valid;
}

bool RosEventDecoder::FindOdometry(const RosMessage& message,
                                   RosEvent* const decoded) const {
  std::vector<RosTransform> transforms;
  if (!DecodeTransforms(encoding_, message.data, &transforms)) return false;
  for (const RosTransform& transform : transforms) {
    if (!IsOdometryFrame(transform.header.frame)) continue;
    OdometryReading reading;
    reading.time =
        transform.header.time == 0 ? message.received : transform.header.time;
    decoded->rank = kOdometryRank;
    decoded->event = reading;
    decoded->frame = transform.child_frame;
    decoded->odometry = transform.pose;
    return true;
  }
  return false;
}

void AddScan(const std::string& topic, const RosEvent& decoded,
             ScanTiming* const timing, NoReturnCodes* const codes) {
  const LaserScan& scan = absl::get<LaserScan>(decoded.event);
  const double sweep = SweepSeconds(scan);
  // Points do not show directions without returns of a rotating laser.
  const double field_of_view =
      scan.ranges.empty() ? 2. * kPi
                          : std::abs(scan.angle_increment) *
                                static_cast<double>(scan.ranges.size());
  timing->Add(topic, decoded.frame, scan.time - FromSeconds(sweep), sweep,
              field_of_view);
  codes->Add(topic, decoded.frame, scan);
}

}  // namespace io
}  // namespace cartographer_ext
