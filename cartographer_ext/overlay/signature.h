// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
#ifndef CARTOGRAPHER_EXT_OVERLAY_SIGNATURE_H_
#define CARTOGRAPHER_EXT_OVERLAY_SIGNATURE_H_

#include <type_traits>

// Fails to compile if a function of the stock class no longer has the type that
// our wrapper forwards to. Without it a changed default or an added overload
// could go unnoticed: a wrapper compiles with anything convertible.
//   CARTOGRAPHER_EXT_EXPECT_SIGNATURE(Stock::Add, void (Stock::*)(int))
#define CARTOGRAPHER_EXT_EXPECT_SIGNATURE(function, ...)               \
  static_assert(std::is_same<decltype(&function), __VA_ARGS__>::value, \
                #function                                              \
                " has changed in this version of Cartographer; leave " \
                "this swap out (SWAPS of cartographer_ext_swap_into)")

#endif  // CARTOGRAPHER_EXT_OVERLAY_SIGNATURE_H_
