// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
//
// Lua with C linkage.
#ifndef CARTOGRAPHER_COMMON_LUA_H_
#define CARTOGRAPHER_COMMON_LUA_H_

#include "lua.hpp"

#endif  // CARTOGRAPHER_COMMON_LUA_H_
