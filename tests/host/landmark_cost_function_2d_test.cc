// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
#include "cartographer/mapping/internal/optimization/cost_functions/landmark_cost_function_2d.h"

#include <cmath>
#include <memory>
#include <vector>

#include "gtest/gtest.h"

namespace cartographer {
namespace mapping {
namespace optimization {
namespace {

using transform::Rigid3d;
using Vector6 = Eigen::Matrix<double, 6, 1>;

// (tracking <- gravity aligned) tilts of two nodes on a ramp.
const Eigen::Quaterniond kTiltBefore(
    Eigen::AngleAxisd(0.1, Eigen::Vector3d::UnitX()));
const Eigen::Quaterniond kTiltAfter(
    Eigen::AngleAxisd(-0.2, Eigen::Vector3d::UnitY()));

NodeSpec2D NodeAt(const double seconds, const Eigen::Quaterniond& gravity) {
  NodeSpec2D node;
  node.time = common::FromUniversal(0) + common::FromSeconds(seconds);
  node.gravity_alignment = gravity;
  return node;
}

// A robot that drives from `before` to `after` and sees a landmark at
// `fraction` between them.
struct Scene {
  Eigen::Vector3d before;
  Eigen::Vector3d after;
  double fraction;

  Rigid3d Tracking(const Eigen::Vector3d& planar,
                   const Eigen::Quaterniond& gravity) const {
    return Rigid3d(
        Eigen::Vector3d(planar[0], planar[1], 0.),
        Eigen::AngleAxisd(planar[2], Eigen::Vector3d::UnitZ()) * gravity);
  }
  // Independent of the code under test: Eigen's own interpolation.
  Rigid3d TrackingAtObservation() const {
    const Rigid3d first = Tracking(before, kTiltBefore);
    const Rigid3d second = Tracking(after, kTiltAfter);
    return Rigid3d(
        (1. - fraction) * first.translation() + fraction * second.translation(),
        first.rotation().slerp(fraction, second.rotation()));
  }
  std::unique_ptr<ceres::CostFunction> CostFunction(
      const Rigid3d& tracking_from_landmark, const double translation_weight,
      const double rotation_weight) const {
    const NodeSpec2D node_before = NodeAt(100., kTiltBefore);
    const NodeSpec2D node_after = NodeAt(102., kTiltAfter);
    const LandmarkObservation observation{
        0, node_before.time + common::FromSeconds(2. * fraction),
        tracking_from_landmark, translation_weight, rotation_weight};
    return std::unique_ptr<ceres::CostFunction>(CreateLandmarkCostFunction2D(
        observation,
        ObservationSite(node_before, node_after, observation.time)));
  }
};

Vector6 Residuals(const ceres::CostFunction& cost_function, const Scene& scene,
                  const Rigid3d& landmark) {
  const Eigen::Quaterniond& q = landmark.rotation();
  const Eigen::Vector4d wxyz(q.w(), q.x(), q.y(), q.z());
  const Eigen::Vector3d xyz = landmark.translation();
  const std::vector<const double*> blocks = {
      scene.before.data(), scene.after.data(), wxyz.data(), xyz.data()};
  Vector6 residuals;
  EXPECT_TRUE(cost_function.Evaluate(blocks.data(), residuals.data(), nullptr));
  return residuals;
}

const Rigid3d kTrackingFromLandmark(
    Eigen::Vector3d(2., -0.5, 0.3),
    Eigen::Quaterniond(
        Eigen::AngleAxisd(0.7, Eigen::Vector3d(0.3, -0.5, 0.8).normalized())));

TEST(LandmarkCostFunction2DTest, VanishesWhereTheObservationPutsTheLandmark) {
  for (const double fraction : {0., 0.25, 0.9, 1.}) {
    const Scene scene{{1., 2., 3.}, {1.4, 1.7, -3.1}, fraction};
    const auto cost_function =
        scene.CostFunction(kTrackingFromLandmark, 100., 50.);
    const Vector6 residuals =
        Residuals(*cost_function, scene,
                  scene.TrackingAtObservation() * kTrackingFromLandmark);
    EXPECT_LT(residuals.norm(), 1e-6) << "fraction " << fraction;
  }
}

TEST(LandmarkCostFunction2DTest, WeighsTranslationAndRotationErrors) {
  const Scene scene{{1., 2., 0.4}, {1.4, 1.7, 0.9}, 0.3};
  const auto cost_function = scene.CostFunction(kTrackingFromLandmark, 10., 4.);
  const Rigid3d tracking = scene.TrackingAtObservation();
  // The landmark is displaced by `offset`, both in the tracking frame, and
  // turned about its own axes.
  const Eigen::Vector3d offset(0.1, -0.2, 0.05);
  const Eigen::Vector3d turn(0.02, 0.01, -0.03);
  const Rigid3d landmark =
      tracking * Rigid3d::Translation(offset) * kTrackingFromLandmark *
      Rigid3d::Rotation(transform::AngleAxisVectorToRotationQuaternion(turn));
  const Vector6 residuals = Residuals(*cost_function, scene, landmark);
  EXPECT_LT((residuals.head<3>() + 10. * offset).norm(), 1e-6);
  EXPECT_LT((residuals.tail<3>() + 4. * turn).norm(), 1e-6);
}

// The derivatives by Jets against central differences, also where the two nodes
// have the same heading.
TEST(LandmarkCostFunction2DTest, DerivativesByAllBlocks) {
  for (const double turned : {0., 1e-5, 0.8}) {
    Scene scene{{1., 2., 0.4}, {1.4, 1.7, 0.4 + turned}, 0.3};
    const auto cost_function =
        scene.CostFunction(kTrackingFromLandmark, 3., 2.);
    Eigen::Vector4d wxyz(0.9, 0.1, -0.3, 0.2);
    wxyz.normalize();
    Eigen::Vector3d xyz(3., 1., 0.5);
    std::vector<double*> blocks = {scene.before.data(), scene.after.data(),
                                   wxyz.data(), xyz.data()};
    const std::vector<int> sizes = {3, 3, 4, 3};
    for (int block = 0; block < 4; ++block) {
      std::vector<double> jacobian(6 * sizes[block]);
      std::vector<double*> jacobians(4, nullptr);
      jacobians[block] = jacobian.data();
      Vector6 residuals;
      ASSERT_TRUE(cost_function->Evaluate(blocks.data(), residuals.data(),
                                          jacobians.data()));
      for (int column = 0; column < sizes[block]; ++column) {
        const double step = 1e-6;
        Vector6 values[2];
        for (const int side : {0, 1}) {
          const double saved = blocks[block][column];
          blocks[block][column] += side == 0 ? -step : step;
          ASSERT_TRUE(cost_function->Evaluate(blocks.data(),
                                              values[side].data(), nullptr));
          blocks[block][column] = saved;
        }
        const Vector6 expected = (values[1] - values[0]) / (2. * step);
        for (int row = 0; row < 6; ++row) {
          EXPECT_NEAR(jacobian[row * sizes[block] + column], expected[row],
                      1e-5)
              << "turn " << turned << " block " << block << " column " << column
              << " row " << row;
        }
      }
    }
  }
}

TEST(InterpolatePosesTest, TurnsAlongTheShorterArc) {
  const Eigen::Vector3d up = Eigen::Vector3d::UnitZ();
  const SpatialPose<double> first{
      Eigen::Quaterniond(Eigen::AngleAxisd(0.2, up)), {1., 0., 0.}};
  SpatialPose<double> second{Eigen::Quaterniond(Eigen::AngleAxisd(1., up)),
                             {3., 1., 0.}};
  for (const double sign : {1., -1.}) {
    second.rotation.coeffs() *= sign;
    const SpatialPose<double> middle = InterpolatePoses(first, second, 0.25);
    EXPECT_NEAR(middle.rotation.angularDistance(
                    Eigen::Quaterniond(Eigen::AngleAxisd(0.4, up))),
                0., 1e-7);
    EXPECT_TRUE(
        middle.translation.isApprox(Eigen::Vector3d(1.5, 0.25, 0.), 1e-12));
  }
}

}  // namespace
}  // namespace optimization
}  // namespace mapping
}  // namespace cartographer
