// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
#include "cartographer_ext/io/ros_messages.h"

#include <cmath>
#include <cstring>
#include <limits>

#include "cartographer_ext/io/carmen_line.h"

namespace cartographer_ext {
namespace io {
namespace {

constexpr double kMaxCoordinate = 1e7;
constexpr uint32_t kMaxTransforms = 10000;
constexpr uint32_t kMaxEchoes = 64;

// Reads fields in their order; once something is missing, `ok` stays false.
class Decoder {
 public:
  explicit Decoder(absl::string_view data) : rest_(data) {}

  template <typename T>
  T Take() {
    T value{};
    if (!ok_ || rest_.size() < sizeof(T)) {
      ok_ = false;
      return value;
    }
    std::memcpy(&value, rest_.data(), sizeof(T));
    rest_.remove_prefix(sizeof(T));
    return value;
  }

  std::string TakeString() {
    const uint32_t length = Take<uint32_t>();
    if (!ok_ || rest_.size() < length) {
      ok_ = false;
      return "";
    }
    std::string text(rest_.substr(0, length));
    rest_.remove_prefix(length);
    return text;
  }

  std::string TakeFrame() {
    std::string frame = TakeString();
    if (!frame.empty() && frame[0] == '/') frame.erase(0, 1);
    return frame;
  }

  // Length of an array of elements that take at least `element_size` bytes.
  uint32_t TakeCount(size_t element_size) {
    const uint32_t count = Take<uint32_t>();
    if (ok_ && count > rest_.size() / element_size) ok_ = false;
    return ok_ ? count : 0;
  }

  void TakeFloats(std::vector<float>* values) {
    values->resize(TakeCount(sizeof(float)));
    if (values->empty()) return;
    const size_t size = values->size() * sizeof(float);
    std::memcpy(values->data(), rest_.data(), size);
    rest_.remove_prefix(size);
  }

  void Skip(size_t size) {
    if (!ok_ || rest_.size() < size) {
      ok_ = false;
      return;
    }
    rest_.remove_prefix(size);
  }

  RosHeader TakeHeader() {
    RosHeader header;
    Take<uint32_t>();  // sequence number
    const int64_t seconds = Take<uint32_t>();
    const int64_t nanoseconds = Take<uint32_t>();
    header.time = seconds * 1000000000 + nanoseconds;
    header.frame = TakeFrame();
    return header;
  }

  Eigen::Vector3d TakeVector() {
    const double x = Take<double>(), y = Take<double>(), z = Take<double>();
    return Eigen::Vector3d(x, y, z);
  }

  // Translation and quaternion. An all-zero quaternion, which careless drivers
  // send, counts as no rotation.
  Eigen::Isometry3d TakePose() {
    const Eigen::Vector3d translation = TakeVector();
    const Eigen::Vector3d vector = TakeVector();
    Eigen::Quaterniond rotation(Take<double>(), vector.x(), vector.y(),
                                vector.z());
    if (rotation.coeffs().isZero()) rotation.setIdentity();
    const double norm = rotation.norm();
    if (!(translation.array().abs() <= kMaxCoordinate).all() ||
        !(std::abs(norm - 1.) <= 0.1)) {
      ok_ = false;
      return Eigen::Isometry3d::Identity();
    }
    Eigen::Isometry3d pose = Eigen::Isometry3d::Identity();
    pose.translation() = translation;
    pose.linear() = rotation.normalized().toRotationMatrix();
    return pose;
  }

  bool ok() const { return ok_; }
  bool AtEnd() const { return ok_ && rest_.empty(); }

