// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
//
// Judges many maps, each in a process of its own: a damaged file is a failed
// map and never stops the others, and memory does not grow from map to map.
#ifndef CARTOGRAPHER_EXT_COLLECTION_MAP_SURVEY_H_
#define CARTOGRAPHER_EXT_COLLECTION_MAP_SURVEY_H_

#include <cstdint>
#include <functional>
#include <string>
#include <vector>

#include "absl/status/statusor.h"
#include "cartographer_ext/collection/map_record.h"
#include "cartographer_ext/tuning/worker_pool.h"

namespace cartographer_ext {
namespace collection {

struct SurveyOptions {
  // Folder for a page of each map, which must be there; empty: no pages.
  std::string reports_directory;
  // Where finished maps are kept, so that a killed survey goes on. A map whose
  // file has another size or time of change since is judged again.
  std::string journal_filename;
  // After each map: how many are done, and the last one.
  std::function<void(int64_t done, const MapRecord& last)> on_progress;
};

// The names of the pages, parallel to `filenames`: in the folder, made of the
// map's name, each once. Empty without a folder.
std::vector<std::string> ReportFilenames(
    const std::vector<std::string>& filenames,
    const std::string& reports_directory);

// In the order of `filenames`, whatever the number of workers. Errors are those
// of the journal only.
absl::StatusOr<std::vector<MapRecord>> SurveyMaps(
    const std::vector<std::string>& filenames, const SurveyOptions& options,
    tuning::WorkerPool* pool);

}  // namespace collection
}  // namespace cartographer_ext

#endif  // CARTOGRAPHER_EXT_COLLECTION_MAP_SURVEY_H_
