// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
//
// Lua code to plain values. The host's parameter dictionary ends the program
// when something is wrong and wants every key read once; a search wants to look
// at a configuration and to report what is wrong in a search file.
#ifndef CARTOGRAPHER_EXT_CONFIGURATION_LUA_VALUE_H_
#define CARTOGRAPHER_EXT_CONFIGURATION_LUA_VALUE_H_

#include <string>
#include <vector>

#include "absl/status/statusor.h"
#include "nlohmann/json.hpp"

namespace cartographer_ext {
namespace evaluation {

// Runs `code`, which is called `name` in messages, and returns the value that
// it returns: a table with keys 1 to n as an array, one with string keys as an
// object in alphabetical order, an empty table as an empty object. The code has
// the standard libraries and include, read and choose as configurations have;
// files are searched in `directories`, the first that has one wins.
//
// Errors name file and line where Lua does. ResourceExhausted: more than 10^9
// instructions or 256 MB, a result with more than 10^6 values or tables nested
// more than 60 times, as those that refer to themselves are; the code is no
// configuration for anybody. InvalidArgument: code that does not compile or
// fails, os.exit, a missing file or one above 16 MB, a result with functions or
// mixed keys. What a library function does in one call is not limited: code of
// unknown origin is tried in a child process first, see fatal_guard.h.
absl::StatusOr<nlohmann::json> EvaluateLua(
    const std::string& code, const std::string& name,
    const std::vector<std::string>& directories);

// From now on code sees no libraries but table, string, math and utf8, and of
// the base library nothing that reads files: for configurations of unknown
// origin. Those of robots may read their environment.
void RestrictLua(bool is_restricted);
bool IsLuaRestricted();

// Lua code that returns `value` without running anything.
std::string ToLuaCode(const nlohmann::json& value);

// The content of the first file of that name in the directories; NotFound when
// none has it.
absl::StatusOr<std::string> ReadFromDirectories(
    const std::string& basename, const std::vector<std::string>& directories);

// A scalar as Lua text that reads back as the same value: true, 90, 0.55, 10.,
// "auto".
std::string ToLua(const nlohmann::json& value);

}  // namespace evaluation
}  // namespace cartographer_ext

#endif  // CARTOGRAPHER_EXT_CONFIGURATION_LUA_VALUE_H_
