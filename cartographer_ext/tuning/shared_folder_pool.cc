// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
#include "cartographer_ext/tuning/shared_folder_pool.h"

#include <dirent.h>
#include <errno.h>
#include <stdio.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <chrono>
#include <fstream>
#include <iterator>
#include <random>
#include <thread>
#include <utility>
#include <vector>

#include "absl/strings/match.h"
#include "absl/strings/numbers.h"
#include "absl/strings/str_cat.h"
#include "absl/strings/strip.h"
#include "glog/logging.h"

namespace cartographer_ext {
namespace tuning {
namespace {

constexpr char kCoordinator[] = "coordinator.json";
constexpr char kRequest[] = ".request.json";
constexpr char kAnswer[] = ".answer.json";
constexpr char kRunning[] = "running";
constexpr char kEnded[] = "ended";
// More would be a damaged file.
constexpr int kMaxSlots = 10000;
// A run is waited for in pieces of this length, so that beats go on.
constexpr double kPauseSeconds = 0.05;

double Now() {
  return std::chrono::duration<double>(
             std::chrono::steady_clock::now().time_since_epoch())
      .count();
}

void Sleep(const double seconds) {
  std::this_thread::sleep_for(std::chrono::duration<double>(seconds));
}

// Differs from that of every other process.
std::string MakeToken() {
  char host[256] = "";
  gethostname(host, sizeof(host) - 1);
  std::random_device random;
  return absl::StrCat(host, "-", getpid(), "-", absl::Hex(random()),
                      absl::Hex(random()));
}

std::string TaskName(const int task) { return absl::StrCat("task-", task); }

std::string SlotName(const std::string& task, const int slot) {
  return absl::StrCat(task, "-", slot);
}

// An object, or null if the file is missing or damaged.
nlohmann::json ReadObject(const std::string& path) {
  std::ifstream stream(path, std::ios::binary);
  if (!stream) return nullptr;
  const std::string text(std::istreambuf_iterator<char>(stream), {});
  auto json = nlohmann::json::parse(text, nullptr, /*allow_exceptions=*/false);
  return json.is_object() ? std::move(json) : nlohmann::json(nullptr);
}

// Replaces the file as a whole. It need not survive a loss of power, and must
// be visible at once, so AtomicFile does not serve.
absl::Status WriteObject(const nlohmann::json& json, const std::string& path) {
  const std::string temporary = absl::StrCat(path, ".", getpid(), ".tmp");
  {
    std::ofstream stream(temporary, std::ios::binary);
    stream << json.dump(-1, ' ', false,
                        nlohmann::json::error_handler_t::replace);
    stream.close();
    if (stream && rename(temporary.c_str(), path.c_str()) == 0) {
      return absl::OkStatus();
    }
  }
  const std::string error = strerror(errno);
  unlink(temporary.c_str());
  return absl::UnavailableError(
      absl::StrCat(path, ": cannot be written: ", error));
}

std::string TextOf(const nlohmann::json& json, const char* const key) {
  if (!json.is_object()) return "";
  const auto found = json.find(key);
  return found != json.end() && found->is_string() ? found->get<std::string>()
                                                   : "";
}

double NumberOf(const nlohmann::json& json, const char* const key) {
  if (!json.is_object()) return -1.;
  const auto found = json.find(key);
  return found != json.end() && found->is_number() ? found->get<double>() : -1.;
}

std::vector<std::string> NamesIn(const std::string& path) {
  std::vector<std::string> names;
  DIR* const folder = opendir(path.c_str());
  if (folder == nullptr) return names;
  while (const dirent* const entry = readdir(folder)) {
    names.push_back(entry->d_name);
  }
  closedir(folder);
  std::sort(names.begin(), names.end());
  return names;
}

absl::Status CheckFolder(const std::string& path) {
  struct stat state;
  if (stat(path.c_str(), &state) == 0 && S_ISDIR(state.st_mode)) {
    return absl::OkStatus();
  }
  return absl::NotFoundError(absl::StrCat(path, ": is not a folder"));
}

nlohmann::json KilledAnswer(const std::string& slot, const double seconds) {
  nlohmann::json answer = Failure(
      absl::StrCat("the task that ran it (", slot, ") is not alive any more"));
  answer["killed"] = true;
  answer["wall_seconds"] = seconds;
  answer["cpu_seconds"] = 0.;
  return answer;
}

// A task other than 0.
class Server {
 public:
  Server(const SharedFolderOptions& options, const RunFunction& run)
      : options_(options), token_(MakeToken()) {
    for (int i = 0; i < options.num_workers; ++i) {
      slots_.emplace_back(SlotName(TaskName(options.task), i),
                          std::unique_ptr<LocalWorkerPool>(new LocalWorkerPool(
                              1, options.max_cpu_seconds, run)));
    }
  }

  absl::Status Run() {
    last_heard_ = Now();
    while (true) {
      const absl::Status status = Poll();
      if (!status.ok() || ended_) {
        if (status.code() != absl::StatusCode::kAlreadyExists) {
          unlink(
              PathOf(absl::StrCat(TaskName(options_.task), ".json")).c_str());
        }
        return status;
      }
      const double next = Now() + options_.poll_seconds;
      while (Now() < next) {
        const absl::Status answered = Answer();
        if (!answered.ok()) return answered;
        Sleep(std::min(kPauseSeconds, options_.poll_seconds));
      }
    }
  }

