// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
#include "cartographer_ext/tuning/workers/shared_folder_pool.h"

#include <algorithm>
#include <utility>

#include "absl/strings/match.h"
#include "absl/strings/numbers.h"
#include "absl/strings/str_cat.h"
#include "absl/strings/strip.h"
#include "cartographer_ext/io/bounded_json.h"
#include "glog/logging.h"

namespace cartographer_ext {
namespace tuning {
namespace {

// A file that claims more is damaged.
constexpr int kMaxSlots = 10000;

nlohmann::json KilledAnswer(const std::string& slot, const double seconds) {
  return WithTimes(KilledFailure(absl::StrCat("the task that ran it (", slot,
                                              ") is not alive any more")),
                   seconds, 0.);
}

}  // namespace

SharedFolderPool::SharedFolderPool(const SharedFolderOptions& options,
                                   RunFunction run)
    : options_(options),
      folder_(options.folder),
      session_(MakeToken()),
      local_(options.num_workers, options.max_cpu_seconds, std::move(run)) {}

absl::StatusOr<std::unique_ptr<SharedFolderPool>> SharedFolderPool::Create(
    const SharedFolderOptions& options, RunFunction run) {
  const SharedFolder folder(options.folder);
  const absl::Status found = folder.Check();
  if (!found.ok()) return found;
  const nlohmann::json other = folder.Read(SharedFolder::kCoordinator);
  if (io::TextIn(other, "state") == SharedFolder::kRunning) {
    // The other process was killed, or it is alive and its beat will change.
    SleepFor(3. * options.poll_seconds);
    if (folder.Read(SharedFolder::kCoordinator) != other) {
      return absl::AlreadyExistsError(absl::StrCat(
          options.folder, ": another process is task 0 of the same job"));
    }
  }
  std::unique_ptr<SharedFolderPool> pool(
      new SharedFolderPool(options, std::move(run)));
  // Left by an earlier search; tasks that are alive write theirs again.
  for (const std::string& name : folder.Names()) {
    // Temporary files belong to tasks that are writing.
    if (absl::StartsWith(name, "task-") && absl::EndsWith(name, ".json")) {
      folder.Remove(name);
    }
  }
  const absl::Status status = pool->Beat(SharedFolder::kRunning);
  if (!status.ok()) return status;
  return pool;
}

SharedFolderPool::~SharedFolderPool() {
  StopAll();
  const absl::Status status = Beat(SharedFolder::kEnded);
  if (!status.ok()) LOG(WARNING) << status.message();
  for (const std::string& name : folder_.Names()) {
    if (absl::StartsWith(name, "task-") && IsAnswer(name)) {
      folder_.Remove(name);
    }
  }
}

absl::Status SharedFolderPool::Beat(const char* const state) {
  return folder_.Write(
      {{"session", session_}, {"beat", ++beat_}, {"state", state}},
      SharedFolder::kCoordinator);
}

int SharedFolderPool::num_workers() const {
  int workers = local_.num_workers();
  for (const auto& task : tasks_) workers += task.second.num_slots;
  // Runs of tasks that have just died still count as running.
  return std::max(workers, num_running());
}

int SharedFolderPool::num_running() const {
  return local_.num_running() + static_cast<int>(running_.size());
}

std::string SharedFolderPool::IdleSlot() const {
  for (const auto& task : tasks_) {
    for (int i = 0; i < task.second.num_slots; ++i) {
      const std::string slot = SlotName(task.first, i);
      if (running_.count(slot) == 0) return slot;
    }
  }
  return "";
}

void SharedFolderPool::Start(const int id, const nlohmann::json& request) {
  CHECK_LT(num_running(), num_workers());
  // Other tasks first, because this process also distributes runs.
  const std::string slot = IdleSlot();
  if (slot.empty()) {
    local_.Start(id, request);
    return;
  }
  const std::string& token = tasks_.at(TaskOfSlot(slot)).token;
  running_[slot] = {id, ++last_serial_, token, SteadySeconds()};
  folder_.Remove(AnswerName(slot));
  const absl::Status status = folder_.Write({{"session", session_},
                                             {"token", token},
                                             {"serial", last_serial_},
                                             {"request", request}},
                                            RequestName(slot));
  // The run is then reported as killed when its task is found to be idle.
  if (!status.ok()) {
    LOG(WARNING) << status.message();
    running_[slot].token.clear();
  }
}

void SharedFolderPool::FindTasks() {
  const double now = SteadySeconds();
  std::map<std::string, Task> alive;
  for (const std::string& name : folder_.Names()) {
    const std::string stem(absl::StripSuffix(name, ".json"));
    int number = 0;
    if (stem == name ||
        !absl::SimpleAtoi(absl::StripPrefix(stem, "task-"), &number) ||
        TaskName(number) != stem) {
      continue;
    }
    const nlohmann::json json = folder_.Read(name);
    const double beat = io::NumberIn(json, "beat", -1.);
    const double slots = io::NumberIn(json, "slots", -1.);
    Task task;
    task.token = io::TextIn(json, "token");
    if (task.token.empty() || !(slots >= 1.) || !(slots <= kMaxSlots)) continue;
    const auto known = tasks_.find(stem);
    task.beat = beat;
    task.num_slots = static_cast<int>(slots);
    const bool is_news = known == tasks_.end() ||
                         known->second.token != task.token ||
                         known->second.beat != beat;
    task.beat_seconds = is_news ? now : known->second.beat_seconds;
    if (now - task.beat_seconds > options_.silent_seconds) {
      // Otherwise it would be taken for a new task at the next look.
      folder_.Remove(name);
      continue;
    }
    alive[stem] = task;
  }
  tasks_ = std::move(alive);
}

void SharedFolderPool::Poll() {
  if (SteadySeconds() - last_poll_ < options_.poll_seconds) return;
  const absl::Status status = Beat(SharedFolder::kRunning);
  if (!status.ok()) {
    LOG_EVERY_N(WARNING, 100) << status.message();
  }
  FindTasks();
  last_poll_ = SteadySeconds();
}

absl::optional<WorkerResult> SharedFolderPool::TakeRemoteResult() {
  for (auto entry = running_.begin(); entry != running_.end(); ++entry) {
    const std::string slot = entry->first;
    const RemoteRun run = entry->second;
    const nlohmann::json json = folder_.Read(AnswerName(slot));
    const auto task = tasks_.find(TaskOfSlot(slot));
    WorkerResult result;
    result.id = run.id;
    if (io::TextIn(json, "session") == session_ &&
        io::TextIn(json, "token") == run.token &&
        io::NumberIn(json, "serial", -1.) == run.serial &&
        json.contains("answer")) {
      result.answer = json["answer"];
    } else if (task == tasks_.end() || task->second.token != run.token) {
      result.answer = KilledAnswer(slot, SteadySeconds() - run.start);
    } else {
      continue;
    }
    folder_.Remove(RequestName(slot));
    folder_.Remove(AnswerName(slot));
    running_.erase(entry);
    return result;
  }
  return absl::nullopt;
}

absl::optional<WorkerResult> SharedFolderPool::Wait(
    const double timeout_seconds) {
  const double end = SteadySeconds() + timeout_seconds;
  double next_look = 0.;
  while (true) {
    Poll();
    auto result = local_.Wait(0.);
    if (result.has_value()) return result;
    if (!running_.empty() && SteadySeconds() >= next_look) {
      result = TakeRemoteResult();
      if (result.has_value()) return result;
      next_look = SteadySeconds() + options_.pause_seconds();
    }
    const double left = end - SteadySeconds();
    if (left <= 0.) return absl::nullopt;
    SleepFor(std::min(0.002, left));
  }
}

void SharedFolderPool::StopAll() {
  local_.StopAll();
  for (const auto& entry : running_) {
    folder_.Remove(RequestName(entry.first));
  }
  running_.clear();
}

}  // namespace tuning
}  // namespace cartographer_ext
