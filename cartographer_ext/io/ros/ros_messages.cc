// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
#include "cartographer_ext/io/ros/ros_messages.h"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <limits>

#include "cartographer_ext/io/carmen/carmen_line.h"

namespace cartographer_ext {
namespace io {
namespace {

constexpr double kMaxCoordinate = 1e7;
constexpr uint32_t kMaxTransforms = 10000;
constexpr uint32_t kMaxEchoes = 64;
constexpr uint64_t kMaxPoints = 1000000;
constexpr double kMaxPointTime = 1.;  // seconds

// Reads fields in their order; once something is missing, `ok` stays false.
class Decoder {
 public:
  Decoder(absl::string_view data, RosEncoding encoding)
      : rest_(data), cdr_(encoding == RosEncoding::kCdr) {
    if (!cdr_) return;
    // Big-endian or parameter-list messages are not written by ROS 2.
    ok_ = rest_.size() >= 4 && rest_[0] == 0 && rest_[1] == 1;
    if (ok_) rest_.remove_prefix(4);
    begin_ = rest_.data();
  }

  template <typename T>
  T Take() {
    T value{};
    Align(sizeof(T));
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
    if (cdr_ && !text.empty()) {
      if (text.back() != '\0') ok_ = false;
      text.pop_back();
    }
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

  absl::string_view TakeBytes(size_t size) {
    const absl::string_view bytes = rest_.substr(0, size);
    Skip(size);
    return bytes;
  }

  void Skip(size_t size) {
    if (!ok_ || rest_.size() < size) {
      ok_ = false;
      return;
    }
    rest_.remove_prefix(size);
  }

  void SkipDoubles(size_t count) {
    Align(sizeof(double));
    Skip(count * sizeof(double));
  }

  RosHeader TakeHeader() {
    RosHeader header;
    if (!cdr_) Take<uint32_t>();  // sequence number
    const int64_t seconds =
        cdr_ ? int64_t{Take<int32_t>()} : int64_t{Take<uint32_t>()};
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
  // A CDR message may be padded at its end.
  bool AtEnd() const { return ok_ && rest_.size() < (cdr_ ? 8u : 1u); }

 private:
  void Align(size_t size) {
    if (!cdr_ || !ok_) return;
    const size_t past = static_cast<size_t>(rest_.data() - begin_) % size;
    if (past != 0) Skip(size - past);
  }

  absl::string_view rest_;
  bool cdr_;
  const char* begin_ = nullptr;  // where CDR counts from
  bool ok_ = true;
};

// Types of the fields of a point cloud.
constexpr uint8_t kInt32 = 5, kUint32 = 6, kFloat32 = 7, kFloat64 = 8;

// The field of a point cloud that says when a point was measured.
struct PointTime {
  static bool IsName(const std::string& name) {
    return name == "t" || name == "time" || name == "timestamp" ||
           name == "time_stamp" || name == "time_offset" ||
           name == "offset_time";
  }
  // Bytes; 0 for types that hold no time.
  static size_t Size(const uint8_t type) {
    return type == kFloat64                                        ? 8
           : type == kInt32 || type == kUint32 || type == kFloat32 ? 4
                                                                   : 0;
  }
  // Seconds after `stamp`.
  double Seconds(const char* const bytes, const TimeNs stamp) const {
    // Seconds, and from where on they are nanoseconds, since 1970.
    constexpr double kAbsoluteSeconds = 1e6, kAbsoluteNanoseconds = 1e15;
    switch (type) {
      case kInt32:
        return 1e-9 * Read<int32_t>(bytes);
      case kUint32:
        return 1e-9 * Read<uint32_t>(bytes);
      case kFloat32:
        return Read<float>(bytes);
      default:
        break;
    }
    const double value = Read<double>(bytes);
    if (!(std::abs(value) >= kAbsoluteSeconds)) return value;
    return std::abs(value) < kAbsoluteNanoseconds
               ? value - 1e-9 * static_cast<double>(stamp)
               : 1e-9 * (value - static_cast<double>(stamp));
  }
  template <typename T>
  static T Read(const char* const bytes) {
    T value;
    std::memcpy(&value, bytes, sizeof(T));
    return value;
  }

  int64_t offset = -1;
  uint8_t type = 0;
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
  // Simulators and some drivers report "no return" as range_max itself.
  scan->range_max = std::nextafter(decoder->Take<float>(), 0.f);
}

// Checks the scan and moves its stamp from the first beam to the last.
bool FinishScan(const RosHeader& header, LaserScan* scan) {
  const size_t n = scan->ranges.size();
  if (n == 0 || n > CarmenLine::kMaxReadings ||
      !(std::abs(scan->angle_min) <= 4. * kPi) ||
      !(std::abs(scan->angle_increment) * n <= 2.1 * kPi) ||
      (scan->angle_increment == 0. && n > 1) ||
      !std::isfinite(scan->range_min) || !(scan->range_max > 0.) ||
      !(scan->time_increment >= 0.) || !(scan->time_increment * n <= 10.)) {
    return false;
  }
  scan->time = header.time + FromSeconds(SweepSeconds(*scan));
  return true;
}

}  // namespace

double SweepSeconds(const LaserScan& scan) {
  if (!scan.point_times.empty()) {
    return -*std::min_element(scan.point_times.begin(), scan.point_times.end());
  }
  if (scan.ranges.empty()) return 0.;
  return scan.time_increment * (static_cast<double>(scan.ranges.size()) - 1.);
}

bool DecodeLaserScan(RosEncoding encoding, absl::string_view data,
                     RosHeader* header, LaserScan* scan) {
  Decoder decoder(data, encoding);
  TakeScanHead(&decoder, header, scan);
  decoder.TakeFloats(&scan->ranges);
  scan->echoes.clear();
  std::vector<float> intensities;
  decoder.TakeFloats(&intensities);
  return decoder.AtEnd() && FinishScan(*header, scan);
}

bool DecodeMultiEchoLaserScan(RosEncoding encoding, absl::string_view data,
                              RosHeader* header, LaserScan* scan) {
  Decoder decoder(data, encoding);
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

bool DecodePointCloud2(RosEncoding encoding, absl::string_view data,
                       RosHeader* header, RosPointCloud* const cloud) {
  Decoder decoder(data, encoding);
  *header = decoder.TakeHeader();
  const uint64_t height = decoder.Take<uint32_t>(),
                 width = decoder.Take<uint32_t>();
  const uint32_t num_fields = decoder.TakeCount(13);
  int64_t offsets[3] = {-1, -1, -1};
  PointTime time;
  for (uint32_t i = 0; i < num_fields && decoder.ok(); ++i) {
    const std::string name = decoder.TakeString();
    const uint32_t offset = decoder.Take<uint32_t>();
    const uint8_t type = decoder.Take<uint8_t>();
    decoder.Take<uint32_t>();  // elements
    if (name.size() == 1 && name[0] >= 'x' && name[0] <= 'z' &&
        type == kFloat32)
      offsets[name[0] - 'x'] = offset;
    if (PointTime::IsName(name) && PointTime::Size(type) > 0)
      time = PointTime{offset, type};
  }
  const bool big_endian = decoder.Take<uint8_t>() != 0;
  const uint64_t point_step = decoder.Take<uint32_t>(),
                 row_step = decoder.Take<uint32_t>();
  const absl::string_view bytes = decoder.TakeBytes(decoder.TakeCount(1));
  decoder.Take<uint8_t>();  // dense
  if (!decoder.AtEnd() || big_endian || height * width > kMaxPoints ||
      row_step < width * point_step || bytes.size() < height * row_step) {
    return false;
  }
  for (const int64_t offset : offsets) {
    if (offset < 0 ||
        static_cast<uint64_t>(offset) + sizeof(float) > point_step)
      return false;
  }
  const bool timed = time.offset >= 0 && static_cast<uint64_t>(time.offset) +
                                                 PointTime::Size(time.type) <=
                                             point_step;
  *cloud = RosPointCloud();
  for (uint64_t row = 0; row < height; ++row) {
    for (uint64_t column = 0; column < width; ++column) {
      const char* const point =
          bytes.data() + row * row_step + column * point_step;
      float xyz[3];
      for (int i = 0; i < 3; ++i)
        std::memcpy(&xyz[i], point + offsets[i], sizeof(float));
      const Eigen::Vector3d position(xyz[0], xyz[1], xyz[2]);
      if (!(position.array().abs() <= kMaxCoordinate).all()) continue;
      cloud->points.push_back(position);
      if (timed)
        cloud->times.push_back(time.Seconds(point + time.offset, header->time));
    }
  }
  const bool plausible = std::all_of(
      cloud->times.begin(), cloud->times.end(),
      [](const double seconds) { return std::abs(seconds) <= kMaxPointTime; });
  if (!plausible) cloud->times.clear();
  return true;
}

bool DecodeOdometry(RosEncoding encoding, absl::string_view data,
                    RosHeader* header, std::string* child_frame,
                    Eigen::Isometry3d* pose) {
  Decoder decoder(data, encoding);
  *header = decoder.TakeHeader();
  *child_frame = decoder.TakeFrame();
  *pose = decoder.TakePose();
  decoder.SkipDoubles(36);      // covariance
  decoder.SkipDoubles(6 + 36);  // velocities
  return decoder.AtEnd();
}

bool DecodeImu(RosEncoding encoding, absl::string_view data, RosHeader* header,
               ImuReading* reading) {
  constexpr double kMaxValue = 1e6;
  Decoder decoder(data, encoding);
  *header = decoder.TakeHeader();
  decoder.SkipDoubles(4 + 9);  // orientation
  reading->angular_velocity = decoder.TakeVector();
  decoder.SkipDoubles(9);
  reading->linear_acceleration = decoder.TakeVector();
  decoder.SkipDoubles(9);
  reading->time = header->time;
  return decoder.AtEnd() &&
         (reading->angular_velocity.array().abs() <= kMaxValue).all() &&
         (reading->linear_acceleration.array().abs() <= kMaxValue).all();
}

bool DecodeTransforms(RosEncoding encoding, absl::string_view data,
                      std::vector<RosTransform>* transforms) {
  Decoder decoder(data, encoding);
  const uint32_t n = decoder.TakeCount(64);  // all but the names and padding
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
