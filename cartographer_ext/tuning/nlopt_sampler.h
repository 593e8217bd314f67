// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
//
// The derivative-free optimisers of NLopt as a sampler. NLopt calls the
// objective and waits, whereas a sampler is asked for points and told results.
// As the algorithms are deterministic, each request restarts the algorithm and
// replays the objectives known so far; the first point beyond them is the next
// request. The replay takes microseconds, a trial minutes.
//
// A failed trial counts as twice as far from the best as the worst one. The
// sampler is done when the algorithm terminates.
#ifndef CARTOGRAPHER_EXT_TUNING_NLOPT_SAMPLER_H_
#define CARTOGRAPHER_EXT_TUNING_NLOPT_SAMPLER_H_

#include <cstdint>
#include <string>
#include <vector>

#include "cartographer_ext/tuning/sampler.h"

namespace cartographer_ext {
namespace tuning {

// nlopt_global and nlopt_local are DIRECT-L and Sbplx.
std::vector<std::string> NloptMethodNames();

class NloptSampler : public Sampler {
 public:
  // `method` is one of NloptMethodNames, otherwise the sampler is done at once.
  // Local algorithms start at `start`, or in the middle when it is empty.
  NloptSampler(const std::vector<Parameter>& parameters,
               const std::string& method, uint64_t seed, const Point& start);

  // One trial at a time: empty until the last result is known.
  absl::optional<TrialRequest> Ask() override;
  void Tell(size_t index, absl::optional<double> objective) override;
  bool Done() const override { return done_; }

 private:
  struct Replay;

  // Runs the algorithm up to the first unknown point.
  absl::optional<std::vector<double>> NextUnitPoint();
  static double Objective(unsigned n, const double* x, double* gradient,
                          void* replay);

  const std::vector<Parameter> parameters_;
  const std::string method_;
  const uint64_t seed_;
  std::vector<double> start_;  // in the unit cube
  size_t num_asked_ = 0;
  std::vector<double> told_;
  bool done_ = false;
};

}  // namespace tuning
}  // namespace cartographer_ext

#endif  // CARTOGRAPHER_EXT_TUNING_NLOPT_SAMPLER_H_
