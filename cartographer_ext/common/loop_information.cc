// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
#include "cartographer_ext/common/loop_information.h"

#include <utility>

#include "Eigen/Eigenvalues"

namespace cartographer_ext {
namespace {

// Eigenvalues this far below zero, relative to the largest, are rounding.
constexpr double kTolerance = 1e-9;

thread_local const ScopedSqrtInformation* innermost_scope = nullptr;

// False where the matrix is not positive semi-definite.
bool TakeSqrt(const Eigen::Matrix3d& information,
              std::array<double, 9>* const sqrt) {
  if (!information.allFinite()) return false;
  const double scale = information.cwiseAbs().maxCoeff();
  if ((information - information.transpose()).cwiseAbs().maxCoeff() >
      kTolerance * scale) {
    return false;
  }
  const Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> eigen(information);
  if (eigen.info() != Eigen::Success ||
      eigen.eigenvalues().minCoeff() < -kTolerance * scale) {
    return false;
  }
  Eigen::Map<Eigen::Matrix3d>{sqrt->data()} =
      eigen.eigenvalues().cwiseMax(0.).cwiseSqrt().asDiagonal() *
      eigen.eigenvectors().transpose();
  return true;
}

}  // namespace

constexpr size_t LoopInformation::kCapacity;

bool LoopInformation::Set(const LoopId& id,
                          const Eigen::Matrix3d& information) {
  Sqrt sqrt;
  if (!TakeSqrt(information, &sqrt)) return false;
  const absl::MutexLock lock(&mutex_);
  const auto inserted = sqrt_of_loop_.emplace(id, sqrt);
  if (!inserted.second) {
    inserted.first->second = sqrt;
    return true;
  }
  oldest_first_.push_back(id);
  if (oldest_first_.size() > kCapacity) {
    sqrt_of_loop_.erase(oldest_first_.front());
    oldest_first_.pop_front();
  }
  return true;
}

bool LoopInformation::FindSqrt(const LoopId& id,
                               Eigen::Matrix3d* const sqrt) const {
  const absl::MutexLock lock(&mutex_);
  const auto it = sqrt_of_loop_.find(id);
  if (it == sqrt_of_loop_.end()) return false;
  *sqrt = Eigen::Map<const Eigen::Matrix3d>(it->second.data());
  return true;
}

size_t LoopInformation::size() const {
  const absl::MutexLock lock(&mutex_);
  return sqrt_of_loop_.size();
}

ScopedSqrtInformation::ScopedSqrtInformation(SqrtOfPose sqrt_of_pose)
    : sqrt_of_pose_(std::move(sqrt_of_pose)), outer_(innermost_scope) {
  innermost_scope = this;
}

ScopedSqrtInformation::~ScopedSqrtInformation() { innermost_scope = outer_; }

bool ScopedSqrtInformation::Find(const void* const pose,
                                 Eigen::Matrix3d* const sqrt) {
  if (innermost_scope == nullptr) return false;
  const auto it = innermost_scope->sqrt_of_pose_.find(pose);
  if (it == innermost_scope->sqrt_of_pose_.end()) return false;
  *sqrt = Eigen::Map<const Eigen::Matrix3d>(it->second.data());
  return true;
}

}  // namespace cartographer_ext
