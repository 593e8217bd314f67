// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
#include "cartographer_ext/tools/command_line.h"

#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <iostream>
#include <system_error>

#include "absl/strings/match.h"
#include "absl/strings/str_cat.h"
#include "absl/strings/str_join.h"
#include "absl/strings/str_split.h"
#include "absl/strings/string_view.h"
#include "cartographer_ext/common/atomic_file.h"
#include "cartographer_ext/common/similar_word.h"
#include "cartographer_ext/configuration/lua_value.h"
#include "cartographer_ext/io/expansion_budget.h"
#include "cartographer_ext/tools/flag_values.h"
#include "gflags/gflags.h"
#include "glog/logging.h"

DEFINE_int32(max_expansion, 50,
             "Limit of the expanded size of a compressed input, as a multiple "
             "of its size.");
DEFINE_bool(sandbox, false,
            "Run the configuration without os, io and other access to this "
            "computer: for files of unknown origin.");

namespace cartographer_ext {
namespace tools {
namespace {

// A file that every folder with our Lua files contains.
constexpr char kOursBasename[] = "cartographer_ext.lua";
// Folders above the program in which these are looked for.
constexpr int kMaxParents = 4;

std::string* MutableProgramName() {
  static std::string* const name = new std::string("cartographer_ext");
  return name;
}

// Where standard output went before it was kept for the result, or -1.
int* KeptStandardOutput() {
  static int descriptor = -1;
  return &descriptor;
}

// Flags of the main inputs of the command.
std::vector<std::string>* InputFlags() {
  static std::vector<std::string>* const flags = new std::vector<std::string>;
  return flags;
}

// A file opened later must not take the place of a standard stream that the
// caller closed: what is printed would end up in it. Using these fails.
void OccupyClosedStandardStreams() {
  for (const int descriptor : {STDIN_FILENO, STDOUT_FILENO, STDERR_FILENO}) {
    if (fcntl(descriptor, F_GETFD) >= 0) continue;
    // Takes the lowest free number.
    open("/dev/null", descriptor == STDIN_FILENO ? O_WRONLY : O_RDONLY);
  }
}

// Whatever is printed goes to standard error from now on, also by a real
// Cartographer library, which shows its progress on standard output. Without
// effect where there is no descriptor left.
void KeepStandardOutput() {
  std::cout.flush();
  std::fflush(stdout);
  if (*KeptStandardOutput() < 0) *KeptStandardOutput() = dup(STDOUT_FILENO);
  if (*KeptStandardOutput() >= 0) dup2(STDERR_FILENO, STDOUT_FILENO);
}

[[noreturn]] void ExitWithUsageError(const std::string& message) {
  UsageError(message);
  std::exit(kExitUsage);
}

bool IsKnown(const std::string& name) {
  gflags::CommandLineFlagInfo info;
  return gflags::GetCommandLineFlagInfo(name.c_str(), &info);
}

// Flags defined in the sources of the command itself, and those here; -sandbox
// where there is a configuration.
std::vector<gflags::CommandLineFlagInfo> OwnFlags() {
  std::vector<gflags::CommandLineFlagInfo> flags;
  gflags::GetAllFlags(&flags);
  const bool has_configuration = IsKnown("configuration_directory") ||
                                 IsKnown("rerun_configuration_directory");
  flags.erase(
      std::remove_if(flags.begin(), flags.end(),
                     [&](const gflags::CommandLineFlagInfo& flag) {
                       return !absl::StrContains(flag.filename,
                                                 "cartographer_ext/tools/") ||
                              (!has_configuration && flag.name == "sandbox");
                     }),
      flags.end());
  return flags;
}

// Breaks the text at blanks so that lines stay within 80 columns.
void PrintWrapped(const std::string& text, const std::string& indent) {
  constexpr size_t kColumns = 80;
  std::string line = indent;
  for (const absl::string_view word :
       absl::StrSplit(text, absl::ByAnyChar(" \n"), absl::SkipEmpty())) {
    if (line.size() > indent.size()) {
      if (line.size() + 1 + word.size() > kColumns) {
        std::cout << line << "\n";
        line = indent;
      } else {
        line += " ";
      }
    }
    absl::StrAppend(&line, word);
  }
  std::cout << line << "\n";
}

[[noreturn]] void PrintVersionAndExit() {
  std::cout << ProgramName() << " " << CARTOGRAPHER_EXT_VERSION << "\n";
  std::exit(ExitCode(absl::OkStatus()));
}

// Whether the command ends with kExitVerdict where a map is not good enough.
bool HasVerdict() {
  gflags::CommandLineFlagInfo info;
  return gflags::GetCommandLineFlagInfo("fail_on", &info) ||
         ProgramName() == "cartographer_ext_repair";
}

[[noreturn]] void PrintHelpAndExit(const std::string& description) {
  std::cout << description << "\n\nFlags:\n";
  for (const gflags::CommandLineFlagInfo& flag : OwnFlags()) {
    std::cout << "  -" << flag.name << " (" << flag.type;
    if (!flag.default_value.empty()) {
      std::cout << ", default "
                << (flag.type == "double" ? ShortestNumber(flag.default_value)
                                          : flag.default_value);
    }
    std::cout << ")\n";
    PrintWrapped(flag.description, "      ");
  }
  std::cout << "\nExit codes: 0 success, 1 bad input, 2 wrong usage"
            << (HasVerdict() ? ", 3 bad verdict" : "") << ".\n";
  std::exit(ExitCode(absl::OkStatus()));
}

std::string Suggestion(const std::string& unknown) {
  std::vector<std::string> names;
  for (const gflags::CommandLineFlagInfo& flag : OwnFlags()) {
    names.push_back(absl::StrCat("-", flag.name));
  }
  return DidYouMean(SimilarWord(unknown, names));
}

void SetFlag(const std::string& name, const std::string& value) {
  const absl::Status sensible = CheckFlagValue(name, value);
  if (!sensible.ok()) ExitWithUsageError(std::string(sensible.message()));
  if (gflags::SetCommandLineOption(name.c_str(), value.c_str()).empty()) {
    ExitWithUsageError(absl::StrCat("-", name, " cannot be \"", value, "\""));
  }
}

bool IsBool(const std::string& name) {
  gflags::CommandLineFlagInfo info;
  return gflags::GetCommandLineFlagInfo(name.c_str(), &info) &&
         info.type == "bool";
}

// Whether writing one file replaces the other. Devices and pipes are not
// replaced.
bool IsSameFile(const std::string& a, const std::string& b) {
  if (a.empty() || b.empty() || a == "-" || b == "-") return false;
  std::error_code error;
  if (std::filesystem::equivalent(a, b, error)) {
    return std::filesystem::is_regular_file(a, error);
  }
  const auto first = std::filesystem::weakly_canonical(a, error);
  if (error) return false;
  const auto second = std::filesystem::weakly_canonical(b, error);
  return !error && first == second && !std::filesystem::exists(first, error);
}

// The command's flags that name this file, alone or in a list with commas.
std::vector<std::string> FlagsThatName(const std::string& filename) {
  std::vector<std::string> names;
  for (const gflags::CommandLineFlagInfo& flag : OwnFlags()) {
    if (flag.type != "string") continue;
    const std::vector<std::string> values =
        absl::StrSplit(flag.current_value, ',');
    if (IsSameFile(flag.current_value, filename) ||
        std::any_of(values.begin(), values.end(),
                    [&](const std::string& value) {
                      return IsSameFile(value, filename);
                    })) {
      names.push_back(flag.name);
    }
  }
  return names;
}

absl::Status CheckDistinct(const std::vector<std::string>& outputs,
                           const std::vector<std::string>& inputs) {
  if (std::count(outputs.begin(), outputs.end(), "-") > 1) {
    return absl::InvalidArgumentError(
        "two outputs are -, but standard output takes only one");
  }
  for (size_t i = 0; i < outputs.size(); ++i) {
    const std::string& output = outputs[i];
    if (output.empty() || output == "-") continue;
    const std::vector<std::string> flags = FlagsThatName(output);
    const bool is_input =
        std::any_of(inputs.begin(), inputs.end(),
                    [&](const std::string& input) {
                      return IsSameFile(input, output);
                    }) ||
        std::any_of(flags.begin(), flags.end(), [](const std::string& flag) {
          return std::count(InputFlags()->begin(), InputFlags()->end(), flag) >
                 0;
        });
    if (is_input) {
      return absl::InvalidArgumentError(absl::StrCat(
          output, ": the output is also the input, which would be ",
          "overwritten; name another output"));
    }
    const bool is_twice = std::any_of(
        outputs.begin() + i + 1, outputs.end(),
        [&](const std::string& other) { return IsSameFile(output, other); });
    if (is_twice || flags.size() > 1) {
      return absl::InvalidArgumentError(absl::StrCat(
          output,
          ": two files of the command have this name, one of them an output",
          flags.empty() ? "" : " (-", absl::StrJoin(flags, ", -"),
          flags.size() == 1 ? ", and one that is written beside another output"
                            : "",
          flags.empty() ? "" : ")"));
    }
  }
  return absl::OkStatus();
}

}  // namespace

CommandLine::CommandLine(const std::string& description,
                         const std::string& input_flag,
                         const std::string& second_input_flag)
    : description_(description),
      input_flag_(input_flag),
      second_input_flag_(second_input_flag) {
  *InputFlags() = {input_flag, second_input_flag};
}

void CommandLine::TakePositional(const std::string& argument) {
  if (input_flag_.empty() || argument == "-") {
    ExitWithUsageError(
        absl::StrCat("what is \"", argument, "\"? All arguments must be flags",
                     input_flag_.empty() ? "" : " except the input"));
  }
  const auto is_set = [](const std::string& flag) {
    gflags::CommandLineFlagInfo info;
    return gflags::GetCommandLineFlagInfo(flag.c_str(), &info) &&
           !info.is_default;
  };
  if (has_positional_input_ || is_set(input_flag_)) {
    if (!second_input_flag_.empty() && !is_set(second_input_flag_)) {
      SetFlag(second_input_flag_, argument);
      second_input_flag_.clear();
      return;
    }
    if (takes_many_) {
      more_inputs_.push_back(argument);
      return;
    }
    ExitWithUsageError(absl::StrCat("\"", argument, "\" is a second input"));
  }
  SetFlag(input_flag_, argument);
  has_positional_input_ = true;
}

void CommandLine::Parse(const int argc, char** const argv) {
  *MutableProgramName() = BaseName(argc > 0 ? argv[0] : "");
  OccupyClosedStandardStreams();
  FLAGS_logtostderr = true;
  FLAGS_minloglevel = google::GLOG_ERROR;
  bool only_inputs = false;  // after "--"
  for (int i = 1; i < argc; ++i) {
    const std::string argument = argv[i];
    if (only_inputs || argument.size() < 2 || argument[0] != '-') {
      TakePositional(argument);
      continue;
    }
    if (argument == "--") {
      only_inputs = true;
      continue;
    }
    const size_t dashes = argument[1] == '-' ? 2 : 1;
    const size_t equals = argument.find('=');
    const std::string name = argument.substr(
        dashes, equals == std::string::npos ? equals : equals - dashes);
    if (name == "help" || name == "h" || name == "helpshort") {
      PrintHelpAndExit(description_);
    }
    if (name == "version") PrintVersionAndExit();
    if (equals != std::string::npos && IsKnown(name)) {
      SetFlag(name, argument.substr(equals + 1));
    } else if (IsBool(name)) {
      SetFlag(name, "true");
    } else if (absl::StartsWith(name, "no") && IsBool(name.substr(2))) {
      SetFlag(name.substr(2), "false");
    } else if (!IsKnown(name)) {
      ExitWithUsageError(
          absl::StrCat("unknown flag -", name, Suggestion("-" + name)));
    } else if (i + 1 == argc) {
      ExitWithUsageError(absl::StrCat("-", name, " needs a value"));
    } else {
      SetFlag(name, argv[++i]);
    }
  }
  std::string json;
  if (gflags::GetCommandLineOption("json", &json) && json == "-") {
    KeepStandardOutput();
  }
  if (FLAGS_max_expansion < 1) {
    ExitWithUsageError("-max_expansion must be at least 1");
  }
  const absl::Status known = CheckFlagChoices(choices_);
  if (!known.ok()) ExitWithUsageError(std::string(known.message()));
  io::SetMaxExpansion(FLAGS_max_expansion);
  evaluation::RestrictLua(FLAGS_sandbox);
  RemoveTemporaryFilesOnSignals();
  google::InitGoogleLogging(ProgramName().c_str());
}

std::string BaseName(const std::string& path) {
  return path.substr(path.find_last_of('/') + 1);
}

const std::string& ProgramName() { return *MutableProgramName(); }

std::vector<std::string> ConfigurationDirectories(const std::string& flag) {
  if (!flag.empty()) return absl::StrSplit(flag, ',', absl::SkipEmpty());
  std::error_code error;
  const auto program = std::filesystem::read_symlink("/proc/self/exe", error);
  return {ConfigurationDirectoryOf(program.string())};
}

std::string ConfigurationDirectoryOf(const std::string& program) {
  const auto is_ours = [](const std::filesystem::path& folder) {
    std::error_code error;
    return std::filesystem::exists(folder / kOursBasename, error);
  };
  std::filesystem::path parent = std::filesystem::path(program).parent_path();
  for (int i = 0; i < kMaxParents && parent.has_relative_path(); ++i) {
    parent = parent.parent_path();
    for (const char* name :
         {"configuration_files", "share/cartographer_ext/configuration_files",
          "share/cartographer/configuration_files"}) {
      if (is_ours(parent / name)) return (parent / name).string();
    }
  }
  if (is_ours(CARTOGRAPHER_EXT_CONFIGURATION_FILES)) {
    return CARTOGRAPHER_EXT_CONFIGURATION_FILES;
  }
  return "configuration_files";
}

int UsageError(const std::string& message) {
  std::cerr << ProgramName() << ": " << Printable(message) << "\n"
            << "Try " << ProgramName() << " -help\n";
  return kExitUsage;
}

void PrintNotes(const std::vector<std::string>& notes) {
  for (const std::string& note : notes) {
    std::cerr << "note: " << Printable(note) << "\n";
  }
}

int ExitCode(const absl::Status& status, const bool verdict_fails) {
  if (status.ok()) {
    std::cout.flush();
    if (std::cout.good() && std::fflush(stdout) == 0 && !std::ferror(stdout)) {
      return verdict_fails ? kExitVerdict : kExitSuccess;
    }
    std::cerr << ProgramName() << ": cannot write standard output\n";
    return kExitBadInput;
  }
  if (IsWrongUsage(status)) return UsageError(std::string(status.message()));
  std::cerr << ProgramName() << ": " << Printable(std::string(status.message()))
            << "\n";
  return kExitBadInput;
}

absl::Status CheckWritable(const std::vector<std::string>& filenames,
                           const std::vector<std::string>& inputs) {
  const absl::Status distinct = CheckDistinct(filenames, inputs);
  if (!distinct.ok()) return distinct;
  for (const std::string& filename : filenames) {
    if (filename.empty() || filename == "-") continue;
    struct stat existing;
    if (::stat(filename.c_str(), &existing) == 0 &&
        S_ISFIFO(existing.st_mode)) {
      continue;  // Opening it twice would end its reader.
    }
    // Goes away again, with nothing left behind.
    const absl::Status status = AtomicFile(filename).status();
    if (!status.ok()) return status;
  }
  return absl::OkStatus();
}

absl::Status WriteJson(const nlohmann::ordered_json& json,
                       const std::string& filename) {
  const std::string text =
      json.dump(2, ' ', false,
                nlohmann::ordered_json::error_handler_t::replace) +
      "\n";
  if (filename != "-" || *KeptStandardOutput() < 0) {
    return WriteFileAtomically(filename, text);
  }
  std::cout.flush();
  std::fflush(stdout);
  dup2(*KeptStandardOutput(), STDOUT_FILENO);
  const absl::Status status = WriteFileAtomically(filename, text);
  KeepStandardOutput();
  return status;
}

}  // namespace tools
}  // namespace cartographer_ext
