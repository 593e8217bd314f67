// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
//
// Topics, frames and stamps of a ROS recording, whatever its container; what
// rosbag_reader.h says of them holds for all.
#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <set>
#include <utility>
#include <vector>

#include "absl/memory/memory.h"
#include "absl/strings/str_cat.h"
#include "absl/strings/str_format.h"
#include "absl/strings/str_join.h"
#include "cartographer_ext/io/reorder.h"
#include "cartographer_ext/io/ros/ros_container.h"
#include "cartographer_ext/io/ros/ros_event.h"
#include "cartographer_ext/io/ros/ros_frames.h"
#include "cartographer_ext/io/tokens.h"

namespace cartographer_ext {
namespace io {
namespace {

constexpr size_t kMaxEvents = 50000000;
constexpr size_t kMaxReorderWindow = 1 << 16;
constexpr size_t kMaxSensorFrames = 100;
// Tilt beyond which projecting a scan onto the plane distorts it by over 2 %.
const double kMaxTilt = DegToRad(11.);

Pose2 Planar(const Eigen::Isometry3d& pose) {
  return Pose2(pose.translation().x(), pose.translation().y(),
               std::atan2(pose.linear()(1, 0), pose.linear()(0, 0)));
}

// Whether points lie in a plane of the sensor, as those of a planar laser do.
bool IsPlanar(const std::vector<Eigen::Vector3d>& points) {
  constexpr double kMaxHeightSigma = 0.1;
  double sum = 0., squares = 0.;
  for (const Eigen::Vector3d& point : points) {
    sum += point.z();
    squares += point.z() * point.z();
  }
  const double n = static_cast<double>(points.size());
  return squares * n - sum * sum <= n * n * kMaxHeightSigma * kMaxHeightSigma;
}

class RosRecording : public SensorSource {
 public:
  RosRecording(const std::string& filename,
               std::unique_ptr<RosContainer> container,
               const SensorSourceOptions& options)
      : filename_(filename),
        container_(std::move(container)),
        tracking_frame_(options.tracking_frame),
        decoder_(container_->encoding(), &topics_, &timing_, &codes_) {
    if (!tracking_frame_.empty() && tracking_frame_[0] == '/') {
      tracking_frame_.erase(0, 1);
    }
  }

  absl::Status Open(const SensorSourceOptions& options);
  // What is missing may be in a part of the file that could not be read.
  absl::Status Explained(const absl::Status& status) const {
    std::vector<std::string> texts = {std::string(status.message())};
    for (std::string& warning : container_->warnings())
      texts.push_back(std::move(warning));
    if (absl::IsDataLoss(status)) return status;
    return absl::Status(status.code(), absl::StrJoin(texts, "; "));
  }

  const SensorSourceInfo& info() const override { return info_; }

  absl::StatusOr<bool> Next(SensorEvent* event) override {
    while (!at_end_ && !waiting_.Ready()) {
      const absl::Status status = Advance();
      if (!status.ok()) return status;
    }
    if (waiting_.empty()) return false;
    *event = waiting_.Pop();
    return true;
  }

 private:
  absl::Status Survey();
  std::string NoScanMessage(const std::string& topics) const;
  // Warns of odometry and IMU that have no time in common with the scans.
  void CheckClocks(const std::vector<EventKey>& keys);
  void CountEvents(const std::vector<EventKey>& keys);
  void ChooseTrackingFrame();
  void CheckFrames();
  // Reads all messages once to find the topics and their order.
  absl::Status ReadKeys(std::vector<EventKey>* keys);
  // Adds the transforms of a message to the frames.
  bool TakeTransforms(const RosMessage& message);
  // Moves the event into the robot's frame.
  void Place(RosEvent* decoded);
  // Reads the next message.
  absl::Status Advance();
  Eigen::Isometry3d SensorPose(const std::string& frame) const {
    return frames_.Lookup(tracking_frame_, frame)
        .value_or(Eigen::Isometry3d::Identity());
  }
  bool IsEventTopic(const std::string& topic) const {
    return topics_.scans.count(topic) > 0 || topic == topics_.odometry ||
           topic == topics_.imu;
  }
  std::set<std::string> EventTopics() const {
    std::set<std::string> topics = {topics_.odometry, topics_.imu};
    for (const auto& scan : topics_.scans) topics.insert(scan.first);
    if (topics_.odometry_from_transforms)
      topics.insert(topics_.transforms.begin(), topics_.transforms.end());
    topics.erase("");
    return topics;
  }

