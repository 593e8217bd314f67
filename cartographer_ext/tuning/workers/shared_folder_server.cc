// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
#include "cartographer_ext/tuning/workers/shared_folder_server.h"

#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "absl/strings/str_cat.h"
#include "absl/types/optional.h"
#include "cartographer_ext/io/bounded_json.h"
#include "glog/logging.h"

namespace cartographer_ext {
namespace tuning {
namespace {

// A task other than 0.
class Server {
 public:
  Server(const SharedFolderOptions& options, const RunFunction& run)
      : options_(options), folder_(options.folder), token_(MakeToken()) {
    for (int i = 0; i < options.num_workers; ++i) {
      slots_.emplace_back(SlotName(TaskName(options.task), i),
                          std::unique_ptr<LocalWorkerPool>(new LocalWorkerPool(
                              1, options.max_cpu_seconds, run)));
    }
  }

  absl::Status Run() {
    const absl::Status status = Serve();
    // Task 0 then knows at once that this one has ended. The file may be that
    // of another process with the same number, though.
    if (status.code() != absl::StatusCode::kAlreadyExists) {
      folder_.Remove(OwnName());
    }
    return status;
  }

 private:
  struct Slot {
    Slot(std::string name, std::unique_ptr<LocalWorkerPool> pool)
        : name(std::move(name)), pool(std::move(pool)) {}
    std::string name;
    std::unique_ptr<LocalWorkerPool> pool;
    int serial = -1;  // of the last request
  };

  absl::Status Serve() {
    last_heard_ = SteadySeconds();
    while (true) {
      const absl::Status status = Poll();
      if (!status.ok() || ended_) return status;
      const double next = SteadySeconds() + options_.poll_seconds;
      while (SteadySeconds() < next) {
        const absl::Status answered = Answer();
        if (!answered.ok()) return answered;
        SleepFor(options_.pause_seconds());
      }
    }
  }

  std::string OwnName() const {
    return absl::StrCat(TaskName(options_.task), ".json");
  }

  absl::Status Beat() {
    const std::string owner = io::TextIn(folder_.Read(OwnName()), "token");
    if (has_written_ && !owner.empty() && owner != token_) {
      return absl::AlreadyExistsError(
          absl::StrCat(options_.folder, ": another process is task ",
                       options_.task, " of the same job"));
    }
    const absl::Status status = folder_.Write(
        {{"token", token_}, {"beat", ++beat_}, {"slots", slots_.size()}},
        OwnName());
    if (status.ok()) {
      has_written_ = true;
      last_written_ = SteadySeconds();
    }
    // A file system may fail for a moment.
    const bool is_short = has_written_ && SteadySeconds() - last_written_ <
                                              options_.silent_seconds;
    return is_short ? absl::OkStatus() : status;
  }

  absl::Status Poll() {
    const nlohmann::json coordinator = folder_.Read(SharedFolder::kCoordinator);
    const std::string session = io::TextIn(coordinator, "session");
    const double beat = io::NumberIn(coordinator, "beat", -1.);
    if (session != session_ || beat != last_beat_)
      last_heard_ = SteadySeconds();
    last_beat_ = beat;
    if (session != session_) {
      session_ = session;
      for (Slot& slot : slots_) {
        slot.pool->StopAll();
        slot.serial = -1;
      }
    }
    if (!first_session_.has_value()) first_session_ = session;
    const bool ended = io::TextIn(coordinator, "state") == SharedFolder::kEnded;
    const double silence = SteadySeconds() - last_heard_;
    if (ended && (has_served_ || session != *first_session_ ||
                  silence > options_.wait_after_end_seconds)) {
      ended_ = true;
      return absl::OkStatus();
    }
    if (silence > options_.wait_seconds) {
      return absl::DeadlineExceededError(
          absl::StrCat(options_.folder, ": no sign of task 0 for ",
                       options_.wait_seconds, " s"));
    }
    const absl::Status status = Beat();
    if (!status.ok() || session.empty() || ended) return status;
    has_served_ = true;
    for (Slot& slot : slots_) TakeRequest(&slot);
    return absl::OkStatus();
  }

  void TakeRequest(Slot* const slot) {
    const nlohmann::json request = folder_.Read(RequestName(slot->name));
    const bool is_mine = io::TextIn(request, "session") == session_ &&
                         io::TextIn(request, "token") == token_ &&
                         request.contains("request");
    const int serial =
        is_mine ? static_cast<int>(io::CountIn(request, "serial", -1)) : -1;
    if (serial == slot->serial) return;
    slot->pool->StopAll();
    slot->serial = serial;
    if (serial >= 0) slot->pool->Start(serial, request["request"]);
  }

  absl::Status Answer() {
    for (Slot& slot : slots_) {
      if (slot.pool->num_running() == 0) continue;
      const auto result = slot.pool->Wait(0.);
      if (!result.has_value()) continue;
      const absl::Status status = folder_.Write({{"session", session_},
                                                 {"token", token_},
                                                 {"serial", result->id},
                                                 {"answer", result->answer}},
                                                AnswerName(slot.name));
      if (!status.ok()) return status;
    }
    return absl::OkStatus();
  }

  const SharedFolderOptions options_;
  const SharedFolder folder_;
  const std::string token_;
  std::vector<Slot> slots_;
  std::string session_;                        // of the coordinator
  absl::optional<std::string> first_session_;  // when this task began
  double last_beat_ = -1.;                     // of task 0
  double last_heard_ = 0.;                     // seconds
  int beat_ = 0;
  bool has_written_ = false;
  double last_written_ = 0.;  // seconds
  bool has_served_ = false;
  bool ended_ = false;
};

}  // namespace

absl::Status ServeSharedFolder(const SharedFolderOptions& options,
                               RunFunction run) {
  CHECK_GT(options.task, 0);
  const absl::Status found = SharedFolder(options.folder).Check();
  if (!found.ok()) return found;
  return Server(options, run).Run();
}

}  // namespace tuning
}  // namespace cartographer_ext
