// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
#include "cartographer/transform/rigid_transform.h"

#include <cmath>
#include <limits>
#include <memory>
#include <sstream>
#include <string>
#include <vector>

#include "cartographer/common/configuration_file_resolver.h"
#include "ceres/jet.h"
#include "gtest/gtest.h"

namespace cartographer {
namespace transform {
namespace {

Rigid3d FromLua(const std::string& code) {
  common::LuaParameterDictionary dictionary(
      code,
      std::unique_ptr<common::FileResolver>(
          new common::ConfigurationFileResolver(std::vector<std::string>())));
  return FromDictionary(&dictionary);
}

TEST(Rigid2Test, QuarterTurnByHand) {
  const Rigid2d pose({1., 2.}, M_PI / 2.);
  const Eigen::Vector2d moved = pose * Eigen::Vector2d(3., 0.);
  EXPECT_NEAR(moved.x(), 1., 1e-15);
  EXPECT_NEAR(moved.y(), 5., 1e-15);
  const Rigid2d back = pose.inverse();
  EXPECT_NEAR(back.translation().x(), -2., 1e-15);
  EXPECT_NEAR(back.translation().y(), 1., 1e-15);
  const Rigid2d none = back * pose;
  EXPECT_NEAR(none.translation().norm(), 0., 1e-15);
  EXPECT_NEAR(none.normalized_angle(), 0., 1e-15);
}

TEST(Rigid2Test, AnglesAddUpAndNormalize) {
  const Rigid2d twice =
      Rigid2d::Rotation(3.) * Rigid2d::Rotation(Eigen::Rotation2Dd(1.));
  EXPECT_DOUBLE_EQ(twice.rotation().angle(), 4.);
  EXPECT_DOUBLE_EQ(twice.normalized_angle(), 4. - 2. * M_PI);
}

TEST(Rigid2Test, FactoriesAndCast) {
  EXPECT_EQ(Rigid2d::Identity().translation(), Eigen::Vector2d::Zero());
  const Rigid2f single = Rigid2d::Translation({0.5, -1.}).cast<float>();
  EXPECT_EQ(single.translation(), Eigen::Vector2f(0.5f, -1.f));
  EXPECT_EQ(single.rotation().angle(), 0.f);
}

TEST(Rigid2Test, WorksWithJets) {
  using Jet = ceres::Jet<double, 3>;
  const Rigid2<Jet> pose(Rigid2<Jet>::Vector(Jet(1., 0), Jet(2., 1)),
                         Eigen::Rotation2D<Jet>(Jet(0., 2)));
  const auto point = pose * Rigid2<Jet>::Vector(Jet(1.), Jet(0.));
  EXPECT_EQ(point.x().a, 2.);
  EXPECT_EQ(point.y().v[2], 1.);  // moves sideways with the angle
}

TEST(Rigid3Test, AgainstMatrices) {
  const Rigid3d a({1., -2., 3.}, RollPitchYaw(0.1, -0.2, 0.3));
  const Rigid3d b({0.5, 0.25, -1.}, RollPitchYaw(-1., 0.4, 2.));
  const Eigen::Vector3d point(0.3, 0.7, -0.9);
  const Eigen::Vector3d one_by_one = a * (b * point);
  EXPECT_TRUE(((a * b) * point).isApprox(one_by_one, 1e-14));
  const Eigen::Vector3d by_matrix =
      a.rotation().toRotationMatrix() * point + a.translation();
  EXPECT_TRUE((a * point).isApprox(by_matrix, 1e-14));
  EXPECT_TRUE((a.inverse() * (a * point)).isApprox(point, 1e-14));
  EXPECT_NEAR((a * b).rotation().norm(), 1., 1e-15);
}

TEST(Rigid3Test, Factories) {
  const Rigid3d from_arrays =
      Rigid3d::FromArrays({{0., 0., 0., 1.}}, {{1., 2., 3.}});
  EXPECT_EQ(from_arrays.rotation().w(), 0.);
  EXPECT_EQ(from_arrays.rotation().z(), 1.);
  EXPECT_EQ(from_arrays.translation().z(), 3.);
  const Rigid3d turn =
      Rigid3d::Rotation(Eigen::AngleAxisd(M_PI, Eigen::Vector3d::UnitX()));
  EXPECT_NEAR((turn * Eigen::Vector3d(0., 1., 0.)).y(), -1., 1e-15);
  const Rigid3f single =
      Rigid3d::Translation(Eigen::Vector3d(1., 0., 0.)).cast<float>();
  EXPECT_EQ(single.translation().x(), 1.f);
}

TEST(Rigid3Test, IsValid) {
  EXPECT_TRUE(Rigid3d::Identity().IsValid());
  const double nan = std::numeric_limits<double>::quiet_NaN();
  EXPECT_FALSE(Rigid3d::Translation(Eigen::Vector3d(0., nan, 0.)).IsValid());
  EXPECT_FALSE(
      Rigid3d::Rotation(Eigen::Quaterniond(1.1, 0., 0., 0.)).IsValid());
  EXPECT_FALSE(
      Rigid3d::Rotation(Eigen::Quaterniond(nan, 0., 0., 0.)).IsValid());
}

TEST(RigidTransformTest, RollPitchYawTurnsAboutFixedAxes) {
  // Roll by 90 degrees takes y to z, then yaw by 90 degrees leaves z alone.
  const Eigen::Quaterniond turn = RollPitchYaw(M_PI / 2., 0., M_PI / 2.);
  EXPECT_TRUE((turn * Eigen::Vector3d::UnitY())
                  .isApprox(Eigen::Vector3d::UnitZ(), 1e-15));
  EXPECT_TRUE((turn * Eigen::Vector3d::UnitX())
                  .isApprox(Eigen::Vector3d::UnitY(), 1e-15));
}

TEST(RigidTransformTest, Printing) {
  std::ostringstream text;
  text << Rigid2d({1., 2.}, 0.5);
  EXPECT_EQ(text.str(), "{ t: [1, 2], r: [0.5] }");
  EXPECT_EQ(Rigid3d::Identity().DebugString(),
            "{ t: [0, 0, 0], q: [1, 0, 0, 0] }");
}

TEST(RigidTransformTest, FromDictionary) {
  const Rigid3d angles =
      FromLua("return { translation = { 1, 2, 3 }, rotation = { 0, 0, 0.5 } }");
  EXPECT_EQ(angles.translation(), Eigen::Vector3d(1., 2., 3.));
  EXPECT_NEAR(angles.rotation().z(), std::sin(0.25), 1e-15);
  const Rigid3d quaternion = FromLua(
      "return { translation = { 0, 0, 0 }, "
      "rotation = { w = 0, x = 0, y = 1, z = 0 } }");
  EXPECT_EQ(quaternion.rotation().y(), 1.);
}

TEST(RigidTransformDeathTest, FromBrokenDictionary) {
  EXPECT_DEATH(FromLua("return { translation = { 1, 2 }, "
                       "rotation = { 0, 0, 0 } }"),
               "three numbers");
  EXPECT_DEATH(FromLua("return { translation = { 1, 2, 3 }, "
                       "rotation = { w = 2, x = 0, y = 0, z = 0 } }"),
               "length 1");
}

}  // namespace
}  // namespace transform
}  // namespace cartographer
