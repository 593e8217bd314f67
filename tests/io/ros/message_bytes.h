// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
#ifndef TESTS_IO_ROS_MESSAGE_BYTES_H_
#define TESTS_IO_ROS_MESSAGE_BYTES_H_

#include <array>
#include <cstdint>
#include <cstring>
#include <string>
#include <vector>

#include "cartographer_ext/io/ros/ros_messages.h"

namespace cartographer_ext {
namespace test {

// Serializes messages field by field, as their definitions say.
class Bytes {
 public:
  explicit Bytes(const io::RosEncoding encoding = io::RosEncoding::kRos1)
      : cdr_(encoding == io::RosEncoding::kCdr) {}

  template <typename T>
  Bytes& Add(T value) {
    while (cdr_ && data_.size() % sizeof(T) != 0) data_.push_back('\0');
    char raw[sizeof(T)];
    std::memcpy(raw, &value, sizeof(T));
    data_.append(raw, sizeof(T));
    return *this;
  }
  Bytes& Text(const std::string& text) {
    Add(static_cast<uint32_t>(text.size() + (cdr_ ? 1 : 0)));
    data_ += text;
    if (cdr_) data_.push_back('\0');
    return *this;
  }
  Bytes& Header(uint32_t seconds, uint32_t nanoseconds,
                const std::string& frame) {
    if (!cdr_) Add(uint32_t{7});
    return Add(seconds).Add(nanoseconds).Text(frame);
  }
  Bytes& Doubles(const std::vector<double>& values) {
    for (const double value : values) Add(value);
    return *this;
  }
  Bytes& Floats(const std::vector<float>& values) {
    for (const float value : values) Add(value);
    return *this;
  }
  Bytes& Raw(const std::string& bytes) {
    data_ += bytes;
    return *this;
  }
  std::string data() const {
    return cdr_ ? std::string("\0\1\0\0", 4) + data_ : data_;
  }

 private:
  const bool cdr_;
  std::string data_;
};

// sensor_msgs/PointCloud2: a row of points, each of x, y, z and an intensity.
// `times` are the bytes of a field `time_field` of `time_type` (PointField's
// numbers) of each point, or there is no such field.
inline std::string PointCloud2Bytes(
    const io::RosEncoding encoding, const uint32_t seconds,
    const std::string& frame, const std::vector<std::array<float, 3>>& points,
    const std::string& time_field = "", const uint8_t time_type = 0,
    const std::vector<std::string>& times = {}) {
  constexpr uint8_t kFloat32 = 7;
  const uint32_t n = static_cast<uint32_t>(points.size());
  const uint32_t num_fields = times.empty() ? 4 : 5;
  const uint32_t step =
      16 + (times.empty() ? 0 : static_cast<uint32_t>(times[0].size()));
  Bytes bytes(encoding);
  bytes.Header(seconds, 0, frame).Add(uint32_t{1}).Add(n).Add(num_fields);
  uint32_t offset = 0;
  for (const char* name : {"x", "y", "z", "intensity"}) {
    bytes.Text(name).Add(offset).Add(kFloat32).Add(uint32_t{1});
    offset += 4;
  }
  if (!times.empty())
    bytes.Text(time_field).Add(offset).Add(time_type).Add(uint32_t{1});
  Bytes data;
  for (size_t i = 0; i < points.size(); ++i) {
    data.Floats({points[i][0], points[i][1], points[i][2], 99.f});
    if (!times.empty()) data.Raw(times[i]);
  }
  return bytes.Add(uint8_t{0})
      .Add(step)
      .Add(step * n)
      .Add(step * n)
      .Raw(data.data())
      .Add(uint8_t{1})
      .data();
}

}  // namespace test
}  // namespace cartographer_ext

#endif  // TESTS_IO_ROS_MESSAGE_BYTES_H_
