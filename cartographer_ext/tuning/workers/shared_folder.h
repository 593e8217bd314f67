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
#ifndef CARTOGRAPHER_EXT_TUNING_WORKERS_SHARED_FOLDER_H_
#define CARTOGRAPHER_EXT_TUNING_WORKERS_SHARED_FOLDER_H_

#include <algorithm>
#include <string>
#include <utility>
#include <vector>

#include "absl/status/status.h"
#include "nlohmann/json.hpp"

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
  // A task that finds a search that has ended waits so long for the next one,
  // and then ends without an error.
  double wait_after_end_seconds = 60.;

  // Between two looks whether a run has finished.
  double pause_seconds() const { return std::min(0.05, poll_seconds); }
};

// The files of one job.
class SharedFolder {
 public:
  explicit SharedFolder(std::string path) : path_(std::move(path)) {}

  static const char kCoordinator[];  // name of its file
  static const char kRunning[];      // states of the coordinator
  static const char kEnded[];

  // An error names the folder if it does not exist.
  absl::Status Check() const;

  std::vector<std::string> Names() const;  // sorted

  // An object, or null if the file is missing or damaged.
  nlohmann::json Read(const std::string& name) const;
  // Replaces the file as a whole; an error names it.
  absl::Status Write(const nlohmann::json& json, const std::string& name) const;
  void Remove(const std::string& name) const;

 private:
  std::string PathOf(const std::string& name) const;

  const std::string path_;
};

std::string TaskName(int task);                           // "task-3"
std::string SlotName(const std::string& task, int slot);  // "task-3-1"
std::string TaskOfSlot(const std::string& slot);
std::string RequestName(const std::string& slot);  // of a file
std::string AnswerName(const std::string& slot);
bool IsAnswer(const std::string& name);

// Differs from that of every other process.
std::string MakeToken();

}  // namespace tuning
}  // namespace cartographer_ext

#endif  // CARTOGRAPHER_EXT_TUNING_WORKERS_SHARED_FOLDER_H_
