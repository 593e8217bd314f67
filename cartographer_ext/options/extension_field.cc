// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
#include "cartographer_ext/options/extension_field.h"

#include <memory>
#include <string>

#include "glog/logging.h"
#include "google/protobuf/unknown_field_set.h"

namespace cartographer_ext {
namespace options {
namespace {

namespace pb = google::protobuf;

const pb::FieldDescriptor* SchemaField(const pb::Message& message) {
  const pb::FieldDescriptor* const field =
      message.GetDescriptor()->FindFieldByName("schema");
  CHECK(field != nullptr &&
        field->cpp_type() == pb::FieldDescriptor::CPPTYPE_INT32)
      << message.GetTypeName() << " has no schema number";
  return field;
}

}  // namespace

void SetExtension(const pb::Message& extension, pb::Message* stock_options) {
  const std::unique_ptr<pb::Message> stamped(extension.New());
  stamped->CopyFrom(extension);
  stamped->GetReflection()->SetInt32(stamped.get(), SchemaField(*stamped),
                                     kSchema);
  pb::UnknownFieldSet* const fields =
      stock_options->GetReflection()->MutableUnknownFields(stock_options);
  fields->DeleteByNumber(kExtensionFieldNumber);
  fields->AddLengthDelimited(kExtensionFieldNumber,
                             stamped->SerializeAsString());
}

bool HasExtension(const pb::Message& stock_options) {
  const pb::UnknownFieldSet& fields =
      stock_options.GetReflection()->GetUnknownFields(stock_options);
  for (int i = 0; i < fields.field_count(); ++i) {
    if (fields.field(i).number() == kExtensionFieldNumber) return true;
  }
  return false;
}

bool GetExtension(const pb::Message& stock_options, pb::Message* extension) {
  extension->Clear();
  bool found = false;
  const pb::UnknownFieldSet& fields =
      stock_options.GetReflection()->GetUnknownFields(stock_options);
  for (int i = 0; i < fields.field_count(); ++i) {
    const pb::UnknownField& field = fields.field(i);
    if (field.number() != kExtensionFieldNumber) continue;
    CHECK(field.type() == pb::UnknownField::TYPE_LENGTH_DELIMITED &&
          extension->MergeFromString(field.length_delimited()))
        << "field " << kExtensionFieldNumber << " of "
        << stock_options.GetTypeName() << " does not hold a "
        << extension->GetTypeName();
    found = true;
  }
  if (found) {
    const int schema = extension->GetReflection()->GetInt32(
        *extension, SchemaField(*extension));
    CHECK_LE(schema, kSchema)
        << extension->GetTypeName() << " was written with schema " << schema
        << ", this version understands up to " << kSchema
        << "; use a newer version of cartographer_ext";
  }
  return found;
}

}  // namespace options
}  // namespace cartographer_ext
