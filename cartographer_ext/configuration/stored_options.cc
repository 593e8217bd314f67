// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
#include "cartographer_ext/configuration/stored_options.h"

#include <algorithm>
#include <memory>

#include "absl/strings/match.h"
#include "absl/strings/str_cat.h"
#include "cartographer_ext/configuration/option_messages.h"
#include "cartographer_ext/front_end_options.pb.h"
#include "cartographer_ext/options/extension_field.h"
#include "cartographer_ext/scan_matcher_options.pb.h"
#include "google/protobuf/descriptor.h"
#include "google/protobuf/unknown_field_set.h"

namespace cartographer_ext {
namespace evaluation {
namespace {

using google::protobuf::FieldDescriptor;
using google::protobuf::Message;

// The decoded block at this place; null if no block belongs there.
std::unique_ptr<Message> BlockAt(const std::string& path) {
  if (absl::EndsWith(path, "ceres_scan_matcher_options")) {
    return std::make_unique<proto::ScanMatcherOptions>();
  }
  if (absl::EndsWith(path, "trajectory_builder_2d_options")) {
    return std::make_unique<proto::FrontEndOptions>();
  }
  return nullptr;
}

std::string DescribeBlock(const std::string& path, const std::string& bytes) {
  const std::unique_ptr<Message> block = BlockAt(path);
  if (block == nullptr || !block->ParseFromString(bytes)) {
    return absl::StrCat(path, ": ", bytes.size(),
                        " bytes that cannot be decoded");
  }
  return absl::StrCat(path, ": ", block->ShortDebugString());
}

void CollectBlocks(const Message& message, const std::string& path,
                   std::vector<std::string>* const lines) {
  const auto* const reflection = message.GetReflection();
  const auto& unknown = reflection->GetUnknownFields(message);
  for (int i = 0; i < unknown.field_count(); ++i) {
    const auto& field = unknown.field(i);
    if (field.number() != options::kExtensionFieldNumber ||
        field.type() != google::protobuf::UnknownField::TYPE_LENGTH_DELIMITED) {
      continue;
    }
    lines->push_back(DescribeBlock(path, field.length_delimited()));
  }
  std::vector<const FieldDescriptor*> parts;
  reflection->ListFields(message, &parts);
  for (const FieldDescriptor* const part : parts) {
    if (part->cpp_type() != FieldDescriptor::CPPTYPE_MESSAGE ||
        part->is_repeated()) {
      continue;
    }
    CollectBlocks(reflection->GetMessage(message, part),
                  absl::StrCat(path, path.empty() ? "" : ".", part->name()),
                  lines);
  }
}

}  // namespace

std::vector<std::string> DescribeBlocks(
    const cartographer::mapping::proto::TrajectoryBuilderOptions& options) {
  std::vector<std::string> lines;
  CollectBlocks(options, "", &lines);
  return lines;
}

std::vector<std::string> DescribeOptionDifferences(
    const cartographer::mapping::proto::AllTrajectoryBuilderOptions& first,
    const cartographer::mapping::proto::AllTrajectoryBuilderOptions& second,
    const size_t max_lines) {
  std::vector<std::string> lines;
  const int common = std::min(first.options_with_sensor_ids_size(),
                              second.options_with_sensor_ids_size());
  for (int i = 0; i < common; ++i) {
    for (const std::string& difference : DescribeDifferences(
             first.options_with_sensor_ids(i).trajectory_builder_options(),
             second.options_with_sensor_ids(i).trajectory_builder_options())) {
      lines.push_back(absl::StrCat("trajectory ", i, ", ", difference));
    }
  }
  if (first.options_with_sensor_ids_size() !=
      second.options_with_sensor_ids_size()) {
    lines.push_back(absl::StrCat(
        "options of ", first.options_with_sensor_ids_size(), " and of ",
        second.options_with_sensor_ids_size(), " trajectories"));
  }
  if (lines.size() > max_lines) {
    const size_t more = lines.size() - max_lines;
    lines.resize(max_lines);
    lines.push_back(absl::StrCat("and ", more, " more options"));
  }
  return lines;
}

}  // namespace evaluation
}  // namespace cartographer_ext
