// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
#include "tests/fuzz/table_readers.h"

#include <vector>

#include "cartographer_ext/collection/baseline.h"
#include "cartographer_ext/collection/map_survey.h"
#include "cartographer_ext/configuration/option_reference.h"
#include "cartographer_ext/experiments/cost_comparison.h"
#include "cartographer_ext/experiments/golden_pairs.h"
#include "cartographer_ext/experiments/robustness_sweep.h"
#include "cartographer_ext/io/line_reader.h"
#include "cartographer_ext/map/switched_constraints.h"
#include "cartographer_ext/navigation/closed_loop/goals.h"
#include "cartographer_ext/optimization/selection/switched_loops.h"
#include "cartographer_ext/repair/loops_by_hand.h"
#include "cartographer_ext/slam/starting_state.h"
#include "cartographer_ext/tuning/journal.h"
#include "cartographer_ext/tuning/search_spec.h"
#include "cartographer_ext/tuning/workers/shared_folder.h"
#include "cartographer_ext/tuning/workers/worker_pool.h"
#include "tests/mutation.h"

namespace cartographer_ext {
namespace test {
namespace {

constexpr size_t kMaxTableBytes = 64 << 20;

// Marked in a map that has the first of the loops.
bool ReadSwitchedLoops(const std::string& name) {
  const auto text = io::ReadFile(name, kMaxTableBytes);
  if (!text.ok()) return false;
  const auto loops = optimization::ParseSwitchedLoopsTable(*text);
  if (!loops.ok()) return false;
  evaluation::MapGraph graph;
  evaluation::GraphConstraint loop;
  loop.is_loop = true;
  graph.constraints.push_back(loop);
  evaluation::MarkSwitchedOff(*loops, &graph);
  return true;
}

bool ReadEffects(const std::string& name) {
  const auto text = io::ReadFile(name, kMaxTableBytes);
  return text.ok() && evaluation::ParseOptionEffects(*text, name).ok();
}

bool ReadBaselineFile(const std::string& name) {
  const auto baseline = collection::ReadBaseline(name);
  if (!baseline.ok()) return false;
  std::vector<collection::MapRecord> records;
  for (const auto& entry : *baseline) records.push_back(entry.second);
  for (const auto& change : collection::Compare(*baseline, records)) {
    collection::ToJson(change);
  }
  return !collection::ToCsv(records).empty() &&
         collection::ToJsonLines(records).empty() == records.empty();
}

bool ReadTuningJournal(const std::string& name) {
  const auto journal = tuning::Journal::Open(name, "f");
  if (!journal.ok()) return false;
  for (const tuning::RunRecord& run : (*journal)->runs()) {
    tuning::RunKey(run);
    tuning::ToJson(run);
  }
  return true;
}

bool ReadSweepJournal(const std::string& name) {
  experiments::SweepOptions options;
  options.journal_filename = name;
  return experiments::RunSweep(options).ok();
}

bool ReadCostJournal(const std::string& name) {
  experiments::SweepOptions options;
  options.journal_filename = name;
  return experiments::CompareCosts(options).ok();
}

bool ReadSurveyJournal(const std::string& name) {
  collection::SurveyOptions options;
  options.journal_filename = name;
  tuning::LocalWorkerPool pool(1, 0., collection::AnswerMapRequest);
  return collection::SurveyMaps({}, options, &pool).ok();
}

// What a task of a job array has written, read by the one that distributes.
bool ReadAnswer(const std::string& name) {
  const size_t slash = name.rfind('/');
  const auto json =
      tuning::SharedFolder(name.substr(0, slash)).Read(name.substr(slash + 1));
  if (!json.contains("answer")) return false;
  tuning::RunRecord run;
  tuning::TakeAnswer(json["answer"], &run);
  tuning::ToJson(run);
  return run.ok;
}

// As given on the command line, for a map that has none of the loops.
bool ReadArguments(const std::string& name) {
  std::string line = ReadBytes(name);
  const std::string loops = line.substr(0, line.find('\n'));
  line.erase(0, loops.size() + 1);
  const std::string goals = line.substr(0, line.find('\n'));
  line.erase(0, goals.size() + 1);
  const std::string pose = line.substr(0, line.find('\n'));
  evaluation::MapGraph graph;
  for (int i = 0; i < 3; ++i) {
    graph.submaps[{0, i}];
    graph.nodes[{0, i}];
  }
  const bool has_loops = repair::ParseLoopsByHand(graph, loops).ok();
  const bool has_goals = navigation::ParseGoals(goals).ok();
  const bool has_pose = evaluation::ParsePose(pose).ok();
  return has_loops && has_goals && has_pose;
}

}  // namespace

std::map<std::string, std::function<bool(const std::string&)>> TableReaders() {
  return {{"switched", ReadSwitchedLoops},
          {"effects", ReadEffects},
          {"baseline", ReadBaselineFile},
          {"tuning", ReadTuningJournal},
          {"sweep", ReadSweepJournal},
          {"costs", ReadCostJournal},
          {"survey", ReadSurveyJournal},
          {"answer", ReadAnswer},
          {"arguments", ReadArguments},
          {"golden",
           [](const std::string& name) {
             return evaluation::ReadGoldenPairs(name).ok();
           }},
          {"search", [](const std::string& name) {
             return tuning::ReadSearchSpec(name).ok();
           }}};
}

}  // namespace test
}  // namespace cartographer_ext
