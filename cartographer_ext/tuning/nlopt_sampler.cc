// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
#include "cartographer_ext/tuning/nlopt_sampler.h"

#include <nlopt.h>

#include <algorithm>

#include "glog/logging.h"

namespace cartographer_ext {
namespace tuning {
namespace {

struct Method {
  const char* name;
  nlopt_algorithm algorithm;
  bool is_local;
};

// Only algorithms of the MIT licensed parts of NLopt.
constexpr Method kMethods[] = {
    {"nlopt_global", NLOPT_GN_DIRECT_L, false},
    {"nlopt_local", NLOPT_LN_SBPLX, true},
    {"nlopt_direct_l", NLOPT_GN_DIRECT_L, false},
    {"nlopt_crs2_lm", NLOPT_GN_CRS2_LM, false},
    {"nlopt_isres", NLOPT_GN_ISRES, false},
    {"nlopt_esch", NLOPT_GN_ESCH, false},
    {"nlopt_sbplx", NLOPT_LN_SBPLX, true},
    {"nlopt_neldermead", NLOPT_LN_NELDERMEAD, true},
    {"nlopt_bobyqa", NLOPT_LN_BOBYQA, true},
    {"nlopt_cobyla", NLOPT_LN_COBYLA, true},
};

constexpr double kFirstFailure = 1e6;
constexpr double kLocalStep = 0.2;        // of the unit interval
constexpr double kLocalTolerance = 0.01;  // of the unit interval

const Method* FindMethod(const std::string& name) {
  for (const Method& method : kMethods) {
    if (name == method.name) return &method;
  }
  return nullptr;
}

}  // namespace

std::vector<std::string> NloptMethodNames() {
  std::vector<std::string> names;
  for (const Method& method : kMethods) names.push_back(method.name);
  return names;
}

struct NloptSampler::Replay {
  const std::vector<double>* told;
  nlopt_opt optimizer;
  size_t calls = 0;
  bool stopped = false;
  std::vector<double> next;
};

NloptSampler::NloptSampler(const std::vector<Parameter>& parameters,
                           const std::string& method, const uint64_t seed,
                           const Point& start)
    : parameters_(parameters), method_(method), seed_(seed) {
  done_ = FindMethod(method) == nullptr;
  for (size_t i = 0; i < parameters_.size(); ++i) {
    start_.push_back(start.size() == parameters_.size()
                         ? parameters_[i].ToUnit(start[i])
                         : 0.5);
  }
}

double NloptSampler::Objective(const unsigned n, const double* const x,
                               double* /*gradient*/, void* const data) {
  Replay* const replay = static_cast<Replay*>(data);
  if (replay->calls < replay->told->size()) {
    return (*replay->told)[replay->calls++];
  }
  if (!replay->stopped) {
    replay->stopped = true;
    replay->next.assign(x, x + n);
    nlopt_force_stop(replay->optimizer);
  }
  return kFirstFailure;
}

absl::optional<std::vector<double>> NloptSampler::NextUnitPoint() {
  const Method* const method = FindMethod(method_);
  const unsigned n = static_cast<unsigned>(parameters_.size());
  nlopt_srand(static_cast<unsigned long>(seed_));  // NOLINT
  Replay replay;
  replay.told = &told_;
  replay.optimizer = nlopt_create(method->algorithm, n);
  CHECK(replay.optimizer != nullptr);
  nlopt_set_lower_bounds1(replay.optimizer, 0.);
  nlopt_set_upper_bounds1(replay.optimizer, 1.);
  nlopt_set_min_objective(replay.optimizer, &NloptSampler::Objective, &replay);
  if (method->is_local) {
    nlopt_set_initial_step1(replay.optimizer, kLocalStep);
    nlopt_set_xtol_abs1(replay.optimizer, kLocalTolerance);
  }
  std::vector<double> x = start_;
  double minimum = 0.;
  nlopt_optimize(replay.optimizer, x.data(), &minimum);
  nlopt_destroy(replay.optimizer);
  if (!replay.stopped) return absl::nullopt;
  return replay.next;
}

absl::optional<TrialRequest> NloptSampler::Ask() {
  if (done_ || num_asked_ > told_.size()) return absl::nullopt;
  const auto unit_point = NextUnitPoint();
  if (!unit_point.has_value()) {
    done_ = true;
    return absl::nullopt;
  }
  TrialRequest request;
  for (size_t i = 0; i < parameters_.size(); ++i) {
    request.point.push_back(parameters_[i].FromUnit((*unit_point)[i]));
  }
  ++num_asked_;
  return request;
}

void NloptSampler::Tell(const size_t index,
                        const absl::optional<double> objective) {
  CHECK_EQ(index, told_.size())
      << "results must be reported in the order of the requests";
  if (objective.has_value()) {
    told_.push_back(*objective);
    return;
  }
  if (told_.empty()) {
    told_.push_back(kFirstFailure);
    return;
  }
  const auto range = std::minmax_element(told_.begin(), told_.end());
  told_.push_back(*range.second + (*range.second - *range.first));
}

}  // namespace tuning
}  // namespace cartographer_ext
