// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
#ifndef CARTOGRAPHER_TRANSFORM_TRANSFORM_INTERPOLATION_BUFFER_H_
#define CARTOGRAPHER_TRANSFORM_TRANSFORM_INTERPOLATION_BUFFER_H_

#include <cstddef>
#include <deque>
#include <limits>

#include "cartographer/common/time.h"
#include "cartographer/mapping/proto/trajectory.pb.h"
#include "cartographer/transform/rigid_transform.h"
#include "cartographer/transform/timestamped_transform.h"

namespace cartographer {
namespace transform {

constexpr size_t kUnlimitedBufferSize = std::numeric_limits<size_t>::max();

// Poses in order of time that can be asked for any time in between.
class TransformInterpolationBuffer {
 public:
  TransformInterpolationBuffer() = default;
  // The node poses of a trajectory.
  explicit TransformInterpolationBuffer(
      const mapping::proto::Trajectory& trajectory);

  // Keeps the newest `buffer_size_limit` poses only.
  void SetSizeLimit(size_t buffer_size_limit);

  // `time` must not be before the last one.
  void Push(common::Time time, const transform::Rigid3d& transform);
  void Clear();

  // Whether earliest_time() <= time <= latest_time().
  bool Has(common::Time time) const;

  // Has(time) must hold.
  transform::Rigid3d Lookup(common::Time time) const;

  // Must not be empty.
  common::Time earliest_time() const;
  common::Time latest_time() const;

  bool empty() const;
  size_t size_limit() const;
  size_t size() const;

 private:
  void DropOldest();

  std::deque<TimestampedTransform> timestamped_transforms_;
  size_t buffer_size_limit_ = kUnlimitedBufferSize;
};

}  // namespace transform
}  // namespace cartographer

#endif  // CARTOGRAPHER_TRANSFORM_TRANSFORM_INTERPOLATION_BUFFER_H_
