// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
//
// The types of the values in a Lua table. Cartographer's dictionary has no
// query for them, and reading a value as the wrong type terminates the program
// with a message that does not name the key; but it can print a table as text,
// from which the types can be determined beforehand.
#ifndef CARTOGRAPHER_EXT_OPTIONS_LUA_LITERALS_H_
#define CARTOGRAPHER_EXT_OPTIONS_LUA_LITERALS_H_

#include <map>
#include <string>

namespace cartographer_ext {
namespace options {

// Type of a Lua value.
enum class LuaKind { NUMBER, BOOLEAN, STRING, TABLE, OTHER };

// A value of a printed Lua table.
struct LuaLiteral {
  LuaKind kind = LuaKind::OTHER;
  std::string text;  // as printed; "{ ... }" for tables
};

// The named values of a table, not those of its sub-tables, from the text of
// LuaParameterDictionary::ToString(). For text that is not a printed table, the
// values that could be read.
std::map<std::string, LuaLiteral> LuaLiterals(const std::string& table);

}  // namespace options
}  // namespace cartographer_ext

#endif  // CARTOGRAPHER_EXT_OPTIONS_LUA_LITERALS_H_
