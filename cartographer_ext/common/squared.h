// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
#ifndef CARTOGRAPHER_EXT_COMMON_SQUARED_H_
#define CARTOGRAPHER_EXT_COMMON_SQUARED_H_

namespace cartographer_ext {

// The square of a value.
inline double Squared(const double x) { return x * x; }

}  // namespace cartographer_ext

#endif  // CARTOGRAPHER_EXT_COMMON_SQUARED_H_
