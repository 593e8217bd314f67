// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
#include "cartographer_ext/common/delimited_messages.h"

#include <string>
#include <vector>

#include "gmock/gmock.h"
#include "google/protobuf/wrappers.pb.h"
#include "gtest/gtest.h"

namespace cartographer_ext {
namespace {

using google::protobuf::StringValue;
using testing::HasSubstr;

std::string Encode(const std::vector<std::string>& values) {
  std::string bytes;
  for (const std::string& value : values) {
    StringValue message;
    message.set_value(value);
    AppendDelimited(message, &bytes);
  }
  return bytes;
}

std::string ErrorOf(const std::string& bytes) {
  const auto messages = ParseDelimited<StringValue>(bytes, "entry");
  EXPECT_EQ(messages.status().code(), absl::StatusCode::kDataLoss);
  return std::string(messages.status().message());
}

TEST(DelimitedMessagesTest, ReadsWhatIsWritten) {
  // Lengths of one, two and three bytes, and a message without content.
  const std::vector<std::string> values = {"", "one", std::string(200, 'x'),
                                           std::string(20000, 'y'), ""};
  const auto messages = ParseDelimited<StringValue>(Encode(values), "entry");
  ASSERT_TRUE(messages.ok()) << messages.status();
  ASSERT_EQ(messages->size(), values.size());
  for (size_t i = 0; i != values.size(); ++i) {
    EXPECT_EQ((*messages)[i].value(), values[i]);
  }
  EXPECT_TRUE(ParseDelimited<StringValue>("", "entry")->empty());
}

TEST(DelimitedMessagesTest, NamesTheMessageThatIsCutOff) {
  const std::string whole = Encode({"first", "second"});
  const size_t second = Encode({"first"}).size();
  for (size_t size = 1; size != whole.size(); ++size) {
    if (size == second) continue;
    EXPECT_EQ(
        ErrorOf(whole.substr(0, size)),
        absl::StrCat("entry cut off at byte ", size < second ? 0 : second));
  }
}

TEST(DelimitedMessagesTest, RefusesLengthsThatCannotBe) {
  // 2^63, and a varint that does not end.
  EXPECT_THAT(ErrorOf(std::string(9, '\x80') + "\x01"), HasSubstr("byte 0"));
  EXPECT_THAT(ErrorOf(std::string(20, '\xff')), HasSubstr("byte 0"));
}

TEST(DelimitedMessagesTest, RefusesWhatDoesNotDecode) {
  // Field 1 with three bytes of text, of which only one follows.
  EXPECT_EQ(ErrorOf(std::string("\x03\x0a\x03x", 4)),
            "entry at byte 0 does not decode");
}

}  // namespace
}  // namespace cartographer_ext
