// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
//
// Which maps a user means: files, folders, patterns.
#ifndef CARTOGRAPHER_EXT_COLLECTION_MAP_FILES_H_
#define CARTOGRAPHER_EXT_COLLECTION_MAP_FILES_H_

#include <string>
#include <vector>

#include "absl/status/statusor.h"

namespace cartographer_ext {
namespace collection {

// Whether it is more than the name of one file: a folder, or a pattern with
// * ? [ that is not itself the name of a file.
bool NamesMany(const std::string& input);

// The maps in order of name, each once. A folder stands for all *.pbstream
// below it (links to folders are not followed), a pattern for the files that
// match it as a shell would expand it, a name for itself, even where there is
// no such file. An error where a folder or a pattern has no map.
absl::StatusOr<std::vector<std::string>> FindMaps(
    const std::vector<std::string>& inputs);

}  // namespace collection
}  // namespace cartographer_ext

#endif  // CARTOGRAPHER_EXT_COLLECTION_MAP_FILES_H_
