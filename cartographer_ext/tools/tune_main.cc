// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
// LINK: tuning
// SOURCES: job.cc
//
// cartographer_ext_tune: finds a configuration that suits the recordings.
#include <iostream>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "absl/status/status.h"
#include "absl/status/statusor.h"
#include "absl/strings/str_cat.h"
#include "absl/strings/str_format.h"
#include "absl/strings/str_join.h"
#include "absl/strings/str_split.h"
#include "cartographer_ext/common/atomic_file.h"
#include "cartographer_ext/common/progress.h"
#include "cartographer_ext/tools/command_line.h"
#include "cartographer_ext/tools/job.h"
#include "cartographer_ext/tuning/configuration_patch.h"
#include "cartographer_ext/tuning/journal.h"
#include "cartographer_ext/tuning/result_writer.h"
#include "cartographer_ext/tuning/search_spec.h"
#include "cartographer_ext/tuning/sensitivity_plot.h"
#include "cartographer_ext/tuning/trial_run.h"
#include "cartographer_ext/tuning/tuner.h"
#include "gflags/gflags.h"

DEFINE_string(search_filename, "",
              "Lua file with the keys and their ranges; see docs/tuning.md.");
DEFINE_string(configuration_directory, "",
              "Folders that are searched for Lua files in this order, comma "
              "separated. Empty: the files installed with this command.");
DEFINE_string(configuration_basename, "",
              "Configuration to start from. Empty: that of the search file, or "
              "stock.lua.");
DEFINE_string(
    inputs, "",
    "Recordings or finished maps (.pbstream: loop closure only), comma "
    "separated: FILE, FILE=TRUTH or WORLD.world#SEED. TRUTH is a reference "
    "trajectory (.tum) or relations; without it, the name of FILE with "
    ".relations or .tum is used. Empty: those of the search file.");
DEFINE_string(holdout, "",
              "Held-out inputs, in the same form: the result is evaluated on "
              "them at the end.");
DEFINE_string(objective, "",
              "Objective to minimise: a name or name:weight,name:weight. "
              "Empty: that of the search file, or relations.");
DEFINE_string(method, "halving",
              "grid, random, halving (random with successive halving), "
              "nlopt_global, nlopt_local, or an NLopt algorithm.");
DEFINE_int32(max_trials, 0, "Limit of the number of trials; 0: no limit.");
DEFINE_double(budget_minutes, 0.,
              "Limit of the total time in minutes, including baseline and "
              "pruning; 0: no limit.");
DEFINE_uint64(seed, 1, "Seed of the random methods.");
DEFINE_double(min_fidelity, 0.3,
              "halving: smallest part of the recordings, which is tried first; "
              "the parts are 1, 1/3, 1/9 ...");
DEFINE_int32(folds, 0,
             "Number of folds: repeat the search with each part of the inputs "
             "held out and evaluate the result on it; 0: none.");
DEFINE_bool(prune, true,
            "At the end reset each changed key in turn, keep those that "
            "improve the result, and report their gain.");
DEFINE_int32(workers, 0,
             "Number of parallel runs of this process; 0: one per processor. "
             "Under mpirun the other ranks are the workers.");
DEFINE_int32(threads, 1, "Background threads of each run.");
DEFINE_double(max_run_cpu_seconds, 3600.,
              "Limit of the CPU time of a run, beyond which it is killed and "
              "fails; 0: no limit.");
DEFINE_string(
    odometry_source, "",
    "CARMEN logs: odom, scan, both or auto. Empty: as in the configuration.");
DEFINE_string(journal_filename, "",
              "Journal to which every finished run is added; a search started "
              "again with the same journal resumes.");
DEFINE_string(output_filename, "",
              "Output: Lua file, a configuration that includes the initial one "
              "and changes some of its keys.");
DEFINE_string(picture_filename, "",
              "Output: objective over each key (.png or .svg).");
DEFINE_string(json, "", "Output: the result as JSON; - is standard output.");

namespace cartographer_ext {
namespace {

constexpr char kDescription[] =
    R"(Searches Lua keys for the best configuration for the recordings.

