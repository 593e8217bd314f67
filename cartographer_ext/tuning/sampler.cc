// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
#include "cartographer_ext/tuning/sampler.h"

#include <algorithm>
#include <limits>

#include "absl/strings/str_cat.h"
#include "absl/strings/str_join.h"
#include "cartographer_ext/tuning/nlopt_sampler.h"

namespace cartographer_ext {
namespace tuning {
namespace {

constexpr size_t kReduction = 3;  // eta of successive halving

double OrInfinity(const absl::optional<double>& objective) {
  return objective.has_value() ? *objective
                               : std::numeric_limits<double>::infinity();
}

}  // namespace

GridSampler::GridSampler(const std::vector<Parameter>& parameters) {
  for (const Parameter& parameter : parameters) {
    axes_.push_back(parameter.GridValues());
    const int64_t count = static_cast<int64_t>(axes_.back().size());
    size_ = size_ > std::numeric_limits<int64_t>::max() / count
                ? std::numeric_limits<int64_t>::max()
                : size_ * count;
  }
  position_.assign(axes_.size(), 0);
}

absl::optional<TrialRequest> GridSampler::Ask() {
  if (done_) return absl::nullopt;
  TrialRequest request;
  for (size_t i = 0; i < axes_.size(); ++i) {
    request.point.push_back(axes_[i][position_[i]]);
  }
  done_ = true;
  for (size_t i = axes_.size(); i-- > 0;) {
    if (++position_[i] < axes_[i].size()) {
      done_ = false;
      break;
    }
    position_[i] = 0;
  }
  return request;
}

void GridSampler::Tell(size_t /*index*/, absl::optional<double> /*objective*/) {
}

RandomSampler::RandomSampler(const std::vector<Parameter>& parameters,
                             const uint64_t seed)
    : parameters_(parameters), random_(seed) {}

absl::optional<TrialRequest> RandomSampler::Ask() {
  TrialRequest request;
  for (const Parameter& parameter : parameters_) {
    request.point.push_back(parameter.FromUnit(random_.Uniform()));
  }
  return request;
}

void RandomSampler::Tell(size_t /*index*/,
                         absl::optional<double> /*objective*/) {}

HalvingSampler::HalvingSampler(const std::vector<Parameter>& parameters,
                               const uint64_t seed, const double min_fidelity)
    : draws_(parameters, seed) {
  // At most six rungs.
  for (double fidelity = 1.; fidelities_.empty() || (fidelity >= min_fidelity &&
                                                     fidelities_.size() < 6);
       fidelity /= kReduction) {
    fidelities_.insert(fidelities_.begin(), fidelity);
  }
  StartBracket();
}

void HalvingSampler::StartBracket() {
  rung_ = 0;
  first_index_ = num_asked_;
  results_.clear();
  points_.clear();
  size_t count = 1;
  for (size_t i = 0; i < fidelities_.size(); ++i) count *= kReduction;
  while (points_.size() < count) points_.push_back(draws_.Ask()->point);
}

void HalvingSampler::Promote() {
  if (rung_ + 1 == fidelities_.size()) {
    StartBracket();
    return;
  }
  std::vector<size_t> order(points_.size());
  for (size_t i = 0; i < order.size(); ++i) order[i] = i;
  std::stable_sort(order.begin(), order.end(), [this](size_t a, size_t b) {
    return OrInfinity(results_[first_index_ + a]) <
           OrInfinity(results_[first_index_ + b]);
  });
  std::vector<Point> promoted;
  for (size_t i = 0; i < order.size() / kReduction; ++i) {
    if (!results_[first_index_ + order[i]].has_value()) break;
    promoted.push_back(points_[order[i]]);
  }
  if (promoted.empty()) {
    StartBracket();
    return;
  }
  ++rung_;
  first_index_ = num_asked_;
  results_.clear();
  points_ = std::move(promoted);
}

absl::optional<TrialRequest> HalvingSampler::Ask() {
  if (num_asked_ - first_index_ == points_.size()) {
    if (results_.size() < points_.size()) return absl::nullopt;
    Promote();
  }
  TrialRequest request;
  request.point = points_[num_asked_ - first_index_];
  request.fidelity = fidelities_[rung_];
  ++num_asked_;
  return request;
}

void HalvingSampler::Tell(const size_t index,
                          const absl::optional<double> objective) {
  if (index >= first_index_) results_[index] = objective;
}

std::vector<std::string> MethodNames() {
  std::vector<std::string> names = {"grid", "random", "halving"};
  for (const std::string& name : NloptMethodNames()) names.push_back(name);
  return names;
}

absl::StatusOr<std::unique_ptr<Sampler>> CreateSampler(
    const std::vector<Parameter>& parameters, const SamplerOptions& options) {
  if (options.method == "grid") {
    return std::unique_ptr<Sampler>(new GridSampler(parameters));
  }
  if (options.method == "random") {
    return std::unique_ptr<Sampler>(
        new RandomSampler(parameters, options.seed));
  }
  if (options.method == "halving") {
    return std::unique_ptr<Sampler>(
        new HalvingSampler(parameters, options.seed, options.min_fidelity));
  }
  for (const std::string& name : NloptMethodNames()) {
    if (options.method == name) {
      return std::unique_ptr<Sampler>(new NloptSampler(
          parameters, options.method, options.seed, options.start));
    }
  }
  return absl::InvalidArgumentError(
      absl::StrCat("unknown method '", options.method, "', known are ",
                   absl::StrJoin(MethodNames(), ", ")));
}

}  // namespace tuning
}  // namespace cartographer_ext
