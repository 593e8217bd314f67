// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
//
// Our blocks of a configuration as text, Markdown and Lua, all from the
// annotations of the option messages.
#ifndef CARTOGRAPHER_EXT_OPTIONS_OPTION_PRINTING_H_
#define CARTOGRAPHER_EXT_OPTIONS_OPTION_PRINTING_H_

#include <memory>
#include <string>
#include <vector>

#include "google/protobuf/message.h"

namespace cartographer_ext {
namespace options {

// One place in the stock tables where one of our blocks is allowed.
struct OptionBlock {
  // The stock table it extends: "POSE_GRAPH.constraint_builder".
  std::string stock_path;
  // Its name in configuration_files/cartographer_ext.lua.
  std::string name;
  // One sentence: what the block enables.
  std::string summary;
  // Whether the configuration has the block.
  bool present = false;
  // Its values; the defaults if it is absent.
  std::unique_ptr<google::protobuf::Message> options;
};

// Escapes the text of a cell of a Markdown table.
std::string EscapeCell(const std::string& text);

// Human-readable: the basic options of all blocks, then one paragraph per block
// with the others, one line per option. A star marks values that are not the
// default.
std::string ToText(const std::vector<OptionBlock>& blocks);

// One table per block, basic options first.
std::string ToMarkdown(const std::vector<OptionBlock>& blocks);

// Assignments for the blocks that are present, to be placed after the stock
// files of a configuration.
std::string ToLua(const std::vector<OptionBlock>& blocks);

// The values that are not the default, for a line of a log: "search.enabled =
// false, fusion.window = 5"; "defaults" if there are none.
std::string ChangesToText(const google::protobuf::Message& options);

// The whole of configuration_files/cartographer_ext.lua: every option with its
// documentation and default, as tables that a configuration may assign. Blocks
// of the same name are written once.
std::string ToLuaFile(const std::vector<OptionBlock>& blocks);

}  // namespace options
}  // namespace cartographer_ext

#endif  // CARTOGRAPHER_EXT_OPTIONS_OPTION_PRINTING_H_
