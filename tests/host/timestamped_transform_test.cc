// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
#include "cartographer/transform/timestamped_transform.h"

#include "cartographer/transform/transform.h"
#include "cartographer/transform/transform_interpolation_buffer.h"
#include "gtest/gtest.h"

namespace cartographer {
namespace transform {
namespace {

common::Time At(const int64 ticks) { return common::FromUniversal(ticks); }

TEST(TimestampedTransformTest, Interpolate) {
  const TimestampedTransform start{At(100), Rigid3d::Identity()};
  const TimestampedTransform end{
      At(200), Rigid3d({10., 0., -4.}, RollPitchYaw(0., 0., 1.))};
  const TimestampedTransform middle = Interpolate(start, end, At(125));
  EXPECT_EQ(middle.time, At(125));
  EXPECT_NEAR(middle.transform.translation().x(), 2.5, 1e-14);
  EXPECT_NEAR(middle.transform.translation().z(), -1., 1e-14);
  EXPECT_NEAR(GetYaw(middle.transform), 0.25, 1e-14);
  EXPECT_EQ(Interpolate(start, start, At(100)).transform.translation().x(), 0.);
}

TEST(TimestampedTransformDeathTest, NoExtrapolation) {
  const TimestampedTransform start{At(100), Rigid3d::Identity()};
  const TimestampedTransform end{At(200), Rigid3d::Identity()};
  EXPECT_DEATH(Interpolate(start, end, At(99)), "");
  EXPECT_DEATH(Interpolate(start, end, At(201)), "");
}

TEST(TimestampedTransformTest, Protos) {
  const TimestampedTransform back = FromProto(ToProto(TimestampedTransform{
      At(7), Rigid3d::Translation(Eigen::Vector3d(1., 2., 3.))}));
  EXPECT_EQ(back.time, At(7));
  EXPECT_EQ(back.transform.translation().z(), 3.);
}

TEST(TransformInterpolationBufferTest, LooksUp) {
  TransformInterpolationBuffer buffer;
  EXPECT_TRUE(buffer.empty());
  EXPECT_FALSE(buffer.Has(At(1)));
  for (int i = 0; i != 5; ++i) {
    buffer.Push(At(10 * i), Rigid3d::Translation(Eigen::Vector3d(i, 0., 0.)));
  }
  EXPECT_EQ(buffer.size(), 5);
  EXPECT_TRUE(buffer.Has(At(0)));
  EXPECT_TRUE(buffer.Has(At(40)));
  EXPECT_FALSE(buffer.Has(At(41)));
  EXPECT_EQ(buffer.Lookup(At(0)).translation().x(), 0.);
  EXPECT_NEAR(buffer.Lookup(At(25)).translation().x(), 2.5, 1e-14);
  EXPECT_EQ(buffer.Lookup(At(40)).translation().x(), 4.);
}

TEST(TransformInterpolationBufferTest, SizeLimitDropsOldest) {
  TransformInterpolationBuffer buffer;
  EXPECT_EQ(buffer.size_limit(), kUnlimitedBufferSize);
  for (int i = 0; i != 5; ++i) buffer.Push(At(i), Rigid3d::Identity());
  buffer.SetSizeLimit(2);
  EXPECT_EQ(buffer.size(), 2);
  EXPECT_EQ(buffer.earliest_time(), At(3));
  buffer.Push(At(7), Rigid3d::Identity());
  EXPECT_EQ(buffer.earliest_time(), At(4));
  EXPECT_EQ(buffer.latest_time(), At(7));
  buffer.Clear();
  EXPECT_TRUE(buffer.empty());
}

TEST(TransformInterpolationBufferTest, FromTrajectory) {
  mapping::proto::Trajectory trajectory;
  for (int i = 0; i != 2; ++i) {
    auto* const node = trajectory.add_node();
    node->set_timestamp(100 * i);
    *node->mutable_pose() =
        ToProto(Rigid3d::Translation(Eigen::Vector3d(0., i, 0.)));
  }
  const TransformInterpolationBuffer buffer(trajectory);
  EXPECT_NEAR(buffer.Lookup(At(50)).translation().y(), 0.5, 1e-14);
}

TEST(TransformInterpolationBufferDeathTest, Misuse) {
  TransformInterpolationBuffer buffer;
  EXPECT_DEATH(buffer.earliest_time(), "");
  EXPECT_DEATH(buffer.Lookup(At(0)), "no transform");
  buffer.Push(At(5), Rigid3d::Identity());
  EXPECT_DEATH(buffer.Push(At(4), Rigid3d::Identity()), "out of order");
}

}  // namespace
}  // namespace transform
}  // namespace cartographer
