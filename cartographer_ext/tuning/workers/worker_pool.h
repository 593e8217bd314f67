// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
//
// Executes runs, each in a separate process: a run that crashes, runs out of
// memory or fails a check is a failed trial and does not stop the search, and
// memory does not grow from run to run.
#ifndef CARTOGRAPHER_EXT_TUNING_WORKERS_WORKER_POOL_H_
#define CARTOGRAPHER_EXT_TUNING_WORKERS_WORKER_POOL_H_

#include <sys/types.h>

#include <functional>
#include <map>
#include <string>
#include <vector>

#include "absl/types/optional.h"
#include "nlohmann/json.hpp"

namespace cartographer_ext {
namespace tuning {

// { "ok": true, "metrics": {...} } or { "ok": false, "message": "..." }, with
// "wall_seconds" and "cpu_seconds" of the process in either case.
struct WorkerResult {
  int id = 0;
  nlohmann::json answer;
};

class WorkerPool {
 public:
  virtual ~WorkerPool() = default;

  virtual int num_workers() const = 0;
  virtual int num_running() const = 0;

  // Requires num_running() < num_workers(). The result has the same `id`.
  virtual void Start(int id, const nlohmann::json& request) = 0;

  // Returns a finished run, or nothing after `timeout_seconds`.
  virtual absl::optional<WorkerResult> Wait(double timeout_seconds) = 0;

  // Stops all running requests, without results.
  virtual void StopAll() = 0;
};

// Answers { "ok": ... } to a request; called in a separate process.
using RunFunction = std::function<nlohmann::json(const nlohmann::json&)>;

// A clock of this machine, and waiting by it; seconds.
double SteadySeconds();
void SleepFor(double seconds);

// A failed answer, and that of a run which was ended from outside and may
// succeed when it is repeated ("killed").
nlohmann::json Failure(const std::string& message);
nlohmann::json KilledFailure(const std::string& message);
// The answer with the times that the run took.
nlohmann::json WithTimes(nlohmann::json answer, double wall_seconds,
                         double cpu_seconds);

// Child processes of this one, which must have no other threads. They are
// terminated with it.
class LocalWorkerPool : public WorkerPool {
 public:
  // Runs that exceed `max_cpu_seconds` (0: no limit) of CPU time are killed and
  // fail.
  LocalWorkerPool(int num_workers, double max_cpu_seconds, RunFunction run);
  ~LocalWorkerPool() override;

  int num_workers() const override { return num_workers_; }
  int num_running() const override {
    return static_cast<int>(children_.size() + failed_.size());
  }
  void Start(int id, const nlohmann::json& request) override;
  absl::optional<WorkerResult> Wait(double timeout_seconds) override;
  void StopAll() override;

 private:
  struct Child {
    int id = 0;
    int answer = -1;    // file descriptors without a name
    int messages = -1;  // its standard error
    double start = 0.;  // seconds
  };

  absl::optional<WorkerResult> Reap();

  const int num_workers_;
  const double max_cpu_seconds_;
  const RunFunction run_;
  std::map<pid_t, Child> children_;
  std::vector<WorkerResult> failed_;  // that could not be started
};

}  // namespace tuning
}  // namespace cartographer_ext

#endif  // CARTOGRAPHER_EXT_TUNING_WORKERS_WORKER_POOL_H_
