// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
//
// Many products a * b of 3 x 3 blocks with the same b, which dominate the time
// of factorisations, and sums of products, which dominate that of
// substitutions. The upper two values of a column are computed together, in
// the same order as one by one, so results are identical.
#ifndef CARTOGRAPHER_EXT_OPTIMIZATION_SOLVERS_BLOCK_PRODUCT_H_
#define CARTOGRAPHER_EXT_OPTIMIZATION_SOLVERS_BLOCK_PRODUCT_H_

#include <cstring>

#include "Eigen/Core"

namespace cartographer_ext {
namespace optimization {

// A column of three values.
class PackedColumn {
 public:
  PackedColumn() = default;
  explicit PackedColumn(const double* const values) : lower_(values[2]) {
    std::memcpy(&upper_, values, sizeof(upper_));
  }
  // The same value three times.
  explicit PackedColumn(const double value)
      : upper_{value, value}, lower_(value) {}

  void CopyTo(double* const values) const {
    std::memcpy(values, &upper_, sizeof(upper_));
    values[2] = lower_;
  }

  PackedColumn operator+(const PackedColumn& other) const {
    return {upper_ + other.upper_, lower_ + other.lower_};
  }
  PackedColumn operator-(const PackedColumn& other) const {
    return {upper_ - other.upper_, lower_ - other.lower_};
  }
  // Element-wise product.
  PackedColumn operator*(const PackedColumn& other) const {
    return {upper_ * other.upper_, lower_ * other.lower_};
  }

 private:
  using Pair = double __attribute__((vector_size(2 * sizeof(double))));

  PackedColumn(const Pair& upper, const double lower)
      : upper_(upper), lower_(lower) {}

  Pair upper_;
  double lower_;
};

// A 3 x 3 block by columns.
struct PackedBlock {
  PackedBlock() = default;
  explicit PackedBlock(const Eigen::Matrix3d& block) {
    for (int c = 0; c != 3; ++c) {
      columns[c] = PackedColumn(block.data() + 3 * c);
    }
  }
  void CopyTo(Eigen::Matrix3d* const block) const {
    for (int c = 0; c != 3; ++c) columns[c].CopyTo(block->data() + 3 * c);
  }

  PackedColumn columns[3];
};

// A right factor b for many products.
class RightFactor {
 public:
  explicit RightFactor(const Eigen::Matrix3d& b) {
    for (int c = 0; c != 3; ++c) {
      for (int r = 0; r != 3; ++r) values_[c][r] = PackedColumn(b(r, c));
    }
  }

  // a * b.
  PackedBlock ProductWith(const PackedBlock& a) const {
    PackedBlock result;
    for (int c = 0; c != 3; ++c) result.columns[c] = Times(a, c);
    return result;
  }

  // y - a * b and y + a * b.
  PackedBlock SubtractedFrom(const PackedBlock& y, const PackedBlock& a) const {
    PackedBlock result;
    for (int c = 0; c != 3; ++c) result.columns[c] = y.columns[c] - Times(a, c);
    return result;
  }
  PackedBlock AddedTo(const PackedBlock& y, const PackedBlock& a) const {
    PackedBlock result;
    for (int c = 0; c != 3; ++c) result.columns[c] = y.columns[c] + Times(a, c);
    return result;
  }

 private:
  PackedColumn Times(const PackedBlock& a, const int column) const {
    return a.columns[0] * values_[column][0] +
           a.columns[1] * values_[column][1] +
           a.columns[2] * values_[column][2];
  }

  PackedColumn values_[3][3];  // by column and row
};

// The sum of a' * x over many blocks a, as a backward substitution needs it. The
// products with a column of a are added one below another, so that none waits
// for the one before.
class TransposedProducts {
 public:
  void Add(const Eigen::Matrix3d& a, const Eigen::Vector3d& x) {
    const PackedColumn values(x.data());
    for (int c = 0; c != 3; ++c) {
      sums_[c] = sums_[c] + PackedColumn(a.data() + 3 * c) * values;
    }
  }
  Eigen::Vector3d Sum() const {
    Eigen::Matrix3d sums;
    for (int c = 0; c != 3; ++c) sums_[c].CopyTo(sums.data() + 3 * c);
    return sums.colwise().sum();
  }

 private:
  PackedColumn sums_[3] = {PackedColumn(0.), PackedColumn(0.),
                           PackedColumn(0.)};
};

}  // namespace optimization
}  // namespace cartographer_ext

#endif  // CARTOGRAPHER_EXT_OPTIMIZATION_SOLVERS_BLOCK_PRODUCT_H_
