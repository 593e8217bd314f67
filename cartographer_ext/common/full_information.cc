// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
#include "cartographer_ext/common/full_information.h"

#include <algorithm>
#include <atomic>
#include <cstring>
#include <deque>
#include <map>

#include "Eigen/Eigenvalues"
#include "absl/base/thread_annotations.h"
#include "absl/synchronization/mutex.h"

namespace cartographer_ext {
namespace {

// Eigenvalues this far below zero, relative to the largest, are rounding.
constexpr double kTolerance = 1e-9;

// Kept as numbers: Eigen's fixed-size types would ask for alignment.
using Sqrt = std::array<double, 9>;

template <typename Bits>
class Registry {
 public:
  void Insert(const Bits& bits, const Sqrt& sqrt) {
    const absl::MutexLock lock(&mutex_);
    const auto inserted = sqrt_of_.emplace(bits, sqrt);
    if (!inserted.second) {
      inserted.first->second = sqrt;
      return;
    }
    order_.push_back(inserted.first);
    if (order_.size() > kMaxFullInformation) {
      sqrt_of_.erase(order_.front());
      order_.pop_front();
    }
    size_ = order_.size();
  }

  bool Find(const Bits& bits, Sqrt* const sqrt) {
    // Most processes never have an entry, and an optimisation asks for every
    // residual.
    if (size_ == 0) return false;
    const absl::MutexLock lock(&mutex_);
    const auto it = sqrt_of_.find(bits);
    if (it == sqrt_of_.end()) return false;
    *sqrt = it->second;
    return true;
  }

  void Clear() {
    const absl::MutexLock lock(&mutex_);
    sqrt_of_.clear();
    order_.clear();
    size_ = 0;
  }

  size_t size() const { return size_; }

 private:
  using Map = std::map<Bits, Sqrt>;

  absl::Mutex mutex_;
  Map sqrt_of_ ABSL_GUARDED_BY(mutex_);
  std::deque<typename Map::iterator> order_ ABSL_GUARDED_BY(mutex_);
  std::atomic<size_t> size_{0};
};

// Never destroyed: background threads may outlive static destruction.
Registry<ConstraintBits>& TheRegistry() {
  static auto* const registry = new Registry<ConstraintBits>;
  return *registry;
}

Registry<PoseBits>& TheRelativeRegistry() {
  static auto* const registry = new Registry<PoseBits>;
  return *registry;
}

// A root of the matrix; false where it is no information.
bool TakeRoot(const Eigen::Matrix3d& information, Sqrt* const sqrt) {
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
  const Eigen::Matrix3d root =
      eigen.eigenvalues().cwiseMax(0.).cwiseSqrt().asDiagonal() *
      eigen.eigenvectors().transpose();
  Eigen::Map<Eigen::Matrix3d>{sqrt->data()} = root;
  return true;
}

// The pose and the weights of a constraint.
PoseBits PoseOf(const ConstraintBits& bits) {
  PoseBits pose;
  std::copy(bits.begin(), bits.begin() + pose.size(), pose.begin());
  return pose;
}

double NumberOf(const uint64_t bits) {
  double number;
  std::memcpy(&number, &bits, sizeof(number));
  return number;
}

}  // namespace

bool RememberFullInformation(const ConstraintBits& bits,
                             const Eigen::Matrix3d& information) {
  Sqrt sqrt;
  if (!TakeRoot(information, &sqrt)) return false;
  TheRegistry().Insert(bits, sqrt);
  return true;
}

bool RememberRelativeInformation(const PoseBits& bits,
                                 const Eigen::Matrix3d& relative) {
  Sqrt sqrt;
  if (!TakeRoot(relative, &sqrt)) return false;
  TheRelativeRegistry().Insert(bits, sqrt);
  return true;
}

bool FindSqrtInformation(const ConstraintBits& bits,
                         Eigen::Matrix3d* const sqrt) {
  Sqrt found;
  if (TheRegistry().Find(bits, &found)) {
    *sqrt = Eigen::Map<const Eigen::Matrix3d>(found.data());
    return true;
  }
  if (!TheRelativeRegistry().Find(PoseOf(bits), &found)) return false;
  const double translation_weight = NumberOf(bits[7]);
  const double rotation_weight = NumberOf(bits[8]);
  *sqrt =
      Eigen::Map<const Eigen::Matrix3d>(found.data()) *
      Eigen::Vector3d(translation_weight, translation_weight, rotation_weight)
          .asDiagonal();
  return true;
}

size_t CountFullInformation() {
  return TheRegistry().size() + TheRelativeRegistry().size();
}

void ForgetFullInformation() {
  TheRegistry().Clear();
  TheRelativeRegistry().Clear();
}

}  // namespace cartographer_ext
