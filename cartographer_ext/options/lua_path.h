// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
//
// The position in the user's Lua file of the option factory that is being
// called. Cartographer passes a factory its own table only, and one factory is
// used for several tables (ceres_scan_matcher is in both the pose graph and the
// trajectory builder), so the outer factories record their name here for error
// messages.
#ifndef CARTOGRAPHER_EXT_OPTIONS_LUA_PATH_H_
#define CARTOGRAPHER_EXT_OPTIONS_LUA_PATH_H_

#include <string>

namespace cartographer_ext {
namespace options {

// During its lifetime the tables read by this thread are below `path`, such as
// "POSE_GRAPH.constraint_builder". May be nested; the innermost applies.
class ScopedLuaPath {
 public:
  explicit ScopedLuaPath(const std::string& path);
  ~ScopedLuaPath();
  ScopedLuaPath(const ScopedLuaPath&) = delete;
  ScopedLuaPath& operator=(const ScopedLuaPath&) = delete;

 private:
  const std::string outer_;
};

// Full name of the table `key`, or "<unknown_parent>.key" outside any scope.
std::string LuaPathOf(const std::string& key,
                      const std::string& unknown_parent);

}  // namespace options
}  // namespace cartographer_ext

#endif  // CARTOGRAPHER_EXT_OPTIONS_LUA_PATH_H_
