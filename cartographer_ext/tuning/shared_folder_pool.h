// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
//
// The same search on several machines without MPI: the tasks of a job array, or
// processes started by hand, that share nothing but a folder. Task 0 keeps the
// journal and distributes runs, and executes some itself; all other tasks
// execute runs, each in a child process as LocalWorkerPool does. Recordings and
// configurations must have the same paths on all machines.
//
// Every file in the folder has one writer and is replaced as a whole, so that no
// locks are needed, which many shared file systems lack:
//
//   coordinator.json       of task 0: session, beat, whether it has ended
//   task-3.json            of task 3: token, beat, number of slots
//   task-3-1.request.json  of task 0: a run for slot 1 of task 3
//   task-3-1.answer.json   of task 3: its result
//
// A process is alive while its beat, a counter, changes; clocks of different
// machines are never compared. Tasks may come, go and be started again at any
// time: the run of a task that has died is reported as killed from outside. When
// task 0 is started again, the others drop what they are doing and serve it.
#ifndef CARTOGRAPHER_EXT_TUNING_SHARED_FOLDER_POOL_H_
#define CARTOGRAPHER_EXT_TUNING_SHARED_FOLDER_POOL_H_

#include <map>
#include <memory>
#include <string>

#include "absl/status/status.h"
#include "absl/status/statusor.h"
#include "absl/types/optional.h"
#include "cartographer_ext/tuning/worker_pool.h"

namespace cartographer_ext {
namespace tuning {

struct SharedFolderOptions {
  std::string folder;  // exists
  int task = 0;
  int num_workers = 1;  // parallel runs of this task
  double max_cpu_seconds = 0.;
  // How often files are read and beats are written.
  double poll_seconds = 0.5;
  // A process whose beat has not changed for so long is dead. File systems
  // cache file attributes for up to a minute.
  double silent_seconds = 120.;
  // Tasks other than 0 end when there has been no task 0 for so long.
  double wait_seconds = 600.;
};

// The pool of task 0.
class SharedFolderPool : public WorkerPool {
 public:
  // An error names the folder if it does not exist or cannot be written, or if
  // another task 0 is alive.
  static absl::StatusOr<std::unique_ptr<SharedFolderPool>> Create(
      const SharedFolderOptions& options, RunFunction run = &AnswerRequest);
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
  std::string PathOf(const std::string& name) const;

  const SharedFolderOptions options_;
  const std::string session_;
  LocalWorkerPool local_;
  std::map<std::string, Task> tasks_;         // alive, by "task-3"
  std::map<std::string, RemoteRun> running_;  // by slot, "task-3-1"
  int beat_ = 0;
  int last_serial_ = 0;
  double last_poll_ = 0.;
};

// Executes requests until task 0 has ended the search. Errors: no task 0 within
// wait_seconds, none for so long later on, another process with the same task
// number, or a folder that cannot be written.
absl::Status ServeSharedFolder(const SharedFolderOptions& options,
                               RunFunction run = &AnswerRequest);

}  // namespace tuning
}  // namespace cartographer_ext

#endif  // CARTOGRAPHER_EXT_TUNING_SHARED_FOLDER_POOL_H_