 private:
  absl::string_view rest_;
  bool ok_ = true;
};

// The fields in front of the ranges.
void TakeScanHead(Decoder* decoder, RosHeader* header, LaserScan* scan) {
  *header = decoder->TakeHeader();
  scan->angle_min = decoder->Take<float>();
  decoder->Take<float>();  // angle_max, implied
  scan->angle_increment = decoder->Take<float>();
  scan->time_increment = decoder->Take<float>();
  decoder->Take<float>();  // scan_time, between scans
  scan->range_min = decoder->Take<float>();
  scan->range_max = decoder->Take<float>();
}

// Checks the scan and moves its stamp from the first beam to the last.
bool FinishScan(const RosHeader& header, LaserScan* scan) {
  const size_t n = scan->ranges.size();
  if (n == 0 || n > CarmenLine::kMaxReadings ||
      !(std::abs(scan->angle_min) <= 4. * kPi) ||
      !(std::abs(scan->angle_increment) * n <= 2.1 * kPi) ||
      !std::isfinite(scan->range_min) || !(scan->range_max > 0.) ||
      !(scan->time_increment >= 0.) || !(scan->time_increment * n <= 10.)) {
    return false;
  }
  scan->time = header.time + FromSeconds(scan->time_increment * (n - 1));
  return true;
}

}  // namespace

bool DecodeLaserScan(absl::string_view data, RosHeader* header,
                     LaserScan* scan) {
  Decoder decoder(data);
  TakeScanHead(&decoder, header, scan);
  decoder.TakeFloats(&scan->ranges);
  scan->echoes.clear();
  std::vector<float> intensities;
  decoder.TakeFloats(&intensities);
  return decoder.AtEnd() && FinishScan(*header, scan);
}

bool DecodeMultiEchoLaserScan(absl::string_view data, RosHeader* header,
                              LaserScan* scan) {
  Decoder decoder(data);
  TakeScanHead(&decoder, header, scan);
  const uint32_t n = decoder.TakeCount(sizeof(uint32_t));
  if (n > CarmenLine::kMaxReadings) return false;
  scan->echoes.assign(n, {});
  scan->ranges.assign(n, std::numeric_limits<float>::quiet_NaN());
  for (uint32_t i = 0; i < n; ++i) {
    decoder.TakeFloats(&scan->echoes[i]);
    if (!decoder.ok() || scan->echoes[i].size() > kMaxEchoes) return false;
    if (!scan->echoes[i].empty()) scan->ranges[i] = scan->echoes[i].front();
  }
  const uint32_t num_intensities = decoder.TakeCount(sizeof(uint32_t));
  for (uint32_t i = 0; i < num_intensities && decoder.ok(); ++i) {
    decoder.Skip(decoder.TakeCount(sizeof(float)) * sizeof(float));
  }
  return decoder.AtEnd() && FinishScan(*header, scan);
}

bool DecodeOdometry(absl::string_view data, RosHeader* header,
                    std::string* child_frame, Eigen::Isometry3d* pose) {
  constexpr size_t kCovarianceSize = 36 * sizeof(double);
  Decoder decoder(data);
  *header = decoder.TakeHeader();
  *child_frame = decoder.TakeFrame();
  *pose = decoder.TakePose();
  decoder.Skip(kCovarianceSize);
  decoder.Skip(6 * sizeof(double) + kCovarianceSize);  // velocities
  return decoder.AtEnd();
}

bool DecodeImu(absl::string_view data, RosHeader* header, ImuReading* reading) {
  constexpr size_t kCovarianceSize = 9 * sizeof(double);
  constexpr double kMaxValue = 1e6;
  Decoder decoder(data);
  *header = decoder.TakeHeader();
  decoder.Skip(4 * sizeof(double) + kCovarianceSize);  // orientation
  reading->angular_velocity = decoder.TakeVector();
  decoder.Skip(kCovarianceSize);
  reading->linear_acceleration = decoder.TakeVector();
  decoder.Skip(kCovarianceSize);
  reading->time = header->time;
  return decoder.AtEnd() &&
         (reading->angular_velocity.array().abs() <= kMaxValue).all() &&
         (reading->linear_acceleration.array().abs() <= kMaxValue).all();
}

bool DecodeTransforms(absl::string_view data,
                      std::vector<RosTransform>* transforms) {
  Decoder decoder(data);
  const uint32_t n = decoder.TakeCount(76);  // all but the names
  if (n > kMaxTransforms) return false;
  transforms->resize(n);
  for (RosTransform& transform : *transforms) {
    transform.header = decoder.TakeHeader();
    transform.child_frame = decoder.TakeFrame();
    transform.pose = decoder.TakePose();
    if (!decoder.ok()) return false;
  }
  return decoder.AtEnd();
}

}  // namespace io
}  // namespace cartographer_ext
