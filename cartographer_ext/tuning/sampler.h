// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
//
// Chooses the configurations to try. A sampler is asked for trials and told
// their objectives (ask-and-tell interface). Its requests depend on its seed
// and on these objectives, but not on the time of their arrival: any number of
// workers gives the same list of trials.
//
// * Grid: all combinations of GridValues, the last parameter fastest.
// * Random: independent draws, uniform in the unit cube.
// * Successive halving (Jamieson and Talwalkar, AISTATS 2016), bracket after
//   bracket: many draws are tried on the first part of each recording, the best
//   third of them on a three times longer part, and so on up to the whole. Bad
//   draws are abandoned early.
// * NLopt, see nlopt_sampler.h.
#ifndef CARTOGRAPHER_EXT_TUNING_SAMPLER_H_
#define CARTOGRAPHER_EXT_TUNING_SAMPLER_H_

#include <cstdint>
#include <map>
#include <memory>
#include <string>
#include <vector>

#include "absl/status/statusor.h"
#include "absl/types/optional.h"
#include "cartographer_ext/common/random.h"
#include "cartographer_ext/tuning/parameter_space.h"

namespace cartographer_ext {
namespace tuning {

struct TrialRequest {
  Point point;
  // Share of each recording that is run, in (0, 1].
  double fidelity = 1.;
};

class Sampler {
 public:
  virtual ~Sampler() = default;

  // The next trial. Empty while results are needed first, or at the end.
  virtual absl::optional<TrialRequest> Ask() = 0;

  // Adds the result of trial `index` (from 0, in the order of the requests):
  // the objective, smaller is better, or nothing if it failed.
  virtual void Tell(size_t index, absl::optional<double> objective) = 0;

  // Whether there are no more trials.
  virtual bool Done() const = 0;
};

class GridSampler : public Sampler {
 public:
  explicit GridSampler(const std::vector<Parameter>& parameters);

  absl::optional<TrialRequest> Ask() override;
  void Tell(size_t index, absl::optional<double> objective) override;
  bool Done() const override { return done_; }

  // Number of points of the grid; saturates.
  int64_t size() const { return size_; }

 private:
  std::vector<std::vector<Value>> axes_;
  std::vector<size_t> position_;
  int64_t size_ = 1;
  bool done_ = false;
};

// Never done.
class RandomSampler : public Sampler {
 public:
  RandomSampler(const std::vector<Parameter>& parameters, uint64_t seed);

  absl::optional<TrialRequest> Ask() override;
  void Tell(size_t index, absl::optional<double> objective) override;
  bool Done() const override { return false; }

 private:
  const std::vector<Parameter> parameters_;
  Random random_;
};

// Never done.
class HalvingSampler : public Sampler {
 public:
  // The parts are 1, 1/3, 1/9, ... down to at least `min_fidelity`. A bracket
  // starts with 3^(number of parts) draws.
  HalvingSampler(const std::vector<Parameter>& parameters, uint64_t seed,
                 double min_fidelity);

  absl::optional<TrialRequest> Ask() override;
  void Tell(size_t index, absl::optional<double> objective) override;
  bool Done() const override { return false; }

 private:
  void StartBracket();
  void Promote();

  RandomSampler draws_;
  std::vector<double> fidelities_;  // ascending, the last is 1
  size_t num_asked_ = 0;            // of all brackets
  // The current rung.
  size_t rung_ = 0;
  size_t first_index_ = 0;  // of its first trial
  std::vector<Point> points_;
  std::map<size_t, absl::optional<double>> results_;  // by index
};

struct SamplerOptions {
  // grid, random, halving, nlopt_global, nlopt_local, or an algorithm by its
  // own name (nlopt_crs2_lm, nlopt_sbplx, ...; see nlopt_sampler.h).
  std::string method = "halving";
  uint64_t seed = 1;
  double min_fidelity = 0.3;
  // Where local methods start: the values of the configuration.
  Point start;
};

// Names for messages.
std::vector<std::string> MethodNames();

absl::StatusOr<std::unique_ptr<Sampler>> CreateSampler(
    const std::vector<Parameter>& parameters, const SamplerOptions& options);

}  // namespace tuning
}  // namespace cartographer_ext

#endif  // CARTOGRAPHER_EXT_TUNING_SAMPLER_H_
