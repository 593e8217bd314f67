// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
#include "cartographer/common/configuration_file_resolver.h"

#include <fstream>
#include <iterator>

#include "absl/strings/str_join.h"
#include "glog/logging.h"

namespace cartographer {
namespace common {

ConfigurationFileResolver::ConfigurationFileResolver(
    const std::vector<std::string>& configuration_files_directories)
    : configuration_files_directories_(configuration_files_directories) {
#ifdef CARTOGRAPHER_CONFIGURATION_FILES_DIRECTORY
  configuration_files_directories_.push_back(
      CARTOGRAPHER_CONFIGURATION_FILES_DIRECTORY);
#endif
}

std::string ConfigurationFileResolver::GetFullPathOrDie(
    const std::string& basename) {
  for (const std::string& directory : configuration_files_directories_) {
    const std::string path = directory + "/" + basename;
    if (std::ifstream(path).good()) {
      VLOG(1) << basename << " is " << path;
      return path;
    }
  }
  LOG(FATAL) << "none of the configuration directories has a file '" << basename
             << "': " << absl::StrJoin(configuration_files_directories_, ", ");
  return "";
}

std::string ConfigurationFileResolver::GetFileContentOrDie(
    const std::string& basename) {
  CHECK(!basename.empty()) << "the name of the configuration file is empty";
  const std::string path = GetFullPathOrDie(basename);
  std::ifstream file(path);
  const std::string content((std::istreambuf_iterator<char>(file)),
                            std::istreambuf_iterator<char>());
  CHECK(!file.bad()) << "Cannot read '" << path << "'.";
  return content;
}

}  // namespace common
}  // namespace cartographer
