// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
#include "cartographer/sensor/compressed_point_cloud.h"

#include <array>
#include <map>

#include "cartographer/common/math.h"
#include "glog/logging.h"

namespace cartographer {
namespace sensor {

namespace {

constexpr float kResolution = 0.001f;  // metres
constexpr int kBits = 10;              // of a coordinate inside its cube
constexpr int32 kMask = (1 << kBits) - 1;
constexpr int32 kMaxCoordinate = 1 << 23;
constexpr size_t kHeaderSize = 4;  // count and cube

using Cube = std::array<int32, 3>;

// The order in which cubes are stored: those of 64, then of 8 neighbouring ones
// a side stay together, and at each level z counts most.
struct StorageOrder {
  bool operator()(const Cube& a, const Cube& b) const {
    for (const int shift : {6, 3, 0}) {
      for (int i = 2; i >= 0; --i) {
        const int32 a_part = a[i] >> shift;
        const int32 b_part = b[i] >> shift;
        if (a_part != b_part) return a_part < b_part;
      }
    }
    return false;
  }
};

// Whether the data is a sequence of whole blocks with `num_points` in all.
bool IsWellFormed(const std::vector<int32>& data, const size_t num_points) {
  size_t position = 0;
  size_t points = 0;
  while (position < data.size()) {
    const int32 count = data[position];
    if (count <= 0 || data.size() - position < kHeaderSize ||
        static_cast<size_t>(count) > data.size() - position - kHeaderSize) {
      return false;
    }
    for (size_t i = 1; i != kHeaderSize; ++i) {
      const int32 cube = data[position + i];
      if (cube < -(kMaxCoordinate >> kBits) || cube > kMaxCoordinate >> kBits) {
        return false;
      }
    }
    points += count;
    position += kHeaderSize + count;
  }
  return points == num_points;
}

}  // namespace

CompressedPointCloud::CompressedPointCloud(const PointCloud& point_cloud)
    : num_points_(point_cloud.size()) {
  // Packed points by cube, in the order of the cloud.
  std::map<Cube, std::vector<int32>, StorageOrder> cubes;
  for (const RangefinderPoint& point : point_cloud) {
    Cube cube;
    int32 packed = 0;
    for (int i = 2; i >= 0; --i) {
      const float scaled = point.position[i] / kResolution;
      // In this form NaN does not pass.
      CHECK(std::abs(scaled) < kMaxCoordinate) << point.position.transpose();
      const int32 millimetres = common::RoundToInt(scaled);
      // An arithmetic shift: rounds down for negative numbers, too.
      cube[i] = millimetres >> kBits;
      packed = (packed << kBits) | (millimetres & kMask);
    }
    cubes[cube].push_back(packed);
  }
  point_data_.reserve(kHeaderSize * cubes.size() + num_points_);
  for (const auto& entry : cubes) {
    point_data_.push_back(static_cast<int32>(entry.second.size()));
    point_data_.insert(point_data_.end(), entry.first.begin(),
                       entry.first.end());
    point_data_.insert(point_data_.end(), entry.second.begin(),
                       entry.second.end());
  }
}

CompressedPointCloud::CompressedPointCloud(
    const proto::CompressedPointCloud& proto)
    : point_data_(proto.point_data().begin(), proto.point_data().end()),
      num_points_(proto.num_points()) {
  CHECK(IsWellFormed(point_data_, num_points_))
      << "broken compressed point cloud";
}

PointCloud CompressedPointCloud::Decompress() const {
  std::vector<RangefinderPoint> points;
  points.reserve(num_points_);
  for (const RangefinderPoint& point : *this) points.push_back(point);
  return PointCloud(std::move(points));
}

CompressedPointCloud::ConstIterator CompressedPointCloud::begin() const {
  return ConstIterator(this);
}

CompressedPointCloud::ConstIterator CompressedPointCloud::end() const {
  return ConstIterator::EndIterator(this);
}

bool CompressedPointCloud::operator==(const CompressedPointCloud& other) const {
  return num_points_ == other.num_points_ && point_data_ == other.point_data_;
}

proto::CompressedPointCloud CompressedPointCloud::ToProto() const {
  proto::CompressedPointCloud proto;
  proto.set_num_points(static_cast<int32>(num_points_));
  *proto.mutable_point_data() = {point_data_.begin(), point_data_.end()};
  return proto;
}

CompressedPointCloud::ConstIterator::ConstIterator(
    const CompressedPointCloud* const cloud)
    : ConstIterator(cloud, 0) {
  EnterBlock();
}

CompressedPointCloud::ConstIterator::ConstIterator(
    const CompressedPointCloud* const cloud, const size_t position)
    : cloud_(cloud), position_(position) {}

CompressedPointCloud::ConstIterator
CompressedPointCloud::ConstIterator::EndIterator(
    const CompressedPointCloud* const cloud) {
  return ConstIterator(cloud, cloud->point_data_.size());
}

void CompressedPointCloud::ConstIterator::EnterBlock() {
  const std::vector<int32>& data = cloud_->point_data_;
  if (left_in_block_ > 0 || position_ == data.size()) return;
  left_in_block_ = data[position_];
  cube_ = Eigen::Vector3i(data[position_ + 1], data[position_ + 2],
                          data[position_ + 3]);
  position_ += kHeaderSize;
}

RangefinderPoint CompressedPointCloud::ConstIterator::operator*() const {
  const int32 packed = cloud_->point_data_[position_];
  Eigen::Vector3f point;
  for (int i = 0; i != 3; ++i) {
    const int32 millimetres =
        cube_[i] * (1 << kBits) + ((packed >> (i * kBits)) & kMask);
    point[i] = static_cast<float>(millimetres) * kResolution;
  }
  return {point};
}

CompressedPointCloud::ConstIterator&
CompressedPointCloud::ConstIterator::operator++() {
  ++position_;
  --left_in_block_;
  EnterBlock();
  return *this;
}

bool CompressedPointCloud::ConstIterator::operator==(
    const ConstIterator& other) const {
  return cloud_ == other.cloud_ && position_ == other.position_;
}

bool CompressedPointCloud::ConstIterator::operator!=(
    const ConstIterator& other) const {
  return !(*this == other);
}

}  // namespace sensor
}  // namespace cartographer
