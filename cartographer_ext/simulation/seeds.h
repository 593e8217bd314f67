// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
//
// One seed, many independent streams of random numbers: what one sensor draws
// never shifts what another one gets, so that a world without dropouts, say,
// keeps the very same odometry.
#ifndef CARTOGRAPHER_EXT_SIMULATION_SEEDS_H_
#define CARTOGRAPHER_EXT_SIMULATION_SEEDS_H_

#include <cstdint>

#include "cartographer_ext/common/random.h"

namespace cartographer_ext {
namespace simulation {

enum class RandomStream : uint64_t {
  kDrive = 1,
  kLaser,
  kOdometryScales,
  kOdometryNoise,
  kImu,
  kObstacles,
  kFaults,
  kBuilding,
  kOdometryLateral,
  kStalls,
};

// The finaliser of SplitMix64 (Steele, Lea and Flood 2014) spreads neighbouring
// seeds and streams over all 64 bits.
inline uint64_t MixBits(uint64_t bits) {
  bits += 0x9E3779B97F4A7C15ull;
  bits = (bits ^ (bits >> 30)) * 0xBF58476D1CE4E5B9ull;
  bits = (bits ^ (bits >> 27)) * 0x94D049BB133111EBull;
  return bits ^ (bits >> 31);
}

inline Random MakeRandom(const uint64_t seed, const RandomStream stream) {
  return Random(MixBits(MixBits(seed) ^ static_cast<uint64_t>(stream)));
}

}  // namespace simulation
}  // namespace cartographer_ext

#endif  // CARTOGRAPHER_EXT_SIMULATION_SEEDS_H_
