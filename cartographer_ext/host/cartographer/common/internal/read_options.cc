// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
#include "cartographer/common/internal/read_options.h"

#include "glog/logging.h"
#include "google/protobuf/descriptor.h"
#include "google/protobuf/descriptor.pb.h"

namespace cartographer {
namespace common {
namespace {

using google::protobuf::EnumDescriptor;
using google::protobuf::EnumValueDescriptor;
using google::protobuf::FieldDescriptor;
using google::protobuf::Message;
using google::protobuf::Reflection;

const EnumValueDescriptor* FindValueOrDie(const EnumDescriptor& type,
                                          const std::string& key,
                                          const std::string& name) {
  const EnumValueDescriptor* const value = type.FindValueByName(name);
  if (value == nullptr) {
    std::string known;
    for (int i = 0; i < type.value_count(); ++i) {
      known += (i > 0 ? ", " : "") + type.value(i)->name();
    }
    LOG(FATAL) << key << ": there is no '" << name << "', only " << known;
  }
  return value;
}

void ReadField(const FieldDescriptor& field,
               LuaParameterDictionary* const table, Message* const options) {
  const Reflection& reflection = *options->GetReflection();
  const std::string& key = field.name();
  switch (field.cpp_type()) {
    case FieldDescriptor::CPPTYPE_BOOL:
      reflection.SetBool(options, &field, table->GetBool(key));
      return;
    case FieldDescriptor::CPPTYPE_INT32:
      reflection.SetInt32(options, &field, table->GetInt(key));
      return;
    case FieldDescriptor::CPPTYPE_FLOAT:
      reflection.SetFloat(options, &field,
                          static_cast<float>(table->GetDouble(key)));
      return;
    case FieldDescriptor::CPPTYPE_DOUBLE:
      reflection.SetDouble(options, &field, table->GetDouble(key));
      return;
    case FieldDescriptor::CPPTYPE_ENUM:
      reflection.SetEnum(
          options, &field,
          FindValueOrDie(*field.enum_type(), key, table->GetString(key)));
      return;
    default:
      LOG(FATAL) << field.full_name() << " is of a type that no option has";
  }
}

}  // namespace

void ReadFields(LuaParameterDictionary* const table, Message* const options,
                const std::set<std::string>& optional) {
  const auto& descriptor = *options->GetDescriptor();
  for (int i = 0; i < descriptor.field_count(); ++i) {
    const FieldDescriptor& field = *descriptor.field(i);
    const bool is_plain = !field.is_repeated() &&
                          !field.options().deprecated() &&
                          field.cpp_type() != FieldDescriptor::CPPTYPE_MESSAGE;
    const bool may_be_missing = optional.count(field.name()) > 0;
    if (is_plain && (!may_be_missing || table->HasKey(field.name()))) {
      ReadField(field, table, options);
    }
  }
}

}  // namespace common
}  // namespace cartographer
