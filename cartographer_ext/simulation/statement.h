// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
//
// One line of a world file: a keyword, plain values, and `key=value` options.
//
//   circle 3 4 0.5 reflectivity=0.3      # comment
//
// Values are read through checked accessors that store the first error, so the
// reader of a statement is a list of its fields; `Finish` then reports the
// error (file, line, key, value, allowed range), or unused values.
#ifndef CARTOGRAPHER_EXT_SIMULATION_STATEMENT_H_
#define CARTOGRAPHER_EXT_SIMULATION_STATEMENT_H_

#include <cstddef>
#include <string>
#include <utility>
#include <vector>

#include "Eigen/Core"
#include "absl/status/status.h"
#include "absl/strings/string_view.h"

namespace cartographer_ext {
namespace simulation {

class Statement {
 public:
  // `where` is "file:line". An empty or comment-only line has no keyword.
  Statement(absl::string_view line, std::string where);

  const std::string& keyword() const { return keyword_; }
  const std::string& where() const { return where_; }

  // Plain values in order. Missing or malformed ones give 0 and an error.
  double Number(absl::string_view what, double min, double max);
  std::string Word(absl::string_view what);
  Eigen::Vector2d Point(absl::string_view what);
  // All remaining values as points; at least `min_count` of them.
  std::vector<Eigen::Vector2d> Points(size_t min_count);
  bool has_values() const { return next_value_ < values_.size(); }

  // Options; `fallback` when absent.
  bool Has(absl::string_view key) const;
  double Option(absl::string_view key, double fallback, double min, double max);
  std::string WordOption(absl::string_view key, absl::string_view fallback);
  // Every occurrence of a key, as comma separated numbers.
  std::vector<std::vector<double>> ListOptions(absl::string_view key,
                                               size_t count, double limit);

  // Stores an error found by the caller; the first one is kept.
  void Fail(absl::string_view message);
  absl::Status Finish();

 private:
  struct KeyValue {
    std::string key;
    std::string value;
    bool used = false;
  };

  bool Parse(absl::string_view text, absl::string_view what, double min,
             double max, double* number);

  std::string where_;
  std::string keyword_;
  std::vector<std::string> values_;
  size_t next_value_ = 0;
  std::vector<KeyValue> options_;
  std::vector<std::string> known_options_;  // those asked for
  absl::Status status_;
};

// Larger coordinates are typing errors, and would overflow the grids.
constexpr double kMaxCoordinate = 1e4;

}  // namespace simulation
}  // namespace cartographer_ext

#endif  // CARTOGRAPHER_EXT_SIMULATION_STATEMENT_H_
