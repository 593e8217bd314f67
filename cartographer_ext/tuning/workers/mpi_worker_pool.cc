// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
#include "cartographer_ext/tuning/workers/mpi_worker_pool.h"

#include <chrono>
#include <cstdlib>
#include <string>
#include <thread>
#include <utility>

#ifdef CARTOGRAPHER_EXT_HAS_MPI
// Only the C interface is used.
#define OMPI_SKIP_MPICXX 1
#define MPICH_SKIP_MPICXX 1
#include <mpi.h>
#endif

namespace cartographer_ext {
namespace tuning {

bool IsMpiJob() {
  return std::getenv("OMPI_COMM_WORLD_SIZE") != nullptr ||
         std::getenv("PMI_SIZE") != nullptr ||
         std::getenv("PMIX_RANK") != nullptr;
}

#ifdef CARTOGRAPHER_EXT_HAS_MPI
bool HasMpi() { return true; }

namespace {

enum Tag { kRequest = 1, kAnswer = 2, kCancel = 3, kEnd = 4 };

// Receiving waits in a busy loop, so messages are polled instead.
constexpr auto kPause = std::chrono::milliseconds(2);
constexpr double kServeSeconds = 0.02;

void SendText(const std::string& text, const int rank, const int tag) {
  MPI_Send(text.data(), static_cast<int>(text.size()), MPI_CHAR, rank, tag,
           MPI_COMM_WORLD);
}

// False when there is no message from `rank` (or MPI_ANY_SOURCE).
bool Receive(int* const rank, int* const tag, std::string* const text) {
  int there = 0;
  MPI_Status status;
  MPI_Iprobe(*rank, MPI_ANY_TAG, MPI_COMM_WORLD, &there, &status);
  if (there == 0) return false;
  int size = 0;
  MPI_Get_count(&status, MPI_CHAR, &size);
  text->resize(static_cast<size_t>(size));
  *rank = status.MPI_SOURCE;
  *tag = status.MPI_TAG;
  MPI_Recv(&(*text)[0], size, MPI_CHAR, *rank, *tag, MPI_COMM_WORLD,
           MPI_STATUS_IGNORE);
  return true;
}

class MpiWorkerPool : public WorkerPool {
 public:
  explicit MpiWorkerPool(const int size) {
    for (int rank = 1; rank < size; ++rank) idle_.insert(rank);
  }

  int num_workers() const override {
    return static_cast<int>(idle_.size() + running_.size());
  }
  int num_running() const override { return static_cast<int>(running_.size()); }

  void Start(const int id, const nlohmann::json& request) override {
    const int rank = *idle_.begin();
    idle_.erase(idle_.begin());
    running_[rank] = id;
    nlohmann::json message = {{"id", id}, {"request", request}};
    SendText(
        message.dump(-1, ' ', false, nlohmann::json::error_handler_t::replace),
        rank, kRequest);
  }

  absl::optional<WorkerResult> Wait(const double timeout_seconds) override {
    const auto end = std::chrono::steady_clock::now() +
                     std::chrono::duration<double>(timeout_seconds);
    while (true) {
      int rank = MPI_ANY_SOURCE, tag = 0;
      std::string text;
      if (Receive(&rank, &tag, &text)) {
        const auto found = running_.find(rank);
        const auto answer = nlohmann::json::parse(text, nullptr, false);
        // A cancelled run may have been finished already.
        if (found == running_.end() || !answer.is_object() ||
            answer.value("id", -1) != found->second) {
          continue;
        }
        WorkerResult result;
        result.id = found->second;
        result.answer = answer["answer"];
        idle_.insert(rank);
        running_.erase(found);
        return result;
      }
      if (std::chrono::steady_clock::now() >= end) return absl::nullopt;
      std::this_thread::sleep_for(kPause);
    }
  }

  void StopAll() override {
    for (const auto& entry : running_) {
      SendText("", entry.first, kCancel);
      idle_.insert(entry.first);
    }
    running_.clear();
  }

 private:
  std::set<int> idle_;  // ranks
  std::map<int, int> running_;
};

}  // namespace

MpiSession::MpiSession(int* const argc, char*** const argv) {
  if (!IsMpiJob()) return;
  MPI_Init(argc, argv);
  started_ = true;
  MPI_Comm_rank(MPI_COMM_WORLD, &rank_);
  MPI_Comm_size(MPI_COMM_WORLD, &size_);
}

MpiSession::~MpiSession() {
  if (!started_) return;
  if (rank_ == 0) {
    for (int rank = 1; rank < size_; ++rank) SendText("", rank, kEnd);
  }
  MPI_Finalize();
}

void MpiSession::Serve(const double max_cpu_seconds, RunFunction run) {
  LocalWorkerPool pool(1, max_cpu_seconds, std::move(run));
  while (true) {
    int rank = 0, tag = 0;
    std::string text;
    if (Receive(&rank, &tag, &text)) {
      if (tag == kEnd) return;
      if (tag == kCancel) pool.StopAll();
      if (tag == kRequest) {
        const auto message = nlohmann::json::parse(text, nullptr, false);
        if (message.is_object()) {
          pool.Start(message.value("id", -1), message["request"]);
        }
      }
      continue;
    }
    if (pool.num_running() == 0) {
      std::this_thread::sleep_for(kPause);
      continue;
    }
    const auto result = pool.Wait(kServeSeconds);
    if (!result.has_value()) continue;
    const nlohmann::json message = {{"id", result->id},
                                    {"answer", result->answer}};
    SendText(
        message.dump(-1, ' ', false, nlohmann::json::error_handler_t::replace),
        0, kAnswer);
  }
}

std::unique_ptr<WorkerPool> CreateMpiWorkerPool(const MpiSession& session) {
  if (session.rank() != 0 || session.size() < 2) return nullptr;
  return std::unique_ptr<WorkerPool>(new MpiWorkerPool(session.size()));
}

#else

bool HasMpi() { return false; }

MpiSession::MpiSession(int* /*argc*/, char*** /*argv*/) {}
MpiSession::~MpiSession() = default;
void MpiSession::Serve(double /*max_cpu_seconds*/, RunFunction /*run*/) {}
std::unique_ptr<WorkerPool> CreateMpiWorkerPool(const MpiSession& /*session*/) {
  return nullptr;
}

#endif

}  // namespace tuning
}  // namespace cartographer_ext
