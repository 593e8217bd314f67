// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
#include "cartographer_ext/options/option_description.h"

#include <cmath>

#include "absl/strings/ascii.h"
#include "absl/strings/numbers.h"
#include "absl/strings/str_cat.h"
#include "absl/strings/str_replace.h"
#include "absl/strings/str_split.h"
#include "glog/logging.h"

namespace cartographer_ext {
namespace options {
namespace {

namespace pb = google::protobuf;
using pb::FieldDescriptor;

constexpr char kSchemaField[] = "schema";
constexpr int kLineLength = 78;

const proto::OptionAnnotation& Annotation(const FieldDescriptor& field) {
  CHECK(field.options().HasExtension(proto::option))
      << field.full_name() << " is not annotated";
  return field.options().GetExtension(proto::option);
}

// The shortest text that reads back as the same number.
std::string NumberText(const double value) {
  if (value == std::floor(value) && std::abs(value) < 1e7) {
    return absl::StrCat(static_cast<int>(value));
  }
  for (int digits = 1; digits < 17; ++digits) {
    char buffer[40];
    snprintf(buffer, sizeof(buffer), "%.*g", digits, value);
    double back = 0.;
    if (absl::SimpleAtod(buffer, &back) && back == value) return buffer;
  }
  return absl::StrCat(value);
}

std::string ValueText(const pb::Message& options,
                      const FieldDescriptor& field) {
  const pb::Reflection* const reflection = options.GetReflection();
  switch (field.cpp_type()) {
    case FieldDescriptor::CPPTYPE_DOUBLE:
      return NumberText(reflection->GetDouble(options, &field));
    case FieldDescriptor::CPPTYPE_INT32:
      return absl::StrCat(reflection->GetInt32(options, &field));
    case FieldDescriptor::CPPTYPE_BOOL:
      return reflection->GetBool(options, &field) ? "true" : "false";
    case FieldDescriptor::CPPTYPE_ENUM:
      return absl::AsciiStrToLower(
          reflection->GetEnum(options, &field)->name());
    case FieldDescriptor::CPPTYPE_STRING:
      return reflection->GetString(options, &field);
    default:
      LOG(FATAL) << field.full_name() << " has a type that options do not have";
      return "";
  }
}

void SetDefault(const FieldDescriptor& field, pb::Message* options) {
  const std::string& text = Annotation(field).default_value();
  const pb::Reflection* const reflection = options->GetReflection();
  switch (field.cpp_type()) {
    case FieldDescriptor::CPPTYPE_DOUBLE: {
      double value = 0.;
      CHECK(absl::SimpleAtod(text, &value)) << field.full_name();
      reflection->SetDouble(options, &field, value);
      break;
    }
    case FieldDescriptor::CPPTYPE_INT32: {
      int value = 0;
      CHECK(absl::SimpleAtoi(text, &value)) << field.full_name();
      reflection->SetInt32(options, &field, value);
      break;
    }
    case FieldDescriptor::CPPTYPE_BOOL:
      CHECK(text == "true" || text == "false") << field.full_name();
      reflection->SetBool(options, &field, text == "true");
      break;
    case FieldDescriptor::CPPTYPE_ENUM: {
      const pb::EnumValueDescriptor* const value = FindChoice(field, text);
      CHECK(value != nullptr) << field.full_name() << ": " << text;
      reflection->SetEnum(options, &field, value);
      break;
    }
    case FieldDescriptor::CPPTYPE_STRING:
      reflection->SetString(options, &field, text);
      break;
    default:
      LOG(FATAL) << field.full_name() << " has a type that options do not have";
  }
}

std::string TypeText(const FieldDescriptor& field) {
  switch (field.cpp_type()) {
    case FieldDescriptor::CPPTYPE_DOUBLE:
      return "number";
    case FieldDescriptor::CPPTYPE_INT32:
      return "integer";
    case FieldDescriptor::CPPTYPE_BOOL:
      return "boolean";
    case FieldDescriptor::CPPTYPE_STRING:
      return "text";
    default:
      return "choice";
  }
}

void DescribeInto(const std::string& prefix, const pb::Message& options,
                  std::vector<OptionDescription>* const descriptions) {
  const pb::Descriptor* const descriptor = options.GetDescriptor();
  for (int i = 0; i < descriptor->field_count(); ++i) {
    const FieldDescriptor& field = *descriptor->field(i);
    if (field.name() == kSchemaField) continue;
    if (field.cpp_type() == FieldDescriptor::CPPTYPE_MESSAGE) {
      DescribeInto(absl::StrCat(prefix, field.name(), "."),
                   options.GetReflection()->GetMessage(options, &field),
                   descriptions);
      continue;
    }
    const proto::OptionAnnotation& annotation = Annotation(field);
    OptionDescription description;
    description.key = absl::StrCat(prefix, field.name());
    description.type = TypeText(field);
    description.default_value = annotation.default_value();
    description.range = RangeText(field);
    description.unit = annotation.unit();
    description.documentation = annotation.documentation();
    description.is_basic = annotation.basic();
    description.value = ValueText(options, field);
    descriptions->push_back(description);
  }
}

// The documentation as comment lines of a limited length.
std::string Comment(const std::string& indent, const std::string& text) {
  std::string result, line = absl::StrCat(indent, "--");
  const std::string empty = line;
  for (const auto word : absl::StrSplit(text, ' ', absl::SkipEmpty())) {
    if (line != empty && line.size() + 1 + word.size() > kLineLength) {
      absl::StrAppend(&result, line, "\n");
      line = empty;
    }
    absl::StrAppend(&line, " ", word);
  }
  if (line != empty) absl::StrAppend(&result, line, "\n");
  return result;
}

void TableToLua(const std::string& name, const pb::Message& options,
                const std::string& indent, std::string* const result) {
  absl::StrAppend(result, indent, name, " = {\n");
  const std::string inner = indent + "  ";
  const pb::Descriptor* const descriptor = options.GetDescriptor();
  for (int i = 0; i < descriptor->field_count(); ++i) {
    const FieldDescriptor& field = *descriptor->field(i);
    if (field.name() == kSchemaField) continue;
    if (field.cpp_type() == FieldDescriptor::CPPTYPE_MESSAGE) {
      TableToLua(field.name(),
                 options.GetReflection()->GetMessage(options, &field), inner,
                 result);
      continue;
    }
    const proto::OptionAnnotation& annotation = Annotation(field);
    std::string facts = RangeText(field);
    if (annotation.basic()) {
      facts = absl::StrCat("basic", facts.empty() ? "" : ", ", facts);
    }
    if (annotation.has_unit()) {
      absl::StrAppend(&facts, facts.empty() ? "" : ", ", annotation.unit());
    }
    absl::StrAppend(
        result, Comment(inner, absl::StrCat(annotation.documentation(),
                                            facts.empty() ? "" : " [", facts,
                                            facts.empty() ? "" : "]")));
    std::string value = ValueText(options, field);
    if (field.cpp_type() == FieldDescriptor::CPPTYPE_ENUM ||
        field.cpp_type() == FieldDescriptor::CPPTYPE_STRING) {
      value = absl::StrCat(
          "\"", absl::StrReplaceAll(value, {{"\\", "\\\\"}, {"\"", "\\\""}}),
          "\"");
    }
    absl::StrAppend(result, inner, field.name(), " = ", value, ",\n");
  }
  absl::StrAppend(result, indent, "}", indent.empty() ? "" : ",", "\n");
}

}  // namespace

void SetDefaults(pb::Message* const options) {
  const pb::Descriptor* const descriptor = options->GetDescriptor();
  for (int i = 0; i < descriptor->field_count(); ++i) {
    const FieldDescriptor& field = *descriptor->field(i);
    if (field.name() == kSchemaField) continue;
    if (field.cpp_type() == FieldDescriptor::CPPTYPE_MESSAGE) {
      SetDefaults(options->GetReflection()->MutableMessage(options, &field));
    } else {
      SetDefault(field, options);
    }
  }
}

std::string CheckNumber(const FieldDescriptor& field, const double value) {
  const proto::OptionAnnotation& annotation = Annotation(field);
  const bool too_small =
      annotation.has_minimum() &&
      (annotation.minimum_excluded() ? !(value > annotation.minimum())
                                     : !(value >= annotation.minimum()));
  const bool too_large =
      annotation.has_maximum() && !(value <= annotation.maximum());
  if (std::isfinite(value) && !too_small && !too_large) return "";
  const std::string range = RangeText(field);
  return absl::StrCat(NumberText(value), " is out of range, allowed: ",
                      range.empty() ? "a finite number" : range);
}

const pb::EnumValueDescriptor* FindChoice(const FieldDescriptor& field,
                                          const std::string& name) {
  const pb::EnumDescriptor* const choices = field.enum_type();
  for (int i = 0; i < choices->value_count(); ++i) {
    if (absl::AsciiStrToLower(choices->value(i)->name()) == name) {
      return choices->value(i);
    }
  }
  return nullptr;
}

std::string FormerName(const FieldDescriptor& field) {
  return field.options().HasExtension(proto::option)
             ? Annotation(field).former_name()
             : "";
}

const FieldDescriptor* FindRenamed(const pb::Descriptor& options,
                                   const std::string& name) {
  for (int i = 0; i < options.field_count(); ++i) {
    if (!name.empty() && FormerName(*options.field(i)) == name) {
      return options.field(i);
    }
  }
  return nullptr;
}

std::string RangeText(const FieldDescriptor& field) {
  if (field.cpp_type() == FieldDescriptor::CPPTYPE_ENUM) {
    std::string result = "one of: ";
    const pb::EnumDescriptor* const choices = field.enum_type();
    for (int i = 0; i < choices->value_count(); ++i) {
      absl::StrAppend(&result, i == 0 ? "" : ", ",
                      absl::AsciiStrToLower(choices->value(i)->name()));
    }
    return result;
  }
  const proto::OptionAnnotation& annotation = Annotation(field);
  std::string result;
  if (annotation.has_minimum()) {
    absl::StrAppend(&result, annotation.minimum_excluded() ? "> " : ">= ",
                    NumberText(annotation.minimum()));
  }
  if (annotation.has_maximum()) {
    absl::StrAppend(&result, result.empty() ? "" : " and ",
                    "<= ", NumberText(annotation.maximum()));
  }
  return result;
}

std::vector<OptionDescription> Describe(const pb::Message& options) {
  std::vector<OptionDescription> descriptions;
  DescribeInto("", options, &descriptions);
  return descriptions;
}

std::string ToLua(const std::string& name, const pb::Message& options) {
  std::string result;
  TableToLua(name, options, "", &result);
  return result;
}

}  // namespace options
}  // namespace cartographer_ext
