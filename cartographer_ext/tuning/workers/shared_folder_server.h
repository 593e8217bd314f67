// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
//
// Tasks other than 0 of a job array over a shared folder; see shared_folder.h.
#ifndef CARTOGRAPHER_EXT_TUNING_WORKERS_SHARED_FOLDER_SERVER_H_
#define CARTOGRAPHER_EXT_TUNING_WORKERS_SHARED_FOLDER_SERVER_H_

#include "absl/status/status.h"
#include "cartographer_ext/tuning/workers/shared_folder.h"
#include "cartographer_ext/tuning/workers/worker_pool.h"

namespace cartographer_ext {
namespace tuning {

// Executes requests until task 0 has ended the search. Errors: no task 0 within
// wait_seconds, none for so long later on, another process with the same task
// number, or a folder that cannot be written.
absl::Status ServeSharedFolder(const SharedFolderOptions& options,
                               RunFunction run);

}  // namespace tuning
}  // namespace cartographer_ext

#endif  // CARTOGRAPHER_EXT_TUNING_WORKERS_SHARED_FOLDER_SERVER_H_
