// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
#include "cartographer/common/fixed_ratio_sampler.h"

#include "absl/strings/str_format.h"
#include "glog/logging.h"

namespace cartographer {
namespace common {

FixedRatioSampler::FixedRatioSampler(const double ratio) : ratio_(ratio) {
  CHECK_GE(ratio, 0.);
  CHECK_LE(ratio, 1.);
}

bool FixedRatioSampler::Pulse() {
  ++num_pulses_;
  const bool sample =
      static_cast<double>(num_samples_) / static_cast<double>(num_pulses_) <
      ratio_;
  if (sample) ++num_samples_;
  return sample;
}

std::string FixedRatioSampler::DebugString() const {
  const double percent =
      num_pulses_ == 0 ? 0. : 100. * num_samples_ / num_pulses_;
  return absl::StrFormat("%d (%.2f%%)", num_samples_, percent);
}

}  // namespace common
}  // namespace cartographer
