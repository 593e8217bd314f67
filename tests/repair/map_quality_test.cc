// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
#include "cartographer_ext/repair/map_quality.h"

#include "gmock/gmock.h"
#include "gtest/gtest.h"

namespace cartographer_ext {
namespace repair {
namespace {

using testing::HasSubstr;

MapQuality Broken() {
  MapQuality quality;
  quality.verdict = "broken";
  quality.severe_share = 0.3;
  quality.contradicted_rays = 0.2;
  quality.open_cycles = 0.1;
  quality.entropy = -1.;
  quality.agreeing_nodes = 100.;
  return quality;
}

TEST(MapQualityTest, TheFirstMeasureThatDiffersDecides) {
  MapQuality better = Broken();
  EXPECT_THAT(WhyNotBetter(Broken(), better),
              HasSubstr("would not change in quality"));
  better.severe_share = 0.2;
  better.contradicted_rays = 0.3;
  better.entropy = 0.;
  EXPECT_EQ(WhyNotBetter(Broken(), better), "");
  EXPECT_THAT(WhyNotBetter(better, Broken()), HasSubstr("severe share"));
  better = Broken();
  better.contradicted_rays = 0.1;
  better.open_cycles = 0.9;
  EXPECT_EQ(WhyNotBetter(Broken(), better), "");
  better = Broken();
  better.entropy = -1.1;
  EXPECT_EQ(WhyNotBetter(Broken(), better), "");
  EXPECT_THAT(WhyNotBetter(better, Broken()), HasSubstr("entropy"));
}

TEST(MapQualityTest, TheVerdictGoesBeforeTheMeasures) {
  MapQuality doubtful = Broken();
  doubtful.verdict = "doubtful";
  doubtful.severe_share = 0.31;
  EXPECT_EQ(WhyNotBetter(Broken(), doubtful), "");
  EXPECT_THAT(WhyNotBetter(doubtful, Broken()),
              HasSubstr("would be broken, it is doubtful"));
}

TEST(MapQualityTest, AMapTornApartIsNotBetter) {
  MapQuality torn = Broken();
  torn.verdict = "sound";
  torn.severe_share = 0.;
  torn.agreeing_nodes = 79.;
  EXPECT_THAT(WhyNotBetter(Broken(), torn), HasSubstr("apart"));
  torn.agreeing_nodes = 81.;
  EXPECT_EQ(WhyNotBetter(Broken(), torn), "");
  torn.verdict = "unknown";
  EXPECT_THAT(WhyNotBetter(Broken(), torn), HasSubstr("apart"));
}

}  // namespace
}  // namespace repair
}  // namespace cartographer_ext
