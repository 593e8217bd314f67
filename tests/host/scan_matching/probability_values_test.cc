// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
#include "cartographer/mapping/probability_values.h"

#include "cartographer/mapping/submaps.h"
#include "cartographer/mapping/value_conversion_tables.h"
#include "gtest/gtest.h"

namespace cartographer {
namespace mapping {
namespace {

TEST(ProbabilityValuesTest, OddsAndBack) {
  EXPECT_FLOAT_EQ(Odds(0.5f), 1.f);
  EXPECT_NEAR(Odds(0.8f), 4.f, 1e-5f);
  EXPECT_FLOAT_EQ(ProbabilityFromOdds(4.f), 0.8f);
  EXPECT_FLOAT_EQ(ClampProbability(0.f), kMinProbability);
  EXPECT_FLOAT_EQ(ClampProbability(1.f), kMaxProbability);
  EXPECT_FLOAT_EQ(ClampCorrespondenceCost(-3.f), kMinCorrespondenceCost);
  EXPECT_FLOAT_EQ(ClampCorrespondenceCost(3.f), kMaxCorrespondenceCost);
}

TEST(ProbabilityValuesTest, EncodesLinearly) {
  EXPECT_EQ(CorrespondenceCostToValue(kMinCorrespondenceCost), 1);
  EXPECT_EQ(CorrespondenceCostToValue(kMaxCorrespondenceCost), 32767);
  EXPECT_EQ(CorrespondenceCostToValue(0.f), 1);
  EXPECT_EQ(CorrespondenceCostToValue(1.f), 32767);
  EXPECT_NEAR(CorrespondenceCostToValue(0.5f), 16384, 1);
  EXPECT_EQ(ProbabilityToValue(kMinProbability), 1);
  EXPECT_EQ(ProbabilityToValue(kMaxProbability), 32767);
  EXPECT_FLOAT_EQ(ValueToCorrespondenceCost(16384), 0.5f);
  EXPECT_FLOAT_EQ(ValueToProbability(16384), 0.5f);
}

TEST(ProbabilityValuesTest, UnknownReadsAsFree) {
  EXPECT_EQ(ValueToProbability(kUnknownProbabilityValue), kMinProbability);
  EXPECT_EQ(ValueToCorrespondenceCost(kUnknownCorrespondenceValue),
            kMaxCorrespondenceCost);
}

TEST(ProbabilityValuesTest, EveryValueSurvivesDecodingAndEncoding) {
  for (int value = 1; value != 32768; ++value) {
    const float cost = ValueToCorrespondenceCost(value);
    // Through the probability, too: what cropping a grid relies on.
    ASSERT_EQ(CorrespondenceCostToValue(ProbabilityToCorrespondenceCost(
                  CorrespondenceCostToProbability(cost))),
              value);
    ASSERT_EQ(ProbabilityToValue(ValueToProbability(value)), value);
    ASSERT_EQ(ValueToCorrespondenceCost(value | kUpdateMarker), cost);
  }
}

TEST(ProbabilityValuesTest, ConvertsBetweenEncodings) {
  EXPECT_EQ(ProbabilityValueToCorrespondenceCostValue(0), 0);
  EXPECT_EQ(CorrespondenceCostValueToProbabilityValue(0), 0);
  // Opposite ends of the scale.
  EXPECT_EQ(ProbabilityValueToCorrespondenceCostValue(1), 32767);
  EXPECT_EQ(CorrespondenceCostValueToProbabilityValue(1), 32767);
  EXPECT_EQ(ProbabilityValueToCorrespondenceCostValue(kUpdateMarker + 1),
            kUpdateMarker + 32767);
  EXPECT_EQ(CorrespondenceCostValueToProbabilityValue(kUpdateMarker + 100),
            kUpdateMarker + 32668);
}

TEST(ProbabilityValuesTest, TableMultipliesOdds) {
  const auto table =
      ComputeLookupTableToApplyCorrespondenceCostOdds(Odds(0.55f));
  ASSERT_EQ(table.size(), 32768u);
  for (const uint16 value : table) ASSERT_TRUE(value & kUpdateMarker);
  // Unknown: p = 0.55, cost 0.45, value 1 + 0.35 * 32766 / 0.8.
  EXPECT_NEAR(table[0] - kUpdateMarker, 14336, 1);
  // Once more: odds (11/9)^2, p = 121/202, cost 81/202.
  const uint16 once = table[0] - kUpdateMarker;
  EXPECT_NEAR(ValueToCorrespondenceCost(table[once]), 81. / 202., 3e-5);
  // Saturates.
  EXPECT_EQ(table[1], kUpdateMarker + 1);
}

TEST(ProbabilityValuesTest, TableOfProbabilitiesMultipliesOdds) {
  const auto table = ComputeLookupTableToApplyOdds(Odds(0.45f));
  EXPECT_NEAR(ValueToProbability(table[0]), 0.45, 3e-5);
  EXPECT_NEAR(ValueToProbability(table[ProbabilityToValue(0.5f)]), 0.45, 3e-5);
  EXPECT_EQ(table[1], kUpdateMarker + 1);
}

TEST(ValueConversionTablesTest, DecodesAnyRange) {
  ValueConversionTables tables;
  const std::vector<float>* const table =
      tables.GetConversionTable(-1.f, -0.5f, 1.5f);
  ASSERT_EQ(table->size(), 65536u);
  EXPECT_EQ((*table)[0], -1.f);
  EXPECT_EQ((*table)[kUpdateMarker], -1.f);
  EXPECT_NEAR((*table)[1], -0.5f, 1e-6);
  EXPECT_NEAR((*table)[16384], 0.5f, 1e-6);
  EXPECT_NEAR((*table)[32767], 1.5f, 1e-6);
  EXPECT_NEAR((*table)[65535], 1.5f, 1e-6);
  EXPECT_EQ(tables.GetConversionTable(-1.f, -0.5f, 1.5f), table);
  EXPECT_NE(tables.GetConversionTable(-2.f, -0.5f, 1.5f), table);
}

TEST(SubmapsTest, LogOddsIntegers) {
  EXPECT_EQ(ProbabilityToLogOddsInteger(kMinProbability), 1);
  EXPECT_EQ(ProbabilityToLogOddsInteger(kMaxProbability), 255);
  EXPECT_EQ(ProbabilityToLogOddsInteger(0.5f), 128);
}

}  // namespace
}  // namespace mapping
}  // namespace cartographer
