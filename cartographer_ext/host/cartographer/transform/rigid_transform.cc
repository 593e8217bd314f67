// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
#include "cartographer/transform/rigid_transform.h"

#include <memory>
#include <vector>

#include "glog/logging.h"

namespace cartographer {
namespace transform {

Eigen::Quaterniond RollPitchYaw(const double roll, const double pitch,
                                const double yaw) {
  return Eigen::AngleAxisd(yaw, Eigen::Vector3d::UnitZ()) *
         Eigen::AngleAxisd(pitch, Eigen::Vector3d::UnitY()) *
         Eigen::AngleAxisd(roll, Eigen::Vector3d::UnitX());
}

Rigid3d FromDictionary(common::LuaParameterDictionary* const dictionary) {
  const std::vector<double> translation =
      dictionary->GetDictionary("translation")->GetArrayValuesAsDoubles();
  CHECK_EQ(translation.size(), 3) << "a translation has three numbers";
  const auto rotation = dictionary->GetDictionary("rotation");
  Eigen::Quaterniond quaternion;
  if (rotation->HasKey("w")) {
    quaternion.w() = rotation->GetDouble("w");
    quaternion.x() = rotation->GetDouble("x");
    quaternion.y() = rotation->GetDouble("y");
    quaternion.z() = rotation->GetDouble("z");
    CHECK_LE(std::abs(quaternion.norm() - 1.), 1e-9)
        << "the quaternion of a rotation must have length 1";
  } else {
    const std::vector<double> angles = rotation->GetArrayValuesAsDoubles();
    CHECK_EQ(angles.size(), 3) << "a rotation has roll, pitch and yaw";
    quaternion = RollPitchYaw(angles[0], angles[1], angles[2]);
  }
  return Rigid3d(
      Eigen::Vector3d(translation[0], translation[1], translation[2]),
      quaternion);
}

}  // namespace transform
}  // namespace cartographer
