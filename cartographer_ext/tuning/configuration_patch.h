// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
//
// A configuration with some keys changed. The file of the user is not changed;
// a trial runs its code and then assigns to the global tables (POSE_GRAPH,
// TRAJECTORY_BUILDER_2D, ...), which the returned table refers to.
//
// Keys are checked before the first trial: they must exist, must take the
// values of their range, and must affect 2D SLAM. Keys of our own blocks
// (...cartographer_ext...) may be absent from the file, in which case they have
// their default, but the block itself must be present.
#ifndef CARTOGRAPHER_EXT_TUNING_CONFIGURATION_PATCH_H_
#define CARTOGRAPHER_EXT_TUNING_CONFIGURATION_PATCH_H_

#include <string>
#include <vector>

#include "absl/status/status.h"
#include "absl/status/statusor.h"
#include "cartographer_ext/configuration/slam_configuration.h"
#include "cartographer_ext/tuning/parameter_space.h"

namespace cartographer_ext {
namespace tuning {

class BaseConfiguration {
 public:
  // Reads the file; errors as of evaluation::LoadSlamConfiguration.
  static absl::StatusOr<BaseConfiguration> Load(
      const std::vector<std::string>& directories, const std::string& basename);

  const std::string& name() const { return name_; }
  const std::vector<std::string>& directories() const { return directories_; }
  const evaluation::SlamConfiguration& parsed() const { return parsed_; }

  // The values of the keys in the configuration. Errors name the key and, if
  // there is one, a similar existing key.
  absl::StatusOr<Point> Values(const std::vector<Parameter>& parameters) const;

  // Tries the ends of each range and each choice. Errors name the key: it has a
  // different type, the value is not allowed, or it has no effect.
  absl::Status CheckParameters(const std::vector<Parameter>& parameters) const;

  // Lua code of the configuration with { key: value } assigned, files to be
  // included first.
  std::string CodeWith(const nlohmann::json& assignment) const;

  // A short text that identifies everything the runs depend on.
  std::string Fingerprint() const;

 private:
  BaseConfiguration() = default;
  absl::StatusOr<Value> BlockValue(const Parameter& parameter) const;

  std::string name_;
  std::vector<std::string> directories_;
  std::string code_;
  evaluation::SlamConfiguration parsed_;
};

// 64 bits of FNV-1a as hexadecimal digits.
std::string HashText(const std::string& text);

}  // namespace tuning
}  // namespace cartographer_ext

#endif  // CARTOGRAPHER_EXT_TUNING_CONFIGURATION_PATCH_H_