 private:
  struct Slot {
    Slot(std::string name, std::unique_ptr<LocalWorkerPool> pool)
        : name(std::move(name)), pool(std::move(pool)) {}
    std::string name;
    std::unique_ptr<LocalWorkerPool> pool;
    int serial = -1;  // of the last request
  };

  std::string PathOf(const std::string& name) const {
    return absl::StrCat(options_.folder, "/", name);
  }

  absl::Status Beat() {
    const std::string path =
        PathOf(absl::StrCat(TaskName(options_.task), ".json"));
    const std::string owner = TextOf(ReadObject(path), "token");
    if (has_written_ && !owner.empty() && owner != token_) {
      return absl::AlreadyExistsError(
          absl::StrCat(options_.folder, ": another process is task ",
                       options_.task, " of the same job"));
    }
    has_written_ = true;
    return WriteObject(
        {{"token", token_}, {"beat", ++beat_}, {"slots", slots_.size()}}, path);
  }

  absl::Status Poll() {
    const nlohmann::json coordinator = ReadObject(PathOf(kCoordinator));
    const std::string session = TextOf(coordinator, "session");
    const double beat = NumberOf(coordinator, "beat");
    if (session != session_ || beat != last_beat_) last_heard_ = Now();
    last_beat_ = beat;
    if (session != session_) {
      session_ = session;
      for (Slot& slot : slots_) {
        slot.pool->StopAll();
        slot.serial = -1;
      }
    }
    const bool ended = TextOf(coordinator, "state") == kEnded;
    if (ended && has_served_) {
      ended_ = true;
      return absl::OkStatus();
    }
    if (Now() - last_heard_ > options_.wait_seconds) {
      ended_ = ended;  // it had ended before this task began
      return ended ? absl::OkStatus()
                   : absl::DeadlineExceededError(absl::StrCat(
                         options_.folder, ": no sign of task 0 for ",
                         options_.wait_seconds, " s"));
    }
    if (session.empty() || ended) return absl::OkStatus();
    has_served_ = true;
    const absl::Status status = Beat();
    if (!status.ok()) return status;
    for (Slot& slot : slots_) TakeRequest(&slot);
    return absl::OkStatus();
  }

  void TakeRequest(Slot* const slot) {
    const nlohmann::json request =
        ReadObject(PathOf(absl::StrCat(slot->name, kRequest)));
    const bool is_mine = TextOf(request, "session") == session_ &&
                         TextOf(request, "token") == token_ &&
                         request.contains("request");
    const int serial =
        is_mine ? static_cast<int>(NumberOf(request, "serial")) : -1;
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
      const absl::Status status =
          WriteObject({{"session", session_},
                       {"token", token_},
                       {"serial", result->id},
                       {"answer", result->answer}},
                      PathOf(absl::StrCat(slot.name, kAnswer)));
      if (!status.ok()) return status;
    }
    return absl::OkStatus();
  }

