// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
#include "cartographer_ext/io/tokens.h"

#include <cmath>
#include <limits>
#include <string>

#include "cartographer_ext/common/random.h"
#include "gtest/gtest.h"

namespace cartographer_ext {
namespace io {
namespace {

TEST(TokensTest, TakesWords) {
  Tokens tokens("  a\tbc   d\r");
  EXPECT_EQ(tokens.Next(), "a");
  EXPECT_TRUE(tokens.More());
  EXPECT_EQ(tokens.Next(), "bc");
  EXPECT_EQ(tokens.Next(), "d");
  EXPECT_FALSE(tokens.More());
  EXPECT_EQ(tokens.Next(), "");
}

TEST(TokensTest, ParsesDoublesLikeTheStandardLibrary) {
  Random random(7);
  for (int i = 0; i < 20000; ++i) {
    std::string text;
    if (random.UniformInt(0, 1) == 0) text += "-";
    const int64_t digits = random.UniformInt(1, 19);
    const int64_t point = random.UniformInt(0, digits);
    for (int64_t k = 0; k < digits; ++k) {
      if (k == point) text += ".";
      text += static_cast<char>('0' + random.UniformInt(0, 9));
    }
    if (random.UniformInt(0, 3) == 0) {
      text += "e" + std::to_string(random.UniformInt(-30, 30));
    }
    double value;
    ASSERT_TRUE(ParseDouble(text, &value)) << text;
    ASSERT_EQ(value, std::strtod(text.c_str(), nullptr)) << text;
  }
}

TEST(TokensTest, ParsesSpecialNumbers) {
  double value;
  EXPECT_TRUE(ParseDouble("nan", &value));
  EXPECT_TRUE(std::isnan(value));
  EXPECT_TRUE(ParseDouble("-inf", &value));
  EXPECT_EQ(value, -std::numeric_limits<double>::infinity());
  EXPECT_TRUE(ParseDouble("1e999", &value));
  EXPECT_EQ(value, std::numeric_limits<double>::infinity());
  EXPECT_TRUE(ParseDouble("1e-999", &value));
  EXPECT_EQ(value, 0.);
  EXPECT_TRUE(ParseDouble("+2.5", &value));
  EXPECT_EQ(value, 2.5);
  EXPECT_TRUE(ParseDouble("6.747499e+001", &value));
  EXPECT_EQ(value, 67.47499);
  for (const char* text :
       {"", "-", ".", "+", "+-1", "1.2.3", "0x10", "1,5", "5m", "e5"}) {
    EXPECT_FALSE(ParseDouble(text, &value)) << text;
  }
  EXPECT_FALSE(ParseFinite("inf", &value));
  EXPECT_FALSE(ParseFinite("nan", &value));
  EXPECT_TRUE(ParseFinite("0", &value));
  EXPECT_TRUE(ParseCoordinate("-1e9", &value));
  EXPECT_FALSE(ParseCoordinate("1.1e9", &value));
  EXPECT_FALSE(ParseCoordinate("-1e308", &value));
  EXPECT_FALSE(ParseCoordinate("nan", &value));
}

TEST(TokensTest, ParsesTimesToTheNanosecond) {
  TimeNs time;
  ASSERT_TRUE(ParseTime("1134864629.895182", &time));
  EXPECT_EQ(time, 1134864629895182000);
  ASSERT_TRUE(ParseTime("1134864629.1234567894", &time));
  EXPECT_EQ(time, 1134864629123456789);
  ASSERT_TRUE(ParseTime("0.9999999999", &time));  // Rounds up.
  EXPECT_EQ(time, 1000000000);
  ASSERT_TRUE(ParseTime("70.1", &time));
  EXPECT_EQ(time, 70100000000);
  ASSERT_TRUE(ParseTime("7.01e1", &time));
  EXPECT_EQ(time, 70100000000);
  ASSERT_TRUE(ParseTime("9000000000", &time));
  for (const char* text : {"", "-1", "nan", "inf", "9000000001", "1e30", "1.2x",
                           "99999999999999999999"}) {
    EXPECT_FALSE(ParseTime(text, &time)) << text;
  }
}

TEST(TokensTest, FormatsBackExactly) {
  EXPECT_EQ(FormatTime(1134864629895182000), "1134864629.895182000");
  EXPECT_EQ(FormatTime(5), "0.000000005");
  EXPECT_EQ(FormatTime(-1500000000), "-1.500000000");
  EXPECT_EQ(FormatDouble(0.1), "0.1");
  EXPECT_EQ(FormatDouble(-2.), "-2");
  Random random(3);
  for (int i = 0; i < 5000; ++i) {
    const double value =
        random.Normal() * std::pow(10., random.Uniform(-20., 20.));
    double again;
    ASSERT_TRUE(ParseDouble(FormatDouble(value), &again));
    ASSERT_EQ(again, value);
    const TimeNs time = random.UniformInt(0, 9000000000000000000);
    TimeNs time_again;
    ASSERT_TRUE(ParseTime(FormatTime(time), &time_again));
    ASSERT_EQ(time_again, time);
  }
}

}  // namespace
}  // namespace io
}  // namespace cartographer_ext
