// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
#include "cartographer/mapping/probability_values.h"

namespace cartographer {
namespace mapping {
namespace {

// Leaked on purpose: readable from other static objects until the very end.
const std::vector<float>* NewProbabilityTable() {
  return new std::vector<float>(internal::DecodingTable(
      kMinProbability, kMinProbability, kMaxProbability));
}

const std::vector<float>* NewCorrespondenceCostTable() {
  return new std::vector<float>(internal::DecodingTable(
      kMaxCorrespondenceCost, kMinCorrespondenceCost, kMaxCorrespondenceCost));
}

// Applies `convert` to a known value, leaving marker and "unknown" as they are.
template <typename Converter>
uint16 ConvertKnownValue(const uint16 value, const Converter& convert) {
  const uint16 marker = value & kUpdateMarker;
  const uint16 plain = value & static_cast<uint16>(~kUpdateMarker);
  // A bare marker has always been passed on as it is.
  return plain == 0 ? value : static_cast<uint16>(convert(plain) | marker);
}

}  // namespace

namespace internal {

std::vector<float> DecodingTable(const float unknown_result, const float lower,
                                 const float upper) {
  constexpr int kHalf = 32768;
  const float step = (upper - lower) / 32766.f;
  std::vector<float> table(2 * kHalf);
  for (int value = 0; value != kHalf; ++value) {
    const float decoded =
        value == 0 ? unknown_result : value * step + (lower - step);
    table[value] = decoded;
    table[value + kHalf] = decoded;
  }
  return table;
}

}  // namespace internal

const std::vector<float>* const kValueToProbability = NewProbabilityTable();
const std::vector<float>* const kValueToCorrespondenceCost =
    NewCorrespondenceCostTable();

uint16 ProbabilityValueToCorrespondenceCostValue(
    const uint16 probability_value) {
  return ConvertKnownValue(probability_value, [](const uint16 value) {
    return CorrespondenceCostToValue(
        ProbabilityToCorrespondenceCost(ValueToProbability(value)));
  });
}

uint16 CorrespondenceCostValueToProbabilityValue(
    const uint16 correspondence_cost_value) {
  return ConvertKnownValue(correspondence_cost_value, [](const uint16 value) {
    return ProbabilityToValue(
        CorrespondenceCostToProbability(ValueToCorrespondenceCost(value)));
  });
}

std::vector<uint16> ComputeLookupTableToApplyOdds(const float odds) {
  std::vector<uint16> table(kUpdateMarker);
  for (int value = 0; value != kUpdateMarker; ++value) {
    const float new_odds =
        value == kUnknownProbabilityValue
            ? odds
            : odds * Odds(ValueToProbability(static_cast<uint16>(value)));
    table[value] =
        kUpdateMarker | ProbabilityToValue(ProbabilityFromOdds(new_odds));
  }
  return table;
}

std::vector<uint16> ComputeLookupTableToApplyCorrespondenceCostOdds(
    const float odds) {
  std::vector<uint16> table(kUpdateMarker);
  for (int value = 0; value != kUpdateMarker; ++value) {
    const float new_odds =
        value == kUnknownCorrespondenceValue
            ? odds
            : odds *
                  Odds(CorrespondenceCostToProbability(
                      ValueToCorrespondenceCost(static_cast<uint16>(value))));
    table[value] = kUpdateMarker |
                   CorrespondenceCostToValue(ProbabilityToCorrespondenceCost(
                       ProbabilityFromOdds(new_odds)));
  }
  return table;
}

}  // namespace mapping
}  // namespace cartographer
