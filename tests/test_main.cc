// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
#include <cstring>
#include <iostream>
#include <string>

#include "glog/logging.h"
#include "gtest/gtest.h"

// Read by the leak sanitizer where a test is built with it. Fontconfig, which
// cairo draws text with, keeps its configuration until the process ends.
extern "C" const char* __lsan_default_suppressions();
extern "C" const char* __lsan_default_suppressions() {
  return "leak:libfontconfig";
}

// Memory that does not exist is asked for, too, and must be refused as usual.
extern "C" const char* __asan_default_options();
extern "C" const char* __asan_default_options() {
  return "allocator_may_return_null=1";
}

namespace {

// The filter that selects the tests defined in `source`, a file name without folders: of a folder's tests, which are one
// program, CTest runs one source at a time. Empty if the source defines none.
std::string TestsOfSource(const std::string& source) {
  std::string filter;
  const testing::UnitTest& all = *testing::UnitTest::GetInstance();
  for (int i = 0; i != all.total_test_suite_count(); ++i) {
    const testing::TestSuite& suite = *all.GetTestSuite(i);
    for (int j = 0; j != suite.total_test_count(); ++j) {
      const testing::TestInfo& test = *suite.GetTestInfo(j);
      const std::string file = test.file();
      if (file.substr(file.find_last_of('/') + 1) != source) continue;
      filter += (filter.empty() ? "" : ":") + std::string(suite.name()) + "." +
                test.name();
    }
  }
  return filter;
}

}  // namespace

int main(int argc, char** argv) {
  google::InitGoogleLogging(argv[0]);
  FLAGS_logtostderr = true;
  testing::InitGoogleTest(&argc, argv);
  constexpr char kTestSource[] = "--test_source=";
  for (int i = 1; i != argc; ++i) {
    if (std::strncmp(argv[i], kTestSource, std::strlen(kTestSource)) != 0)
      continue;
    const std::string source = argv[i] + std::strlen(kTestSource);
    const std::string filter = TestsOfSource(source);
    if (filter.empty()) {
      std::cerr << "no test is defined in '" << source << "'\n";
      return 1;
    }
    // A filter given besides, as death tests give it to the process they start, is the narrower one.
    if (testing::GTEST_FLAG(filter) == "*")
      testing::GTEST_FLAG(filter) = filter;
  }
  return RUN_ALL_TESTS();
}
