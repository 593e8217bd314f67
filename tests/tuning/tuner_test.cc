// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
#include "cartographer_ext/tuning/tuner.h"

#include <cmath>
#include <regex>
#include <set>

#include "cartographer_ext/common/random.h"
#include "gmock/gmock.h"
#include "gtest/gtest.h"
#include "tests/tuning/temporary_file.h"

namespace cartographer_ext {
namespace tuning {
namespace {

using testing::HasSubstr;

constexpr char kScore[] = "POSE_GRAPH.constraint_builder.min_score";
constexpr char kScale[] = "POSE_GRAPH.optimization_problem.huber_scale";
constexpr char kUnused[] = "POSE_GRAPH.matcher_rotation_weight";

// Instead of SLAM: smallest at min_score 0.7 and huber_scale 100; the third key
// does nothing. "b" likes them as "a" does, but is twice as bad; "c" would have
// min_score low.
double Error(const std::map<std::string, double>& values,
             const std::string& input) {
  const double score = values.at(kScore) - 0.7;
  const double scale = std::log10(values.at(kScale)) - 2.;
  if (input[0] == 'c') return 0.01 * (1. + values.at(kScore));
  return (input[0] == 'b' ? 2. : 1.) *
         (0.1 + score * score + 0.05 * scale * scale);
}

// Answers in an order that depends on the seed.
class FakePool : public WorkerPool {
 public:
  FakePool(const int num_workers, const uint64_t seed)
      : num_workers_(num_workers), random_(seed) {}

  int num_workers() const override { return num_workers_; }
  int num_running() const override { return static_cast<int>(runs_.size()); }

  void Start(const int id, const nlohmann::json& request) override {
    ASSERT_LT(num_running(), num_workers_);
    runs_.push_back({id, request});
    ++started;
  }

  absl::optional<WorkerResult> Wait(double /*timeout_seconds*/) override {
    if (runs_.empty() || (started > hang_after && hang_after > 0)) {
      return absl::nullopt;
    }
    const size_t index = static_cast<size_t>(
        random_.UniformInt(0, static_cast<int64_t>(runs_.size()) - 1));
    const auto run = runs_[index];
    runs_.erase(runs_.begin() + static_cast<ptrdiff_t>(index));
    if (kills > 0) {
      --kills;
      nlohmann::json answer = Failure("killed");
      answer["killed"] = true;
      return WorkerResult{run.first, answer};
    }
    return WorkerResult{run.first, Answer(run.second)};
  }

  void StopAll() override {
    runs_.clear();
    hang_after = 0;
  }

  int started = 0;
  int hang_after = 0;
  double fail_below_score = 0.;
  int kills = 0;  // of the next runs

 private:
  nlohmann::json Answer(const nlohmann::json& request) const {
    const std::string code = request["code"].get<std::string>();
    std::map<std::string, double> values;
    const std::regex assignment("assign\\(\"([^\"]+)\", ([^)]+)\\)");
    for (auto match =
             std::sregex_iterator(code.begin(), code.end(), assignment);
         match != std::sregex_iterator(); ++match) {
      values[(*match)[1]] = std::stod((*match)[2]);
    }
    if (values.at(kScore) < fail_below_score) return Failure("too low");
    const double noise = 1. - request["fidelity"].get<double>();
    return {{"ok", true},
            {"metrics",
             {{"relations",
               Error(values, request["input"]["name"].get<std::string>()) +
                   0.01 * noise}}},
            {"wall_seconds", 0.01},
            {"cpu_seconds", 1.}};
  }

