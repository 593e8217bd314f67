// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
// LINK: configuration io options
//
// cartographer_ext_print_options: our options in a configuration, with their
// meaning, default and range.
#include <iostream>
#include <string>
#include <vector>

#include "absl/status/statusor.h"
#include "absl/strings/str_split.h"
#include "cartographer_ext/configuration/option_blocks.h"
#include "cartographer_ext/configuration/option_reference.h"
#include "cartographer_ext/configuration/slam_configuration.h"
#include "cartographer_ext/io/line_reader.h"
#include "cartographer_ext/options/option_printing.h"
#include "cartographer_ext/tools/command_line.h"
#include "gflags/gflags.h"

DEFINE_string(configuration_directory, "",
              "Folders that are searched for Lua files, comma separated. "
              "Empty: the files installed with this command.");
DEFINE_string(configuration_basename, "",
              "Configuration file; empty: every option with its default.");
DEFINE_string(format, "text",
              "Output format: text, markdown, lua or, without a configuration, "
              "reference.");
DEFINE_string(effects_filename, "",
              "Measured effects for -format=reference, written by "
              "scripts/option_effects.");

namespace cartographer_ext {
namespace {

constexpr size_t kMaxEffectsSize = 1 << 20;

constexpr char kDescription[] =
    R"(Prints the options of cartographer_ext: value, default, range, meaning.

  cartographer_ext_print_options -configuration_basename=default.lua
  cartographer_ext_print_options -format=lua
      writes configuration_files/cartographer_ext.lua to standard output
  cartographer_ext_print_options -format=reference \
      -effects_filename=docs/option_effects.csv
      writes docs/options.md to standard output
  cartographer_ext_print_options -configuration_basename=mine.lua -format=lua
      writes the blocks of mine.lua in full, including the defaults)";

int PrintReference(const std::vector<options::OptionBlock>& blocks) {
  std::vector<evaluation::OptionEffect> effects;
  if (!FLAGS_effects_filename.empty()) {
    const auto text = io::ReadFile(FLAGS_effects_filename, kMaxEffectsSize);
    if (!text.ok()) return tools::ExitCode(text.status());
    auto parsed = evaluation::ParseOptionEffects(*text, FLAGS_effects_filename);
    if (!parsed.ok()) return tools::ExitCode(parsed.status());
    effects = *std::move(parsed);
  }
  std::cout << evaluation::OptionReference(blocks, effects);
  return tools::ExitCode(absl::OkStatus());
}

int Run() {
  evaluation::SlamConfiguration configuration;
  const bool has_configuration = !FLAGS_configuration_basename.empty();
  if (has_configuration) {
    const std::vector<std::string> directories =
        tools::ConfigurationDirectories(FLAGS_configuration_directory);
    absl::StatusOr<evaluation::SlamConfiguration> loaded =
        evaluation::LoadSlamConfiguration(directories,
                                          FLAGS_configuration_basename);
    if (!loaded.ok()) return tools::ExitCode(loaded.status());
    configuration = *loaded;
  }
  std::vector<options::OptionBlock> blocks =
      evaluation::OptionBlocks(configuration);
  if (!has_configuration) {
    for (options::OptionBlock& block : blocks) block.present = true;
  }
  if (FLAGS_format == "text") {
    std::cout << options::ToText(blocks);
  } else if (FLAGS_format == "markdown") {
    std::cout << options::ToMarkdown(blocks);
  } else if (FLAGS_format == "reference") {
    return PrintReference(blocks);
  } else {
    std::cout << (has_configuration ? options::ToLua(blocks)
                                    : options::ToLuaFile(blocks));
  }
  return tools::ExitCode(absl::OkStatus());
}

}  // namespace
}  // namespace cartographer_ext

int main(int argc, char** argv) {
  using namespace cartographer_ext;  // NOLINT
  tools::CommandLine command_line(kDescription);
  command_line.TakeOneOf("format", {"text", "markdown", "lua", "reference"});
  command_line.Parse(argc, argv);
  if (FLAGS_format == "reference" && !FLAGS_configuration_basename.empty()) {
    return tools::UsageError("-format=reference is for all options");
  }
  return Run();
}
