// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
#include "cartographer_ext/io/rosbag_reader.h"

#include "absl/strings/str_cat.h"

#ifndef CARTOGRAPHER_EXT_HAS_ROSBAG

namespace cartographer_ext {
namespace io {

absl::StatusOr<std::unique_ptr<SensorSource>> OpenRosbag(
    const std::string& filename, const SensorSourceOptions& options) {
  return absl::UnimplementedError(absl::StrCat(
      filename, ": built without librosbag-storage, bags cannot be read"));
}

}  // namespace io
}  // namespace cartographer_ext

#else  // CARTOGRAPHER_EXT_HAS_ROSBAG

#include <algorithm>
#include <cmath>
#include <exception>
#include <limits>
#include <map>
#include <set>
#include <utility>
#include <vector>

#include "absl/memory/memory.h"
#include "absl/strings/str_join.h"
#include "cartographer_ext/io/reorder.h"
#include "cartographer_ext/io/ros_frames.h"
#include "cartographer_ext/io/ros_messages.h"
#include "cartographer_ext/io/rosbag_check.h"
#include "cartographer_ext/io/rosbag_topics.h"
#include "rosbag/bag.h"
#include "rosbag/view.h"

namespace cartographer_ext {
namespace io {
namespace {

constexpr size_t kMaxEvents = 50000000;
constexpr size_t kMaxReorderWindow = 1 << 16;
constexpr size_t kMaxSensorFrames = 100;
// Tilt beyond which projecting a scan onto the plane distorts it by over 2 %.
const double kMaxTilt = DegToRad(11.);

// Lets the bag library copy the bytes of a message.
struct MessageBytes {
  std::string bytes;
  uint8_t* advance(uint32_t size) {
    bytes.resize(size);
    return reinterpret_cast<uint8_t*>(&bytes[0]);
  }
};

Pose2 Planar(const Eigen::Isometry3d& pose) {
  return Pose2(pose.translation().x(), pose.translation().y(),
               std::atan2(pose.linear()(1, 0), pose.linear()(0, 0)));
}

enum Rank { kOdometryRank, kImuRank, kScanRank, kNumRanks };

// A message of one of the chosen topics, not yet in the robot's frame.
struct Decoded {
  Rank rank = kOdometryRank;
  SensorEvent event;
  std::string frame;           // of the sensor, or the child of odometry
  Eigen::Isometry3d odometry;  // (odometry <- frame)
};

class RosbagSource : public SensorSource {
 public:
  RosbagSource(const std::string& filename, const SensorSourceOptions& options)
      : filename_(filename), tracking_frame_(options.tracking_frame) {
    if (!tracking_frame_.empty() && tracking_frame_[0] == '/') {
      tracking_frame_.erase(0, 1);
    }
  }

  // May throw what the bag library throws.
  absl::Status Open(const SensorSourceOptions& options);

  const SensorSourceInfo& info() const override { return info_; }

  absl::StatusOr<bool> Next(SensorEvent* event) override {
    try {
      while (!at_end_ && !waiting_.Ready()) Advance();
    } catch (const std::exception& exception) {
      return absl::DataLossError(
          absl::StrCat(filename_, ": ", exception.what()));
    } catch (...) {
      return absl::DataLossError(absl::StrCat(filename_, ": unknown error"));
    }
    if (waiting_.empty()) return false;
    *event = waiting_.Pop();
    return true;
  }

 private:
  absl::Status Survey();
  void ChooseTrackingFrame();
  void CheckFrames();
  bool Decode(const rosbag::MessageInstance& message, Decoded* decoded);
  // Moves the event into the robot's frame.
  void Place(Decoded* decoded);
  void Advance();
  Eigen::Isometry3d SensorPose(const std::string& frame) const {
    return frames_.Lookup(tracking_frame_, frame)
        .value_or(Eigen::Isometry3d::Identity());
  }
  bool IsEventTopic(const std::string& topic) const {
    return topic == topics_.scan || topic == topics_.odometry ||
           topic == topics_.imu;
  }
  Rank RankOf(const std::string& event_topic) const {
    return event_topic == topics_.scan  ? kScanRank
           : event_topic == topics_.imu ? kImuRank
                                        : kOdometryRank;
  }

  const std::string filename_;
  std::string tracking_frame_;
  SensorSourceInfo info_;
  rosbag::Bag bag_;
  ChosenTopics topics_;
  RosFrames frames_;
  std::set<std::string> seen_frames_[kNumRanks];