  const int num_workers_;
  Random random_;
  std::vector<std::pair<int, nlohmann::json>> runs_;
};

std::vector<Parameter> Parameters() {
  std::vector<Parameter> parameters(3);
  parameters[0].key = kScore;
  parameters[0].low = 0.4;
  parameters[0].high = 0.9;
  parameters[1].key = kScale;
  parameters[1].low = 1.;
  parameters[1].high = 1e4;
  parameters[1].log_scale = true;
  parameters[2].key = kUnused;
  parameters[2].low = 100.;
  parameters[2].high = 1e4;
  return parameters;
}

std::vector<TuneInput> Inputs(const std::vector<std::string>& names) {
  std::vector<TuneInput> inputs;
  for (const std::string& name : names) {
    TuneInput input;
    input.name = name;
    input.recording = name;
    inputs.push_back(input);
  }
  return inputs;
}

struct Case {
  std::string method = "halving";
  int max_trials = 30;
  int workers = 1;
  uint64_t order = 1;
  int folds = 0;
  double budget_seconds = 0.;
  int hang_after = 0;
  double fail_below_score = 0.;
  bool no_input_worse = false;
  std::string journal;
  std::vector<std::string> inputs = {"a", "b"};
  std::vector<std::string> holdout = {"held out"};
  int* started = nullptr;
  int kills = 0;
};

absl::StatusOr<TuneResult> Tune(const Case& c) {
  const auto configuration =
      BaseConfiguration::Load({"configuration_files"}, "stock.lua");
  EXPECT_TRUE(configuration.ok());
  TunerOptions options;
  options.sampler.method = c.method;
  options.max_trials = c.max_trials;
  options.folds = c.folds;
  options.budget_seconds = c.budget_seconds;
  options.no_input_worse = c.no_input_worse;
  const auto journal = Journal::Open(c.journal, "f");
  if (!journal.ok()) return journal.status();
  FakePool pool(c.workers, c.order);
  pool.hang_after = c.hang_after;
  pool.fail_below_score = c.fail_below_score;
  pool.kills = c.kills;
  Tuner tuner({*configuration, Parameters(), Objective(), Inputs(c.inputs),
               Inputs(c.holdout)},
              options, &pool, journal->get());
  auto result = tuner.Run();
  if (c.started != nullptr) *c.started = pool.started;
  return result;
}

std::string Signature(const TuneResult& result) {
  std::string text;
  for (const Trial& trial : result.trials) {
    text += ToAssignment(Parameters(), trial.point).dump() +
            std::to_string(trial.fidelity) + std::to_string(trial.objective) +
            "\n";
  }
  return text + ToAssignment(Parameters(), result.best.point).dump();
}

TEST(TunerTest, FindsTheMinimumAndPrunesWhatGainsNothing) {
  const auto result = Tune({});
  ASSERT_TRUE(result.ok()) << result.status();
  EXPECT_EQ(result->trials.size(), 30u);
  // Stock is at 0.55 and 10.
  const double before = 1.5 * (0.1 + 0.0225 + 0.05);
  EXPECT_NEAR(result->baseline.objective, before, 1e-9);
  EXPECT_LT(result->best.objective, 0.75 * before);
  EXPECT_EQ(result->best.fidelity, 1.);
  ASSERT_TRUE(result->best_holdout.has_value());
  EXPECT_LT(result->best_holdout->objective,
            result->baseline_holdout->objective);
  for (const KeyResult& key : result->keys) {
    EXPECT_NE(key.key, kUnused);
    ASSERT_TRUE(key.gain.has_value());
    EXPECT_GT(*key.gain, 0.);
    EXPECT_EQ(key.better_on, 2);
  }
  EXPECT_FALSE(result->keys.empty());
  // The pruned point is what the keys say.
  EXPECT_EQ(result->best.point[2], result->baseline.point[2]);
}

TEST(TunerTest, WhatHeldOutRecordingsDenyIsNotTheResult) {
  Case c;
  c.holdout = {"c"};  // worse with a higher score
  const auto result = Tune(c);
  ASSERT_TRUE(result.ok()) << result.status();
  EXPECT_TRUE(result->keys.empty());
  EXPECT_EQ(result->best.objective, result->baseline.objective);
  EXPECT_THAT(result->not_confirmed, HasSubstr("held-out recordings change"));
  ASSERT_TRUE(result->best_holdout.has_value());
  EXPECT_GT(result->best_holdout->objective,
            result->baseline_holdout->objective);
}

TEST(TunerTest, NoRecordingNeedBeWorse) {
  Case c;
  c.inputs = {"a", "c"};
  const auto free = Tune(c);
  ASSERT_TRUE(free.ok()) << free.status();
  EXPECT_GT(free->best.point[0], 0.55);
  EXPECT_GT(free->best.objectives[1], free->baseline.objectives[1]);
  c.no_input_worse = true;
  const auto careful = Tune(c);
  ASSERT_TRUE(careful.ok()) << careful.status();
  EXPECT_LE(careful->best.point[0], 0.55);
  EXPECT_LT(careful->best.objectives[0], careful->baseline.objectives[0]);
  EXPECT_LE(careful->best.objectives[1], careful->baseline.objectives[1]);
}

TEST(TunerTest, TheNumberAndOrderOfWorkersDoNotMatter) {
  for (const std::string method :
       {"grid", "random", "halving", "nlopt_global", "nlopt_local"}) {
    Case c;
    c.method = method;
    c.max_trials = 25;
    const auto one = Tune(c);
    ASSERT_TRUE(one.ok()) << one.status();
    for (const int workers : {2, 5}) {
      for (const uint64_t order : {1, 2}) {
        c.workers = workers;
        c.order = order;
        const auto other = Tune(c);
        ASSERT_TRUE(other.ok());
        EXPECT_EQ(Signature(*one), Signature(*other)) << method << workers;
      }
    }
  }
}

TEST(TunerTest, GoesOnWhereAJournalStops) {
  const test::Folder folder;
  Case c;
  const auto whole = Tune(c);
  ASSERT_TRUE(whole.ok());
  c.journal = folder.path() + "/journal";
  int all = 0;
  c.started = &all;
  ASSERT_TRUE(Tune(c).ok());
  const std::string journal = folder.Read("journal");
  // Killed after any run: the rest is done, nothing twice, the same file.
  for (size_t size = journal.find('\n') + 1; size < journal.size();
       size += 999) {
    folder.Write("journal", journal.substr(0, size));
    const int known =
        static_cast<int>(
            std::count(journal.begin(),
                       journal.begin() + static_cast<ptrdiff_t>(size), '\n')) -
        1;
    int started = 0;
    c.started = &started;
    const auto result = Tune(c);
    ASSERT_TRUE(result.ok()) << result.status();
    EXPECT_EQ(started, all - known);
    EXPECT_EQ(Signature(*whole), Signature(*result));
    EXPECT_EQ(folder.Read("journal"), journal);
  }
}

TEST(TunerTest, ABudgetEndsTheSearch) {
  Case c;
  c.max_trials = 0;
  c.budget_seconds = 1.;
  c.hang_after = 20;  // the rest takes for ever, until it is stopped
  c.method = "random";
  c.workers = 2;
  const auto result = Tune(c);
  ASSERT_TRUE(result.ok()) << result.status();
  EXPECT_TRUE(result->ended_by_budget);
  // Two runs a trial, four of the baseline.
  EXPECT_GE(result->trials.size(), 6u);
  EXPECT_LE(result->trials.size(), 8u);
  EXPECT_TRUE(result->best_holdout.has_value());
}

TEST(TunerTest, SmallSpacesAreExhausted) {
  Case c;
  c.method = "grid";
  c.max_trials = 0;
  const auto result = Tune(c);
  ASSERT_TRUE(result.ok());
  EXPECT_EQ(result->trials.size(), 125u);
}

TEST(TunerTest, FailedTrialsAreNotTheEnd) {
  Case c;
  c.fail_below_score = 0.5;
  const auto result = Tune(c);
  ASSERT_TRUE(result.ok()) << result.status();
  int failed = 0;
  for (const Trial& trial : result->trials) failed += !trial.ok;
  EXPECT_GT(failed, 0);
  EXPECT_LT(result->best.objective, result->baseline.objective);
}

TEST(TunerTest, AConfigurationThatFailsAsItIsIsAnError) {
  Case c;
  c.fail_below_score = 0.6;
  EXPECT_THAT(std::string(Tune(c).status().message()),
              HasSubstr("the initial configuration fails: a: too low"));
}

TEST(TunerTest, RunsThatWereKilledAreTriedAgain) {
  Case c;
  const auto undisturbed = Tune(c);
  c.kills = 2;
  const auto result = Tune(c);
  ASSERT_TRUE(result.ok()) << result.status();
  EXPECT_EQ(Signature(*result), Signature(*undisturbed));
}

TEST(TunerTest, AKilledBaselineIsNotFailedForEver) {
  const test::Folder folder;
  Case c;
  c.journal = folder.path() + "/journal";
  c.kills = 30;
  EXPECT_THAT(std::string(Tune(c).status().message()), HasSubstr("killed"));
  c.kills = 0;
  const auto resumed = Tune(c);
  ASSERT_TRUE(resumed.ok()) << resumed.status();
  EXPECT_TRUE(resumed->baseline.ok);
}

TEST(TunerTest, FoldsLeaveEachRecordingOutOnce) {
  Case c;
  c.folds = 3;
  c.inputs = {"a1", "b1", "a2"};
  const auto result = Tune(c);
  ASSERT_TRUE(result.ok()) << result.status();
  ASSERT_EQ(result->folds.size(), 3u);
  std::multiset<std::string> held_out;
  for (const FoldResult& fold : result->folds) {
    EXPECT_LT(fold.after, fold.before);
    held_out.insert(fold.held_out.begin(), fold.held_out.end());
  }
  EXPECT_THAT(held_out, testing::UnorderedElementsAre("a1", "a2", "b1"));
}

}  // namespace
}  // namespace tuning
}  // namespace cartographer_ext
