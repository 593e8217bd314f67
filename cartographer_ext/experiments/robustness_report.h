// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
//
// Results of a sweep: medians over seeds as a table, as JSON and as a plot.
#ifndef CARTOGRAPHER_EXT_EXPERIMENTS_ROBUSTNESS_REPORT_H_
#define CARTOGRAPHER_EXT_EXPERIMENTS_ROBUSTNESS_REPORT_H_

#include <string>
#include <vector>

#include "absl/status/status.h"
#include "cartographer_ext/experiments/paper_tables.h"
#include "cartographer_ext/experiments/robustness_sweep.h"
#include "nlohmann/json.hpp"

namespace cartographer_ext {
namespace experiments {

// Runs that differ in their seed only; medians unless stated otherwise.
struct SweepCell {
  std::string dataset, kernel, type;
  int count = 0;
  int runs = 0;
  double cpu_seconds = 0., ate = 0., ate_largest = 0., ate_truth = -1.;
  double rpe = 0., precision = 0., recall = 0., truncated = 0.;
  double step_mean = 0., step_p99 = 0., step_max = 0.;  // ms; max: largest
  double success_rate = 0.;
  int same_by_data = 0;  // successes beyond the limit of the ATE
  int unfinished = 0;    // runs that a limit of time or iterations ended
  int undecidable = 0;   // failed runs in which the data favour a wrong map
};

// Number of outliers from which no estimator can find the right map. An upper
// bound: a search that finds more wrong maps with a lower cost than the right
// one lowers it.
struct SweepLimit {
  std::string dataset, type;
  // Smallest share of outliers among all loops at which the data of some run
  // favour a wrong map, and its mean number of outliers; 2 and 0 for none.
  double undecidable_from = 2.;
  int count = 0;
  double largest_share = 0.;  // that was tried
};

// The runs of one kernel against the limits of their sets and types.
struct LimitScore {
  std::string kernel;
  int runs = 0, successes = 0;
  int undecidable = 0;
  int missed = 0;  // the right map would have cost less
  // Runs with less than kBelowLimit of the outliers from which on no estimator
  // can decide.
  int below = 0, below_successes = 0;
  double below_precision = 1.;  // mean
};

constexpr double kBelowLimit = 0.9;

// In order of first appearance.
std::vector<SweepCell> Summarize(const std::vector<SweepRun>& runs);

std::vector<SweepLimit> FindLimits(const std::vector<SweepRun>& runs);

// In order of first appearance of the kernels.
std::vector<LimitScore> ScoreByLimits(const std::vector<SweepRun>& runs);

// Each limit that was met, then a line for each kernel.
std::string LimitTable(const std::vector<SweepRun>& runs);

std::string SweepTable(const std::vector<SweepCell>& cells);

// Our times beside the printed ones, one line per printed row that was run: SC,
// the method, and SC over the method, ours and theirs. SC's time is a lower
// bound (>) where a limit ended at least half of its runs.
std::string PrintedComparison(const std::vector<SweepCell>& cells,
                              const std::vector<PrintedRow>& printed,
                              const std::string& method);

// "runs" (every run), "cells" (Summarize), "limits" (FindLimits) and
// "by_limits" (ScoreByLimits).
nlohmann::ordered_json SweepJson(const std::vector<SweepRun>& runs);

// Median ATE over the number of outliers, one panel per data set and type, one
// line per kernel, both axes logarithmic, with a vertical line at the limit.
absl::Status WriteSweepPlot(const std::vector<SweepCell>& cells,
                            const std::vector<SweepLimit>& limits,
                            const std::string& filename);

}  // namespace experiments
}  // namespace cartographer_ext

#endif  // CARTOGRAPHER_EXT_EXPERIMENTS_ROBUSTNESS_REPORT_H_
