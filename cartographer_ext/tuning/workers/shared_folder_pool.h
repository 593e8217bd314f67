// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
//
// Task 0 of a job array over a shared folder; see shared_folder.h.
#ifndef CARTOGRAPHER_EXT_TUNING_WORKERS_SHARED_FOLDER_POOL_H_
#define CARTOGRAPHER_EXT_TUNING_WORKERS_SHARED_FOLDER_POOL_H_

#include <map>
#include <memory>
#include <string>

#include "absl/status/status.h"
#include "absl/status/statusor.h"
#include "absl/types/optional.h"
#include "cartographer_ext/tuning/workers/shared_folder.h"
#include "cartographer_ext/tuning/workers/worker_pool.h"

namespace cartographer_ext {
namespace tuning {

// The pool of task 0.
class SharedFolderPool : public WorkerPool {
 public:
  // An error names the folder if it does not exist or cannot be written, or if
  // another task 0 is alive.
  static absl::StatusOr<std::unique_ptr<SharedFolderPool>> Create(
      const SharedFolderOptions& options, RunFunction run);
  // Tells the other tasks that the search has ended.
  ~SharedFolderPool() override;

  // Its own and those of the tasks that are alive.
  int num_workers() const override;
  int num_running() const override;
  void Start(int id, const nlohmann::json& request) override;
  absl::optional<WorkerResult> Wait(double timeout_seconds) override;
  void StopAll() override;

  // Tasks that are alive, this one included.
  int num_tasks() const { return 1 + static_cast<int>(tasks_.size()); }

 private:
  struct Task {
    std::string token;
    double beat = -1.;
    double beat_seconds = 0.;  // when it changed last, by this clock
    int num_slots = 0;
  };
  struct RemoteRun {
    int id = 0;
    int serial = 0;     // of the request
    std::string token;  // of the task
    double start = 0.;  // seconds
  };

  SharedFolderPool(const SharedFolderOptions& options, RunFunction run);

  absl::Status Beat(const char* state);
  // Beats, and looks for tasks and answers; not more often than poll_seconds.
  void Poll();
  void FindTasks();
  // The result of a run that has an answer or whose task has died.
  absl::optional<WorkerResult> TakeRemoteResult();
  // The name of a slot that is idle, or empty.
  std::string IdleSlot() const;

  const SharedFolderOptions options_;
  const SharedFolder folder_;
  const std::string session_;
  LocalWorkerPool local_;
  std::map<std::string, Task> tasks_;         // alive, by "task-3"
  std::map<std::string, RemoteRun> running_;  // by slot, "task-3-1"
  int beat_ = 0;
  int last_serial_ = 0;
  double last_poll_ = 0.;
};

}  // namespace tuning
}  // namespace cartographer_ext

#endif  // CARTOGRAPHER_EXT_TUNING_WORKERS_SHARED_FOLDER_POOL_H_
