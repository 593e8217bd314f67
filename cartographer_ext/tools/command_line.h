// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
//
// Common parts of the commands: reading flags, reporting errors and writing
// results. Exit codes: 0 success, 1 bad input, 2 wrong usage, 3 if a command
// judges maps and the verdict is worse than required.
//
//   DEFINE_string(input_filename, "", "what to read");
//   int main(int argc, char** argv) {
//     tools::CommandLine command_line("Maps a recording.\n\nExample: ...",
//                                     "input_filename");
//     command_line.Parse(argc, argv);
//     if (FLAGS_input_filename.empty()) {
//       return tools::UsageError("-input_filename is missing");
//     }
//     return tools::ExitCode(Run());
//   }
#ifndef CARTOGRAPHER_EXT_TOOLS_COMMAND_LINE_H_
#define CARTOGRAPHER_EXT_TOOLS_COMMAND_LINE_H_

#include <string>
#include <vector>

#include "absl/status/status.h"
#include "cartographer_ext/tools/flag_values.h"
#include "nlohmann/json.hpp"

namespace cartographer_ext {
namespace tools {

constexpr int kExitSuccess = 0;
constexpr int kExitBadInput = 1;
constexpr int kExitUsage = 2;
constexpr int kExitVerdict = 3;

// Sets the gflags of a command. `-flag value`, `-flag=value` with one or two
// dashes, `-flag` and `-noflag` for booleans. One argument that is not a flag
// is the main input, if the command has one; behind `--` no argument is a flag. Unknown flags, bad values and
// other arguments exit with code 2 and a hint; -help prints the description and
// the command's own flags and exits with 0, -version prints the version.
// Initialises the log, which shows errors only unless -minloglevel is given.
// With `-json -` only the JSON of WriteJson is written to standard output.
class CommandLine {
 public:
  // `description` is what -help prints above the flags, `input_flag` the flag of
  // the main input, if any, `second_input_flag` that of a second one.
  explicit CommandLine(const std::string& description,
                       const std::string& input_flag = "",
                       const std::string& second_input_flag = "");
  // Accepts any number of inputs: those after the first are more_inputs().
  void TakeMany() { takes_many_ = true; }
  // The only values of a flag, or of the words of one with a list.
  void TakeOneOf(const std::string& flag,
                 const std::vector<std::string>& values) {
    choices_.push_back({flag, values, FlagChoices::Kind::kOne});
  }
  void TakeListOf(const std::string& flag,
                  const std::vector<std::string>& values) {
    choices_.push_back({flag, values, FlagChoices::Kind::kList});
  }
  // How the name of a file must end; pictures, unless it is said here, in .png.
  void TakeEndings(const std::string& flag,
                   const std::vector<std::string>& endings) {
    choices_.push_back({flag, endings, FlagChoices::Kind::kEnding});
  }
  void Parse(int argc, char** argv);

  // Whether the main input was given without its flag.
  bool has_positional_input() const { return has_positional_input_; }

  const std::vector<std::string>& more_inputs() const { return more_inputs_; }

 private:
  void TakePositional(const std::string& argument);

  const std::string description_;
  const std::string input_flag_;
  std::string second_input_flag_;  // empty once it was taken
  bool has_positional_input_ = false;
  bool takes_many_ = false;
  std::vector<std::string> more_inputs_;
  std::vector<FlagChoices> choices_;
};

// The name the program was called by, without folders.
const std::string& ProgramName();

// The part of a path behind the last slash.
std::string BaseName(const std::string& path);

// Prints the message and returns kExitUsage.
int UsageError(const std::string& message);

// On standard error, a line each.
void PrintNotes(const std::vector<std::string>& notes);

// kExitSuccess, or prints the message and returns kExitBadInput (kExitUsage if
// the status is marked by WrongUsage of flag_values.h); also if
// standard output could not be written (full, closed). With `verdict_fails`
// success becomes kExitVerdict.
int ExitCode(const absl::Status& status, bool verdict_fails = false);

// The folders of a flag, comma separated. If empty, the folder with our Lua
// files that belongs to this program, independent of the working folder: the
// one above it (a build inside the sources, an installation), otherwise that of
// the sources it was built from, otherwise configuration_files.
std::vector<std::string> ConfigurationDirectories(const std::string& flag);

// The same for a program with this path.
std::string ConfigurationDirectoryOf(const std::string& program);

// Checks at the start, rather than after an hour of work, that outputs can be
// written and do not replace an input or another output: an error if one is
// among `inputs` or the main input, is named by two flags of the command, or is
// listed twice. Links are followed. Empty names, "-", devices and pipes are
// allowed.
absl::Status CheckWritable(const std::vector<std::string>& filenames,
                           const std::vector<std::string>& inputs = {});

// Indented, with a line end; atomically; "-" is standard output. Numbers that
// are not finite become null.
absl::Status WriteJson(const nlohmann::ordered_json& json,
                       const std::string& filename);

}  // namespace tools
}  // namespace cartographer_ext

#endif  // CARTOGRAPHER_EXT_TOOLS_COMMAND_LINE_H_
