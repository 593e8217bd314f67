// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
#include "cartographer_ext/options/lua_literals.h"

#include "absl/strings/ascii.h"
#include "absl/strings/numbers.h"
#include "absl/strings/string_view.h"
#include "absl/strings/strip.h"

namespace cartographer_ext {
namespace options {
namespace {

// End of the entry that starts at `begin`: the position of the comma or brace
// that ends it, outside of quotes and inner tables.
size_t EntryEnd(const std::string& text, const size_t begin) {
  int depth = 0;
  bool quoted = false;
  for (size_t i = begin; i < text.size(); ++i) {
    const char c = text[i];
    if (quoted) {
      if (c == '\\') {
        ++i;
      } else if (c == '"') {
        quoted = false;
      }
    } else if (c == '"') {
      quoted = true;
    } else if (c == '{') {
      ++depth;
    } else if (c == '}') {
      if (depth == 0) return i;
      --depth;
    } else if (c == ',' && depth == 0) {
      return i;
    }
  }
  return text.size();
}

LuaLiteral ToLiteral(const absl::string_view text) {
  LuaLiteral literal;
  literal.text = std::string(text);
  double number = 0.;
  if (text == "true" || text == "false") {
    literal.kind = LuaKind::BOOLEAN;
  } else if (!text.empty() && text[0] == '"') {
    literal.kind = LuaKind::STRING;
  } else if (!text.empty() && text[0] == '{') {
    literal.kind = LuaKind::TABLE;
    literal.text = "{ ... }";
  } else if (absl::SimpleAtod(text, &number) ||
             absl::StripPrefix(text, "-") == "math.huge") {
    literal.kind = LuaKind::NUMBER;
  }
  return literal;
}

// Requires a name before the sign, so that a comparison in a string is not
// taken for an assignment.
bool IsName(const absl::string_view text) {
  for (const char c : text) {
    if (!absl::ascii_isalnum(c) && c != '_') return false;
  }
  return !text.empty();
}

}  // namespace

std::map<std::string, LuaLiteral> LuaLiterals(const std::string& table) {
  std::map<std::string, LuaLiteral> literals;
  const size_t open = table.find('{');
  size_t begin = open == std::string::npos ? table.size() : open + 1;
  while (begin < table.size()) {
    const size_t end = EntryEnd(table, begin);
    const absl::string_view entry =
        absl::string_view(table).substr(begin, end - begin);
    const size_t equals = entry.find('=');
    if (equals != absl::string_view::npos) {
      const absl::string_view name =
          absl::StripAsciiWhitespace(entry.substr(0, equals));
      if (IsName(name)) {
        literals[std::string(name)] =
            ToLiteral(absl::StripAsciiWhitespace(entry.substr(equals + 1)));
      }
    }
    if (end == table.size() || table[end] == '}') break;
    begin = end + 1;
  }
  return literals;
}

}  // namespace options
}  // namespace cartographer_ext
