// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
#include "cartographer_ext/tuning/tuner.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <set>
#include <utility>

#include "absl/strings/str_cat.h"
#include "cartographer_ext/tuning/comparable_trials.h"
#include "cartographer_ext/tuning/trial_run.h"
#include "glog/logging.h"

namespace cartographer_ext {
namespace tuning {
namespace {

// Of a run that something else ended.
constexpr int kMaxRetries = 2;
constexpr double kForever = std::numeric_limits<double>::infinity();
constexpr double kWaitSeconds = 0.2;
// Share of the time of a search that is reserved for pruning.
constexpr double kShareForPruning = 0.2;
constexpr double kHoldoutReserve = 1.3;  // times the run of the baseline
// A small space is exhausted after this many consecutive draws that have been
// tried before.
constexpr int kMaxRepetitions = 200;

std::vector<TuneInput> Concatenate(std::vector<TuneInput> first,
                                   const std::vector<TuneInput>& second) {
  first.insert(first.end(), second.begin(), second.end());
  return first;
}

std::vector<size_t> Range(const size_t begin, const size_t end) {
  std::vector<size_t> indices;
  for (size_t i = begin; i < end; ++i) indices.push_back(i);
  return indices;
}

}  // namespace

Tuner::Tuner(TuneProblem problem, const TunerOptions& options,
             WorkerPool* const pool, Journal* const journal)
    : configuration_(std::move(problem.configuration)),
      parameters_(std::move(problem.parameters)),
      objective_(std::move(problem.objective)),
      all_inputs_(Concatenate(problem.inputs, problem.holdout)),
      num_inputs_(problem.inputs.size()),
      options_(options),
      pool_(pool),
      journal_(journal),
      start_(SteadySeconds()) {
  for (const RunRecord& record : journal_->runs()) {
    if (record.killed) continue;
    KnownRun& run = runs_[RunKey(record)];
    run.record = record;
    run.finished = true;
  }
}

void Tuner::SetProgressCallback(
    std::function<void(const TunerProgress&)> callback) {
  callback_ = std::move(callback);
}

double Tuner::Elapsed() const { return SteadySeconds() - start_; }

void Tuner::Report(const int trials) {
  if (!callback_) return;
  progress_.trials = trials;
  progress_.max_trials = options_.max_trials;
  progress_.elapsed_seconds = Elapsed();
  callback_(progress_);
}

RunRecord Tuner::Record(const Point& point, const size_t input,
                        const double fidelity) const {
  RunRecord record;
  record.assignment = ToAssignment(parameters_, point);
  record.input = all_inputs_[input].name;
  // A finished map cannot be cut.
  record.fidelity = all_inputs_[input].is_pbstream ? 1. : fidelity;
  return record;
}

nlohmann::json Tuner::Request(const RunRecord& record,
                              const size_t input) const {
  RunRequest request;
  request.code = configuration_.CodeWith(record.assignment);
  request.name = configuration_.name();
  request.directories = configuration_.directories();
  request.input = all_inputs_[input];
  request.fidelity = record.fidelity;
  request.odometry_source = options_.odometry_source;
  request.num_threads = options_.num_threads;
  request.wants_self_consistency = objective_.Wants("self_consistency");
  return ToJson(request);
}

Tuner::PendingTrial Tuner::Queue(const Point& point, const double fidelity,
                                 const std::vector<size_t>& inputs) {
  PendingTrial pending;
  pending.trial.point = point;
  pending.trial.fidelity = fidelity;
  pending.inputs = inputs;
  for (const size_t input : inputs) {
    const RunRecord record = Record(point, input, fidelity);
    const std::string key = RunKey(record);
    pending.keys.push_back(key);
    const auto found = runs_.find(key);
    if (found != runs_.end()) continue;
    KnownRun run;
    run.record = record;
    run.input = input;
    runs_[key] = run;
    queue_.push_back(key);
  }
  return pending;
}

bool Tuner::IsComplete(const PendingTrial& trial) const {
  return std::all_of(
      trial.keys.begin(), trial.keys.end(),
      [this](const std::string& key) { return runs_.at(key).finished; });
}

void Tuner::Complete(PendingTrial* const pending) const {
  Trial& trial = pending->trial;
  trial.ok = true;
  for (size_t i = 0; i < pending->keys.size(); ++i) {
    const RunRecord& record = runs_.at(pending->keys[i]).record;
    std::string message = record.message;
    if (record.ok) {
      const auto value = EvaluateRun(objective_, record.metrics);
      if (value.ok()) {
        trial.objectives.push_back(*value);
        continue;
      }
      message = std::string(value.status().message());
    }
    trial.ok = false;
    trial.message =
        absl::StrCat(all_inputs_[pending->inputs[i]].recording, ": ", message);
    trial.objectives.clear();
    return;
  }
  trial.objective = Aggregate(objective_, trial.objectives);
}

absl::Status Tuner::Pump() {
  while (!queue_.empty() && pool_->num_running() < pool_->num_workers()) {
    const std::string key = queue_.front();
    queue_.pop_front();
    const KnownRun& run = runs_.at(key);
    running_[next_id_] = key;
    pool_->Start(next_id_++, Request(run.record, run.input));
  }
  if (running_.empty()) return absl::OkStatus();
  const auto result = pool_->Wait(kWaitSeconds);
  if (!result.has_value()) return absl::OkStatus();
  const auto found = running_.find(result->id);
  if (found == running_.end()) return absl::OkStatus();
  KnownRun& run = runs_.at(found->second);
  running_.erase(found);
  TakeAnswer(result->answer, &run.record);
  if (run.record.killed && ++run.kills <= kMaxRetries) {
    queue_.push_back(RunKey(run.record));
    return absl::OkStatus();
  }
  run.finished = true;
  ++result_.num_runs;
  result_.cpu_seconds += run.record.cpu_seconds;
  return journal_->Append(run.record);
}

void Tuner::Stop() {
  pool_->StopAll();
  running_.clear();
  queue_.clear();
  for (auto run = runs_.begin(); run != runs_.end();) {
    run = run->second.finished ? std::next(run) : runs_.erase(run);
  }
}

absl::StatusOr<absl::optional<Trial>> Tuner::Evaluate(
    const Point& point, const std::vector<size_t>& inputs,
    const double deadline) {
  PendingTrial pending = Queue(point, 1., inputs);
  while (!IsComplete(pending)) {
    if (Elapsed() >= deadline) {
      Stop();
      return absl::optional<Trial>();
    }
    const absl::Status status = Pump();
    if (!status.ok()) return status;
    Report(progress_.trials);
  }
  Complete(&pending);
  return absl::optional<Trial>(pending.trial);
}

absl::StatusOr<Trial> Tuner::EvaluateNow(const Point& point,
                                         const std::vector<size_t>& inputs) {
  const auto trial = Evaluate(point, inputs, kForever);
  if (!trial.ok()) return trial.status();
  return **trial;
}

absl::Status Tuner::RunSampler(const std::vector<size_t>& inputs,
                               const double deadline,
                               std::vector<Trial>* const trials) {
  SamplerOptions sampler_options = options_.sampler;
  sampler_options.start = base_point_;
  const auto sampler = CreateSampler(parameters_, sampler_options);
  if (!sampler.ok()) return sampler.status();
  const size_t max_trials = options_.max_trials > 0
                                ? static_cast<size_t>(options_.max_trials)
                                : std::numeric_limits<size_t>::max();
  std::map<size_t, PendingTrial> open;
  std::map<size_t, Trial> done;
  std::set<std::string> tried;
  size_t asked = 0;
  int repetitions = 0;
  bool exhausted = false;
  while (true) {
    for (auto entry = open.begin(); entry != open.end();) {
      if (!IsComplete(entry->second)) {
        ++entry;
        continue;
      }
      Complete(&entry->second);
      const Trial& trial = entry->second.trial;
      (*sampler)->Tell(entry->first, trial.ok
                                         ? absl::make_optional(trial.objective)
                                         : absl::nullopt);
      if (trial.ok && trial.fidelity == 1. &&
          (!progress_.best.has_value() || trial.objective < *progress_.best)) {
        progress_.best = trial.objective;
      }
      done[entry->first] = trial;
      entry = open.erase(entry);
    }
    if (Elapsed() >= deadline) {
      result_.ended_by_budget = true;
      Stop();
      break;
    }
    bool asked_one = false;
    if (asked < max_trials && !exhausted &&
        queue_.size() < static_cast<size_t>(pool_->num_workers())) {
      const auto request = (*sampler)->Ask();
      if (request.has_value()) {
        asked_one = true;
        open[asked] = Queue(request->point, request->fidelity, inputs);
        std::string all_keys;
        for (const auto& key : open[asked].keys) all_keys += key;
        repetitions = tried.insert(all_keys).second ? 0 : repetitions + 1;
        exhausted = repetitions >= kMaxRepetitions;
        ++asked;
      } else if (open.empty()) {
        break;
      }
    } else if (open.empty()) {
      break;
    }
    if (asked_one) continue;  // until there is enough to start
    const absl::Status status = Pump();
    if (!status.ok()) return status;
    Report(static_cast<int>(done.size()));
  }
  for (const auto& entry : done) trials->push_back(entry.second);
  return absl::OkStatus();
}

bool Tuner::IsAllowed(const Trial& trial, const Trial& baseline) const {
  if (!trial.ok || trial.fidelity != 1.) return false;
  if (!options_.no_input_worse) return true;
  for (size_t i = 0; i < trial.objectives.size(); ++i) {
    if (trial.objectives[i] > baseline.objectives[i]) return false;
  }
  return true;
}

absl::Status Tuner::Prune(const std::vector<size_t>& inputs,
                          const Trial& baseline, const double deadline,
                          SearchResult* const result) {
  Trial* const best = &result->best;
  for (size_t i = 0; i < parameters_.size(); ++i) {
    if (best->point[i] == base_point_[i]) continue;
    KeyResult key;
    key.key = parameters_[i].key;
    key.before = base_point_[i];
    key.after = best->point[i];
    if (options_.prune) {
      Point without = best->point;
      without[i] = base_point_[i];
      const auto trial = Evaluate(without, inputs, deadline);
      if (!trial.ok()) return trial.status();
      if (trial->has_value() && (*trial)->ok) {
        const double gain = (*trial)->objective - best->objective;
        if (IsAllowed(**trial, baseline) &&
            gain <= options_.least_gain * std::abs(best->objective)) {
          *best = **trial;
          continue;
        }
        key.gain = gain;
        for (size_t k = 0; k < inputs.size(); ++k) {
          key.better_on += (*trial)->objectives[k] > best->objectives[k];
        }
      }
    }
    result->keys.push_back(key);
  }
  return absl::OkStatus();
}

absl::StatusOr<Tuner::SearchResult> Tuner::Search(
    const std::vector<size_t>& inputs, const double seconds) {
  SearchResult result;
  const auto baseline = EvaluateNow(base_point_, inputs);
  if (!baseline.ok()) return baseline.status();
  const double start = Elapsed();
  const double pruning = options_.prune ? kShareForPruning * seconds : 0.;
  progress_.best.reset();
  progress_.step = "search";
  const absl::Status status = RunSampler(
      inputs, seconds == kForever ? kForever : start + seconds - pruning,
      &result.trials);
  if (!status.ok()) return status;
  result.best = *baseline;
  bool any = false;
  for (const Trial& trial : result.trials) {
    any |= trial.ok;
    if (IsAllowed(trial, *baseline) &&
        trial.objective < result.best.objective) {
      result.best = trial;
    }
  }
  if (!any && !result.trials.empty()) {
    return absl::InvalidArgumentError(absl::StrCat(
        "every trial failed, the first with: ", result.trials.front().message));
  }
  progress_.step = "pruning";
  const absl::Status pruned =
      Prune(inputs, *baseline, start + seconds, &result);
  if (!pruned.ok()) return pruned;
  return result;
}

absl::Status Tuner::RunFolds(const double seconds_each) {
  const size_t folds =
      std::min(static_cast<size_t>(options_.folds), num_inputs_);
  for (size_t fold = 0; fold < folds; ++fold) {
    std::vector<size_t> train, test;
    for (size_t i = 0; i < num_inputs_; ++i) {
      (i % folds == fold ? test : train).push_back(i);
    }
    const auto search = Search(train, seconds_each);
    if (!search.ok()) return search.status();
    progress_.step = "fold";
    const auto before = EvaluateNow(base_point_, test);
    if (!before.ok()) return before.status();
    const auto after = EvaluateNow(search->best.point, test);
    if (!after.ok()) return after.status();
    FoldResult result;
    for (const size_t i : test) {
      result.held_out.push_back(all_inputs_[i].name);
    }
    result.point = search->best.point;
    result.before = before->objective;
    result.after = after->ok ? after->objective : kForever;
    result_.folds.push_back(result);
  }
  return absl::OkStatus();
}

absl::StatusOr<TuneResult> Tuner::Run() {
  const auto base_point = configuration_.Values(parameters_);
  if (!base_point.ok()) return base_point.status();
  base_point_ = *base_point;
  result_.num_known_runs = static_cast<int>(journal_->runs().size());
  const std::vector<size_t> searched = Range(0, num_inputs_);
  const std::vector<size_t> held_out = Range(num_inputs_, all_inputs_.size());

  progress_.step = "baseline";
  // All at once, to keep every worker busy.
  Queue(base_point_, 1., Range(0, all_inputs_.size()));
  const auto baseline = EvaluateNow(base_point_, searched);
  if (!baseline.ok()) return baseline.status();
  if (!baseline->ok) {
    return absl::InvalidArgumentError(
        absl::StrCat("the initial configuration fails: ", baseline->message));
  }
  result_.baseline = *baseline;
  double reserve = 0.;
  if (!held_out.empty()) {
    const auto trial = EvaluateNow(base_point_, held_out);
    if (!trial.ok()) return trial.status();
    result_.baseline_holdout = *trial;
    for (const size_t i : held_out) {
      const RunRecord& record =
          runs_.at(RunKey(Record(base_point_, i, 1.))).record;
      reserve = std::max(reserve, kHoldoutReserve * record.wall_seconds);
    }
  }

  double seconds_each = kForever;
  const bool has_folds = options_.folds >= 2 && num_inputs_ >= 2;
  if (options_.budget_seconds > 0.) {
    const size_t searches =
        1 + (has_folds
                 ? std::min(static_cast<size_t>(options_.folds), num_inputs_)
                 : 0);
    seconds_each = std::max(0., options_.budget_seconds - reserve - Elapsed()) /
                   static_cast<double>(searches);
  }
  if (has_folds) {
    const absl::Status status = RunFolds(seconds_each);
    if (!status.ok()) return status;
  }
  auto search = Search(searched, seconds_each);
  if (!search.ok()) return search.status();
  result_.trials = std::move(search->trials);
  result_.best = std::move(search->best);
  result_.keys = std::move(search->keys);
  if (!held_out.empty()) {
    progress_.step = "holdout";
    const auto trial = EvaluateNow(result_.best.point, held_out);
    if (!trial.ok()) return trial.status();
    result_.best_holdout = *trial;
    KeepIfConfirmed(options_.least_gain, &result_);
  }
  return result_;
}

}  // namespace tuning
}  // namespace cartographer_ext