  const std::string filename_;
  const std::unique_ptr<RosContainer> container_;
  std::string tracking_frame_;
  SensorSourceInfo info_;
  ChosenTopics topics_;
  ScanTiming timing_;
  NoReturnCodes codes_;
  RosEventDecoder decoder_;
  RosFrames frames_;
  std::set<std::string> seen_frames_[kNumRanks];
  std::map<std::string, int64_t> damaged_;  // messages of each topic
  int64_t num_clouds_ = 0, num_planar_clouds_ = 0;

  ReorderPlan reordering_;
  ReorderBuffer<SensorEvent> waiting_;
  int64_t ordinal_ = 0;
  size_t next_dropped_ = 0;
  bool at_end_ = false;
};

absl::Status RosRecording::Open(const SensorSourceOptions& options) {
  auto chosen = ChooseTopics(container_->topics(), options);
  if (!chosen.ok()) {
    return absl::Status(
        chosen.status().code(),
        absl::StrCat(filename_, ": ", chosen.status().message()));
  }
  topics_ = std::move(*chosen);
  info_.format = container_->format();
  for (const std::string& warning : topics_.warnings) {
    info_.warnings.push_back(absl::StrCat(filename_, ": ", warning));
  }
  absl::Status status = Survey();
  if (!status.ok()) return status;
  for (std::string& warning : container_->warnings())
    info_.warnings.push_back(std::move(warning));
  CheckFrames();
  status = container_->Rewind(EventTopics());
  if (!status.ok()) return status;
  waiting_ = ReorderBuffer<SensorEvent>(reordering_.window);
  return absl::OkStatus();
}

bool RosRecording::TakeTransforms(const RosMessage& message) {
  std::vector<RosTransform> transforms;
  if (!DecodeTransforms(container_->encoding(), message.data, &transforms))
    return false;
  for (const RosTransform& transform : transforms) frames_.Add(transform);
  return true;
}

absl::Status RosRecording::ReadKeys(std::vector<EventKey>* keys) {
  std::set<std::string> topics = EventTopics();
  topics.insert(topics_.transforms.begin(), topics_.transforms.end());
  const absl::Status rewound = container_->Rewind(topics);
  if (!rewound.ok()) return rewound;
  keys->clear();
  info_.num_out_of_order = 0;
  damaged_.clear();
  std::map<std::string, TimeNs> last;
  RosEvent decoded;
  RosMessage message;
  while (true) {
    const absl::StatusOr<bool> more = container_->Next(&message);
    if (!more.ok()) return more.status();
    if (!*more) break;
    const bool is_event = IsEventTopic(message.topic);
    if (!is_event) {
      if (!TakeTransforms(message)) ++damaged_[message.topic];
      if (!topics_.odometry_from_transforms) continue;
    }
    if (!decoder_.Decode(message, &decoded)) {
      if (is_event) ++damaged_[message.topic];
      continue;
    }
    std::set<std::string>& frames = seen_frames_[decoded.rank];
    if (frames.size() < kMaxSensorFrames) frames.insert(decoded.frame);
    if (decoded.rank == kScanRank)
      AddScan(message.topic, decoded, &timing_, &codes_);
    if (!decoded.cloud.points.empty()) {
      ++num_clouds_;
      if (IsPlanar(decoded.cloud.points)) ++num_planar_clouds_;
    }
    const TimeNs time = EventTime(decoded.event);
    const auto known = last.emplace(message.topic, time);
    if (time < known.first->second) ++info_.num_out_of_order;
    known.first->second = time;
    keys->push_back(
        EventKey{time, decoded.rank, static_cast<int64_t>(keys->size())});
    if (keys->size() > kMaxEvents) {
      return absl::OutOfRangeError(
          absl::StrCat(filename_, ": more than ", kMaxEvents, " messages"));
    }
  }
  return absl::OkStatus();
}

absl::Status RosRecording::Survey() {
  std::vector<EventKey> keys;
  absl::Status status = ReadKeys(&keys);
  if (!status.ok()) return status;
  timing_.Judge();
  codes_.Judge();
  for (const auto& warnings : {timing_.Warnings(), codes_.Warnings()}) {
    for (const std::string& warning : warnings)
      info_.warnings.push_back(absl::StrCat(filename_, ": ", warning));
  }
  // Stamps of scans without the time that their beams claim to take.
  if (timing_.AnyImpossible() && !(status = ReadKeys(&keys)).ok())
    return status;
  for (const auto& topic : damaged_) {
    info_.warnings.push_back(absl::StrCat(
        filename_, ": ", topic.second, " messages on ", topic.first,
        " are damaged or have values that are not numbers; skipped"));
  }
  if (topics_.odometry_from_transforms) {
    if (frames_.HasMovingChild(seen_frames_[kOdometryRank])) {
      info_.warnings.push_back(absl::StrCat(
          filename_, ": no odometry messages; taking the transforms from \"",
          *seen_frames_[kOdometryRank].begin(), "\" to \"odom\""));
    } else {
      // None, or of a robot that only says so.
      topics_.odometry_from_transforms = false;
      seen_frames_[kOdometryRank].clear();
      keys.erase(std::remove_if(keys.begin(), keys.end(),
                                [](const EventKey& key) {
                                  return key.rank == kOdometryRank;
                                }),
                 keys.end());
      int64_t ordinal = 0;
      for (EventKey& key : keys) key.ordinal = ordinal++;
    }
  }
  CountEvents(keys);
  CheckClocks(keys);
  std::vector<std::string> scans;
  for (const auto& scan : topics_.scans) scans.push_back(scan.first);
  const std::string names = absl::StrJoin(scans, ", ");
  if (info_.num_scans == 0) {
    return absl::InvalidArgumentError(NoScanMessage(names));
  }
  if (scans.size() > 1) info_.lasers = std::move(scans);
  if (2 * num_planar_clouds_ < num_clouds_) {
    return absl::InvalidArgumentError(
        absl::StrCat(filename_, ": the points on ", names,
                     " do not lie in one plane; only lasers that measure in a "
                     "plane are read"));
  }
  return absl::OkStatus();
}

std::string RosRecording::NoScanMessage(const std::string& topics) const {
  int64_t num_damaged = 0;
  for (const auto& scan : topics_.scans) {
    const auto damaged = damaged_.find(scan.first);
    if (damaged != damaged_.end()) num_damaged += damaged->second;
  }
  return absl::StrCat(
      filename_, ": no valid scan on ", topics, ": ",
      num_damaged == 0
          ? "no messages"
          : absl::StrCat(num_damaged,
                         " messages are damaged or have no beams, or angles, "
                         "ranges or times of beams that cannot be"));
}

void RosRecording::CheckClocks(const std::vector<EventKey>& keys) {
  constexpr TimeNs kMax = std::numeric_limits<TimeNs>::max();
  constexpr TimeNs kSlack = 1000000000;
  TimeNs begin[kNumRanks], end[kNumRanks];
  std::fill(begin, begin + kNumRanks, kMax);
  std::fill(end, end + kNumRanks, -kMax);
  for (const EventKey& key : keys) {
    begin[key.rank] = std::min(begin[key.rank], key.time);
    end[key.rank] = std::max(end[key.rank], key.time);
  }
  if (begin[kScanRank] > end[kScanRank]) return;
  for (const RosRank rank : {kOdometryRank, kImuRank}) {
    if (begin[rank] > end[rank]) continue;
    if (begin[rank] <= end[kScanRank] + kSlack &&
        end[rank] >= begin[kScanRank] - kSlack) {
      continue;
    }
    info_.warnings.push_back(absl::StrFormat(
        "%s: %s has stamps from %s s to %s s, scans from %s s to %s s: no time "
        "in common, so it says nothing about them (another clock, "
        "use_sim_time?)",
        filename_, rank == kOdometryRank ? "odometry" : "the IMU",
        FormatTime(begin[rank]), FormatTime(end[rank]),
        FormatTime(begin[kScanRank]), FormatTime(end[kScanRank])));
  }
}

void RosRecording::CountEvents(const std::vector<EventKey>& keys) {
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
}

void RosRecording::ChooseTrackingFrame() {
  if (frames_.Knows(tracking_frame_)) return;
  for (const std::set<std::string>& seen : seen_frames_) {
    if (seen.count(tracking_frame_) > 0) return;
  }
  for (const RosRank rank : {kOdometryRank, kScanRank}) {
    std::set<std::string> seen = seen_frames_[rank];
    seen.erase("");  // odometry without child_frame_id
    if (seen.empty()) continue;
    info_.warnings.push_back(
        absl::StrCat(filename_, ": tracking frame \"", tracking_frame_,
                     "\" does not occur; taking \"", *seen.begin(), "\""));
    tracking_frame_ = *seen.begin();
    return;
  }
}

void RosRecording::CheckFrames() {
  ChooseTrackingFrame();
  std::set<std::string> frames;
  for (const std::set<std::string>& seen : seen_frames_) {
    frames.insert(seen.begin(), seen.end());
  }
  for (const std::string& frame : frames) {
    std::vector<std::string> moving;
    const auto pose = frames_.Lookup(tracking_frame_, frame, &moving);
    if (frame.empty()) {
      info_.warnings.push_back(absl::StrCat(
          filename_, ": messages without a frame; taken to be at \"",
          tracking_frame_, "\""));
    } else if (!pose.has_value()) {
      info_.warnings.push_back(absl::StrCat(filename_, ": no transform from \"",
                                            frame, "\" to \"", tracking_frame_,
                                            "\"; assumed to coincide"));
    } else if (!moving.empty()) {
      info_.warnings.push_back(
          absl::StrCat(filename_, ": \"", absl::StrJoin(moving, "\", \""),
                       "\" moves on the robot; its first pose is used"));
    }
    if (pose.has_value() && seen_frames_[kScanRank].count(frame) > 0 &&
        std::abs(pose->linear()(2, 2)) < std::cos(kMaxTilt)) {
      info_.warnings.push_back(
          absl::StrCat(filename_, ": laser frame \"", frame,
                       "\" is tilted; its scans are treated as level"));
    }
  }
}

void RosRecording::Place(RosEvent* decoded) {
  const Eigen::Isometry3d sensor = SensorPose(decoded->frame);
  if (decoded->rank == kScanRank) {
    LaserScan& scan = absl::get<LaserScan>(decoded->event);
    scan.laser_pose = Planar(sensor);
    if (sensor.linear()(2, 2) <
        0.) {  // Upside down: beams run in the other direction.
      scan.angle_min = -scan.angle_min;
      scan.angle_increment = -scan.angle_increment;
    }
    const Pose2 laser_from_robot = scan.laser_pose.Inverse();
    for (const Eigen::Vector3d& point : decoded->cloud.points) {
      scan.points.push_back(laser_from_robot *
                            Eigen::Vector2d((sensor * point).head<2>()));
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

absl::Status RosRecording::Advance() {
  RosMessage message;
  const absl::StatusOr<bool> more = container_->Next(&message);
  if (!more.ok()) return more.status();
  if (!*more) {
    at_end_ = true;
    return absl::OkStatus();
  }
  RosEvent decoded;
  if (!decoder_.Decode(message, &decoded)) return absl::OkStatus();
  const EventKey key{EventTime(decoded.event), decoded.rank, ordinal_++};
  if (next_dropped_ < reordering_.dropped.size() &&
      reordering_.dropped[next_dropped_] == key.ordinal) {
    ++next_dropped_;
    return absl::OkStatus();
  }
  Place(&decoded);
  waiting_.Push(key, std::move(decoded.event));
  return absl::OkStatus();
}

}  // namespace

absl::StatusOr<std::unique_ptr<SensorSource>> OpenRosRecording(
    const std::string& filename, std::unique_ptr<RosContainer> container,
    const SensorSourceOptions& options) {
  auto source =
      absl::make_unique<RosRecording>(filename, std::move(container), options);
  const absl::Status status = source->Open(options);
  if (!status.ok()) return source->Explained(status);
  return std::unique_ptr<SensorSource>(std::move(source));
}

}  // namespace io
}  // namespace cartographer_ext
