// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
#include "cartographer/transform/transform_interpolation_buffer.h"

#include <algorithm>

#include "cartographer/transform/transform.h"
#include "glog/logging.h"

namespace cartographer {
namespace transform {

TransformInterpolationBuffer::TransformInterpolationBuffer(
    const mapping::proto::Trajectory& trajectory) {
  for (const mapping::proto::Trajectory::Node& node : trajectory.node()) {
    Push(common::FromUniversal(node.timestamp()), ToRigid3(node.pose()));
  }
}

void TransformInterpolationBuffer::SetSizeLimit(
    const size_t buffer_size_limit) {
  buffer_size_limit_ = buffer_size_limit;
  DropOldest();
}

void TransformInterpolationBuffer::Push(const common::Time time,
                                        const transform::Rigid3d& transform) {
  CHECK(empty() || latest_time() <= time) << "transforms are out of order";
  timestamped_transforms_.push_back(TimestampedTransform{time, transform});
  DropOldest();
}

void TransformInterpolationBuffer::Clear() { timestamped_transforms_.clear(); }

bool TransformInterpolationBuffer::Has(const common::Time time) const {
  return !empty() && earliest_time() <= time && time <= latest_time();
}

transform::Rigid3d TransformInterpolationBuffer::Lookup(
    const common::Time time) const {
  CHECK(Has(time)) << "no transform for " << time;
  const auto end = std::lower_bound(
      timestamped_transforms_.begin(), timestamped_transforms_.end(), time,
      [](const TimestampedTransform& entry, const common::Time wanted) {
        return entry.time < wanted;
      });
  if (end->time == time) return end->transform;
  return Interpolate(*std::prev(end), *end, time).transform;
}

common::Time TransformInterpolationBuffer::earliest_time() const {
  CHECK(!empty());
  return timestamped_transforms_.front().time;
}

common::Time TransformInterpolationBuffer::latest_time() const {
  CHECK(!empty());
  return timestamped_transforms_.back().time;
}

bool TransformInterpolationBuffer::empty() const {
  return timestamped_transforms_.empty();
}

size_t TransformInterpolationBuffer::size_limit() const {
  return buffer_size_limit_;
}

size_t TransformInterpolationBuffer::size() const {
  return timestamped_transforms_.size();
}

void TransformInterpolationBuffer::DropOldest() {
  while (size() > buffer_size_limit_) timestamped_transforms_.pop_front();
}

}  // namespace transform
}  // namespace cartographer
