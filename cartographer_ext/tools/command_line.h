// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
//
// What the commands share: how flags are read, errors are reported and results
// are written. Exit codes: 0 success, 1 bad input, 2 wrong usage; 3 where a
// command judges maps and the verdict is not the one that was asked for.
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
#include "nlohmann/json.hpp"

namespace cartographer_ext {
namespace tools {

constexpr int kExitSuccess = 0;
constexpr int kExitBadInput = 1;
constexpr int kExitUsage = 2;
constexpr int kExitVerdict = 3;

// Sets the gflags of a command. `-flag value`, `-flag=value` with one or two
// dashes, `-flag` and `-noflag` for booleans. One argument that is no flag is
// the main input, where the command has one. Unknown flags, bad values and
// other arguments end the program with exit code 2 and a hint; -help prints the
// description and the command's own flags and ends it with 0, -version the
// version. Starts the log,
// which shows errors only unless -minloglevel is given. With `-json -` nothing
// but the JSON of WriteJson reaches standard output.
class CommandLine {
 public:
  // `description` is what -help prints above the flags, `input_flag` the flag of
  // the main input, if any, `second_input_flag` that of a second one.
  explicit CommandLine(const std::string& description,
                       const std::string& input_flag = "",
                       const std::string& second_input_flag = "");
  // Takes any number of inputs: those behind the first are more_inputs().
  void TakeMany() { takes_many_ = true; }
  void Parse(int argc, char** argv);

  // Whether the main input stood there without its flag.
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
};

// The name the program was called by, without folders.
const std::string& ProgramName();

// The part of a path behind the last slash.
std::string BaseName(const std::string& path);

// Prints the message and returns kExitUsage.
int UsageError(const std::string& message);

// On standard error, a line each.
void PrintNotes(const std::vector<std::string>& notes);

// kExitSuccess, or prints the message and returns kExitBadInput; that also when
// standard output did not take what was printed (full, closed). With
// `verdict_fails` success becomes kExitVerdict.
int ExitCode(const absl::Status& status, bool verdict_fails = false);

// The folders of a flag, comma separated. For an empty one the folder with our
// Lua files that belongs to this program, wherever it is called from: that
// above it (a build inside the sources, an installation), else that of the
// sources it was built from, else configuration_files.
std::vector<std::string> ConfigurationDirectories(const std::string& flag);

// The same for a program with this path.
std::string ConfigurationDirectoryOf(const std::string& program);

// Finds out at the start, rather than after an hour's work, that an output
// cannot be written, or would replace an input or another output: one that is
// among `inputs` or given by the flag of a main input, that two flags of the
// command name, or that stands here twice. Links are followed. Empty names, "-",
// devices and pipes are fine.
absl::Status CheckWritable(const std::vector<std::string>& filenames,
                           const std::vector<std::string>& inputs = {});

// Indented, with a line end; atomically; "-" is standard output. Numbers that
// are not finite become null.
absl::Status WriteJson(const nlohmann::ordered_json& json,
                       const std::string& filename);

}  // namespace tools
}  // namespace cartographer_ext

#endif  // CARTOGRAPHER_EXT_TOOLS_COMMAND_LINE_H_
