// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
//
// Evaluates Lua code to plain values. The host's parameter dictionary aborts on
// errors and requires every key to be read once; a search needs to inspect a
// configuration and to report errors in a search file.
#ifndef CARTOGRAPHER_EXT_CONFIGURATION_LUA_VALUE_H_
#define CARTOGRAPHER_EXT_CONFIGURATION_LUA_VALUE_H_

#include <string>
#include <vector>

#include "absl/status/statusor.h"
#include "nlohmann/json.hpp"

namespace cartographer_ext {
namespace evaluation {

// Runs `code`, named `name` in messages, and returns its result: a table with
// keys 1 to n as an array, one with string keys as an object in alphabetical
// order, an empty table as an empty object. The code has the standard libraries
// and the functions include, read and choose of configurations; files are
// searched in `directories` in this order.
//
// Errors name file and line if Lua does. ResourceExhausted: more than 10^9
// instructions or 256 MB, a result with more than 10^6 values or tables nested
// more than 60 levels, such as recursive ones; such code cannot be a valid
// configuration. InvalidArgument: code that does not compile or fails, os.exit,
// a missing file or one above 16 MB, a result with functions or mixed keys. A
// single call of a library function is not limited: code of unknown origin is
// first run in a child process, see fatal_guard.h.
absl::StatusOr<nlohmann::json> EvaluateLua(
    const std::string& code, const std::string& name,
    const std::vector<std::string>& directories);

// If restricted, code can only use the libraries table, string, math and utf8,
// and the functions of the base library that do not read files: for
// configurations of unknown origin. Others may read their environment.
void RestrictLua(bool is_restricted);
bool IsLuaRestricted();

// Lua code that returns `value` without running anything.
std::string ToLuaCode(const nlohmann::json& value);

// The content of the first file of that name in the directories; NotFound if
// none has it.
absl::StatusOr<std::string> ReadFromDirectories(
    const std::string& basename, const std::vector<std::string>& directories);

// A scalar as Lua text that reads back as the same value: true, 90, 0.55, 10.,
// "auto".
std::string ToLua(const nlohmann::json& value);

}  // namespace evaluation
}  // namespace cartographer_ext

#endif  // CARTOGRAPHER_EXT_CONFIGURATION_LUA_VALUE_H_
