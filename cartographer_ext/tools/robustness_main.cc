// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
// LINK: experiments
//
// cartographer_ext_robustness: how many wrong loops does a back end survive?
#include <algorithm>
#include <iostream>
#include <string>
#include <vector>

#include "absl/strings/numbers.h"
#include "absl/strings/str_cat.h"
#include "absl/strings/str_split.h"
#include "cartographer_ext/experiments/cost_comparison.h"
#include "cartographer_ext/experiments/graph_families.h"
#include "cartographer_ext/experiments/paper_tables.h"
#include "cartographer_ext/experiments/robustness_report.h"
#include "cartographer_ext/experiments/robustness_sweep.h"
#include "cartographer_ext/tools/command_line.h"
#include "gflags/gflags.h"

DEFINE_string(
    preset, "",
    "Default values of the flags below: a_table_2 (ACS paper), r_table_2 "
    "(R-iSAM paper), survival_random, survival_local, quality.");
DEFINE_string(data_directory, "../shared/data/g2o",
              "Folder of the data sets given by name, as <name>.g2o[.xz|.gz].");
DEFINE_string(
    datasets, "intel",
    "Names or g2o files, comma separated; none if only -family is given.");
DEFINE_string(
    family, "",
    "Families of generated graphs with known truth, comma separated, one graph "
    "per seed: ring, road, grid, star, floors, robots, few, overconfident, "
    "underconfident, or all. Success is then an ATE to the optimum without "
    "outliers of at most -ate_limit plus half of that optimum's own error.");
DEFINE_string(kernels, "auto",
              "Comma separated: none, huber, sc, gm, dcs, acs, acs_paper, "
              "gnc_tls, auto or r_isam.");
DEFINE_string(
    outlier_types, "R",
    "Comma separated: R (random), L (local), RG, LG (grouped), none.");
DEFINE_string(
    outlier_counts, "1000",
    "Comma separated: number of edges, or with % the share of all loops.");
DEFINE_int32(seeds, 1, "Number of seeds.");
DEFINE_int32(first_seed, 1, "The first seed.");
DEFINE_int32(group_size, 10, "Edges per group (RG, LG).");
DEFINE_string(
    norm, "spectral",
    "Norm |Lambda| of acs_paper: spectral, determinant, root or information.");
DEFINE_double(
    ate_limit, 0.05,
    "Success is an ATE to the optimum without outliers of at most this "
    "(metres), or a map that odometry and correct loops cannot distinguish "
    "from it: within a tenth of a standard deviation.");
DEFINE_double(ate_limit_local, 0.4, "The same limit for the types L and LG.");
DEFINE_string(ate_limits, "intel=0.01",
              "Limits of single data sets: name=metres, comma separated.");
DEFINE_string(truths, "",
              "Ground truth of data sets that have natural outliers: "
              "name=file, comma separated. Their reference is the optimum that "
              "`auto` finds.");
DEFINE_bool(adaptive_gate, true,
            "auto, r_isam: make the final decision with a gate narrowed to the "
            "noise scale of the loops that agree. Off: auto returns the lowest "
            "truncated cost.");
DEFINE_bool(lowest_cost, true,
            "auto: return the solution with the lowest truncated cost that is "
            "closest to the decision of the adapted gate.");
DEFINE_double(max_seconds, 1e9,
              "Limit of the CPU seconds of one solution by sc or gnc_tls.");
DEFINE_bool(compare_cost, false,
            "Instead of a sweep: compares the truncated cost of auto with that "
            "of every other kernel from the given poses, a spanning tree and a "
            "chordal relaxation, and lists the graphs in which it is above. "
            "Does not use -kernels; needs a different journal than a sweep.");
DEFINE_string(journal_filename, "",
              "Journal to which every finished run is added; a sweep started "
              "again with the same journal skips these runs.");
DEFINE_string(picture_filename, "",
              "Output: PNG, ATE over the number of outliers.");
DEFINE_string(json, "", "Output: all runs as JSON; - is standard output.");

namespace cartographer_ext {
namespace {

constexpr char kDescription[] =
    R"(Adds wrong loops to pose graphs and evaluates the robust back ends; medians over seeds.

