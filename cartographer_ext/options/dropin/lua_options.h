// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
//
// Reads the sub-table `cartographer_ext` of a stock Lua table into our options.
#ifndef CARTOGRAPHER_EXT_OPTIONS_DROPIN_LUA_OPTIONS_H_
#define CARTOGRAPHER_EXT_OPTIONS_DROPIN_LUA_OPTIONS_H_

#include <string>

#include "cartographer/common/lua_parameter_dictionary.h"
#include "google/protobuf/message.h"

namespace cartographer_ext {
namespace options {

// Key of our table in the stock table it extends.
constexpr char kExtensionKey[] = "cartographer_ext";

// Returns false without reading anything if `stock` has no such sub-table.
// Otherwise sets the defaults, then reads every key present. An unknown key, a
// value of the wrong type and a value out of range are fatal, with a message
// that names the full key (`stock_path` is the Lua name of the stock table,
// such as "POSE_GRAPH.constraint_builder"), the value and the allowed ones.
bool ReadExtension(const std::string& stock_path,
                   cartographer::common::LuaParameterDictionary* stock,
                   google::protobuf::Message* options);

}  // namespace options
}  // namespace cartographer_ext

#endif  // CARTOGRAPHER_EXT_OPTIONS_DROPIN_LUA_OPTIONS_H_
