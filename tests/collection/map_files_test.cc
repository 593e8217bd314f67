// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
#include "cartographer_ext/collection/map_files.h"

#include <stdlib.h>

#include <filesystem>
#include <fstream>

#include "gmock/gmock.h"
#include "gtest/gtest.h"

namespace cartographer_ext {
namespace collection {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;

class MapFilesTest : public testing::Test {
 protected:
  MapFilesTest() {
    std::string name = testing::TempDir() + "map_files_XXXXXX";
    root_ = mkdtemp(&name[0]);
    std::filesystem::create_directories(root_ + "/b/c");
    std::filesystem::create_directories(root_ + "/none");
    for (const char* const file :
         {"z.pbstream", "b/y.pbstream", "b/c/x.pbstream", "b/readme.txt",
          "a[1].pbstream"}) {
      std::ofstream(root_ + "/" + file) << "x";
    }
  }
  ~MapFilesTest() override { std::filesystem::remove_all(root_); }

  std::string At(const std::string& name) const { return root_ + "/" + name; }

  std::string root_;
};

TEST_F(MapFilesTest, AFolderStandsForAllMapsBelowIt) {
  EXPECT_TRUE(NamesMany(root_));
  const auto maps = FindMaps({root_});
  ASSERT_TRUE(maps.ok()) << maps.status();
  EXPECT_THAT(*maps, ElementsAre(At("a[1].pbstream"), At("b/c/x.pbstream"),
                                 At("b/y.pbstream"), At("z.pbstream")));
}

TEST_F(MapFilesTest, APatternIsExpandedAndEachMapComesOnce) {
  EXPECT_TRUE(NamesMany(At("b/*.pbstream")));
  const auto maps =
      FindMaps({At("z.pbstream"), At("*/*.pbstream"), At("./z.pbstream")});
  ASSERT_TRUE(maps.ok()) << maps.status();
  EXPECT_THAT(*maps, ElementsAre(At("b/y.pbstream"), At("z.pbstream")));
}

TEST_F(MapFilesTest, AFileWithBracketsIsAFile) {
  EXPECT_FALSE(NamesMany(At("a[1].pbstream")));
  EXPECT_THAT(*FindMaps({At("a[1].pbstream")}),
              ElementsAre(At("a[1].pbstream")));
}

TEST_F(MapFilesTest, WhatIsNotThereIsReportedWithItsName) {
  EXPECT_THAT(std::string(FindMaps({At("none")}).status().message()),
              HasSubstr("none: no .pbstream"));
  EXPECT_THAT(std::string(FindMaps({At("q*")}).status().message()),
              HasSubstr("q*: no file matches"));
  // A single name may still fail, as one map among others.
  EXPECT_THAT(*FindMaps({At("missing.pbstream")}),
              ElementsAre(At("missing.pbstream")));
}

}  // namespace
}  // namespace collection
}  // namespace cartographer_ext
