// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
#include "cartographer/transform/timestamped_transform.h"

#include "cartographer/transform/transform.h"
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

}  // namespace
}  // namespace transform
}  // namespace cartographer
