// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
//
// Generates docs/options.md: all options, the basic ones first, with their
// effects.
#ifndef CARTOGRAPHER_EXT_CONFIGURATION_OPTION_REFERENCE_H_
#define CARTOGRAPHER_EXT_CONFIGURATION_OPTION_REFERENCE_H_

#include <string>
#include <vector>

#include "absl/status/statusor.h"
#include "absl/strings/string_view.h"
#include "cartographer_ext/options/option_printing.h"

namespace cartographer_ext {
namespace evaluation {

// Measured effects of options (scripts/option_effects), one for each option,
// value and recording.
struct OptionEffect {
  // With the name of its block: "constraint_builder.search.enabled". "scatter":
  // three times the spread under irrelevant changes.
  std::string key;
  std::string value;
  std::string recording;
  // Error of the map over that with the default, > 0; NaN if the run failed.
  double ratio = 1.;
};

// Of the lines "key,value,recording,ratio" after a header with these names.
// InvalidArgument names `name` and the line.
absl::StatusOr<std::vector<OptionEffect>> ParseOptionEffects(
    absl::string_view text, const std::string& name);

// The document, in Markdown. The blocks must have their defaults.
std::string OptionReference(const std::vector<options::OptionBlock>& blocks,
                            const std::vector<OptionEffect>& effects);

}  // namespace evaluation
}  // namespace cartographer_ext

#endif  // CARTOGRAPHER_EXT_CONFIGURATION_OPTION_REFERENCE_H_
