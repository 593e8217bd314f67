// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
#include "cartographer_ext/io/bounded_json.h"

#include <string>

#include "gtest/gtest.h"

namespace cartographer_ext {
namespace io {
namespace {

TEST(BoundedJsonTest, TakesWhatIsNotTooDeep) {
  const auto json = ParseBoundedJson(R"({"a": [1, {"b": []}], "c": 2})", 4);
  ASSERT_TRUE(json.is_object());
  EXPECT_EQ(json["c"], 2);
  EXPECT_EQ(json["a"][1]["b"].size(), 0u);
  EXPECT_FALSE(
      ParseBoundedJson(R"({"a": [1, {"b": []}], "c": 2})", 3).is_structured());
  EXPECT_TRUE(ParseBoundedJson("[[0]]", 2).is_array());
  EXPECT_FALSE(ParseBoundedJson("[[0]]", 1).is_structured());
  EXPECT_EQ(ParseBoundedJson("7", 0), 7);
}

TEST(BoundedJsonTest, DamagedTextIsNoValue) {
  for (const char* const text :
       {"", "{", "[1,", "{\"a\" 1}", "nan", "\"\xff\"", "[1] 2"}) {
    const auto json = ParseBoundedJson(text, 9);
    EXPECT_TRUE(json.is_null() || json.is_discarded()) << text;
  }
}

TEST(BoundedJsonTest, AMillionBracketsReturn) {
  for (const char* const bracket : {"[", "{\"a\":"}) {
    std::string text;
    for (int i = 0; i < 1000000; ++i) text += bracket;
    EXPECT_TRUE(ParseBoundedJson(text, 16).is_null());
  }
}

TEST(BoundedJsonTest, FieldsOfAnotherTypeAreMissing) {
  const auto json = ParseBoundedJson(
      R"({"text": "t", "number": 2.5, "truth": true, "list": [1], "none": null,
          "large": 1e300, "negative": -3, "most": 9007199254740992})",
      2);
  EXPECT_EQ(TextIn(json, "text"), "t");
  EXPECT_EQ(TextIn(json, "number", "else"), "else");
  EXPECT_EQ(TextIn(json, "missing"), "");
  EXPECT_EQ(NumberIn(json, "number", 0.), 2.5);
  EXPECT_EQ(NumberIn(json, "text", 7.), 7.);
  EXPECT_EQ(NumberIn(json, "none", 7.), 7.);
  EXPECT_TRUE(TruthIn(json, "truth", false));
  EXPECT_TRUE(TruthIn(json, "number", true));
  EXPECT_FALSE(TruthIn(json, "list", false));
  EXPECT_EQ(CountIn(json, "number", 9), 2);
  EXPECT_EQ(CountIn(json, "large", 9), 9);
  EXPECT_EQ(CountIn(json, "negative", 9), 9);
  EXPECT_EQ(CountIn(json, "most", 9), int64_t{1} << 53);
  int value = 11;
  EXPECT_TRUE(TakeInt(json, "negative", &value));
  EXPECT_EQ(value, -3);
  EXPECT_FALSE(TakeInt(json, "large", &value));
  EXPECT_FALSE(TakeInt(json, "text", &value));
  EXPECT_FALSE(TakeInt(json, "missing", &value));
  EXPECT_EQ(value, -3);
}

TEST(BoundedJsonTest, WhatIsNotAnObjectHasNoFields) {
  for (const char* const text : {"[1]", "3", "null", "\"text\"", "{"}) {
    const auto json = ParseBoundedJson(text, 2);
    EXPECT_EQ(TextIn(json, "text", "else"), "else");
    EXPECT_EQ(NumberIn(json, "number", 1.), 1.);
    EXPECT_TRUE(TruthIn(json, "truth", true));
  }
}

}  // namespace
}  // namespace io
}  // namespace cartographer_ext
