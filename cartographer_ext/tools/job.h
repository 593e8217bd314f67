// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
//
// How the runs of a command are spread over processes and machines: an MPI job,
// the tasks of a job array over a shared folder (-job_folder, -job_task), or
// child processes of this one alone.
#ifndef CARTOGRAPHER_EXT_TOOLS_JOB_H_
#define CARTOGRAPHER_EXT_TOOLS_JOB_H_

#include <memory>
#include <string>

#include "absl/status/status.h"
#include "absl/status/statusor.h"
#include "cartographer_ext/tuning/workers/mpi_worker_pool.h"
#include "cartographer_ext/tuning/workers/worker_pool.h"

namespace cartographer_ext {
namespace tools {

class Job {
 public:
  // What is wrong with the flags or the environment; empty if nothing is.
  static std::string WrongUsage();

  // Flags must have been parsed.
  Job(int* argc, char*** argv);

  // Whether this process only executes runs that another one distributes.
  bool is_worker() const;

  // The part of a worker. `num_workers` as for CreatePool, in a job array.
  absl::Status Serve(int num_workers, double max_cpu_seconds,
                     tuning::RunFunction run) const;

  // For the process that distributes runs; `num_workers` is the number of runs
  // it executes at a time itself (0: one per hardware thread; under mpirun it
  // executes none).
  absl::StatusOr<std::unique_ptr<tuning::WorkerPool>> CreatePool(
      int num_workers, double max_cpu_seconds, tuning::RunFunction run) const;

  // `filename`, or if that is empty in a job array, a journal in its folder.
  std::string JournalOr(const std::string& filename) const;

 private:
  std::unique_ptr<tuning::MpiSession> mpi_;
};

}  // namespace tools
}  // namespace cartographer_ext

#endif  // CARTOGRAPHER_EXT_TOOLS_JOB_H_
