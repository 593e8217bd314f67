// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
//
// Probabilities, odds and their 16-bit encoding in grid cells.
//
// A cell holds 0 for "unknown", or v in [1, 32767] for the correspondence cost
//   cost(v) = 0.1 + (v - 1) * 0.8 / 32766,      probability = 1 - cost.
// While range data is being inserted, bit 15 marks the cells already touched.
#ifndef CARTOGRAPHER_MAPPING_PROBABILITY_VALUES_H_
#define CARTOGRAPHER_MAPPING_PROBABILITY_VALUES_H_

#include <vector>

#include "cartographer/common/math.h"
#include "cartographer/common/port.h"

namespace cartographer {
namespace mapping {

constexpr float kMinProbability = 0.1f;
constexpr float kMaxProbability = 1.f - kMinProbability;
constexpr float kMinCorrespondenceCost = 1.f - kMaxProbability;
constexpr float kMaxCorrespondenceCost = 1.f - kMinProbability;

constexpr uint16 kUnknownProbabilityValue = 0;
constexpr uint16 kUnknownCorrespondenceValue = 0;
constexpr uint16 kUpdateMarker = 0x8000;

inline float Odds(const float probability) {
  return probability / (1.f - probability);
}

inline float ProbabilityFromOdds(const float odds) {
  return odds / (odds + 1.f);
}

inline float ProbabilityToCorrespondenceCost(const float probability) {
  return 1.f - probability;
}

inline float CorrespondenceCostToProbability(const float correspondence_cost) {
  return 1.f - correspondence_cost;
}

inline float ClampProbability(const float probability) {
  return common::Clamp(probability, kMinProbability, kMaxProbability);
}

inline float ClampCorrespondenceCost(const float correspondence_cost) {
  return common::Clamp(correspondence_cost, kMinCorrespondenceCost,
                       kMaxCorrespondenceCost);
}

namespace internal {

// Linear map of [lower, upper] onto {1, ..., 32767}; values outside are
// clamped.
inline uint16 EncodeBounded(const float value, const float lower,
                            const float upper) {
  const float above_lower = common::Clamp(value, lower, upper) - lower;
  return static_cast<uint16>(
      1 + common::RoundToInt(above_lower * (32766.f / (upper - lower))));
}

// The inverse, for every 16-bit value; the update marker makes no difference.
// Unknown (0) reads as `unknown_result`.
std::vector<float> DecodingTable(float unknown_result, float lower,
                                 float upper);

}  // namespace internal

inline uint16 CorrespondenceCostToValue(const float correspondence_cost) {
  return internal::EncodeBounded(correspondence_cost, kMinCorrespondenceCost,
                                 kMaxCorrespondenceCost);
}

inline uint16 ProbabilityToValue(const float probability) {
  return internal::EncodeBounded(probability, kMinProbability, kMaxProbability);
}

// Indexed by value, with or without the update marker. Unknown reads as the
// lowest probability, that is the highest cost.
extern const std::vector<float>* const kValueToProbability;
extern const std::vector<float>* const kValueToCorrespondenceCost;

inline float ValueToProbability(const uint16 value) {
  return (*kValueToProbability)[value];
}

inline float ValueToCorrespondenceCost(const uint16 value) {
  return (*kValueToCorrespondenceCost)[value];
}

// Both keep the update marker and "unknown".
uint16 ProbabilityValueToCorrespondenceCostValue(uint16 probability_value);
uint16 CorrespondenceCostValueToProbabilityValue(
    uint16 correspondence_cost_value);

// Tables of 32768 entries: entry v is the value, update marker set, of a cell
// that held v after multiplying its odds by `odds`. An unknown cell takes the
// probability of `odds`.
std::vector<uint16> ComputeLookupTableToApplyOdds(float odds);
std::vector<uint16> ComputeLookupTableToApplyCorrespondenceCostOdds(float odds);

}  // namespace mapping
}  // namespace cartographer

#endif  // CARTOGRAPHER_MAPPING_PROBABILITY_VALUES_H_
