// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
#include "cartographer/common/configuration_file_resolver.h"

#include <cstdio>
#include <fstream>
#include <string>

#include "gtest/gtest.h"

namespace cartographer {
namespace common {
namespace {

class ConfigurationFileResolverTest : public ::testing::Test {
 protected:
  ConfigurationFileResolverTest()
      : directory_(::testing::TempDir()),
        path_(directory_ + "/resolver_test.lua") {
    std::ofstream(path_) << "A = 1\n";
  }
  ~ConfigurationFileResolverTest() override { std::remove(path_.c_str()); }

  const std::string directory_;
  const std::string path_;
};

TEST_F(ConfigurationFileResolverTest, SearchesInOrder) {
  ConfigurationFileResolver resolver({"/nonexistent", directory_});
  EXPECT_EQ(resolver.GetFullPathOrDie("resolver_test.lua"), path_);
  EXPECT_EQ(resolver.GetFileContentOrDie("resolver_test.lua"), "A = 1\n");
}

using ConfigurationFileResolverDeathTest = ConfigurationFileResolverTest;

TEST_F(ConfigurationFileResolverDeathTest, NamesMissingFileAndDirectories) {
  ConfigurationFileResolver resolver({"/nonexistent", directory_});
  EXPECT_DEATH(resolver.GetFullPathOrDie("absent.lua"),
               "has a file 'absent.lua': /nonexistent");
  EXPECT_DEATH(resolver.GetFileContentOrDie(""), "empty");
}

}  // namespace
}  // namespace common
}  // namespace cartographer
