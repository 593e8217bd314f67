// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
#include "cartographer_ext/collection/map_files.h"

#include <glob.h>

#include <filesystem>
#include <set>
#include <system_error>

#include "absl/strings/str_cat.h"

namespace cartographer_ext {
namespace collection {
namespace {

namespace fs = std::filesystem;

constexpr char kEnding[] = ".pbstream";

absl::Status AddFolder(const std::string& folder,
                       std::set<std::string>* const maps) {
  std::error_code error;
  fs::recursive_directory_iterator entry(folder, error);
  const size_t before = maps->size();
  while (!error && entry != fs::recursive_directory_iterator()) {
    if (entry->path().extension() == kEnding && !entry->is_directory(error)) {
      maps->insert(entry->path().lexically_normal().string());
    }
    entry.increment(error);
  }
  if (error) {
    return absl::InvalidArgumentError(
        absl::StrCat(folder, ": ", error.message()));
  }
  if (maps->size() > before) return absl::OkStatus();
  return absl::InvalidArgumentError(
      absl::StrCat(folder, ": no ", kEnding, " below this folder"));
}

}  // namespace

bool NamesMany(const std::string& input) {
  std::error_code error;
  if (fs::is_directory(input, error)) return true;
  return input.find_first_of("*?[") != std::string::npos &&
         !fs::exists(input, error);
}

absl::StatusOr<std::vector<std::string>> FindMaps(
    const std::vector<std::string>& inputs) {
  std::set<std::string> all;
  for (const std::string& input : inputs) {
    std::vector<std::string> names = {input};
    std::error_code error;
    if (NamesMany(input) && !fs::is_directory(input, error)) {
      names.clear();
      glob_t found;
      if (glob(input.c_str(), GLOB_TILDE, nullptr, &found) == 0) {
        names.assign(found.gl_pathv, found.gl_pathv + found.gl_pathc);
      }
      globfree(&found);
      if (names.empty()) {
        return absl::InvalidArgumentError(
            absl::StrCat(input, ": no file matches this pattern"));
      }
    }
    for (const std::string& name : names) {
      if (!fs::is_directory(name, error)) {
        all.insert(fs::path(name).lexically_normal().string());
        continue;
      }
      // By itself, so that a folder that is named twice is not called empty.
      std::set<std::string> maps;
      const absl::Status status = AddFolder(name, &maps);
      if (!status.ok()) return status;
      all.insert(maps.begin(), maps.end());
    }
  }
  return std::vector<std::string>(all.begin(), all.end());
}

}  // namespace collection
}  // namespace cartographer_ext
