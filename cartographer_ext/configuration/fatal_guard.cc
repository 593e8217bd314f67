// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
#include "cartographer_ext/configuration/fatal_guard.h"

#include <errno.h>
#include <fcntl.h>
#include <signal.h>
#include <string.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

#include <string>

#include "absl/strings/ascii.h"
#include "absl/strings/str_cat.h"
#include "glog/logging.h"

namespace cartographer_ext {
namespace evaluation {
namespace {

constexpr int kFatalExitCode = 93;
// Exit code of a child whose `body` returned; 0 would be ambiguous.
constexpr int kReturnedExitCode = 94;

// Forwards fatal messages to the parent.
class FatalSink : public google::LogSink {
 public:
  explicit FatalSink(const int descriptor) : descriptor_(descriptor) {}

  using google::LogSink::send;
  void send(google::LogSeverity severity, const char* /*full_filename*/,
            const char* /*base_filename*/, int /*line*/,
            const google::LogMessageTime& /*time*/, const char* message,
            size_t message_length) override {
    if (severity != google::GLOG_FATAL) return;
    while (message_length > 0) {
      const ssize_t written = write(descriptor_, message, message_length);
      if (written <= 0) return;
      message += written;
      message_length -= static_cast<size_t>(written);
    }
  }

 private:
  const int descriptor_;
};

[[noreturn]] void ExitAfterFatal() { _exit(kFatalExitCode); }

[[noreturn]] void RunChild(const std::function<void()>& body,
                           const int max_cpu_seconds, const int descriptor) {
  const int null_device = open("/dev/null", O_RDWR);
  if (null_device >= 0) {
    dup2(null_device, STDOUT_FILENO);
    dup2(null_device, STDERR_FILENO);
  }
  // At the limit the system ends the child.
  const rlimit limit = {static_cast<rlim_t>(max_cpu_seconds),
                        static_cast<rlim_t>(max_cpu_seconds) + 1};
  setrlimit(RLIMIT_CPU, &limit);
  const rlimit no_core = {0, 0};
  setrlimit(RLIMIT_CORE, &no_core);
  FatalSink sink(descriptor);
  google::AddLogSink(&sink);
  google::InstallFailureFunction(&ExitAfterFatal);
  body();
  _exit(kReturnedExitCode);
}

std::string ReadAll(const int descriptor) {
  std::string text;
  char buffer[4096];
  while (true) {
    const ssize_t count = read(descriptor, buffer, sizeof(buffer));
    if (count < 0 && errno == EINTR) continue;
    if (count <= 0) return text;
    text.append(buffer, static_cast<size_t>(count));
  }
}

std::string Readable(const std::string& message) {
  std::string text(absl::StripAsciiWhitespace(message));
  return text.empty() ? "it ended the program without a message" : text;
}

}  // namespace

absl::Status TryInChildProcess(const std::function<void()>& body,
                               const int max_cpu_seconds) {
  int ends[2];
  if (pipe(ends) != 0) {
    return absl::InternalError(absl::StrCat("pipe: ", strerror(errno)));
  }
  const pid_t child = fork();
  if (child < 0) {
    const int error = errno;
    close(ends[0]);
    close(ends[1]);
    return absl::InternalError(absl::StrCat("fork: ", strerror(error)));
  }
  if (child == 0) {
    close(ends[0]);
    RunChild(body, max_cpu_seconds, ends[1]);
  }
  close(ends[1]);
  const std::string message = ReadAll(ends[0]);
  close(ends[0]);
  int state = 0;
  while (waitpid(child, &state, 0) < 0 && errno == EINTR) {
  }
  if (WIFEXITED(state) && WEXITSTATUS(state) == kReturnedExitCode) {
    return absl::OkStatus();
  }
  if (WIFEXITED(state) && WEXITSTATUS(state) == 0) {
    return absl::InvalidArgumentError("it ended the program (os.exit)");
  }
  if (WIFSIGNALED(state) && WTERMSIG(state) == SIGXCPU) {
    return absl::InvalidArgumentError(
        absl::StrCat("it does not terminate: more than ", max_cpu_seconds,
                     " s of CPU time"));
  }
  if (WIFEXITED(state) && WEXITSTATUS(state) == kFatalExitCode) {
    return absl::InvalidArgumentError(Readable(message));
  }
  return absl::InternalError(
      WIFSIGNALED(state)
          ? absl::StrCat("the check crashed: ", strsignal(WTERMSIG(state)))
          : absl::StrCat("the check ended with code ", WEXITSTATUS(state)));
}

}  // namespace evaluation
}  // namespace cartographer_ext