  cartographer_ext_tune -search_filename=configuration_files/tuning/stock.lua \
      -inputs=aces.clf,csail.clf -holdout=intel.clf -budget_minutes=30 \
      -journal_filename=tune.jsonl -output_filename=tuned.lua
  mpirun -n 9 cartographer_ext_tune ...        (the same on eight workers)
  cartographer_ext_tune ... -job_folder=/shared/tune -job_task=K
      (task K of a job array; task 0 writes the results)

An interrupted search resumes with the same journal. The list of trials depends
on -seed and -max_trials, not on the number of workers.)";

struct Setup {
  tuning::SearchSpec spec;
  std::vector<tuning::TuneInput> inputs;
  std::vector<tuning::TuneInput> holdout;
  tuning::TunerOptions options;
};

std::vector<std::string> Words(const std::string& text) {
  return absl::StrSplit(text, ',', absl::SkipEmpty());
}

absl::StatusOr<Setup> ReadSetup() {
  Setup setup;
  auto spec = tuning::ReadSearchSpec(FLAGS_search_filename);
  if (!spec.ok()) return spec.status();
  setup.spec = *std::move(spec);
  if (!FLAGS_objective.empty()) {
    setup.spec.objective.weights = *tuning::ParseWeights(FLAGS_objective);
  }
  if (!FLAGS_configuration_basename.empty()) {
    setup.spec.configuration = FLAGS_configuration_basename;
  } else if (setup.spec.configuration.empty()) {
    setup.spec.configuration = "stock.lua";
  }
  const auto inputs = tuning::ParseInputs(
      FLAGS_inputs.empty() ? setup.spec.inputs : Words(FLAGS_inputs));
  if (!inputs.ok()) return inputs.status();
  const auto holdout = tuning::ParseInputs(
      FLAGS_holdout.empty() ? setup.spec.holdout : Words(FLAGS_holdout));
  if (!holdout.ok()) return holdout.status();
  setup.inputs = *inputs;
  setup.holdout = *holdout;
  if (setup.inputs.empty()) {
    return absl::InvalidArgumentError(
        "no inputs: give -inputs, or inputs in the search file");
  }
  for (const auto* const some : {&setup.inputs, &setup.holdout}) {
    const absl::Status known = tuning::CheckTruth(*some, setup.spec.objective);
    if (!known.ok()) return known;
  }
  for (const tuning::TuneInput& held_out : setup.holdout) {
    for (const tuning::TuneInput& input : setup.inputs) {
      if (held_out.name == input.name) {
        return absl::InvalidArgumentError(
            absl::StrCat(input.recording, " is both an input and held out"));
      }
    }
  }
  tuning::TunerOptions& options = setup.options;
  options.sampler.method = FLAGS_method;
  options.sampler.seed = FLAGS_seed;
  options.sampler.min_fidelity = FLAGS_min_fidelity;
  options.max_trials = FLAGS_max_trials;
  options.budget_seconds = 60. * FLAGS_budget_minutes;
  options.folds = FLAGS_folds;
  options.prune = FLAGS_prune;
  options.no_input_worse = setup.spec.no_input_worse;
  options.odometry_source = FLAGS_odometry_source;
  options.num_threads = FLAGS_threads;
  return setup;
}

std::string ObjectiveText(const tuning::Objective& objective) {
  std::vector<std::string> parts;
  for (const auto& entry : objective.weights) {
    parts.push_back(entry.second == 1.
                        ? entry.first
                        : absl::StrFormat("%g %s", entry.second, entry.first));
  }
  return absl::StrJoin(parts, " + ");
}

absl::Status WriteResults(const tuning::TuneResult& result,
                          const tuning::ResultContext& context) {
  AtomicFileSet files;
  if (!FLAGS_output_filename.empty()) {
    const absl::Status status = WriteFileAtomically(
        FLAGS_output_filename, tuning::ToLuaFile(result, context));
    if (!status.ok()) return status;
  }
  if (!FLAGS_picture_filename.empty()) {
    const absl::Status status =
        tuning::WriteSensitivityPlot(result, context, FLAGS_picture_filename);
    if (!status.ok()) return status;
  }
  if (FLAGS_json != "-") std::cout << tuning::ToText(result, context);
  if (!FLAGS_json.empty()) {
    const absl::Status status =
        tools::WriteJson(tuning::ToJson(result, context), FLAGS_json);
    if (!status.ok()) return status;
  }
  return files.Commit();
}

std::string BestAndBudget(const tuning::TunerProgress& state) {
  std::string text;
  if (state.best.has_value()) {
    absl::StrAppendFormat(&text, ", best so far %.4g", *state.best);
  }
  if (FLAGS_budget_minutes > 0.) {
    absl::StrAppend(
        &text, ", ",
        FormatDuration(60. * FLAGS_budget_minutes - state.elapsed_seconds),
        " of the budget left");
  }
  return text;
}

absl::Status Run(const tools::Job& job) {
  const absl::Status writable = tools::CheckWritable(
      {FLAGS_output_filename, FLAGS_picture_filename, FLAGS_json});
  if (!writable.ok()) return writable;
  auto setup = ReadSetup();
  if (!setup.ok()) return setup.status();
  if (tools::BaseName(FLAGS_output_filename) == setup->spec.configuration) {
    return absl::InvalidArgumentError(
        absl::StrCat(FLAGS_output_filename, ": the output includes ",
                     setup->spec.configuration, " and must have another name"));
  }
  auto configuration = tuning::BaseConfiguration::Load(
      tools::ConfigurationDirectories(FLAGS_configuration_directory),
      setup->spec.configuration);
  if (!configuration.ok()) return configuration.status();
  const absl::Status checked =
      configuration->CheckParameters(setup->spec.parameters);
  if (!checked.ok()) {
    return absl::InvalidArgumentError(
        absl::StrCat(FLAGS_search_filename, ": ", checked.message()));
  }
  const std::string journal_filename = job.JournalOr(FLAGS_journal_filename);
  const auto journal = tuning::Journal::Open(
      journal_filename,
      absl::StrCat(configuration->Fingerprint(), "|", FLAGS_odometry_source,
                   setup->spec.objective.Wants("self_consistency")
                       ? "|self_consistency"
                       : ""));
  if (!journal.ok()) return journal.status();
  if ((*journal)->was_torn()) {
    std::cerr << tools::ProgramName() << ": " << journal_filename
              << ": the last line is incomplete and is dropped\n";
  }

  const auto pool = job.CreatePool(FLAGS_workers, FLAGS_max_run_cpu_seconds,
                                   &tuning::AnswerRequest);
  if (!pool.ok()) return pool.status();
  tuning::Tuner tuner({*configuration, setup->spec.parameters,
                       setup->spec.objective, setup->inputs, setup->holdout},
                      setup->options, pool->get(), journal->get());
  Progress progress("Trial", FLAGS_max_trials);
  tuner.SetProgressCallback([&progress](const tuning::TunerProgress& state) {
    progress.Update(state.trials,
                    absl::StrCat(state.step, BestAndBudget(state)));
  });
  const auto result = tuner.Run();
  progress.Finish();
  if (!result.ok()) return result.status();
  tuning::ResultContext context;
  context.configuration = setup->spec.configuration;
  context.directories = configuration->directories();
  context.filename = tools::BaseName(FLAGS_output_filename);
  context.objective = ObjectiveText(setup->spec.objective);
  context.parameters = setup->spec.parameters;
  context.inputs = setup->inputs;
  context.holdout = setup->holdout;
  return WriteResults(*result, context);
}

int CheckUsage() {
  if (FLAGS_search_filename.empty()) {
    return tools::UsageError("-search_filename is missing");
  }
  if (!FLAGS_objective.empty()) {
    const absl::Status status = tuning::ParseWeights(FLAGS_objective).status();
    if (!status.ok()) {
      return tools::UsageError(absl::StrCat("-objective: ", status.message()));
    }
  }
  if (FLAGS_max_trials < 0 || !(FLAGS_budget_minutes >= 0.) ||
      FLAGS_folds < 0 || FLAGS_workers < 0 || FLAGS_threads < 1 ||
      !(FLAGS_max_run_cpu_seconds >= 0.)) {
    return tools::UsageError(
        "-max_trials, -budget_minutes, -folds, -workers and "
        "-max_run_cpu_seconds must not be negative, -threads at least 1");
  }
  if (!(FLAGS_min_fidelity > 0.) || !(FLAGS_min_fidelity <= 1.)) {
    return tools::UsageError("-min_fidelity must be above 0 and at most 1");
  }
  if (FLAGS_max_trials == 0 && FLAGS_budget_minutes == 0. &&
      FLAGS_method != "grid") {
    return tools::UsageError(
        "only a grid terminates by itself: give -max_trials or "
        "-budget_minutes");
  }
  return tools::kExitSuccess;
}

}  // namespace
}  // namespace cartographer_ext

int main(int argc, char** argv) {
  using namespace cartographer_ext;  // NOLINT
  tools::CommandLine command_line(kDescription);
  command_line.TakeOneOf("method", tuning::MethodNames());
  command_line.TakeOneOf("odometry_source", {"odom", "scan", "both", "auto"});
  command_line.TakeEndings("picture_filename", {".png", ".svg"});
  command_line.Parse(argc, argv);
  const int usage = CheckUsage();
  if (usage != tools::kExitSuccess) return usage;
  const std::string wrong = tools::Job::WrongUsage();
  if (!wrong.empty()) return tools::UsageError(wrong);
  const tools::Job job(&argc, &argv);
  if (job.is_worker()) {
    return tools::ExitCode(job.Serve(FLAGS_workers, FLAGS_max_run_cpu_seconds,
                                     &tuning::AnswerRequest));
  }
  return tools::ExitCode(Run(job));
}
