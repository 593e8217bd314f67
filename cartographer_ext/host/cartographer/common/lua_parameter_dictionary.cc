// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
#include "cartographer/common/lua_parameter_dictionary.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "absl/strings/str_cat.h"
#include "absl/strings/str_format.h"
#include "absl/strings/str_join.h"
#include "absl/strings/str_replace.h"
#include "cartographer/common/lua.h"
#include "glog/logging.h"

namespace cartographer {
namespace common {
namespace {

std::string Quote(const std::string& text) {
  return absl::StrCat(
      "\"",
      absl::StrReplaceAll(text,
                          {{"\\", "\\\\"}, {"\"", "\\\""}, {"\n", "\\n"}}),
      "\"");
}

// Shortest text that reads back as the same number.
std::string NumberToString(const double value) {
  if (std::isinf(value)) return value > 0. ? "math.huge" : "-math.huge";
  for (int digits = 6; digits < 17; ++digits) {
    const std::string text = absl::StrFormat("%.*g", digits, value);
    if (std::stod(text) == value) return text;
  }
  return absl::StrFormat("%.17g", value);
}

void DieOnError(lua_State* const lua, const int result) {
  if (result == LUA_OK) return;
  const char* const text = lua_tostring(lua, -1);
  LOG(FATAL) << (text == nullptr ? "Lua error" : text);
}

}  // namespace

class LuaParameterDictionary::State {
 public:
  explicit State(std::unique_ptr<FileResolver> file_resolver)
      : lua_(luaL_newstate()), file_resolver_(std::move(file_resolver)) {
    CHECK(lua_ != nullptr);
    luaL_openlibs(lua_);
    lua_pushlightuserdata(lua_, &kRegistryKey);
    lua_pushlightuserdata(lua_, this);
    lua_settable(lua_, LUA_REGISTRYINDEX);
    lua_register(lua_, "choose", Choose);
    lua_register(lua_, "include", Include);
    lua_register(lua_, "read", Read);
  }
  ~State() { lua_close(lua_); }
  State(const State&) = delete;
  State& operator=(const State&) = delete;

  lua_State* lua() const { return lua_; }

 private:
  static State* Of(lua_State* const lua) {
    lua_pushlightuserdata(lua, &kRegistryKey);
    lua_gettable(lua, LUA_REGISTRYINDEX);
    State* const state = static_cast<State*>(lua_touserdata(lua, -1));
    lua_pop(lua, 1);
    return state;
  }

  static int Choose(lua_State* const lua) {
    CHECK_EQ(lua_gettop(lua), 3) << "choose() needs a condition and two values";
    CHECK(lua_isboolean(lua, 1)) << "condition of choose() is not a boolean";
    lua_pushvalue(lua, lua_toboolean(lua, 1) ? 2 : 3);
    return 1;
  }

  static std::string FileNameArgument(lua_State* const lua,
                                      const char* const function) {
    CHECK(lua_gettop(lua) == 1 && lua_isstring(lua, 1))
        << function << "() takes a file name.";
    return lua_tostring(lua, 1);
  }

  static int Include(lua_State* const lua) {
    State* const state = Of(lua);
    const std::string basename = FileNameArgument(lua, "include");
    const std::string path = state->file_resolver_->GetFullPathOrDie(basename);
    auto& included = state->included_files_;
    if (std::find(included.begin(), included.end(), path) != included.end()) {
      LOG(FATAL) << "'" << path << "' is included again, after "
                 << absl::StrJoin(included, ", ");
    }
    included.push_back(path);
    const std::string code =
        state->file_resolver_->GetFileContentOrDie(basename);
    lua_settop(lua, 0);
    DieOnError(lua, luaL_loadbuffer(lua, code.data(), code.size(),
                                    absl::StrCat("@", path).c_str()));
    DieOnError(lua, lua_pcall(lua, 0, LUA_MULTRET, 0));
    return lua_gettop(lua);
  }

  static int Read(lua_State* const lua) {
    const std::string content = Of(lua)->file_resolver_->GetFileContentOrDie(
        FileNameArgument(lua, "read"));
    lua_pushlstring(lua, content.data(), content.size());
    return 1;
  }

  // Only the address is used, as a key of the registry.
  static char kRegistryKey;

