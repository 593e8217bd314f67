// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
#include "cartographer_ext/configuration/option_types.h"

#include <cmath>
#include <limits>

#include "absl/strings/numbers.h"
#include "absl/strings/str_cat.h"
#include "absl/strings/str_replace.h"
#include "absl/strings/strip.h"
#include "cartographer_ext/common/similar_word.h"
#include "cartographer_ext/configuration/lua_value.h"

namespace cartographer_ext {
namespace evaluation {
namespace {

using google::protobuf::Descriptor;
using google::protobuf::FieldDescriptor;
using nlohmann::json;

bool IsInteger(const double value) {
  return value == std::floor(value) &&
         value >= std::numeric_limits<int32_t>::min() &&
         value <= std::numeric_limits<int32_t>::max();
}

// Null if the value has the right type, otherwise a description of that type.
const char* Expected(const FieldDescriptor& field, const json& value) {
  double number = value.is_number() ? value.get<double>() : 0.;
  const bool is_number =
      value.is_number() ||
      (value.is_string() &&
       absl::SimpleAtod(value.get_ref<const std::string&>(), &number));
  switch (field.cpp_type()) {
    case FieldDescriptor::CPPTYPE_BOOL:
      return value.is_boolean() ? nullptr : "true or false";
    case FieldDescriptor::CPPTYPE_FLOAT:
    case FieldDescriptor::CPPTYPE_DOUBLE:
      return is_number ? nullptr : "a number";
    case FieldDescriptor::CPPTYPE_INT32:
    case FieldDescriptor::CPPTYPE_INT64:
    case FieldDescriptor::CPPTYPE_UINT32:
    case FieldDescriptor::CPPTYPE_UINT64:
      return is_number && IsInteger(number) ? nullptr : "an integer of 32 bits";
    case FieldDescriptor::CPPTYPE_STRING:
    case FieldDescriptor::CPPTYPE_ENUM:
      return value.is_string() || value.is_number() ? nullptr : "a string";
    case FieldDescriptor::CPPTYPE_MESSAGE:
      return value.is_object() ? nullptr : "a table with names";
  }
  return nullptr;
}

// Without "_options" and a number of dimensions.
std::string KeyOf(const FieldDescriptor& field) {
  const std::string name =
      absl::StrReplaceAll(field.name(), {{"_options", ""}});
  if (name.size() == field.name().size()) return name;
  return std::string(absl::StripSuffix(absl::StripSuffix(name, "_2d"), "_3d"));
}

// One of our blocks may be there.
bool HasExtensionBlock(const Descriptor& message) {
  for (const char* const name :
       {"ConstraintBuilderOptions", "OptimizationProblemOptions",
        "LocalTrajectoryBuilderOptions2D", "CeresScanMatcherOptions2D"}) {
    if (message.name() == name) return true;
  }
  return false;
}

std::string SimilarKey(const Descriptor& message, const std::string& key) {
  std::vector<std::string> names;
  for (int i = 0; i != message.field_count(); ++i) {
    names.push_back(KeyOf(*message.field(i)));
  }
  return SimilarWord(key, names);
}

}  // namespace

const FieldDescriptor* FindOptionField(const Descriptor& message,
                                       const std::string& key) {
  const FieldDescriptor* const same = message.FindFieldByName(key);
  if (same != nullptr) return same;
  const FieldDescriptor* similar = nullptr;
  for (int i = 0; i != message.field_count(); ++i) {
    const FieldDescriptor* const field = message.field(i);
    const std::string name =
        absl::StrReplaceAll(field->name(), {{"_options", ""}});
    if (name == key) return field;
    const bool has_options = name.size() != field->name().size();
    if (has_options && similar == nullptr &&
        (absl::StripSuffix(name, "_2d") == key ||
         absl::StripSuffix(name, "_3d") == key)) {
      similar = field;
    }
  }
  return similar;
}

absl::Status CheckOptionTypes(const json& table, const Descriptor& message,
                              const std::string& path) {
  for (const auto& item : table.items()) {
    const FieldDescriptor* const field = FindOptionField(message, item.key());
    if (field == nullptr || field->is_repeated()) continue;
    const json& value = item.value();
    const std::string key = absl::StrCat(path, ".", item.key());
    const char* const expected = Expected(*field, value);
    if (expected != nullptr) {
      return absl::InvalidArgumentError(absl::StrCat(
          key, " is ", value.is_primitive() ? ToLua(value) : "a table",
          ", must be ", expected));
    }
    if (field->cpp_type() != FieldDescriptor::CPPTYPE_MESSAGE) continue;
    const absl::Status below =
        CheckOptionTypes(value, *field->message_type(), key);
    if (!below.ok()) return below;
  }
  return absl::OkStatus();
}

std::vector<UnknownKey> FindUnknownKeys(const json& table,
                                        const Descriptor& message,
                                        const std::string& path) {
  std::vector<UnknownKey> unknown;
  for (const auto& item : table.items()) {
    if (item.key() == "cartographer_ext" && HasExtensionBlock(message)) {
      continue;
    }
    const FieldDescriptor* const field = FindOptionField(message, item.key());
    if (field == nullptr) {
      unknown.push_back({path, item.key(), SimilarKey(message, item.key())});
    } else if (field->cpp_type() == FieldDescriptor::CPPTYPE_MESSAGE &&
               !field->is_repeated() && item.value().is_object()) {
      const auto below = FindUnknownKeys(item.value(), *field->message_type(),
                                         absl::StrCat(path, ".", item.key()));
      unknown.insert(unknown.end(), below.begin(), below.end());
    }
  }
  return unknown;
}

}  // namespace evaluation
}  // namespace cartographer_ext
