// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
#include "cartographer_ext/slam/side_files.h"

#include <fstream>
#include <string>
#include <utility>
#include <vector>

#include "gmock/gmock.h"
#include "gtest/gtest.h"

namespace cartographer_ext {
namespace evaluation {
namespace {

using testing::HasSubstr;

absl::StatusOr<int> ParseLength(const absl::string_view bytes) {
  if (bytes.empty()) return absl::DataLossError("nothing in it");
  return static_cast<int>(bytes.size());
}

absl::Status Write(
    const std::string& records, const std::string& csv,
    const std::vector<std::pair<std::string, std::string>>& parts) {
  SideFileWriter files(records, csv);
  for (const auto& part : parts) files.Add(part.first, part.second);
  return files.Finish();
}

TEST(SideFilesTest, StandBesideTheMap) {
  EXPECT_EQ(SideFilename("maps/a.pbstream", ".loops.pb"), "maps/a.loops.pb");
  EXPECT_EQ(SideFilename("a.pbstream.old", ".loops.pb"),
            "a.pbstream.old.loops.pb");
  EXPECT_EQ(SideFilename("a", ".nodes.csv"), "a.nodes.csv");
}

TEST(SideFilesTest, AreWrittenReadAndRemovedTogether) {
  const std::string stem = testing::TempDir() + "side_files_test";
  const std::string records = stem + ".pb", csv = stem + ".csv";
  // With a zero and a line end in it.
  const std::string bytes("a\0b\nc", 5);
  ASSERT_TRUE(
      Write(
          records, csv,
          {{"", "x,y\n"}, {bytes.substr(0, 2), "1,"}, {bytes.substr(2), "2\n"}})
          .ok());
  const auto read = ReadBytes(records);
  ASSERT_TRUE(read.ok()) << read.status();
  EXPECT_EQ(*read, bytes);
  EXPECT_EQ(*ReadBytes(csv), "x,y\n1,2\n");
  const auto parsed = ReadSideFile<int>(records, &ParseLength);
  ASSERT_TRUE(parsed.ok()) << parsed.status();
  EXPECT_EQ(*parsed, 5);
  // A map without records has no files, not those of the map before.
  ASSERT_TRUE(Write(records, csv, {}).ok());
  EXPECT_TRUE(absl::IsNotFound(ReadBytes(records).status()));
  EXPECT_TRUE(absl::IsNotFound(ReadBytes(csv).status()));
  // Nothing to remove is no error.
  EXPECT_TRUE(Write(records, csv, {}).ok());
}

TEST(SideFilesTest, ErrorsNameTheFile) {
  const std::string missing = testing::TempDir() + "no_such_folder/x.pb";
  EXPECT_FALSE(Write(missing, missing, {{"a", "b"}}).ok());
  const auto read = ReadBytes(missing);
  EXPECT_TRUE(absl::IsNotFound(read.status()));
  EXPECT_THAT(std::string(read.status().message()), HasSubstr("x.pb"));
  const auto folder = ReadBytes(testing::TempDir());
  EXPECT_TRUE(absl::IsDataLoss(folder.status()));
  EXPECT_THAT(std::string(folder.status().message()),
              HasSubstr(testing::TempDir()));
  EXPECT_TRUE(
      absl::IsNotFound(ReadSideFile<int>(missing, &ParseLength).status()));
  const std::string empty = testing::TempDir() + "side_files_empty.pb";
  std::ofstream(empty).close();
  const auto parsed = ReadSideFile<int>(empty, &ParseLength);
  EXPECT_TRUE(absl::IsDataLoss(parsed.status()));
  EXPECT_THAT(std::string(parsed.status().message()),
              testing::AllOf(HasSubstr("side_files_empty.pb"),
                             HasSubstr("nothing in it")));
}

}  // namespace
}  // namespace evaluation
}  // namespace cartographer_ext
