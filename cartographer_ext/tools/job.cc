// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
#include "cartographer_ext/tools/job.h"

#include <algorithm>
#include <thread>
#include <utility>

#include "absl/strings/str_cat.h"
#include "cartographer_ext/tuning/workers/shared_folder_pool.h"
#include "cartographer_ext/tuning/workers/shared_folder_server.h"
#include "gflags/gflags.h"

DEFINE_string(job_folder, "",
              "Job array: folder on a shared file system over which the tasks "
              "of one job work together. All are started with the same flags "
              "but for -job_task.");
DEFINE_int32(job_task, -1,
             "Job array: number of this task. Task 0 distributes the runs and "
             "writes the results, all tasks execute runs.");

namespace cartographer_ext {
namespace tools {
namespace {

int NumWorkers(const int num_workers) {
  return num_workers > 0
             ? num_workers
             : std::max(1,
                        static_cast<int>(std::thread::hardware_concurrency()));
}

tuning::SharedFolderOptions FolderOptions(const int num_workers,
                                          const double max_cpu_seconds) {
  tuning::SharedFolderOptions options;
  options.folder = FLAGS_job_folder;
  options.task = FLAGS_job_task;
  options.num_workers = NumWorkers(num_workers);
  options.max_cpu_seconds = max_cpu_seconds;
  return options;
}

}  // namespace

std::string Job::WrongUsage() {
  if (tuning::IsMpiJob() && !tuning::HasMpi()) {
    return "built without MPI: mpirun would repeat the same work";
  }
  if (FLAGS_job_folder.empty() != (FLAGS_job_task < 0)) {
    return "-job_folder and -job_task (from 0) belong together";
  }
  if (!FLAGS_job_folder.empty() && tuning::IsMpiJob()) {
    return "-job_folder is not for mpirun, which needs no shared folder";
  }
  return "";
}

Job::Job(int* const argc, char*** const argv)
    : mpi_(new tuning::MpiSession(argc, argv)) {}

bool Job::is_worker() const { return mpi_->rank() > 0 || FLAGS_job_task > 0; }

absl::Status Job::Serve(const int num_workers, const double max_cpu_seconds,
                        tuning::RunFunction run) const {
  if (mpi_->rank() == 0) {
    return tuning::ServeSharedFolder(
        FolderOptions(num_workers, max_cpu_seconds), std::move(run));
  }
  mpi_->Serve(max_cpu_seconds, std::move(run));
  return absl::OkStatus();
}

absl::StatusOr<std::unique_ptr<tuning::WorkerPool>> Job::CreatePool(
    const int num_workers, const double max_cpu_seconds,
    tuning::RunFunction run) const {
  if (!FLAGS_job_folder.empty()) {
    auto pool = tuning::SharedFolderPool::Create(
        FolderOptions(num_workers, max_cpu_seconds), std::move(run));
    if (!pool.ok()) return pool.status();
    return std::unique_ptr<tuning::WorkerPool>(*std::move(pool));
  }
  auto pool = tuning::CreateMpiWorkerPool(*mpi_);
  if (pool != nullptr) return pool;
  return std::unique_ptr<tuning::WorkerPool>(new tuning::LocalWorkerPool(
      NumWorkers(num_workers), max_cpu_seconds, std::move(run)));
}

std::string Job::JournalOr(const std::string& filename) const {
  if (!filename.empty() || FLAGS_job_folder.empty()) return filename;
  return absl::StrCat(FLAGS_job_folder, "/journal.jsonl");
}

}  // namespace tools
}  // namespace cartographer_ext
