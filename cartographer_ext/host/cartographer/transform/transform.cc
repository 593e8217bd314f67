// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
#include "cartographer/transform/transform.h"

namespace cartographer {
namespace transform {

namespace {

template <typename Proto, typename Vector>
Proto Vector2ToProto(const Vector& vector) {
  Proto proto;
  proto.set_x(vector.x());
  proto.set_y(vector.y());
  return proto;
}

template <typename Proto, typename Vector>
Proto Vector3ToProto(const Vector& vector) {
  Proto proto = Vector2ToProto<Proto>(vector);
  proto.set_z(vector.z());
  return proto;
}

template <typename Proto, typename Quaternion>
Proto QuaternionToProto(const Quaternion& quaternion) {
  Proto proto = Vector3ToProto<Proto>(quaternion);
  proto.set_w(quaternion.w());
  return proto;
}

}  // namespace

Rigid2d ToRigid2(const proto::Rigid2d& transform) {
  return Rigid2d(ToEigen(transform.translation()), transform.rotation());
}

Rigid3d ToRigid3(const proto::Rigid3d& rigid) {
  return Rigid3d(ToEigen(rigid.translation()), ToEigen(rigid.rotation()));
}

Eigen::Vector2d ToEigen(const proto::Vector2d& vector) {
  return {vector.x(), vector.y()};
}

Eigen::Vector3f ToEigen(const proto::Vector3f& vector) {
  return {vector.x(), vector.y(), vector.z()};
}

Eigen::Vector4f ToEigen(const proto::Vector4f& vector) {
  return {vector.x(), vector.y(), vector.z(), vector.t()};
}

Eigen::Vector3d ToEigen(const proto::Vector3d& vector) {
  return {vector.x(), vector.y(), vector.z()};
}

Eigen::Quaterniond ToEigen(const proto::Quaterniond& quaternion) {
  return {quaternion.w(), quaternion.x(), quaternion.y(), quaternion.z()};
}

proto::Rigid2d ToProto(const Rigid2d& transform) {
  proto::Rigid2d proto;
  *proto.mutable_translation() = ToProto(transform.translation());
  proto.set_rotation(transform.rotation().angle());
  return proto;
}

proto::Rigid2f ToProto(const Rigid2f& transform) {
  proto::Rigid2f proto;
  *proto.mutable_translation() =
      Vector2ToProto<proto::Vector2f>(transform.translation());
  proto.set_rotation(transform.rotation().angle());
  return proto;
}

proto::Rigid3d ToProto(const Rigid3d& rigid) {
  proto::Rigid3d proto;
  *proto.mutable_translation() = ToProto(rigid.translation());
  *proto.mutable_rotation() = ToProto(rigid.rotation());
  return proto;
}

proto::Rigid3f ToProto(const Rigid3f& rigid) {
  proto::Rigid3f proto;
  *proto.mutable_translation() = ToProto(rigid.translation());
  *proto.mutable_rotation() = ToProto(rigid.rotation());
  return proto;
}

proto::Vector2d ToProto(const Eigen::Vector2d& vector) {
  return Vector2ToProto<proto::Vector2d>(vector);
}

proto::Vector3f ToProto(const Eigen::Vector3f& vector) {
  return Vector3ToProto<proto::Vector3f>(vector);
}

proto::Vector4f ToProto(const Eigen::Vector4f& vector) {
  proto::Vector4f proto = Vector3ToProto<proto::Vector4f>(vector);
  proto.set_t(vector.w());
  return proto;
}

proto::Vector3d ToProto(const Eigen::Vector3d& vector) {
  return Vector3ToProto<proto::Vector3d>(vector);
}

proto::Quaternionf ToProto(const Eigen::Quaternionf& quaternion) {
  return QuaternionToProto<proto::Quaternionf>(quaternion);
}

proto::Quaterniond ToProto(const Eigen::Quaterniond& quaternion) {
  return QuaternionToProto<proto::Quaterniond>(quaternion);
}

}  // namespace transform
}  // namespace cartographer