  cartographer_ext_robustness -datasets=intel,manhattan_g2o -kernels=auto,dcs,sc \
      -outlier_types=R,LG -outlier_counts=1000,4000,90% -seeds=5 \
      -journal_filename=sweep.jsonl -json=sweep.json -picture_filename=sweep.png

Generated graphs with known truth, clean and with outliers:
  cartographer_ext_robustness -family=ring,road,grid -outlier_types=none,R,RG \
      -outlier_counts=50%,80% -seeds=10 -json=families.json

Does auto end with the lowest cost? 1053 graphs, to be stopped and resumed:
  cartographer_ext_robustness -compare_cost -family=all -seeds=9 \
      -outlier_types=none,R,RG,L,LG -outlier_counts=10%,50%,80% \
      -journal_filename=costs.jsonl

The tables of the papers, printed values beside ours:
  cartographer_ext_robustness -preset=a_table_2 -journal_filename=a.jsonl
  cartographer_ext_robustness -preset=r_table_2 -journal_filename=r.jsonl)";

struct Preset {
  const char* name;
  const char* datasets;
  const char* kernels;
  const char* types;
  const char* counts;
  const char* seeds;
};

constexpr Preset kPresets[] = {
    {"a_table_2", "manhattan_g2o,manhattan_olson,city10000,bicocca25b_0.800",
     "sc,acs,acs_paper", "R,L,RG,LG", "1000,2000,3000,4000", "1"},
    {"r_table_2", "intel,manhattan_olson,city10000", "sc,r_isam", "R,L,RG,LG",
     "500,1000,1500,2000", "1"},
    {"survival_random", "intel,manhattan_g2o,manhattan_olson",
     "auto,r_isam,gm,dcs,acs,acs_paper", "R,RG", "90%", "10"},
    {"survival_local", "intel,manhattan_g2o,manhattan_olson,city10000",
     "auto,r_isam,gm,dcs,acs,acs_paper", "L,LG", "50%", "10"},
    {"quality", "intel,manhattan_g2o,manhattan_olson,city10000",
     "auto,r_isam,gm,dcs,acs,acs_paper", "R,RG,L,LG", "1000,2000,4000", "5"},
};

std::vector<std::string> PresetNames() {
  std::vector<std::string> names;
  for (const Preset& preset : kPresets) names.push_back(preset.name);
  return names;
}

std::vector<std::string> FamilyWords() {
  std::vector<std::string> words = experiments::FamilyNames();
  words.push_back("all");
  return words;
}

// Parse has checked that there is such a preset.
void ApplyPreset() {
  for (const Preset& preset : kPresets) {
    if (FLAGS_preset != preset.name) continue;
    const auto set = [](const char* flag, const char* value) {
      if (gflags::GetCommandLineFlagInfoOrDie(flag).is_default) {
        gflags::SetCommandLineOption(flag, value);
      }
    };
    set("datasets", preset.datasets);
    set("kernels", preset.kernels);
    set("outlier_types", preset.types);
    set("outlier_counts", preset.counts);
    set("seeds", preset.seeds);
  }
}

std::vector<std::string> Words(const std::string& text) {
  return absl::StrSplit(text, absl::ByAnyChar(", "), absl::SkipEmpty());
}

absl::StatusOr<experiments::SweepOptions> OptionsFromFlags() {
  experiments::SweepOptions options;
  options.data_directory = FLAGS_data_directory;
  options.datasets = Words(FLAGS_datasets);
  options.kernels = Words(FLAGS_kernels);
  options.types = Words(FLAGS_outlier_types);
  options.counts = Words(FLAGS_outlier_counts);
  for (const std::string& count : options.counts) {
    const absl::Status status = experiments::OutlierCount(count, 0).status();
    if (!status.ok()) {
      return tools::WrongUsage(absl::InvalidArgumentError(
          absl::StrCat("-outlier_counts: ", status.message())));
    }
  }
  options.families = Words(FLAGS_family);
  if (std::count(options.families.begin(), options.families.end(), "all") > 0) {
    options.families = experiments::FamilyNames();
  }
  if (!options.families.empty() &&
      gflags::GetCommandLineFlagInfoOrDie("datasets").is_default) {
    options.datasets.clear();
  }
  options.seeds = FLAGS_seeds;
  options.first_seed = FLAGS_first_seed;
  options.group_size = FLAGS_group_size;
  options.ate_limit = FLAGS_ate_limit;
  options.ate_limit_local = FLAGS_ate_limit_local;
  options.journal_filename = FLAGS_journal_filename;
  options.optimize.max_seconds = FLAGS_max_seconds;
  options.optimize.adaptive_gate = FLAGS_adaptive_gate;
  options.optimize.smoother.adaptive_gate = FLAGS_adaptive_gate;
  options.optimize.lowest_cost = FLAGS_lowest_cost;
  const auto norm = optimization::CovarianceNormFromName(FLAGS_norm);
  if (!norm.ok()) return norm.status();
  options.optimize.norm = *norm;
  for (const std::string& entry : Words(FLAGS_ate_limits)) {
    const std::pair<std::string, std::string> parts =
        absl::StrSplit(entry, absl::MaxSplits('=', 1));
    double limit;
    if (!absl::SimpleAtod(parts.second, &limit)) {
      return tools::WrongUsage(absl::InvalidArgumentError(
          absl::StrCat("-ate_limits: '", entry, "' is not name=metres")));
    }
    options.ate_limits[parts.first] = limit;
  }
  for (const std::string& entry : Words(FLAGS_truths)) {
    const std::pair<std::string, std::string> parts =
        absl::StrSplit(entry, absl::MaxSplits('=', 1));
    if (parts.second.empty()) {
      return tools::WrongUsage(absl::InvalidArgumentError(
          absl::StrCat("-truths: '", entry, "' is not name=file")));
    }
    options.truths[parts.first] = parts.second;
  }
  return options;
}

absl::Status PrintCosts(const experiments::SweepOptions& options) {
  const auto comparisons = experiments::CompareCosts(options);
  if (!comparisons.ok()) return comparisons.status();
  if (FLAGS_json != "-") std::cout << experiments::CostTable(*comparisons);
  if (FLAGS_json.empty()) return absl::OkStatus();
  return tools::WriteJson(experiments::CostJson(*comparisons), FLAGS_json);
}

absl::Status Run() {
  const auto options = OptionsFromFlags();
  if (!options.ok()) return options.status();
  const absl::Status writable =
      tools::CheckWritable({FLAGS_picture_filename, FLAGS_json});
  if (!writable.ok()) return writable;
  if (FLAGS_compare_cost) return PrintCosts(*options);
  const auto runs = experiments::RunSweep(*options);
  if (!runs.ok()) return runs.status();
  const std::vector<experiments::SweepCell> cells =
      experiments::Summarize(*runs);
  if (FLAGS_json != "-") {
    std::cout << experiments::SweepTable(cells)
              << experiments::LimitTable(*runs);
    if (FLAGS_preset == "a_table_2") {
      for (const char* kernel : {"acs", "acs_paper"}) {
        std::cout << "\n"
                  << experiments::PrintedComparison(
                         cells, experiments::AcsTable2(), kernel);
      }
    } else if (FLAGS_preset == "r_table_2") {
      std::cout
          << "\n(ratio ours: SC's one solution over all steps of R-iSAM)\n"
          << experiments::PrintedComparison(cells, experiments::RIsamTable2(),
                                            "r_isam");
    }
  }
  if (!FLAGS_picture_filename.empty()) {
    const absl::Status status = experiments::WriteSweepPlot(
        cells, experiments::FindLimits(*runs), FLAGS_picture_filename);
    if (!status.ok()) return status;
  }
  if (!FLAGS_json.empty()) {
    return tools::WriteJson(experiments::SweepJson(*runs), FLAGS_json);
  }
  return absl::OkStatus();
}

}  // namespace
}  // namespace cartographer_ext

