// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
//
// What kind of value a key of a Lua table has. Cartographer's dictionary has no
// question for that, and reading a value as the wrong type ends the program
// with a message that does not name the key; but it prints a table as text,
// from which the kind can be told beforehand.
#ifndef CARTOGRAPHER_EXT_OPTIONS_LUA_LITERALS_H_
#define CARTOGRAPHER_EXT_OPTIONS_LUA_LITERALS_H_

#include <map>
#include <string>

namespace cartographer_ext {
namespace options {

enum class LuaKind { NUMBER, BOOLEAN, STRING, TABLE, OTHER };

struct LuaLiteral {
  LuaKind kind = LuaKind::OTHER;
  std::string text;  // as printed; "{ ... }" for tables
};

// The named values of a table, not those of its sub-tables, from the text of
// LuaParameterDictionary::ToString(). Text that is no printed table gives as
// many values as could be read.
std::map<std::string, LuaLiteral> LuaLiterals(const std::string& table);

}  // namespace options
}  // namespace cartographer_ext

#endif  // CARTOGRAPHER_EXT_OPTIONS_LUA_LITERALS_H_