  lua_State* const lua_;
  const std::unique_ptr<FileResolver> file_resolver_;
  std::vector<std::string> included_files_;
};

char LuaParameterDictionary::State::kRegistryKey = 0;

LuaParameterDictionary::LuaParameterDictionary(
    const std::string& code, std::unique_ptr<FileResolver> file_resolver)
    : LuaParameterDictionary(Run(code, std::move(file_resolver)), "", true) {}

std::unique_ptr<LuaParameterDictionary>
LuaParameterDictionary::NonReferenceCounted(
    const std::string& code, std::unique_ptr<FileResolver> file_resolver) {
  return std::unique_ptr<LuaParameterDictionary>(new LuaParameterDictionary(
      Run(code, std::move(file_resolver)), "", false));
}

LuaParameterDictionary::LuaParameterDictionary(std::shared_ptr<State> state,
                                               std::string path,
                                               const bool reference_counted)
    : state_(std::move(state)),
      path_(std::move(path)),
      reference_counted_(reference_counted),
      registry_reference_(luaL_ref(state_->lua(), LUA_REGISTRYINDEX)) {}

LuaParameterDictionary::~LuaParameterDictionary() {
  if (reference_counted_) {
    for (const std::string& key : GetKeys()) {
      const int count = read_counts_[key];
      if (count == 0) {
        LOG(FATAL) << "Key '" << KeyPath(key) << "' is not an option";
      }
      CHECK_EQ(count, 1) << "Key '" << KeyPath(key) << "' was read " << count
                         << " times";
    }
  }
  luaL_unref(state_->lua(), LUA_REGISTRYINDEX, registry_reference_);
}

std::shared_ptr<LuaParameterDictionary::State> LuaParameterDictionary::Run(
    const std::string& code, std::unique_ptr<FileResolver> file_resolver) {
  auto state = std::make_shared<State>(std::move(file_resolver));
  lua_State* const lua = state->lua();
  DieOnError(lua, luaL_loadstring(lua, code.c_str()));
  DieOnError(lua, lua_pcall(lua, 0, 1, 0));
  if (!lua_istable(lua, -1)) {
    LOG(FATAL) << "The Lua code does not return a table.";
  }
  return state;
}

std::vector<std::string> LuaParameterDictionary::GetKeys() const {
  lua_State* const lua = state_->lua();
  std::vector<std::string> keys;
  PushTable();
  lua_pushnil(lua);
  while (lua_next(lua, -2) != 0) {
    lua_pop(lua, 1);
    if (lua_type(lua, -1) == LUA_TSTRING)
      keys.emplace_back(lua_tostring(lua, -1));
  }
  lua_pop(lua, 1);
  std::sort(keys.begin(), keys.end());
  return keys;
}

bool LuaParameterDictionary::HasKey(const std::string& key) const {
  lua_State* const lua = state_->lua();
  PushTable();
  lua_getfield(lua, -1, key.c_str());
  const bool has_key = !lua_isnil(lua, -1);
  lua_pop(lua, 2);
  return has_key;
}

std::string LuaParameterDictionary::GetString(const std::string& key) {
  PushValueOrDie(key);
  return PopString(key);
}

double LuaParameterDictionary::GetDouble(const std::string& key) {
  PushValueOrDie(key);
  return PopDouble(key);
}

int LuaParameterDictionary::GetInt(const std::string& key) {
  PushValueOrDie(key);
  lua_State* const lua = state_->lua();
  CheckType(lua_isnumber(lua, -1), key, "a number");
  // Plain lua_tointeger makes 0 of a fraction.
  int is_integer = 0;
  const lua_Integer value = lua_tointegerx(lua, -1, &is_integer);
  CHECK(is_integer != 0 && value >= std::numeric_limits<int>::min() &&
        value <= std::numeric_limits<int>::max())
      << "Key '" << KeyPath(key) << "' is " << lua_tonumber(lua, -1)
      << ", not an integer of 32 bits.";
  lua_pop(lua, 1);
  return static_cast<int>(value);
}

bool LuaParameterDictionary::GetBool(const std::string& key) {
  PushValueOrDie(key);
  lua_State* const lua = state_->lua();
  CheckType(lua_isboolean(lua, -1), key, "a boolean");
  const bool value = lua_toboolean(lua, -1) != 0;
  lua_pop(lua, 1);
  return value;
}

std::unique_ptr<LuaParameterDictionary> LuaParameterDictionary::GetDictionary(
    const std::string& key) {
  PushValueOrDie(key);
  return PopDictionary(key);
}

int LuaParameterDictionary::GetNonNegativeInt(const std::string& key) {
  const int value = GetInt(key);
  CHECK_GE(value, 0) << "Key '" << KeyPath(key) << "' is negative.";
  return value;
}

std::vector<double> LuaParameterDictionary::GetArrayValuesAsDoubles() {
  std::vector<double> values;
  ForEachArrayValue([this, &values](const std::string& key) {
    values.push_back(PopDouble(key));
  });
  return values;
}

std::vector<std::string> LuaParameterDictionary::GetArrayValuesAsStrings() {
  std::vector<std::string> values;
  ForEachArrayValue([this, &values](const std::string& key) {
    values.push_back(PopString(key));
  });
  return values;
}

std::vector<std::unique_ptr<LuaParameterDictionary>>
LuaParameterDictionary::GetArrayValuesAsDictionaries() {
  std::vector<std::unique_ptr<LuaParameterDictionary>> values;
  ForEachArrayValue([this, &values](const std::string& key) {
    values.push_back(PopDictionary(key));
  });
  return values;
}

std::string LuaParameterDictionary::ToString() const {
  PushTable();
  return PopAsText("");
}

void LuaParameterDictionary::PushTable() const {
  lua_rawgeti(state_->lua(), LUA_REGISTRYINDEX, registry_reference_);
}

void LuaParameterDictionary::PushValueOrDie(const std::string& key) {
  lua_State* const lua = state_->lua();
  PushTable();
  lua_getfield(lua, -1, key.c_str());
  lua_remove(lua, -2);
  if (lua_isnil(lua, -1)) {
    LOG(FATAL) << "Key '" << KeyPath(key) << "' is missing; the table is:\n"
               << ToString();
  }
  ++read_counts_[key];
}

void LuaParameterDictionary::CheckType(const bool matches,
                                       const std::string& key,
                                       const char* const expected) const {
  CHECK(matches) << "Key '" << KeyPath(key) << "' is "
                 << luaL_typename(state_->lua(), -1) << ", not " << expected
                 << ".";
}

std::string LuaParameterDictionary::KeyPath(const std::string& key) const {
  return path_.empty() ? key : absl::StrCat(path_, ".", key);
}

double LuaParameterDictionary::PopDouble(const std::string& key) const {
  lua_State* const lua = state_->lua();
  CheckType(lua_isnumber(lua, -1), key, "a number");
  const double value = lua_tonumber(lua, -1);
  lua_pop(lua, 1);
  return value;
}

std::string LuaParameterDictionary::PopString(const std::string& key) const {
  lua_State* const lua = state_->lua();
  CheckType(lua_isstring(lua, -1), key, "a string");
  size_t size = 0;
  const char* const text = lua_tolstring(lua, -1, &size);
  const std::string value(text, size);
  lua_pop(lua, 1);
  return value;
}

std::unique_ptr<LuaParameterDictionary> LuaParameterDictionary::PopDictionary(
    const std::string& key) const {
  CheckType(lua_istable(state_->lua(), -1), key, "a table");
  return std::unique_ptr<LuaParameterDictionary>(
      new LuaParameterDictionary(state_, KeyPath(key), reference_counted_));
}

template <typename PopValue>
void LuaParameterDictionary::ForEachArrayValue(
    const PopValue& pop_value) const {
  lua_State* const lua = state_->lua();
  for (int i = 1;; ++i) {
    PushTable();
    lua_rawgeti(lua, -1, i);
    lua_remove(lua, -2);
    if (lua_isnil(lua, -1)) break;
    pop_value(absl::StrCat(i));
  }
  lua_pop(lua, 1);
}

std::string LuaParameterDictionary::PopAsText(const std::string& indent) const {
  lua_State* const lua = state_->lua();
  std::string text;
  switch (lua_type(lua, -1)) {
    case LUA_TBOOLEAN:
      text = lua_toboolean(lua, -1) ? "true" : "false";
      break;
    case LUA_TNUMBER:
      text = NumberToString(lua_tonumber(lua, -1));
      break;
    case LUA_TSTRING:
      text = Quote(lua_tostring(lua, -1));
      break;
    case LUA_TTABLE: {
      const LuaParameterDictionary table(state_, "", false);
      const std::string inner = indent + "  ";
      text = "{\n";
      for (const std::string& key : table.GetKeys()) {
        table.PushTable();
        lua_getfield(lua, -1, key.c_str());
        lua_remove(lua, -2);
        absl::StrAppend(&text, inner, key, " = ", table.PopAsText(inner),
                        ",\n");
      }
      table.ForEachArrayValue([&](const std::string&) {
        absl::StrAppend(&text, inner, table.PopAsText(inner), ",\n");
      });
      // The dictionary took the value from the stack.
      return absl::StrCat(text, indent, "}");
    }
    default:
      text = absl::StrCat("<", luaL_typename(lua, -1), ">");
  }
  lua_pop(lua, 1);
  return text;
}

}  // namespace common
}  // namespace cartographer
