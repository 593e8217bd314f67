// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
//
// Judges many maps, each in a separate process: a damaged file is a failed map
// and does not stop the others, and memory does not grow from map to map.
#ifndef CARTOGRAPHER_EXT_COLLECTION_MAP_SURVEY_H_
#define CARTOGRAPHER_EXT_COLLECTION_MAP_SURVEY_H_

#include <cstdint>
#include <functional>
#include <string>
#include <vector>

#include "absl/status/statusor.h"
#include "cartographer_ext/collection/map_record.h"
#include "cartographer_ext/tuning/workers/worker_pool.h"

namespace cartographer_ext {
namespace collection {

struct SurveyOptions {
  // Existing folder for a page of each map; empty: no pages.
  std::string reports_directory;
  // Journal of finished maps, from which an interrupted survey resumes. A map
  // whose file has a different size or modification time is judged again.
  std::string journal_filename;
  // Called after each map with the number of finished maps and the last one.
  std::function<void(int64_t done, const MapRecord& last)> on_progress;
};

// Unique names of the pages in the folder, parallel to `filenames`, derived
// from the names of the maps. Empty without a folder.
std::vector<std::string> ReportFilenames(
    const std::vector<std::string>& filenames,
    const std::string& reports_directory);

// In the order of `filenames`, for any number of workers. Only errors of the
// journal are returned.
absl::StatusOr<std::vector<MapRecord>> SurveyMaps(
    const std::vector<std::string>& filenames, const SurveyOptions& options,
    tuning::WorkerPool* pool);

}  // namespace collection
}  // namespace cartographer_ext

#endif  // CARTOGRAPHER_EXT_COLLECTION_MAP_SURVEY_H_
