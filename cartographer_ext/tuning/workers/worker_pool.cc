// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
#include "cartographer_ext/tuning/workers/worker_pool.h"

#include <errno.h>
#include <fcntl.h>
#include <signal.h>
#include <string.h>
#include <sys/mman.h>
#include <sys/prctl.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <thread>

#include "absl/strings/str_cat.h"
#include "absl/strings/str_format.h"
#include "absl/strings/str_split.h"
#include "glog/logging.h"

namespace cartographer_ext {
namespace tuning {
namespace {

double Seconds(const timeval& time) {
  return static_cast<double>(time.tv_sec) + 1e-6 * time.tv_usec;
}

std::string ReadFromStart(const int descriptor) {
  std::string text;
  char buffer[4096];
  while (true) {
    const ssize_t count = pread(descriptor, buffer, sizeof(buffer),
                                static_cast<off_t>(text.size()));
    if (count < 0 && errno == EINTR) continue;
    if (count <= 0) return text;
    text.append(buffer, static_cast<size_t>(count));
  }
}

void WriteAll(const int descriptor, const std::string& text) {
  size_t written = 0;
  while (written < text.size()) {
    const ssize_t count =
        write(descriptor, text.data() + written, text.size() - written);
    if (count < 0 && errno == EINTR) continue;
    if (count <= 0) return;  // an answer that is cut is no answer
    written += static_cast<size_t>(count);
  }
}

// The most informative line: that of a failed check, otherwise the last one.
std::string TellingLine(const std::string& messages) {
  std::string telling;
  for (const absl::string_view line :
       absl::StrSplit(messages, '\n', absl::SkipWhitespace())) {
    const bool is_fatal =
        line.size() > 5 && line[0] == 'F' && line[1] >= '0' && line[1] <= '9';
    telling = std::string(line);
    if (is_fatal) break;
  }
  return telling;
}

std::string HowItEnded(const int state, const bool was_killed,
                       const std::string& messages) {
  std::string text = "it ended without a result";
  if (WIFSIGNALED(state)) {
    text = was_killed ? "it was killed from outside (out of memory?)"
           : WTERMSIG(state) == SIGXCPU || WTERMSIG(state) == SIGKILL
               ? "it was killed (limit of CPU time)"
               : absl::StrCat("it crashed: ", strsignal(WTERMSIG(state)));
  } else if (WEXITSTATUS(state) != 0) {
    text = absl::StrCat("it ended with code ", WEXITSTATUS(state));
  }
  const std::string telling = TellingLine(messages);
  return telling.empty() ? text : absl::StrCat(text, ": ", telling);
}

[[noreturn]] void RunChild(const RunFunction& run,
                           const nlohmann::json& request, const pid_t parent,
                           const double max_cpu_seconds, const int answer,
                           const int messages) {
  prctl(PR_SET_PDEATHSIG, SIGKILL);
  if (getppid() != parent) _exit(1);  // it died before that took effect
  const int null_device = open("/dev/null", O_RDWR);
  if (null_device >= 0) {
    dup2(null_device, STDIN_FILENO);
    dup2(null_device, STDOUT_FILENO);
  }
  dup2(messages, STDERR_FILENO);
  struct rlimit limit = {0, 0};  // no core dumps
  setrlimit(RLIMIT_CORE, &limit);
  if (max_cpu_seconds > 0.) {
    limit.rlim_cur = static_cast<rlim_t>(std::ceil(max_cpu_seconds));
    limit.rlim_max = limit.rlim_cur + 5;
    setrlimit(RLIMIT_CPU, &limit);
  }
  const nlohmann::json result = run(request);
  WriteAll(answer, result.dump(-1, ' ', false,
                               nlohmann::json::error_handler_t::replace));
  _exit(0);
}

}  // namespace

double SteadySeconds() {
  return std::chrono::duration<double>(
             std::chrono::steady_clock::now().time_since_epoch())
      .count();
}

void SleepFor(const double seconds) {
  std::this_thread::sleep_for(std::chrono::duration<double>(seconds));
}

nlohmann::json Failure(const std::string& message) {
  return {{"ok", false}, {"message", message}};
}

nlohmann::json KilledFailure(const std::string& message) {
  nlohmann::json answer = Failure(message);
  answer["killed"] = true;
  return answer;
}

nlohmann::json WithTimes(nlohmann::json answer, const double wall_seconds,
                         const double cpu_seconds) {
  answer["wall_seconds"] = wall_seconds;
  answer["cpu_seconds"] = cpu_seconds;
  return answer;
}

LocalWorkerPool::LocalWorkerPool(const int num_workers,
                                 const double max_cpu_seconds, RunFunction run)
    : num_workers_(num_workers),
      max_cpu_seconds_(max_cpu_seconds),
      run_(std::move(run)) {
  CHECK_GE(num_workers, 1);
}

LocalWorkerPool::~LocalWorkerPool() { StopAll(); }

void LocalWorkerPool::Start(const int id, const nlohmann::json& request) {
  CHECK_LT(num_running(), num_workers_);
  Child child;
  child.id = id;
  child.answer = memfd_create("answer", MFD_CLOEXEC);
  child.messages = memfd_create("messages", MFD_CLOEXEC);
  child.start = SteadySeconds();
  const pid_t parent = getpid();
  const pid_t pid = child.answer < 0 || child.messages < 0 ? -1 : fork();
  if (pid == 0) {
    RunChild(run_, request, parent, max_cpu_seconds_, child.answer,
             child.messages);
  }
  if (pid > 0) {
    children_[pid] = child;
    return;
  }
  const std::string error = strerror(errno);
  if (child.answer >= 0) close(child.answer);
  if (child.messages >= 0) close(child.messages);
  failed_.push_back(
      {id,
       WithTimes(Failure("no process could be started: " + error), 0., 0.)});
}

absl::optional<WorkerResult> LocalWorkerPool::Reap() {
  if (!failed_.empty()) {
    const WorkerResult result = failed_.front();
    failed_.erase(failed_.begin());
    return result;
  }
  for (auto entry = children_.begin(); entry != children_.end(); ++entry) {
    int state = 0;
    struct rusage usage;
    const pid_t pid = wait4(entry->first, &state, WNOHANG, &usage);
    if (pid != entry->first) continue;
    const Child child = entry->second;
    children_.erase(entry);
    nlohmann::json answer =
        nlohmann::json::parse(ReadFromStart(child.answer), nullptr,
                              /*allow_exceptions=*/false);
    const double cpu_seconds =
        Seconds(usage.ru_utime) + Seconds(usage.ru_stime);
    if (!answer.is_object() || !answer.contains("ok")) {
      // The limit of CPU time ends a run with SIGXCPU, then with SIGKILL.
      const bool was_killed =
          WIFSIGNALED(state) &&
          (WTERMSIG(state) == SIGKILL || WTERMSIG(state) == SIGTERM) &&
          !(max_cpu_seconds_ > 0. && cpu_seconds >= max_cpu_seconds_);
      const std::string message =
          HowItEnded(state, was_killed, ReadFromStart(child.messages));
      answer = was_killed ? KilledFailure(message) : Failure(message);
    }
    close(child.answer);
    close(child.messages);
    return WorkerResult{
        child.id, WithTimes(std::move(answer), SteadySeconds() - child.start,
                            cpu_seconds)};
  }
  return absl::nullopt;
}

absl::optional<WorkerResult> LocalWorkerPool::Wait(
    const double timeout_seconds) {
  constexpr double kPauseSeconds = 0.002;
  const double end = SteadySeconds() + timeout_seconds;
  while (true) {
    auto result = Reap();
    if (result.has_value() || SteadySeconds() >= end) return result;
    SleepFor(kPauseSeconds);
  }
}

void LocalWorkerPool::StopAll() {
  for (const auto& entry : children_) kill(entry.first, SIGKILL);
  for (const auto& entry : children_) {
    while (waitpid(entry.first, nullptr, 0) < 0 && errno == EINTR) {
    }
    close(entry.second.answer);
    close(entry.second.messages);
  }
  children_.clear();
  failed_.clear();
}

}  // namespace tuning
}  // namespace cartographer_ext
