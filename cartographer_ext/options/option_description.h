// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
//
// Options as the annotations of their proto fields describe them: defaults,
// ranges, checks, and printing. A nested message is a sub-table; an enum is a
// choice, written in lower case in Lua.
#ifndef CARTOGRAPHER_EXT_OPTIONS_OPTION_DESCRIPTION_H_
#define CARTOGRAPHER_EXT_OPTIONS_OPTION_DESCRIPTION_H_

#include <string>
#include <vector>

#include "cartographer_ext/option_annotation.pb.h"
#include "google/protobuf/message.h"

namespace cartographer_ext {
namespace options {

// One option, for printing.
struct OptionDescription {
  std::string key;   // dotted, within the block: "fusion.window"
  std::string type;  // "number", "integer", "boolean", "choice" or "text"
  std::string default_value;
  std::string range;  // "> 0", "0 ... 1", "one of: a, b", or empty
  std::string unit;
  std::string documentation;
  std::string value;      // of the message described
  bool is_basic = false;  // one of the few to look at first
};

// Sets every field to the default of its annotation. A field without
// annotation, other than `schema`, is a programming error.
void SetDefaults(google::protobuf::Message* options);

// Empty when `value` is allowed for the field, else a text such as
// "-1 is out of range, allowed: >= 0".
std::string CheckNumber(const google::protobuf::FieldDescriptor& field,
                        double value);

// The enum value of a lower-case name, or null.
const google::protobuf::EnumValueDescriptor* FindChoice(
    const google::protobuf::FieldDescriptor& field, const std::string& name);

// The former name of the key of the field; empty if it had none.
std::string FormerName(const google::protobuf::FieldDescriptor& field);

// The field that formerly had this name, or null.
const google::protobuf::FieldDescriptor* FindRenamed(
    const google::protobuf::Descriptor& options, const std::string& name);

// "one of: a, b" for choices, ">= 0" and the like for numbers.
std::string RangeText(const google::protobuf::FieldDescriptor& field);

// All options of a block in the order of their fields.
std::vector<OptionDescription> Describe(
    const google::protobuf::Message& options);

// The block as a Lua table with a comment before each key.
//   `name` = { ... }
std::string ToLua(const std::string& name,
                  const google::protobuf::Message& options);

}  // namespace options
}  // namespace cartographer_ext

#endif  // CARTOGRAPHER_EXT_OPTIONS_OPTION_DESCRIPTION_H_
