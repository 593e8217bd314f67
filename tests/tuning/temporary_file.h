// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
//
// Files for tests that go away with their folder.
#ifndef TESTS_TUNING_TEMPORARY_FILE_H_
#define TESTS_TUNING_TEMPORARY_FILE_H_

#include <dirent.h>
#include <stdlib.h>
#include <unistd.h>

#include <fstream>
#include <iterator>
#include <string>

#include "gtest/gtest.h"

namespace cartographer_ext {
namespace test {

class Folder {
 public:
  Folder() {
    std::string name = testing::TempDir() + "cartographer_ext_tuning_XXXXXX";
    path_ = mkdtemp(&name[0]);
  }
  ~Folder() {
    DIR* const folder = opendir(path_.c_str());
    while (const dirent* const entry = readdir(folder)) {
      unlink((path_ + "/" + entry->d_name).c_str());
    }
    closedir(folder);
    rmdir(path_.c_str());
  }
  const std::string& path() const { return path_; }
  std::string Write(const std::string& name, const std::string& content) const {
    std::ofstream(path_ + "/" + name, std::ios::binary) << content;
    return path_ + "/" + name;
  }
  std::string Read(const std::string& name) const {
    std::ifstream stream(path_ + "/" + name, std::ios::binary);
    return std::string(std::istreambuf_iterator<char>(stream), {});
  }

 private:
  std::string path_;
};

}  // namespace test
}  // namespace cartographer_ext

#endif  // TESTS_TUNING_TEMPORARY_FILE_H_
