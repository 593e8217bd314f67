// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
#include "cartographer_ext/configuration/lua_value.h"

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <fstream>
#include <memory>

#include "absl/strings/match.h"
#include "absl/strings/str_cat.h"
#include "absl/strings/str_format.h"
#include "absl/strings/str_join.h"
#include "absl/strings/str_replace.h"
#include "cartographer_ext/common/bounded_read.h"
#include "cartographer_ext/common/byte_order_mark.h"
#include "lua.hpp"

namespace cartographer_ext {
namespace evaluation {
namespace {

constexpr int kInstructionsBetweenChecks = 1000000;
constexpr int kMaxChecks = 1000;
constexpr int kMaxDepth = 60;
constexpr int kMaxValues = 1000000;
constexpr size_t kMaxMemory = 256 << 20;  // bytes
constexpr size_t kMaxFileSize = 16 << 20;
constexpr size_t kMaxPathLength = 80;  // in messages

bool is_restricted = false;

// What the functions given to the code need; found through the registry.
struct Environment {
  std::vector<std::string> directories;
  std::vector<std::string> included;
  int checks = 0;
  size_t memory = 0;
  bool is_exhausted = false;  // one of the limits is reached
  int values = 0;             // of the result so far
};

// lua_Alloc with a limit.
void* Allocate(void* const environment, void* const block,
               const size_t old_size, const size_t new_size) {
  Environment& use = *static_cast<Environment*>(environment);
  const size_t before = block == nullptr ? 0 : old_size;
  if (new_size == 0) {
    use.memory -= before;
    std::free(block);
    return nullptr;
  }
  if (new_size > before && use.memory - before + new_size > kMaxMemory) {
    use.is_exhausted = true;
    return nullptr;
  }
  void* const result = std::realloc(block, new_size);
  if (result != nullptr) use.memory += new_size - before;
  return result;
}

char registry_key = 0;

Environment* EnvironmentOf(lua_State* const lua) {
  lua_rawgetp(lua, LUA_REGISTRYINDEX, &registry_key);
  Environment* const environment =
      static_cast<Environment*>(lua_touserdata(lua, -1));
  lua_pop(lua, 1);
  return environment;
}

void CountInstructions(lua_State* const lua, lua_Debug* /*where*/) {
  Environment* const environment = EnvironmentOf(lua);
  if (++environment->checks > kMaxChecks) {
    environment->is_exhausted = true;
    // The hook then fires at every instruction, so that code which catches the
    // error cannot continue.
    lua_sethook(lua, CountInstructions, LUA_MASKCOUNT, 1);
    luaL_error(lua, "the code does not terminate");
  }
}

// Pushes the content of the file, or an error message, in which case false.
// No object with a destructor is alive when the caller raises the error, which
// does not unwind the stack.
bool PushFile(lua_State* const lua) {
  if (lua_gettop(lua) != 1 || lua_type(lua, 1) != LUA_TSTRING) {
    lua_pushstring(lua, "include and read take a file name");
    return false;
  }
  const auto content = ReadFromDirectories(lua_tostring(lua, 1),
                                           EnvironmentOf(lua)->directories);
  const std::string text =
      content.ok() ? *content : std::string(content.status().message());
  lua_pushlstring(lua, text.data(), text.size());
  return content.ok();
}

// Loads what PushFile pushed. False leaves an error message.
bool LoadFile(lua_State* const lua) {
  Environment* const environment = EnvironmentOf(lua);
  const std::string basename = lua_tostring(lua, 1);
  auto& included = environment->included;
  if (std::find(included.begin(), included.end(), basename) != included.end()) {
    const std::string message =
        absl::StrCat("'", basename, "' is included twice");
    lua_pushlstring(lua, message.data(), message.size());
    return false;
  }
  included.push_back(basename);
  size_t size = 0;
  const char* const code = lua_tolstring(lua, -1, &size);
  return luaL_loadbuffer(lua, code, size,
                         absl::StrCat("@", basename).c_str()) == LUA_OK;
}

int Include(lua_State* const lua) {
  if (!PushFile(lua) || !LoadFile(lua)) return lua_error(lua);
  const int below = lua_gettop(lua) - 1;
  lua_call(lua, 0, LUA_MULTRET);
  return lua_gettop(lua) - below;
}

int Read(lua_State* const lua) {
  if (!PushFile(lua)) return lua_error(lua);
  return 1;
}

int Choose(lua_State* const lua) {
  if (lua_gettop(lua) != 3) return luaL_error(lua, "choose takes 3 values");
  lua_pushvalue(lua, lua_toboolean(lua, 1) ? 2 : 3);
  return 1;
}

int Exit(lua_State* const lua) {
  return luaL_error(lua, "a configuration must not call os.exit");
}

// The libraries, and the functions of configurations.
void OpenLibraries(lua_State* const lua) {
  if (is_restricted) {
    const luaL_Reg libraries[] = {{"_G", luaopen_base},
                                  {"table", luaopen_table},
                                  {"string", luaopen_string},
                                  {"math", luaopen_math},
                                  {"utf8", luaopen_utf8}};
    for (const luaL_Reg& library : libraries) {
      luaL_requiref(lua, library.name, library.func, 1);
      lua_pop(lua, 1);
    }
    for (const char* const name : {"dofile", "loadfile"}) {
      lua_pushnil(lua);
      lua_setglobal(lua, name);
    }
  } else {
    luaL_openlibs(lua);
    lua_getglobal(lua, "os");
    lua_pushcfunction(lua, Exit);
    lua_setfield(lua, -2, "exit");
    lua_pop(lua, 1);
  }
  lua_register(lua, "include", Include);
  lua_register(lua, "read", Read);
  lua_register(lua, "choose", Choose);
}

// For messages: only the beginning of a long path.
std::string NameOf(const std::string& path) {
  if (path.empty()) return "the result";
  return path.size() <= kMaxPathLength
             ? path
             : absl::StrCat(path.substr(0, kMaxPathLength), "...");
}

absl::Status Unsuitable(const std::string& path, const std::string& what) {
  return absl::InvalidArgumentError(absl::StrCat(NameOf(path), " ", what));
}

absl::Status TooMuch(const std::string& path, const std::string& what) {
  return absl::ResourceExhaustedError(absl::StrCat(NameOf(path), " ", what));
}

absl::StatusOr<nlohmann::json> ToJson(lua_State* lua, const std::string& path,
                                      int depth);

// The table on top of the stack.
absl::StatusOr<nlohmann::json> TableToJson(lua_State* const lua,
                                           const std::string& path,
                                           const int depth) {
  nlohmann::json object = nlohmann::json::object();
  nlohmann::json array = nlohmann::json::array();
  const auto length = static_cast<lua_Integer>(lua_rawlen(lua, -1));
  lua_pushnil(lua);
  while (lua_next(lua, -2) != 0) {
    const bool is_named = lua_type(lua, -2) == LUA_TSTRING;
    const bool is_listed = lua_isinteger(lua, -2) &&
                           lua_tointeger(lua, -2) >= 1 &&
                           lua_tointeger(lua, -2) <= length;
    if (!is_named && !is_listed) {
      return Unsuitable(path, "has keys that are neither names nor 1, 2, ...");
    }
    const std::string child =
        is_named
            ? absl::StrCat(path, path.empty() ? "" : ".", lua_tostring(lua, -2))
            : absl::StrCat(path, "[", lua_tointeger(lua, -2), "]");
    auto value = ToJson(lua, child, depth + 1);
    if (!value.ok()) return value.status();
    if (is_named) {
      object[lua_tostring(lua, -2)] = *std::move(value);
    } else {
      const size_t index = static_cast<size_t>(lua_tointeger(lua, -2)) - 1;
      while (array.size() <= index) array.push_back(nullptr);
      array[index] = *std::move(value);
    }
    lua_pop(lua, 1);
  }
  if (array.empty()) return object;
  if (!object.empty()) {
    return Unsuitable(path, "has both names and 1, 2, ... as keys");
  }
  return array;
}

// The value on top of the stack, which stays there.
absl::StatusOr<nlohmann::json> ToJson(lua_State* const lua,
                                      const std::string& path,
                                      const int depth) {
  if (depth > kMaxDepth || !lua_checkstack(lua, 8)) {
    return TooMuch(path, "is nested too deeply; does a table contain itself?");
  }
  if (++EnvironmentOf(lua)->values > kMaxValues) {
    return TooMuch(path, "is part of too many values");
  }
  switch (lua_type(lua, -1)) {
    case LUA_TNIL:
      return nlohmann::json(nullptr);
    case LUA_TBOOLEAN:
      return nlohmann::json(lua_toboolean(lua, -1) != 0);
    case LUA_TNUMBER:
      if (lua_isinteger(lua, -1)) {
        return nlohmann::json(static_cast<int64_t>(lua_tointeger(lua, -1)));
      }
      return nlohmann::json(lua_tonumber(lua, -1));
    case LUA_TSTRING:
      return nlohmann::json(std::string(lua_tostring(lua, -1)));
    case LUA_TTABLE:
      return TableToJson(lua, path, depth);
    default:
      return Unsuitable(path, absl::StrCat("is a ", luaL_typename(lua, -1)));
  }
}

}  // namespace

absl::StatusOr<std::string> ReadFromDirectories(
    const std::string& basename, const std::vector<std::string>& directories) {
  for (const std::string& directory : directories) {
    std::ifstream stream(absl::StrCat(directory, "/", basename),
                         std::ios::binary);
    if (!stream) continue;
    std::string content;
    if (!ReadUpTo(kMaxFileSize, &stream, &content)) continue;
    if (content.size() <= kMaxFileSize) {
      return std::string(WithoutByteOrderMark(content));
    }
    return absl::InvalidArgumentError(absl::StrCat(
        directory, "/", basename, " has more than ", kMaxFileSize >> 20,
        " MB, which cannot be a configuration"));
  }
  return absl::NotFoundError(absl::StrCat("cannot find or read '", basename,
                                          "' in ",
                                          absl::StrJoin(directories, ", ")));
}

absl::StatusOr<nlohmann::json> EvaluateLua(
    const std::string& code, const std::string& name,
    const std::vector<std::string>& directories) {
  Environment environment;
  environment.directories = directories;
  const std::unique_ptr<lua_State, void (*)(lua_State*)> owner(
      lua_newstate(Allocate, &environment), &lua_close);
  lua_State* const lua = owner.get();
  if (lua == nullptr) return absl::InternalError("no memory for Lua");
  lua_pushlightuserdata(lua, &environment);
  lua_rawsetp(lua, LUA_REGISTRYINDEX, &registry_key);
  OpenLibraries(lua);
  lua_sethook(lua, CountInstructions, LUA_MASKCOUNT,
              kInstructionsBetweenChecks);
  if (luaL_loadbuffer(lua, code.data(), code.size(),
                      absl::StrCat("@", name).c_str()) != LUA_OK ||
      lua_pcall(lua, 0, 1, 0) != LUA_OK) {
    const char* const message = lua_tostring(lua, -1);
    const std::string text = message == nullptr ? "Lua error" : message;
    return absl::Status(
        environment.is_exhausted ? absl::StatusCode::kResourceExhausted
                                 : absl::StatusCode::kInvalidArgument,
        absl::StrContains(text, name) ? text : absl::StrCat(name, ": ", text));
  }
  auto value = ToJson(lua, "", 0);
  if (!value.ok()) {
    return absl::Status(value.status().code(),
                        absl::StrCat(name, ": ", value.status().message()));
  }
  return value;
}

void RestrictLua(const bool restrict_it) { is_restricted = restrict_it; }

bool IsLuaRestricted() { return is_restricted; }

std::string ToLua(const nlohmann::json& value) {
  if (value.is_boolean()) return value.get<bool>() ? "true" : "false";
  if (value.is_number_integer()) return absl::StrCat(value.get<int64_t>());
  if (value.is_number()) {
    const double number = value.get<double>();
    if (std::isnan(number)) return "0/0";
    if (std::isinf(number)) return number > 0. ? "math.huge" : "-math.huge";
    std::string text;
    for (int digits = 6; digits <= 17; ++digits) {
      text = absl::StrFormat("%.*g", digits, number);
      if (std::strtod(text.c_str(), nullptr) == number) break;
    }
    return text.find_first_of(".en") == std::string::npos ? text + "." : text;
  }
  if (value.is_string()) {
    return absl::StrCat(
        "\"",
        absl::StrReplaceAll(
            value.get<std::string>(),
            {{"\\", "\\\\"}, {"\"", "\\\""}, {"\n", "\\n"}, {"\r", "\\r"}}),
        "\"");
  }
  return "nil";
}

namespace {

void AppendLua(const nlohmann::json& value, std::string* const code) {
  if (value.is_primitive()) {
    *code += ToLua(value);
    return;
  }
  *code += "{";
  for (const auto& item : value.items()) {
    if (value.is_object()) {
      absl::StrAppend(code, "[", ToLua(nlohmann::json(item.key())), "]=");
    }
    AppendLua(item.value(), code);
    *code += ",";
  }
  *code += "}";
}

}  // namespace

std::string ToLuaCode(const nlohmann::json& value) {
  std::string code = "return ";
  AppendLua(value, &code);
  return code;
}

}  // namespace evaluation
}  // namespace cartographer_ext
