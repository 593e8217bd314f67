// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
//
// Options have the same names in Lua and in their messages, so that a message
// describes the table it is read from.
#ifndef CARTOGRAPHER_COMMON_INTERNAL_READ_OPTIONS_H_
#define CARTOGRAPHER_COMMON_INTERNAL_READ_OPTIONS_H_

#include <functional>
#include <set>
#include <string>

#include "cartographer/common/lua_parameter_dictionary.h"
#include "google/protobuf/message.h"

namespace cartographer {
namespace common {

// Reads every number, boolean and enumeration (by the name of its value) of
// `options` from the key of the same name. A key of `optional` that is not
// there leaves its field as it is. Deprecated, repeated and message fields are
// not read.
void ReadFields(LuaParameterDictionary* table,
                google::protobuf::Message* options,
                const std::set<std::string>& optional = {});

template <typename Options>
Options ReadOptions(LuaParameterDictionary* const table) {
  Options options;
  ReadFields(table, &options);
  return options;
}

// What `factory` makes of the sub-table of this name.
template <typename Options>
Options ReadTable(LuaParameterDictionary* const table, const std::string& key,
                  Options (*const factory)(LuaParameterDictionary*)) {
  return factory(table->GetDictionary(key).get());
}

// Fills the message that `get_mutable` returns where the sub-table is there.
template <typename Options>
void ReadOptionalTable(LuaParameterDictionary* const table,
                       const std::string& key,
                       const std::function<Options*()>& get_mutable) {
  if (table->HasKey(key)) {
    ReadFields(table->GetDictionary(key).get(), get_mutable());
  }
}

}  // namespace common
}  // namespace cartographer

#endif  // CARTOGRAPHER_COMMON_INTERNAL_READ_OPTIONS_H_
