// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
//
// Random numbers that are the same on every platform and library version: the
// engines of <random> are portable, its distributions are not, so the
// distributions are written out here on top of std::mt19937_64.
#ifndef CARTOGRAPHER_EXT_COMMON_RANDOM_H_
#define CARTOGRAPHER_EXT_COMMON_RANDOM_H_

#include <cmath>
#include <cstdint>
#include <random>

namespace cartographer_ext {

// A generator with its own state; the same seed gives the same numbers.
class Random {
 public:
  explicit Random(uint64_t seed) : engine_(seed) {}

  uint64_t NextBits() { return engine_(); }

  // Uniform in [0, 1) with 53 random bits.
  double Uniform() {
    return static_cast<double>(engine_() >> 11) * (1. / 9007199254740992.);
  }

  // Uniform in [low, high).
  double Uniform(double low, double high) {
    return low + (high - low) * Uniform();
  }

  // Uniform integer in [low, high], both included, without modulo bias.
  int64_t UniformInt(int64_t low, int64_t high) {
    const uint64_t range =
        static_cast<uint64_t>(high) - static_cast<uint64_t>(low) + 1;
    if (range == 0) return static_cast<int64_t>(engine_());
    const uint64_t limit = UINT64_MAX - UINT64_MAX % range;
    uint64_t bits = engine_();
    while (bits >= limit) bits = engine_();
    return static_cast<int64_t>(static_cast<uint64_t>(low) + bits % range);
  }

  // Normal by the polar method of Marsaglia (two values an iteration).
  double Normal() {
    if (has_spare_) {
      has_spare_ = false;
      return spare_;
    }
    double u, v, s;
    do {
      u = 2. * Uniform() - 1.;
      v = 2. * Uniform() - 1.;
      s = u * u + v * v;
    } while (s >= 1. || s == 0.);
    const double factor = std::sqrt(-2. * std::log(s) / s);
    spare_ = v * factor;
    has_spare_ = true;
    return u * factor;
  }

  double Normal(double mean, double sigma) { return mean + sigma * Normal(); }

 private:
  std::mt19937_64 engine_;
  bool has_spare_ = false;
  double spare_ = 0.;
};

}  // namespace cartographer_ext

#endif  // CARTOGRAPHER_EXT_COMMON_RANDOM_H_
