// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
#include "cartographer_ext/options/dropin/lua_options.h"

#include <cmath>
#include <map>
#include <memory>
#include <vector>

#include "absl/strings/str_cat.h"
#include "absl/strings/str_join.h"
#include "cartographer_ext/options/lua_literals.h"
#include "cartographer_ext/options/option_description.h"
#include "glog/logging.h"

namespace cartographer_ext {
namespace options {
namespace {

namespace pb = google::protobuf;
using cartographer::common::LuaParameterDictionary;
using pb::FieldDescriptor;

std::vector<std::string> KnownKeys(const pb::Descriptor& descriptor) {
  std::vector<std::string> keys;
  for (int i = 0; i < descriptor.field_count(); ++i) {
    if (descriptor.field(i)->name() != "schema") {
      keys.push_back(descriptor.field(i)->name());
    }
  }
  return keys;
}

// A note about a key that earlier versions had; empty for other keys.
std::string FormerKey(const pb::Descriptor& descriptor,
                      const std::string& key) {
  const FieldDescriptor* const renamed = FindRenamed(descriptor, key);
  if (renamed != nullptr) {
    return absl::StrCat("now called ", renamed->name(), "; ");
  }
  return descriptor.IsReservedName(key)
             ? "removed, it is a constant now (docs/options.md); "
             : "";
}

// Ends the program, as Cartographer does where a configuration is wrong, but
// without the condition that CHECK would show to the user.
void Require(const bool condition, const std::string& message) {
  if (!condition) LOG(FATAL) << message;
}

std::string AllowedNumbers(const FieldDescriptor& field) {
  const std::string range = RangeText(field);
  return range.empty() ? "a finite number" : range;
}

// Fatal unless the literal has the type of the field.
void CheckType(const std::string& path, const FieldDescriptor& field,
               const LuaLiteral& literal) {
  const std::string is = absl::StrCat(path, ": ", literal.text, " is not ");
  switch (field.cpp_type()) {
    case FieldDescriptor::CPPTYPE_MESSAGE:
      Require(
          literal.kind == LuaKind::TABLE,
          absl::StrCat(is, "a table, allowed: ",
                       absl::StrJoin(KnownKeys(*field.message_type()), ", ")));
      return;
    case FieldDescriptor::CPPTYPE_BOOL:
      Require(literal.kind == LuaKind::BOOLEAN,
              absl::StrCat(is, "a boolean, allowed: true, false"));
      return;
    case FieldDescriptor::CPPTYPE_ENUM:
      Require(literal.kind == LuaKind::STRING,
              absl::StrCat(is, "a string, ", RangeText(field)));
      return;
    case FieldDescriptor::CPPTYPE_STRING:
      Require(literal.kind == LuaKind::STRING, absl::StrCat(is, "a string"));
      return;
    default:
      Require(literal.kind == LuaKind::NUMBER,
              absl::StrCat(is, "a number, allowed: ", AllowedNumbers(field)));
  }
}

void ReadTable(const std::string& path, LuaParameterDictionary* table,
               pb::Message* options);

void ReadField(const std::string& path, const FieldDescriptor& field,
               LuaParameterDictionary* const table,
               pb::Message* const options) {
  const std::string& key = field.name();
  const pb::Reflection* const reflection = options->GetReflection();
  switch (field.cpp_type()) {
    case FieldDescriptor::CPPTYPE_MESSAGE: {
      const std::unique_ptr<LuaParameterDictionary> sub_table =
          table->GetDictionary(key);
      ReadTable(path, sub_table.get(),
                reflection->MutableMessage(options, &field));
      return;
    }
    case FieldDescriptor::CPPTYPE_DOUBLE: {
      const double value = table->GetDouble(key);
      const std::string error = CheckNumber(field, value);
      Require(error.empty(), absl::StrCat(path, ": ", error));
      reflection->SetDouble(options, &field, value);
      return;
    }
    case FieldDescriptor::CPPTYPE_INT32: {
      // Read as a number: GetInt turns 2.5 silently into something else.
      const double value = table->GetDouble(key);
      Require(value == std::floor(value) && std::abs(value) < 2e9,
              absl::StrCat(path, ": ", value, " is not an integer, allowed: ",
                           AllowedNumbers(field)));
      const std::string error = CheckNumber(field, value);
      Require(error.empty(), absl::StrCat(path, ": ", error));
      reflection->SetInt32(options, &field, static_cast<int>(value));
      return;
    }
    case FieldDescriptor::CPPTYPE_BOOL:
      reflection->SetBool(options, &field, table->GetBool(key));
      return;
    case FieldDescriptor::CPPTYPE_STRING:
      reflection->SetString(options, &field, table->GetString(key));
      return;
    case FieldDescriptor::CPPTYPE_ENUM: {
      const std::string name = table->GetString(key);
      const pb::EnumValueDescriptor* const choice = FindChoice(field, name);
      Require(choice != nullptr,
              absl::StrCat(path, ": \"", name, "\" is not allowed, ",
                           RangeText(field)));
      reflection->SetEnum(options, &field, choice);
      return;
    }
    default:
      LOG(FATAL) << field.full_name() << " has a type that options do not have";
  }
}

void ReadTable(const std::string& path, LuaParameterDictionary* const table,
               pb::Message* const options) {
  const pb::Descriptor& descriptor = *options->GetDescriptor();
  const std::vector<std::string> known = KnownKeys(descriptor);
  const std::map<std::string, LuaLiteral> literals =
      LuaLiterals(table->ToString());
  for (const std::string& key : table->GetKeys()) {
    const FieldDescriptor* const found = descriptor.FindFieldByName(key);
    if (found == nullptr || key == "schema") {
      LOG(FATAL) << path << "." << key << ": unknown key, "
                 << FormerKey(descriptor, key)
                 << "allowed: " << absl::StrJoin(known, ", ");
    }
    const FieldDescriptor& field = *found;
    const std::string key_path = absl::StrCat(path, ".", key);
    const auto literal = literals.find(key);
    if (literal != literals.end()) CheckType(key_path, field, literal->second);
    ReadField(key_path, field, table, options);
  }
}

}  // namespace

bool ReadExtension(const std::string& stock_path,
                   LuaParameterDictionary* const stock,
                   pb::Message* const options) {
  if (!stock->HasKey(kExtensionKey)) return false;
  const std::string path = absl::StrCat(stock_path, ".", kExtensionKey);
  const std::map<std::string, LuaLiteral> literals =
      LuaLiterals(stock->ToString());
  const auto literal = literals.find(kExtensionKey);
  if (literal != literals.end()) {
    Require(literal->second.kind == LuaKind::TABLE,
            absl::StrCat(path, ": ", literal->second.text, " is not a table"));
  }
  SetDefaults(options);
  const std::unique_ptr<LuaParameterDictionary> table =
      stock->GetDictionary(kExtensionKey);
  ReadTable(path, table.get(), options);
  return true;
}

}  // namespace options
}  // namespace cartographer_ext
