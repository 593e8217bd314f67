// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
#include "cartographer/transform/transform.h"

#include <cmath>

#include "ceres/jet.h"
#include "gtest/gtest.h"

namespace cartographer {
namespace transform {
namespace {

TEST(TransformTest, Angles) {
  EXPECT_NEAR(GetAngle(Rigid3d::Rotation(Eigen::AngleAxisd(
                  0.7, Eigen::Vector3d(1., 1., 1.).normalized()))),
              0.7, 1e-15);
  // -q turns as q does.
  EXPECT_NEAR(GetAngle(Rigid3d::Rotation(Eigen::Quaterniond(-1., 0., 0., 0.))),
              0., 1e-15);
  EXPECT_NEAR(GetYaw(RollPitchYaw(0.2, -0.3, 1.1)), 1.1, 1e-15);
  EXPECT_NEAR(GetYaw(Rigid3d::Rotation(RollPitchYaw(0., 0., -2.))), -2., 1e-15);
}

TEST(TransformTest, AngleAxisVectors) {
  const Eigen::Vector3d vector(0.3, -0.2, 1.4);
  const Eigen::Quaterniond quaternion =
      AngleAxisVectorToRotationQuaternion(vector);
  EXPECT_NEAR(quaternion.norm(), 1., 1e-15);
  EXPECT_TRUE(
      RotationQuaternionToAngleAxisVector(quaternion).isApprox(vector, 1e-14));
  // The other sign is the same rotation.
  const Eigen::Quaterniond negative(-quaternion.w(), -quaternion.x(),
                                    -quaternion.y(), -quaternion.z());
  EXPECT_TRUE(
      RotationQuaternionToAngleAxisVector(negative).isApprox(vector, 1e-14));
  const Eigen::Vector3d tiny(1e-9, 0., 0.);
  EXPECT_TRUE(RotationQuaternionToAngleAxisVector(
                  AngleAxisVectorToRotationQuaternion(tiny))
                  .isApprox(tiny, 1e-6));
}

TEST(TransformTest, AngleAxisVectorsOfJets) {
  using Jet = ceres::Jet<double, 3>;
  const Eigen::Matrix<Jet, 3, 1> zero(Jet(0., 0), Jet(0., 1), Jet(0., 2));
  const Eigen::Quaternion<Jet> quaternion =
      AngleAxisVectorToRotationQuaternion(zero);
  EXPECT_EQ(quaternion.w().a, 1.);
  EXPECT_EQ(quaternion.y().v[1], 0.5);
}

TEST(TransformTest, ProjectAndEmbed) {
  const Rigid2d flat =
      Project2D(Rigid3d({1., 2., 3.}, RollPitchYaw(0.1, 0.1, 0.5)));
  EXPECT_EQ(flat.translation(), Eigen::Vector2d(1., 2.));
  EXPECT_NEAR(flat.rotation().angle(), 0.5, 1e-15);
  const Rigid3d back = Embed3D(flat);
  EXPECT_EQ(back.translation(), Eigen::Vector3d(1., 2., 0.));
  EXPECT_NEAR(GetYaw(back), 0.5, 1e-15);
  EXPECT_NEAR(GetAngle(back), 0.5, 1e-15);
}

TEST(TransformTest, Protos) {
  const Rigid3d pose({1., 2., 3.}, RollPitchYaw(0.1, 0.2, 0.3));
  const proto::Rigid3d proto = ToProto(pose);
  EXPECT_EQ(proto.translation().y(), 2.);
  EXPECT_EQ(proto.rotation().w(), pose.rotation().w());
  const Rigid3d back = ToRigid3(proto);
  EXPECT_EQ(back.translation(), pose.translation());
  EXPECT_EQ(back.rotation().coeffs(), pose.rotation().coeffs());

  const Rigid2d flat({4., 5.}, 0.6);
  EXPECT_EQ(ToRigid2(ToProto(flat)).translation(), flat.translation());
  EXPECT_EQ(ToRigid2(ToProto(flat)).rotation().angle(), 0.6);
  EXPECT_EQ(ToProto(flat.cast<float>()).rotation(), 0.6f);

  EXPECT_EQ(ToEigen(ToProto(Eigen::Vector2d(1., 2.))), Eigen::Vector2d(1., 2.));
  EXPECT_EQ(ToEigen(ToProto(Eigen::Vector3f(1.f, 2.f, 3.f))),
            Eigen::Vector3f(1.f, 2.f, 3.f));
  EXPECT_EQ(ToEigen(ToProto(Eigen::Vector4f(1.f, 2.f, 3.f, 4.f))),
            Eigen::Vector4f(1.f, 2.f, 3.f, 4.f));
  EXPECT_EQ(ToProto(pose.cast<float>()).translation().z(), 3.f);
  EXPECT_EQ(ToProto(Eigen::Quaternionf(1.f, 2.f, 3.f, 4.f)).z(), 4.f);
}

}  // namespace
}  // namespace transform
}  // namespace cartographer
