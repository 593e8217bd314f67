// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
//
// Resolves the maps named by a user: files, folders, patterns.
#ifndef CARTOGRAPHER_EXT_COLLECTION_MAP_FILES_H_
#define CARTOGRAPHER_EXT_COLLECTION_MAP_FILES_H_

#include <string>
#include <vector>

#include "absl/status/statusor.h"

namespace cartographer_ext {
namespace collection {

// Whether the input may name several files: a folder, or a pattern with
// * ? [ that is not the name of a file.
bool NamesMany(const std::string& input);

// The maps in order of name, without duplicates. A folder means all *.pbstream
// below it (links to folders are not followed), a pattern the matching files as
// in a shell, a name itself, even if there is no such file. An error if a
// folder or a pattern has no map.
absl::StatusOr<std::vector<std::string>> FindMaps(
    const std::vector<std::string>& inputs);

}  // namespace collection
}  // namespace cartographer_ext

#endif  // CARTOGRAPHER_EXT_COLLECTION_MAP_FILES_H_
