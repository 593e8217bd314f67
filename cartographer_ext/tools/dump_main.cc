// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
// LINK: map
//
// cartographer_ext_dump: what is in a .pbstream, is it whole, how do two
// differ?
#include <iostream>
#include <string>
#include <vector>

#include "absl/status/statusor.h"
#include "absl/strings/str_cat.h"
#include "cartographer_ext/io/pbstream/pbstream_reader.h"
#include "cartographer_ext/map/pbstream_difference.h"
#include "cartographer_ext/map/pbstream_inspection.h"
#include "cartographer_ext/tools/command_line.h"
#include "gflags/gflags.h"
#include "nlohmann/json.hpp"

DEFINE_string(pbstream_filename, "", "Map to inspect.");
DEFINE_string(other_pbstream_filename, "",
              "Second map, to compare with the first.");
DEFINE_int32(max_problems, 100, "Maximum number of problems to list.");
DEFINE_bool(options, false,
            "Also print the trajectory builder options as text.");
DEFINE_string(json, "", "Output: everything as JSON; - is standard output.");

namespace cartographer_ext {
namespace {

constexpr char kDescription[] =
    R"(Lists the contents of a .pbstream and checks them; compares two of them.

  cartographer_ext_dump -pbstream_filename=map.pbstream
  cartographer_ext_dump -pbstream_filename=a.pbstream \
      -other_pbstream_filename=b.pbstream

The exit code is 1 if a file cannot be read or has problems. Differences between
two files are not an error.)";

struct Inspected {
  absl::StatusOr<io::Pbstream> pbstream = absl::UnknownError("not read");
  std::vector<std::string> problems;
  nlohmann::ordered_json json;
};

Inspected Inspect(const std::string& filename) {
  Inspected result;
  // Problems are listed below, so they are not an error here.
  io::PbstreamReaderOptions options;
  options.validate = false;
  result.pbstream = io::ReadPbstream(filename, options);
  result.json["pbstream"] = filename;
  if (result.pbstream.ok()) {
    result.problems = evaluation::FindProblems(
        *result.pbstream, static_cast<size_t>(FLAGS_max_problems));
    result.json["valid"] = result.problems.empty();
    result.json.update(evaluation::Summarise(*result.pbstream));
  } else {
    result.problems = {std::string(result.pbstream.status().message())};
    result.json["valid"] = false;
    result.json["trajectories"] = nlohmann::ordered_json::array();
  }
  result.json["problems"] = result.problems;
  return result;
}

void Print(const Inspected& inspected) {
  std::cout << inspected.json["pbstream"].get<std::string>() << "\n";
  if (inspected.pbstream.ok()) {
    std::cout << evaluation::SummaryToText(inspected.json);
    if (FLAGS_options) {
      std::cout << inspected.pbstream->options.DebugString();
    }
  }
  for (const std::string& problem : inspected.problems) {
    std::cout << "problem: " << problem << "\n";
  }
  std::cout << (inspected.problems.empty() ? "valid" : "not valid") << "\n";
}

int Run() {
  const absl::Status writable = tools::CheckWritable({FLAGS_json});
  if (!writable.ok()) return tools::ExitCode(writable);
  const bool prints = FLAGS_json != "-";
  Inspected first = Inspect(FLAGS_pbstream_filename);
  if (prints) Print(first);
  nlohmann::ordered_json json = first.json;
  bool all_fine = first.problems.empty();
  if (!FLAGS_other_pbstream_filename.empty()) {
    const Inspected second = Inspect(FLAGS_other_pbstream_filename);
    if (prints) Print(second);
    json["other"] = second.json;
    all_fine = all_fine && second.problems.empty();
    if (first.pbstream.ok() && second.pbstream.ok()) {
      const evaluation::PbstreamDifference difference =
          evaluation::Compare(*first.pbstream, *second.pbstream);
      json["difference"] = {{"identical", difference.identical},
                            {"differences", difference.differences},
                            {"numbers", difference.numbers}};
      if (prints) {
        for (const std::string& sentence : difference.differences) {
          std::cout << "difference: " << sentence << "\n";
        }
        std::cout << (difference.identical ? "no difference\n" : "");
      }
    }
  }
  if (!FLAGS_json.empty()) {
    const absl::Status status = tools::WriteJson(json, FLAGS_json);
    if (!status.ok()) return tools::ExitCode(status);
  }
  if (all_fine) return tools::ExitCode(absl::OkStatus());
  return tools::ExitCode(absl::DataLossError(
      first.problems.empty()
          ? absl::StrCat(FLAGS_other_pbstream_filename, " is not valid")
          : first.problems.front()));
}

}  // namespace
}  // namespace cartographer_ext

int main(int argc, char** argv) {
  using namespace cartographer_ext;  // NOLINT
  tools::CommandLine(kDescription, "pbstream_filename").Parse(argc, argv);
  if (FLAGS_pbstream_filename.empty()) {
    return tools::UsageError("-pbstream_filename is missing");
  }
  if (FLAGS_max_problems < 1) {
    return tools::UsageError("-max_problems must be above 0");
  }
  return Run();
}
