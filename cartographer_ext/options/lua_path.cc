// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
#include "cartographer_ext/options/lua_path.h"

#include "absl/strings/str_cat.h"

namespace cartographer_ext {
namespace options {
namespace {

std::string& CurrentPath() {
  static thread_local std::string path;
  return path;
}

}  // namespace

ScopedLuaPath::ScopedLuaPath(const std::string& path) : outer_(CurrentPath()) {
  CurrentPath() = path;
}

ScopedLuaPath::~ScopedLuaPath() { CurrentPath() = outer_; }

std::string LuaPathOf(const std::string& key,
                      const std::string& unknown_parent) {
  const std::string& current = CurrentPath();
  return absl::StrCat(current.empty() ? unknown_parent : current, ".", key);
}

}  // namespace options
}  // namespace cartographer_ext
