// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
//
// Where tests find their data: small files of our own in tests/data, and the
// large shared data sets through CARTOGRAPHER_EXT_DATA_DIR (default
// ../shared/data, seen from the source tree). Tests of the latter skip, saying
// so, where the folder is absent.
#ifndef TESTS_TEST_DATA_H_
#define TESTS_TEST_DATA_H_

#include <sys/stat.h>

#include <cstdlib>
#include <string>

#include "gtest/gtest.h"

namespace cartographer_ext {
namespace test {

inline bool Exists(const std::string& path) {
  struct stat unused;
  return stat(path.c_str(), &unused) == 0;
}

// A file of tests/data; tests run in the source folder.
inline std::string OwnData(const std::string& name) {
  return "tests/data/" + name;
}

inline std::string SharedDataDirectory() {
  const char* from_environment = std::getenv("CARTOGRAPHER_EXT_DATA_DIR");
  return from_environment != nullptr ? from_environment : "../shared/data";
}

// For example SharedData("carmen/aces.clf.xz").
inline std::string SharedData(const std::string& name) {
  return SharedDataDirectory() + "/" + name;
}

// Golden vectors live beside the data.
inline std::string Golden(const std::string& name) {
  return SharedDataDirectory() + "/../golden/" + name;
}

}  // namespace test
}  // namespace cartographer_ext

#define CARTOGRAPHER_EXT_SKIP_WITHOUT(path)                      \
  if (!::cartographer_ext::test::Exists(path)) {                 \
    GTEST_SKIP() << "data not available: " << (path)             \
                 << " (set CARTOGRAPHER_EXT_DATA_DIR)";          \
  }

#endif  // TESTS_TEST_DATA_H_
