// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
//
// The search itself, in four steps:
//
// 1. The initial configuration, on all recordings. 2. Trials as requested by
// the sampler, each on all recordings of the search,
//    several at a time, until the budget is used up. Only trials on whole
//    recordings can become the best.
// 3. Pruning: each key that the best trial changed is set back, one after the
//    other; a key that gains nothing stays as it was. What is left has a
//    measured gain for every key.
// 4. The result on the recordings held out, which nothing above has seen.
//
// With folds, steps 2 and 3 are first done with each part of the recordings
// held out, and each result is evaluated on that part: an estimate of the gain
// on an unseen building.
//
// Every run is recorded in the journal, and runs in the journal are not
// repeated.
#ifndef CARTOGRAPHER_EXT_TUNING_TUNER_H_
#define CARTOGRAPHER_EXT_TUNING_TUNER_H_

#include <deque>
#include <functional>
#include <map>
#include <memory>
#include <string>
#include <vector>

#include "absl/status/status.h"
#include "absl/status/statusor.h"
#include "absl/types/optional.h"
#include "cartographer_ext/tuning/configuration_patch.h"
#include "cartographer_ext/tuning/journal.h"
#include "cartographer_ext/tuning/objective.h"
#include "cartographer_ext/tuning/parameter_space.h"
#include "cartographer_ext/tuning/sampler.h"
#include "cartographer_ext/tuning/search_spec.h"
#include "cartographer_ext/tuning/workers/worker_pool.h"

namespace cartographer_ext {
namespace tuning {

struct TunerOptions {
  SamplerOptions sampler;
  int max_trials = 0;          // of one search; 0: no limit
  double budget_seconds = 0.;  // of everything; 0: no limit
  int folds = 0;               // fewer than 2: none
  bool prune = true;
  // A key is reset if its old value makes the objective worse by less than this
  // share.
  double least_gain = 0.005;
  // The best trial must not be worse than the initial configuration on any
  // recording of the search.
  bool no_input_worse = false;
  std::string odometry_source;
  int num_threads = 1;  // of each run
};

// One configuration, put together from its runs.
struct Trial {
  Point point;
  double fidelity = 1.;
  bool ok = false;
  std::string message;             // of the first run that failed
  double objective = 0.;           // over the recordings
  std::vector<double> objectives;  // of each recording, when ok
};

struct KeyResult {
  std::string key;
  Value before;
  Value after;
  // Deterioration of the objective without this change; absent if not measured.
  absl::optional<double> gain;
  // Number of recordings on which it is worse.
  int better_on = 0;
};

struct FoldResult {
  std::vector<std::string> held_out;  // recordings
  Point point;
  double before = 0.;  // objective on the recordings held out
  double after = 0.;
};

struct TuneResult {
  Trial baseline;
  absl::optional<Trial> baseline_holdout;
  // All trials of the last search in the order asked, the baseline not
  // included.
  std::vector<Trial> trials;
  Trial best;  // after pruning; the baseline when nothing is better
  // Held-out result of the best trial, even if it is not the result of the
  // search.
  absl::optional<Trial> best_holdout;
  // Why the best trial is not the result: the held-out recordings do not
  // confirm it (WhyNotBetter). Empty if they do, or if there are none.
  std::string not_confirmed;
  std::vector<KeyResult> keys;  // that differ from the baseline
  std::vector<FoldResult> folds;
  // Counted in runs.
  int num_runs = 0;         // done now
  int num_known_runs = 0;   // found in the journal
  double cpu_seconds = 0.;  // of the runs done now
  bool ended_by_budget = false;
};

struct TunerProgress {
  int trials = 0;
  int max_trials = 0;
  double elapsed_seconds = 0.;
  absl::optional<double> best;
  const char* step = "";
};

// Inputs and search space of the tuner.
struct TuneProblem {
  BaseConfiguration configuration;
  std::vector<Parameter> parameters;
  Objective objective;
  std::vector<TuneInput> inputs;
  std::vector<TuneInput> holdout;
};

class Tuner {
 public:
  // `pool` and `journal` must outlive it.
  Tuner(TuneProblem problem, const TunerOptions& options, WorkerPool* pool,
        Journal* journal);

  // Sets a function that is called occasionally.
  void SetProgressCallback(std::function<void(const TunerProgress&)> callback);

  // Errors: the journal cannot be written, the initial configuration fails on
  // some recording (then all trials would fail), no trial succeeded.
  absl::StatusOr<TuneResult> Run();

 private:
  struct PendingTrial {
    Trial trial;
    std::vector<size_t> inputs;     // indices into all_inputs_
    std::vector<std::string> keys;  // of its runs
  };

  RunRecord Record(const Point& point, size_t input, double fidelity) const;
  nlohmann::json Request(const RunRecord& record, size_t input) const;
  // Queues the runs that are not in the journal.
  PendingTrial Queue(const Point& point, double fidelity,
                     const std::vector<size_t>& inputs);
  bool IsComplete(const PendingTrial& trial) const;
  void Complete(PendingTrial* trial) const;
  // Starts queued runs and collects results for a limited time.
  absl::Status Pump();
  // Clears the queue and stops the running ones.
  void Stop();
  // One configuration on whole recordings, waited for until the deadline.
  absl::StatusOr<absl::optional<Trial>> Evaluate(
      const Point& point, const std::vector<size_t>& inputs, double deadline);
  // Without a deadline.
  absl::StatusOr<Trial> EvaluateNow(const Point& point,
                                    const std::vector<size_t>& inputs);
  // Steps 2 and 3 on some of the recordings.
  struct SearchResult {
    std::vector<Trial> trials;
    Trial best;
    std::vector<KeyResult> keys;
  };
  absl::StatusOr<SearchResult> Search(const std::vector<size_t>& inputs,
                                      double seconds);
  // Whether a trial may be the result of a search that started from `baseline`.
  bool IsAllowed(const Trial& trial, const Trial& baseline) const;
  absl::Status RunSampler(const std::vector<size_t>& inputs, double deadline,
                          std::vector<Trial>* trials);
  absl::Status Prune(const std::vector<size_t>& inputs, const Trial& baseline,
                     double deadline, SearchResult* result);
  absl::Status RunFolds(double seconds_each);
  void Report(int trials);
  double Elapsed() const;

  const BaseConfiguration configuration_;
  const std::vector<Parameter> parameters_;
  const Objective objective_;
  const std::vector<TuneInput> all_inputs_;  // those held out at the end
  const size_t num_inputs_;
  const TunerOptions options_;
  WorkerPool* const pool_;
  Journal* const journal_;
  std::function<void(const TunerProgress&)> callback_;
  const double start_;

  struct KnownRun {
    RunRecord record;
    size_t input = 0;
    bool finished = false;
    int kills = 0;  // number of times it was killed from outside
  };
  std::map<std::string, KnownRun> runs_;  // by RunKey
  std::deque<std::string> queue_;         // keys of runs to start
  std::map<int, std::string> running_;
  int next_id_ = 0;
  Point base_point_;
  TuneResult result_;
  TunerProgress progress_;
};

}  // namespace tuning
}  // namespace cartographer_ext

#endif  // CARTOGRAPHER_EXT_TUNING_TUNER_H_
