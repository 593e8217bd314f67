// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
#include "cartographer_ext/io/line_reader.h"

#include <sstream>
#include <string>
#include <vector>

#include "boost/iostreams/copy.hpp"
#include "boost/iostreams/filter/bzip2.hpp"
#include "boost/iostreams/filter/gzip.hpp"
#include "boost/iostreams/filter/lzma.hpp"
#include "boost/iostreams/filtering_streambuf.hpp"
#include "cartographer_ext/io/expansion_budget.h"
#include "gmock/gmock.h"
#include "gtest/gtest.h"
#include "tests/mutation.h"

namespace cartographer_ext {
namespace io {
namespace {

using ::testing::ElementsAre;
using ::testing::HasSubstr;

std::string Compress(const std::string& text, const std::string& format) {
  namespace streams = boost::iostreams;
  std::stringstream in(text), out;
  streams::filtering_istreambuf filter;
  if (format == "gz") filter.push(streams::gzip_compressor());
  if (format == "bz2") filter.push(streams::bzip2_compressor());
  if (format == "xz") filter.push(streams::lzma_compressor());
  filter.push(in);
  streams::copy(filter, out);
  return out.str();
}

absl::StatusOr<std::vector<std::string>> Lines(const std::string& file) {
  auto reader = LineReader::Open(file);
  if (!reader.ok()) return reader.status();
  std::vector<std::string> lines;
  absl::string_view line;
  while (true) {
    const auto more = (*reader)->Next(&line);
    if (!more.ok()) return more.status();
    if (!*more) return lines;
    lines.emplace_back(line);
    EXPECT_EQ((*reader)->line_number(), static_cast<int64_t>(lines.size()));
  }
}

TEST(LineReaderTest, SplitsLines) {
  test::TemporaryFile file(".txt");
  test::WriteBytes(file.path(), "a\n\nb c\r\nlast");
  const auto lines = Lines(file.path());
  ASSERT_TRUE(lines.ok());
  EXPECT_THAT(*lines, ElementsAre("a", "", "b c", "last"));
  test::WriteBytes(file.path(), "");
  EXPECT_TRUE(Lines(file.path())->empty());
  test::WriteBytes(file.path(), "\n");
  EXPECT_THAT(*Lines(file.path()), ElementsAre(""));
}

TEST(LineReaderTest, SkipsAByteOrderMark) {
  test::TemporaryFile file(".txt");
  test::WriteBytes(file.path(),
                   "\xef\xbb\xbf"
                   "1 2\n\xef\xbb\xbf");
  EXPECT_THAT(*Lines(file.path()), ElementsAre("1 2", "\xef\xbb\xbf"));
}

TEST(LineReaderTest, LinesLongerThanTheBuffer) {
  test::TemporaryFile file(".txt");
  const std::string a(200000, 'a'), b(70000, 'b');
  test::WriteBytes(file.path(), a + "\n" + b + "\n" + a);
  EXPECT_THAT(*Lines(file.path()), ElementsAre(a, b, a));
}

TEST(LineReaderTest, CutsOverlongLines) {
  test::TemporaryFile file(".txt");
  const std::string text(5 * LineReader::kMaxLineLength / 2, 'x');
  test::WriteBytes(file.path(), text + "\nnext\n");
  auto reader = LineReader::Open(file.path());
  ASSERT_TRUE(reader.ok());
  absl::string_view line;
  ASSERT_TRUE(*(*reader)->Next(&line));
  EXPECT_EQ(line.size(), LineReader::kMaxLineLength);
  EXPECT_TRUE((*reader)->truncated());
  ASSERT_TRUE(*(*reader)->Next(&line));
  EXPECT_EQ(line, "next");
  EXPECT_FALSE((*reader)->truncated());
  EXPECT_EQ((*reader)->Location(), file.path() + ":2");
}

class CompressedTest : public ::testing::TestWithParam<const char*> {};

TEST_P(CompressedTest, ReadByContentAndTruncationFound) {
  std::string text;
  for (int i = 0; i < 20000; ++i) text += std::to_string(i) + "\n";
  const std::string packed = Compress(text, GetParam());
  // The name says nothing.
  test::TemporaryFile file(".txt");
  test::WriteBytes(file.path(), packed);
  const auto whole = Lines(file.path());
  ASSERT_TRUE(whole.ok()) << whole.status();
  ASSERT_EQ(whole->size(), 20000u);
  EXPECT_EQ(whole->back(), "19999");
  // Concatenated archives are one file.
  test::WriteBytes(file.path(), packed + packed);
  EXPECT_EQ(Lines(file.path())->size(), 40000u);
  for (const size_t size : {size_t{8}, size_t{40}, packed.size() / 2,
                            packed.size() - 9, packed.size() - 1}) {
    test::WriteBytes(file.path(), packed.substr(0, size));
    const auto part = Lines(file.path());
    EXPECT_EQ(part.status().code(), absl::StatusCode::kDataLoss) << size;
    EXPECT_THAT(std::string(part.status().message()), HasSubstr(file.path()));
    EXPECT_FALSE(ReadFile(file.path(), 1 << 20).ok());
  }
}

TEST_P(CompressedTest, SurvivesMutations) {
  const std::string packed = Compress("1 2 3\n4 5 6\nsome text\n", GetParam());
  test::TemporaryFile file(".txt");
  test::ForEachMutation(packed, [&](const std::string& damaged) {
    test::WriteBytes(file.path(), damaged);
    Lines(file.path()).status().IgnoreError();
  });
}

TEST_P(CompressedTest, BombsEnd) {
  // 80 MB of a few KB.
  test::TemporaryFile file(".txt");
  test::WriteBytes(file.path(),
                   Compress(std::string(80 << 20, '\n'), GetParam()));
  auto reader = LineReader::Open(file.path());
  ASSERT_TRUE(reader.ok());
  absl::string_view line;
  absl::StatusOr<bool> more = true;
  while (more.ok() && *more) more = (*reader)->Next(&line);
  EXPECT_EQ(more.status().code(), absl::StatusCode::kResourceExhausted);
  EXPECT_THAT(std::string(more.status().message()),
              HasSubstr(file.path() + ": expands to more than 50 times"));
  SetMaxExpansion(1 << 20);
  EXPECT_EQ(ReadFile(file.path(), 81 << 20)->size(), size_t{80 << 20});
  SetMaxExpansion(50);
}

INSTANTIATE_TEST_SUITE_P(All, CompressedTest,
                         ::testing::Values("gz", "bz2", "xz"));

TEST(LineReaderTest, ReadFileIsBounded) {
  test::TemporaryFile file(".txt");
  test::WriteBytes(file.path(), Compress(std::string(1 << 20, 'x'), "xz"));
  EXPECT_EQ(ReadFile(file.path(), 1 << 20)->size(), size_t{1} << 20);
  EXPECT_EQ(ReadFile(file.path(), 100).status().code(),
            absl::StatusCode::kOutOfRange);
}

TEST(LineReaderTest, DevicesAreNotReadForEver) {
  const auto lines = Lines("/dev/zero");
  EXPECT_EQ(lines.status().code(), absl::StatusCode::kInvalidArgument);
  EXPECT_THAT(std::string(lines.status().message()),
              HasSubstr("/dev/zero:1: a line of more than 64 MB"));
}

TEST(LineReaderTest, MissingFileAndFolder) {
  EXPECT_EQ(LineReader::Open("/nonexistent/file").status().code(),
            absl::StatusCode::kNotFound);
  EXPECT_THAT(std::string(LineReader::Open("/tmp").status().message()),
              HasSubstr("/tmp is a folder"));
}

}  // namespace
}  // namespace io
}  // namespace cartographer_ext
