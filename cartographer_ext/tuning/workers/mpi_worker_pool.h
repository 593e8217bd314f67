// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
//
// The same search on several machines: rank 0 of an MPI job keeps the journal
// and distributes runs, all other ranks execute them, each in a child process
// as LocalWorkerPool does. Recordings and configurations must have the same
// paths on all machines. MPI is not initialised outside an MPI job.
#ifndef CARTOGRAPHER_EXT_TUNING_WORKERS_MPI_WORKER_POOL_H_
#define CARTOGRAPHER_EXT_TUNING_WORKERS_MPI_WORKER_POOL_H_

#include <map>
#include <memory>
#include <set>

#include "cartographer_ext/tuning/workers/worker_pool.h"

namespace cartographer_ext {
namespace tuning {

// Whether the program was started as part of an MPI job, by the environment. In
// a program built without MPI, such a job would repeat the same search several
// times.
bool IsMpiJob();

// Whether the program was built with MPI.
bool HasMpi();

// Starts and ends MPI. `rank()` is 0 and `size()` 1 outside MPI jobs and
// without MPI.
class MpiSession {
 public:
  MpiSession(int* argc, char*** argv);
  // On rank 0, notifies the others of the end.
  ~MpiSession();
  MpiSession(const MpiSession&) = delete;
  MpiSession& operator=(const MpiSession&) = delete;

  int rank() const { return rank_; }
  int size() const { return size_; }

  // On all ranks except 0: executes requests from rank 0 until the end.
  void Serve(double max_cpu_seconds, RunFunction run);

 private:
  bool started_ = false;
  int rank_ = 0;
  int size_ = 1;
};

// On rank 0 of a job of at least two ranks; null otherwise.
std::unique_ptr<WorkerPool> CreateMpiWorkerPool(const MpiSession& session);

}  // namespace tuning
}  // namespace cartographer_ext

#endif  // CARTOGRAPHER_EXT_TUNING_WORKERS_MPI_WORKER_POOL_H_
