// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
#include "cartographer_ext/configuration/option_messages.h"

#include <map>
#include <utility>

#include "absl/strings/str_cat.h"
#include "cartographer_ext/options/extension_field.h"
#include "google/protobuf/descriptor.h"
#include "google/protobuf/text_format.h"
#include "google/protobuf/unknown_field_set.h"

namespace cartographer_ext {
namespace evaluation {
namespace {

using google::protobuf::FieldDescriptor;
using google::protobuf::Message;

void FlattenTo(const Message& message, const std::string& prefix,
               std::map<std::string, std::string>* const values) {
  const auto* const descriptor = message.GetDescriptor();
  const auto* const reflection = message.GetReflection();
  for (int i = 0; i < descriptor->field_count(); ++i) {
    const FieldDescriptor* const field = descriptor->field(i);
    const std::string name = absl::StrCat(prefix, field->name());
    if (field->is_repeated()) continue;
    if (field->cpp_type() == FieldDescriptor::CPPTYPE_MESSAGE) {
      if (reflection->HasField(message, field)) {
        FlattenTo(reflection->GetMessage(message, field),
                  absl::StrCat(name, "."), values);
      }
      continue;
    }
    std::string text;
    google::protobuf::TextFormat::PrintFieldValueToString(message, field, -1,
                                                          &text);
    (*values)[name] = text;
  }
  if (options::HasExtension(message)) {
    (*values)[absl::StrCat(prefix, "cartographer_ext")] =
        "(cartographer_ext block)";
  }
}

}  // namespace

bool RemoveExtensions(Message* const message) {
  const auto* const reflection = message->GetReflection();
  bool removed = options::HasExtension(*message);
  reflection->MutableUnknownFields(message)->DeleteByNumber(
      options::kExtensionFieldNumber);
  std::vector<const FieldDescriptor*> fields;
  reflection->ListFields(*message, &fields);
  for (const FieldDescriptor* const field : fields) {
    if (field->cpp_type() != FieldDescriptor::CPPTYPE_MESSAGE ||
        field->is_repeated()) {
      continue;
    }
    removed =
        RemoveExtensions(reflection->MutableMessage(message, field)) || removed;
  }
  return removed;
}

void CopyExtensions(const Message& source, Message* const target) {
  const auto& fields = source.GetReflection()->GetUnknownFields(source);
  auto* const unknown = target->GetReflection()->MutableUnknownFields(target);
  for (int i = 0; i < fields.field_count(); ++i) {
    if (fields.field(i).number() == options::kExtensionFieldNumber) {
      unknown->AddField(fields.field(i));
    }
  }
  std::vector<const FieldDescriptor*> parts;
  source.GetReflection()->ListFields(source, &parts);
  for (const FieldDescriptor* const part : parts) {
    if (part->cpp_type() != FieldDescriptor::CPPTYPE_MESSAGE ||
        part->is_repeated() ||
        !target->GetReflection()->HasField(*target, part)) {
      continue;
    }
    CopyExtensions(source.GetReflection()->GetMessage(source, part),
                   target->GetReflection()->MutableMessage(target, part));
  }
}

std::vector<std::string> DescribeDifferences(const Message& first,
                                             const Message& second) {
  std::map<std::string, std::string> a, b;
  FlattenTo(first, "", &a);
  FlattenTo(second, "", &b);
  std::map<std::string, std::pair<std::string, std::string>> both;
  for (const auto& entry : a) both[entry.first].first = entry.second;
  for (const auto& entry : b) both[entry.first].second = entry.second;
  const auto shown = [](const std::string& value) {
    return value.empty() ? std::string("absent") : value;
  };
  std::vector<std::string> lines;
  for (const auto& entry : both) {
    if (entry.second.first == entry.second.second) continue;
    lines.push_back(absl::StrCat(entry.first, ": ", shown(entry.second.first),
                                 " -> ", shown(entry.second.second)));
  }
  return lines;
}

}  // namespace evaluation
}  // namespace cartographer_ext