  MessageBytes bytes_;
  std::unique_ptr<rosbag::View> view_;
  rosbag::View::iterator next_;
  ReorderPlan reordering_;
  ReorderBuffer<SensorEvent> waiting_;
  int64_t ordinal_ = 0;
  size_t next_dropped_ = 0;
  bool at_end_ = false;
};

absl::Status RosbagSource::Open(const SensorSourceOptions& options) {
  const absl::Status sound = CheckRosbag(filename_);
  if (!sound.ok()) return sound;
  bag_.open(filename_, rosbag::bagmode::Read);
  RosTopics topics;
  {
    rosbag::View all(bag_);
    for (const rosbag::ConnectionInfo* connection : all.getConnections()) {
      topics[connection->topic] =
          RosTopicType{connection->datatype, connection->md5sum};
    }
  }
  auto chosen = ChooseTopics(topics, options);
  if (!chosen.ok()) {
    return absl::Status(
        chosen.status().code(),
        absl::StrCat(filename_, ": ", chosen.status().message()));
  }
  topics_ = std::move(*chosen);
  info_.format = "rosbag";
  for (const std::string& warning : topics_.warnings) {
    info_.warnings.push_back(absl::StrCat(filename_, ": ", warning));
  }
  const absl::Status status = Survey();
  if (!status.ok()) return status;
  CheckFrames();
  view_ = absl::make_unique<rosbag::View>(
      bag_, [this](const rosbag::ConnectionInfo* connection) {
        return IsEventTopic(connection->topic);
      });
  next_ = view_->begin();
  waiting_ = ReorderBuffer<SensorEvent>(reordering_.window);
  return absl::OkStatus();
}

bool RosbagSource::Decode(const rosbag::MessageInstance& message,
                          Decoded* decoded) {
  bytes_.bytes.clear();
  message.write(bytes_);
  const std::string& topic = message.getTopic();
  RosHeader header;
  bool valid;
  decoded->rank = RankOf(topic);
  if (decoded->rank == kScanRank) {
    LaserScan scan;
    valid = topics_.multi_echo
                ? DecodeMultiEchoLaserScan(bytes_.bytes, &header, &scan)
                : DecodeLaserScan(bytes_.bytes, &header, &scan);
    decoded->frame = header.frame;
    decoded->event = std::move(scan);
  } else if (decoded->rank == kOdometryRank) {
    OdometryReading reading;
    valid = DecodeOdometry(bytes_.bytes, &header, &decoded->frame,
                           &decoded->odometry);
    reading.time = header.time;
    decoded->event = reading;
  } else {
    ImuReading reading;
    valid = DecodeImu(bytes_.bytes, &header, &reading);
    decoded->frame = header.frame;
    decoded->event = reading;
  }
  if (valid && header.time == 0) {
    const TimeNs received = message.getTime().toNSec();
    absl::visit([received](auto& event) { event.time += received; },
                decoded->event);
  }
  return valid;
}

absl::Status RosbagSource::Survey() {
  rosbag::View view(bag_, [this](const rosbag::ConnectionInfo* connection) {
    return IsEventTopic(connection->topic) ||
           topics_.transforms.count(connection->topic) > 0;
  });
  std::vector<EventKey> keys;
  std::map<std::string, int64_t> damaged;
  std::map<std::string, TimeNs> last;
  std::vector<RosTransform> transforms;
  int64_t ordinal = 0;
  Decoded decoded;
  for (const rosbag::MessageInstance& message : view) {
    const std::string& topic = message.getTopic();
    if (!IsEventTopic(topic)) {
      bytes_.bytes.clear();
      message.write(bytes_);
      if (DecodeTransforms(bytes_.bytes, &transforms)) {
        for (const RosTransform& transform : transforms) {
          frames_.Add(transform);
        }
      } else {
        ++damaged[topic];
      }
      continue;
    }
    if (!Decode(message, &decoded)) {
      ++damaged[topic];
      continue;
    }
    std::set<std::string>& frames = seen_frames_[decoded.rank];
    if (frames.size() < kMaxSensorFrames) frames.insert(decoded.frame);
    const TimeNs time = EventTime(decoded.event);
    const auto known = last.emplace(topic, time);
    if (time < known.first->second) ++info_.num_out_of_order;
    known.first->second = time;
    keys.push_back(EventKey{time, decoded.rank, ordinal++});
    if (keys.size() > kMaxEvents) {
      return absl::OutOfRangeError(
          absl::StrCat(filename_, ": more than ", kMaxEvents, " messages"));
    }
  }
  for (const auto& topic : damaged) {
    info_.warnings.push_back(absl::StrCat(filename_, ": ", topic.second,
                                          " messages on ", topic.first,
                                          " cannot be decoded; skipped"));
  }
  reordering_ = PlanReordering(keys, kMaxReorderWindow);
  if (!reordering_.dropped.empty()) {
    info_.warnings.push_back(absl::StrCat(
        filename_, ": ", reordering_.dropped.size(), " messages more than ",
        kMaxReorderWindow, " messages late dropped"));
  }
  int64_t counts[kNumRanks] = {};
  info_.begin = std::numeric_limits<TimeNs>::max();
  size_t next_dropped = 0;
  for (const EventKey& key : keys) {
    if (next_dropped < reordering_.dropped.size() &&
        reordering_.dropped[next_dropped] == key.ordinal) {
      ++next_dropped;
      continue;
    }
    ++counts[key.rank];
    info_.begin = std::min(info_.begin, key.time);
    info_.end = std::max(info_.end, key.time);
  }
  info_.num_scans = counts[kScanRank];
  info_.num_odometry = counts[kOdometryRank];
  info_.num_imu = counts[kImuRank];
  if (info_.num_scans == 0) {
    return absl::InvalidArgumentError(
        absl::StrCat(filename_, ": no valid scan on ", topics_.scan));
  }
  return absl::OkStatus();
}

void RosbagSource::ChooseTrackingFrame() {
  if (frames_.Knows(tracking_frame_)) return;
  for (const Rank rank : {kOdometryRank, kScanRank}) {
    const std::set<std::string>& seen = seen_frames_[rank];
    if (seen.empty() || seen.count(tracking_frame_) > 0) continue;
    info_.warnings.push_back(
        absl::StrCat(filename_, ": tracking frame \"", tracking_frame_,
                     "\" does not occur; taking \"", *seen.begin(), "\""));
    tracking_frame_ = *seen.begin();
    return;
  }
}

void RosbagSource::CheckFrames() {
  ChooseTrackingFrame();
  std::set<std::string> frames;
  for (const std::set<std::string>& seen : seen_frames_) {
    frames.insert(seen.begin(), seen.end());
  }
  for (const std::string& frame : frames) {
    std::vector<std::string> moving;
    const auto pose = frames_.Lookup(tracking_frame_, frame, &moving);
    if (!pose.has_value()) {
      info_.warnings.push_back(absl::StrCat(filename_, ": no transform from \"",
                                            frame, "\" to \"", tracking_frame_,
                                            "\"; taken to coincide"));
    } else if (!moving.empty()) {
      info_.warnings.push_back(
          absl::StrCat(filename_, ": \"", absl::StrJoin(moving, "\", \""),
                       "\" moves on the robot; its first pose is used"));
    }
    if (pose.has_value() && seen_frames_[kScanRank].count(frame) > 0 &&
        std::abs(pose->linear()(2, 2)) < std::cos(kMaxTilt)) {
      info_.warnings.push_back(absl::StrCat(
          filename_, ": laser frame \"", frame,
          "\" is tilted; its scans are taken as if it were level"));
    }
  }
}

void RosbagSource::Place(Decoded* decoded) {
  const Eigen::Isometry3d sensor = SensorPose(decoded->frame);
  if (decoded->rank == kScanRank) {
    LaserScan& scan = absl::get<LaserScan>(decoded->event);
    scan.laser_pose = Planar(sensor);
    if (sensor.linear()(2, 2) <
        0.) {  // Upside down: beams run in the other direction.
      scan.angle_min = -scan.angle_min;
      scan.angle_increment = -scan.angle_increment;
    }
  } else if (decoded->rank == kOdometryRank) {
    absl::get<OdometryReading>(decoded->event).pose =
        Planar(decoded->odometry * sensor.inverse());
  } else {
    ImuReading& reading = absl::get<ImuReading>(decoded->event);
    reading.angular_velocity = sensor.linear() * reading.angular_velocity;
    reading.linear_acceleration = sensor.linear() * reading.linear_acceleration;
  }
}

// Reads one message on.
void RosbagSource::Advance() {
  if (next_ == view_->end()) {
    at_end_ = true;
    return;
  }
  Decoded decoded;
  const bool valid = Decode(*next_, &decoded);
  ++next_;
  if (!valid) return;
  const EventKey key{EventTime(decoded.event), decoded.rank, ordinal_++};
  if (next_dropped_ < reordering_.dropped.size() &&
      reordering_.dropped[next_dropped_] == key.ordinal) {
    ++next_dropped_;
    return;
  }
  Place(&decoded);
  waiting_.Push(key, std::move(decoded.event));
}

}  // namespace

absl::StatusOr<std::unique_ptr<SensorSource>> OpenRosbag(
    const std::string& filename, const SensorSourceOptions& options) {
  try {
    auto source = absl::make_unique<RosbagSource>(filename, options);
    const absl::Status status = source->Open(options);
    if (!status.ok()) return status;
    return std::unique_ptr<SensorSource>(std::move(source));
  } catch (const std::exception& exception) {
    return absl::DataLossError(absl::StrCat(filename, ": ", exception.what()));
  } catch (...) {
    return absl::DataLossError(absl::StrCat(filename, ": unknown error"));
  }
}

}  // namespace io
}  // namespace cartographer_ext

#endif  // CARTOGRAPHER_EXT_HAS_ROSBAG
