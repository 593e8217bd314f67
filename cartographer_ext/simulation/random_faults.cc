// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
#include "cartographer_ext/simulation/random_faults.h"

#include <cmath>

#include "absl/strings/numbers.h"
#include "absl/strings/str_cat.h"
#include "absl/strings/str_split.h"
#include "cartographer_ext/simulation/seeds.h"
#include "cartographer_ext/simulation/sensors/odometry_model.h"

namespace cartographer_ext {
namespace simulation {
namespace {

using Kind = OdometryFault::Kind;

constexpr double kApart = 10.;        // seconds between two random faults
constexpr double kMinSpeed = 0.15;    // a stale burst shows only while driving
constexpr double kMinTurnRate = 0.3;  // rad/s; a stall shows while turning, too
constexpr int kMaxAttempts = 1000;
constexpr int kMaxCount = 1000;

bool Drives(const MotionState& state) {
  return std::abs(state.speed) >= kMinSpeed;
}

bool Moves(const MotionState& state) {
  return Drives(state) || std::abs(state.turn_rate) >= kMinTurnRate;
}

// A time at which the robot is in motion, and a second later, away from the times
// already taken; negative when the drive has no room left.
double FreeTime(const Drive& drive, const std::vector<double>& taken,
                bool (*is_in_motion)(const MotionState&), Random* random) {
  for (int attempt = 0; attempt != kMaxAttempts; ++attempt) {
    const double time = random->Uniform(kApart, drive.duration() - kApart);
    if (time < kApart || !is_in_motion(drive.At(time)) ||
        !is_in_motion(drive.At(time + 1.))) {
      continue;
    }
    bool is_free = true;
    for (const double other : taken) {
      is_free = is_free && std::abs(other - time) >= kApart;
    }
    if (is_free) return time;
  }
  return -1.;
}

void Randomise(OdometryFault* fault, Random* random) {
  switch (fault->kind) {
    case Kind::kStale:
      fault->duration = random->Uniform(0.3, 1.);
      break;
    case Kind::kJump:
      fault->distance = random->Uniform(0.5, 1.);
      if (random->Uniform() < 0.5) fault->distance = -fault->distance;
      fault->angle = random->Uniform(-20., 20.) * kPi / 180.;
      break;
    case Kind::kSlip:
      fault->duration = random->Uniform(1., 3.);
      fault->gain_left = random->Uniform(0.3, 1.);
      fault->gain_right = random->Uniform(0.3, 1.);
      break;
    case Kind::kReverse:
    case Kind::kOffset:
      break;
  }
}

// As often as asked for, without times.
absl::StatusOr<std::vector<OdometryFault>> Parse(
    const std::string& description) {
  std::vector<OdometryFault> faults;
  for (const absl::string_view item :
       absl::StrSplit(description, ',', absl::SkipEmpty())) {
    const std::vector<std::string> parts = absl::StrSplit(item, ':');
    OdometryFault fault;
    bool known = false;
    for (const Kind kind : {Kind::kSlip, Kind::kStale, Kind::kJump,
                            Kind::kReverse, Kind::kOffset}) {
      if (parts[0] != FaultName(kind)) continue;
      fault.kind = kind;
      known = true;
    }
    double value = 1.;
    const bool numeric =
        parts.size() == 1 ||
        (parts.size() == 2 && absl::SimpleAtod(parts[1], &value) &&
         std::isfinite(value));
    if (!known || !numeric) {
      return absl::InvalidArgumentError(absl::StrCat(
          "odometry fault '", item,
          "': expected slip:N, stale:N, jump:N, reverse or offset:SECONDS"));
    }
    if (fault.kind == Kind::kReverse || fault.kind == Kind::kOffset) {
      fault.seconds = value;
      if (std::abs(value) > 10.) {
        return absl::InvalidArgumentError(absl::StrCat(
            "odometry fault '", item, "': seconds outside [-10, 10]"));
      }
      faults.push_back(fault);
      continue;
    }
    if (value < 0. || value > kMaxCount || value != std::floor(value)) {
      return absl::InvalidArgumentError(
          absl::StrCat("odometry fault '", item,
                       "': the count must be whole, in [0, ", kMaxCount, "]"));
    }
    faults.insert(faults.end(), static_cast<size_t>(value), fault);
  }
  return faults;
}

}  // namespace

absl::Status CheckRandomFaults(const std::string& description) {
  return Parse(description).status();
}

absl::StatusOr<std::vector<OdometryFault>> RandomFaults(
    const std::string& description, const Drive& drive, const uint64_t seed) {
  auto faults = Parse(description);
  if (!faults.ok()) return faults.status();
  std::vector<double> taken;
  Random random = MakeRandom(seed, RandomStream::kFaults);
  for (OdometryFault& fault : *faults) {
    if (fault.kind == Kind::kReverse || fault.kind == Kind::kOffset) continue;
    fault.start = FreeTime(drive, taken, Drives, &random);
    if (fault.start < 0.) {
      return absl::InvalidArgumentError(
          absl::StrCat("odometry faults '", description, "': a drive of ",
                       drive.duration(), " s is too short for so many"));
    }
    taken.push_back(fault.start);
    Randomise(&fault, &random);
  }
  return faults;
}

absl::StatusOr<std::vector<ScanStall>> RandomStalls(const int count,
                                                    const Drive& drive,
                                                    const uint64_t seed) {
  if (count < 0 || count > kMaxCount) {
    return absl::InvalidArgumentError(
        absl::StrCat("the number of stalls must be in [0, ", kMaxCount, "]"));
  }
  std::vector<ScanStall> stalls;
  std::vector<double> taken;
  Random random = MakeRandom(seed, RandomStream::kStalls);
  for (int i = 0; i != count; ++i) {
    const double start = FreeTime(drive, taken, Moves, &random);
    if (start < 0.) {
      return absl::InvalidArgumentError(
          absl::StrCat("a drive of ", drive.duration(),
                       " s is too short for so many stalls: ", count));
    }
    taken.push_back(start);
    stalls.push_back({start, random.Uniform(0.4, 1.)});
  }
  return stalls;
}

}  // namespace simulation
}  // namespace cartographer_ext
