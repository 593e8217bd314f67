// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
#include "cartographer_ext/io/pbstream/pbstream_records.h"

#include "gmock/gmock.h"
#include "gtest/gtest.h"

namespace cartographer_ext {
namespace io {
namespace {

class LimitOf : public ContentLimit {
 public:
  explicit LimitOf(const int64_t bytes) : bytes_(bytes) {}
  int64_t For(absl::string_view, int64_t) const override { return bytes_; }

 private:
  const int64_t bytes_;
};

const LimitOf kAny(1 << 20);

std::string TwoRecords() {
  std::string content(PbstreamMagic());
  AppendPbstreamRecord("first", &content);
  AppendPbstreamRecord(std::string(100000, 'x'), &content);
  return content;
}

TEST(PbstreamRecordsTest, ReturnsWhatWasAppended) {
  const std::string content = TwoRecords();
  PbstreamRecords records(content, "f");
  ASSERT_TRUE(records.status().ok());
  EXPECT_EQ(records.index(), -1);
  std::string data, again(PbstreamMagic());
  for (const std::string& expected :
       {std::string("first"), std::string(100000, 'x')}) {
    const auto more = records.Next(kAny, &data);
    ASSERT_TRUE(more.ok() && *more) << more.status();
    EXPECT_EQ(data, expected);
    again.append(records.bytes().data(), records.bytes().size());
  }
  EXPECT_EQ(records.index(), 1);
  EXPECT_EQ(again, content);
  const auto more = records.Next(kAny, &data);
  ASSERT_TRUE(more.ok());
  EXPECT_FALSE(*more);
}

TEST(PbstreamRecordsTest, SkipDoesNotExpand) {
  std::string content = TwoRecords();
  content[30] ^= 0x55;  // inside the first member
  PbstreamRecords records(content, "f");
  ASSERT_TRUE(*records.Skip());
  std::string data;
  const auto second = records.Next(kAny, &data);
  ASSERT_TRUE(second.ok() && *second);
  EXPECT_EQ(data.size(), 100000u);
  EXPECT_EQ(records.Error(absl::StatusCode::kDataLoss, "why").message(),
            "f: record 1 at byte " +
                std::to_string(content.size() - records.bytes().size()) +
                ": why");
}

TEST(PbstreamRecordsTest, SaysWhatIsWrong) {
  const auto message = [](const std::string& content, const LimitOf& limit) {
    PbstreamRecords records(content, "f");
    absl::Status status = records.status();
    std::string data;
    while (status.ok()) {
      const auto more = records.Next(limit, &data);
      status = more.status();
      if (more.ok() && !*more) return std::string("the end");
    }
    return std::string(status.message());
  };
  const std::string good = TwoRecords();
  EXPECT_EQ(message(good, kAny), "the end");
  EXPECT_THAT(message("", kAny), testing::HasSubstr("f: "));
  EXPECT_THAT(message("nonsense", kAny), testing::HasSubstr("magic number"));
  EXPECT_THAT(message(good.substr(0, good.size() - 1), kAny),
              testing::HasSubstr("but the file ends after"));
  EXPECT_THAT(message(good + "abc", kAny), testing::HasSubstr("record 2"));
  std::string broken = good;
  broken[30] ^= 0x55;
  EXPECT_THAT(message(broken, kAny), testing::HasSubstr("record 0 at byte 8"));
  EXPECT_NE(message(good, LimitOf(99999)), "the end");
}

TEST(PbstreamRecordsTest, AMemberEndsWhereItEnds) {
  std::string content;
  AppendPbstreamRecord("data", &content);
  const std::string member = content.substr(8);
  EXPECT_EQ(*ExpandGzipMember(member, kAny), "data");
  for (const std::string& wrong :
       {member + "x", member.substr(0, member.size() - 1), std::string()}) {
    EXPECT_EQ(ExpandGzipMember(wrong, kAny).status().code(),
              absl::StatusCode::kDataLoss);
  }
  EXPECT_EQ(ExpandGzipMember(member, LimitOf(3)).status().code(),
            absl::StatusCode::kResourceExhausted);
}

}  // namespace
}  // namespace io
}  // namespace cartographer_ext
