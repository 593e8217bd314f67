// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
#include "cartographer_ext/navigation/closed_loop/shadow_localization.h"

#include "gtest/gtest.h"
#include "tests/navigation/closed_loop/room_run.h"

namespace cartographer_ext {
namespace navigation {
namespace {

// That the same localisation reports the same poses is tested with the run.
TEST(ShadowLocalizationTest, AnotherLocalizationGetsTheSameReadings) {
  const Room& room = Room::Get();
  NavigationRunOptions options = room.Options();
  options.goals = {{3., 2.}};
  options.keep_readings = true;
  const auto run =
      RunNavigation(room.world, room.map, room.configuration, options);
  ASSERT_TRUE(run.ok()) << run.status();
  const auto stock = LocalizeAgain(*run, Room::Load("stock_localization.lua"),
                                   room.pbstream_filename);
  ASSERT_TRUE(stock.ok()) << stock.status();
  EXPECT_GE(stock->errors.size(), run->localization.size());
  EXPECT_LT(MedianError(stock->errors), 0.2);
  EXPECT_GT(stock->cpu_seconds, 0.);
}

}  // namespace
}  // namespace navigation
}  // namespace cartographer_ext