int main(int argc, char** argv) {
  using namespace cartographer_ext;  // NOLINT
  tools::CommandLine command_line(kDescription);
  command_line.TakeOneOf("preset", PresetNames());
  command_line.TakeListOf("kernels", optimization::MethodNames());
  command_line.TakeListOf("outlier_types", {"none", "R", "L", "RG", "LG"});
  command_line.TakeListOf("family", FamilyWords());
  command_line.TakeOneOf("norm",
                         {"spectral", "determinant", "root", "information"});
  command_line.Parse(argc, argv);
  ApplyPreset();
  if (FLAGS_seeds < 1 || FLAGS_group_size < 1 || FLAGS_first_seed < 0) {
    return tools::UsageError(
        "-seeds and -group_size must be at least 1, -first_seed at least 0");
  }
  if (Words(FLAGS_datasets).empty() && Words(FLAGS_family).empty()) {
    return tools::UsageError("neither -datasets nor -family names graphs");
  }
  for (const char* flag : {"kernels", "outlier_types", "outlier_counts"}) {
    if (Words(gflags::GetCommandLineFlagInfoOrDie(flag).current_value)
            .empty()) {
      return tools::UsageError(absl::StrCat("-", flag, " names nothing"));
    }
  }
  return tools::ExitCode(Run());
}