  const SharedFolderOptions options_;
  const std::string token_;
  std::vector<Slot> slots_;
  std::string session_;
  double last_beat_ = -1.;  // of task 0
  double last_heard_ = 0.;  // seconds
  int beat_ = 0;
  bool has_written_ = false;
  bool has_served_ = false;
  bool ended_ = false;
};

}  // namespace

SharedFolderPool::SharedFolderPool(const SharedFolderOptions& options,
                                   RunFunction run)
    : options_(options),
      session_(MakeToken()),
      local_(options.num_workers, options.max_cpu_seconds, std::move(run)) {}

absl::StatusOr<std::unique_ptr<SharedFolderPool>> SharedFolderPool::Create(
    const SharedFolderOptions& options, RunFunction run) {
  const absl::Status found = CheckFolder(options.folder);
  if (!found.ok()) return found;
  const std::string path = absl::StrCat(options.folder, "/", kCoordinator);
  const nlohmann::json other = ReadObject(path);
  if (TextOf(other, "state") == kRunning) {
    // It was killed, or it is alive.
    Sleep(3. * options.poll_seconds);
    if (ReadObject(path) != other) {
      return absl::AlreadyExistsError(absl::StrCat(
          options.folder, ": another process is task 0 of the same job"));
    }
  }
  std::unique_ptr<SharedFolderPool> pool(
      new SharedFolderPool(options, std::move(run)));
  // Left by an earlier search; tasks that are alive write theirs again.
  for (const std::string& name : NamesIn(options.folder)) {
    if (absl::StartsWith(name, "task-")) unlink(pool->PathOf(name).c_str());
  }
  const absl::Status status = pool->Beat(kRunning);
  if (!status.ok()) return status;
  return pool;
}

SharedFolderPool::~SharedFolderPool() {
  StopAll();
  const absl::Status status = Beat(kEnded);
  if (!status.ok()) LOG(WARNING) << status.message();
  for (const std::string& name : NamesIn(options_.folder)) {
    if (absl::EndsWith(name, kAnswer)) unlink(PathOf(name).c_str());
  }
}

std::string SharedFolderPool::PathOf(const std::string& name) const {
  return absl::StrCat(options_.folder, "/", name);
}

absl::Status SharedFolderPool::Beat(const char* const state) {
  return WriteObject(
      {{"session", session_}, {"beat", ++beat_}, {"state", state}},
      PathOf(kCoordinator));
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
  // Others first: this process distributes as well.
  const std::string slot = IdleSlot();
  if (slot.empty()) {
    local_.Start(id, request);
    return;
  }
  const std::string& token = tasks_.at(slot.substr(0, slot.rfind('-'))).token;
  running_[slot] = {id, ++last_serial_, token, Now()};
  unlink(PathOf(absl::StrCat(slot, kAnswer)).c_str());
  const absl::Status status = WriteObject({{"session", session_},
                                           {"token", token},
                                           {"serial", last_serial_},
                                           {"request", request}},
                                          PathOf(absl::StrCat(slot, kRequest)));
  // The run is then reported as killed when its task is found to be idle.
  if (!status.ok()) {
    LOG(WARNING) << status.message();
    running_[slot].token.clear();
  }
}

void SharedFolderPool::FindTasks() {
  const double now = Now();
  std::map<std::string, Task> alive;
  for (const std::string& name : NamesIn(options_.folder)) {
    const std::string stem(absl::StripSuffix(name, ".json"));
    int number = 0;
    if (stem == name ||
        !absl::SimpleAtoi(absl::StripPrefix(stem, "task-"), &number) ||
        TaskName(number) != stem) {
      continue;
    }
    const nlohmann::json json = ReadObject(PathOf(name));
    const double beat = NumberOf(json, "beat");
    const double slots = NumberOf(json, "slots");
    Task task;
    task.token = TextOf(json, "token");
    if (task.token.empty() || !(slots >= 1.) || !(slots <= kMaxSlots)) continue;
    const auto known = tasks_.find(stem);
    task.beat = beat;
    task.num_slots = static_cast<int>(slots);
    const bool is_news = known == tasks_.end() ||
                         known->second.token != task.token ||
                         known->second.beat != beat;
    task.beat_seconds = is_news ? now : known->second.beat_seconds;
    if (now - task.beat_seconds > options_.silent_seconds) {
      // Otherwise it would be news again.
      unlink(PathOf(name).c_str());
      continue;
    }
    alive[stem] = task;
  }
  tasks_ = std::move(alive);
}

void SharedFolderPool::Poll() {
  if (Now() - last_poll_ < options_.poll_seconds) return;
  const absl::Status status = Beat(kRunning);
  if (!status.ok()) {
    LOG_EVERY_N(WARNING, 100) << status.message();
  }
  FindTasks();
  last_poll_ = Now();
}

absl::optional<WorkerResult> SharedFolderPool::TakeRemoteResult() {
  for (auto entry = running_.begin(); entry != running_.end(); ++entry) {
    const std::string slot = entry->first;
    const RemoteRun run = entry->second;
    const nlohmann::json json = ReadObject(PathOf(absl::StrCat(slot, kAnswer)));
    const auto task = tasks_.find(slot.substr(0, slot.rfind('-')));
    WorkerResult result;
    result.id = run.id;
    if (TextOf(json, "session") == session_ &&
        TextOf(json, "token") == run.token &&
        NumberOf(json, "serial") == run.serial && json.contains("answer")) {
      result.answer = json["answer"];
    } else if (task == tasks_.end() || task->second.token != run.token) {
      result.answer = KilledAnswer(slot, Now() - run.start);
    } else {
      continue;
    }
    unlink(PathOf(absl::StrCat(slot, kRequest)).c_str());
    unlink(PathOf(absl::StrCat(slot, kAnswer)).c_str());
    running_.erase(entry);
    return result;
  }
  return absl::nullopt;
}

absl::optional<WorkerResult> SharedFolderPool::Wait(
    const double timeout_seconds) {
  const double end = Now() + timeout_seconds;
  double next_look = 0.;
  while (true) {
    Poll();
    auto result = local_.Wait(0.);
    if (result.has_value()) return result;
    if (!running_.empty() && Now() >= next_look) {
      result = TakeRemoteResult();
      if (result.has_value()) return result;
      next_look = Now() + std::min(kPauseSeconds, options_.poll_seconds);
    }
    const double left = end - Now();
    if (left <= 0.) return absl::nullopt;
    Sleep(std::min(0.002, left));
  }
}

void SharedFolderPool::StopAll() {
  local_.StopAll();
  for (const auto& entry : running_) {
    unlink(PathOf(absl::StrCat(entry.first, kRequest)).c_str());
  }
  running_.clear();
}

absl::Status ServeSharedFolder(const SharedFolderOptions& options,
                               RunFunction run) {
  CHECK_GT(options.task, 0);
  const absl::Status found = CheckFolder(options.folder);
  if (!found.ok()) return found;
  return Server(options, run).Run();
}

}  // namespace tuning
}  // namespace cartographer_ext
