// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
#include "cartographer_ext/tuning/workers/shared_folder.h"

#include <dirent.h>
#include <errno.h>
#include <stdio.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <fstream>
#include <random>

#include "absl/strings/match.h"
#include "absl/strings/str_cat.h"
#include "cartographer_ext/common/bounded_read.h"
#include "cartographer_ext/io/bounded_json.h"

namespace cartographer_ext {
namespace tuning {
namespace {

constexpr char kAnswerEnding[] = ".answer.json";
constexpr size_t kMaxFileSize = 64 << 20;  // of a file that is not damaged
constexpr int kMaxDepth = 16;              // more than a request has

}  // namespace

const char SharedFolder::kCoordinator[] = "coordinator.json";
const char SharedFolder::kRunning[] = "running";
const char SharedFolder::kEnded[] = "ended";

std::string SharedFolder::PathOf(const std::string& name) const {
  return absl::StrCat(path_, "/", name);
}

absl::Status SharedFolder::Check() const {
  struct stat state;
  if (stat(path_.c_str(), &state) == 0 && S_ISDIR(state.st_mode)) {
    return absl::OkStatus();
  }
  return absl::NotFoundError(absl::StrCat(path_, ": is not a folder"));
}

std::vector<std::string> SharedFolder::Names() const {
  std::vector<std::string> names;
  DIR* const folder = opendir(path_.c_str());
  if (folder == nullptr) return names;
  while (const dirent* const entry = readdir(folder)) {
    names.push_back(entry->d_name);
  }
  closedir(folder);
  std::sort(names.begin(), names.end());
  return names;
}

nlohmann::json SharedFolder::Read(const std::string& name) const {
  std::ifstream stream(PathOf(name), std::ios::binary);
  if (!stream) return nullptr;
  std::string text;
  if (!ReadUpTo(kMaxFileSize, &stream, &text) || text.size() > kMaxFileSize) {
    return nullptr;
  }
  auto json = io::ParseBoundedJson(text, kMaxDepth);
  if (!json.is_object()) return nullptr;
  return json;
}

// AtomicFile is not used: it synchronises with the disk, which is not needed
// here, and may wait for the end of a set.
absl::Status SharedFolder::Write(const nlohmann::json& json,
                                 const std::string& name) const {
  const std::string path = PathOf(name);
  const std::string temporary = absl::StrCat(path, ".", getpid(), ".tmp");
  std::ofstream stream(temporary, std::ios::binary);
  stream << json.dump(-1, ' ', false, nlohmann::json::error_handler_t::replace);
  stream.close();
  if (stream && rename(temporary.c_str(), path.c_str()) == 0) {
    return absl::OkStatus();
  }
  const std::string error = strerror(errno);
  unlink(temporary.c_str());
  return absl::UnavailableError(
      absl::StrCat(path, ": cannot be written: ", error));
}

void SharedFolder::Remove(const std::string& name) const {
  unlink(PathOf(name).c_str());
}

std::string TaskName(const int task) { return absl::StrCat("task-", task); }

std::string SlotName(const std::string& task, const int slot) {
  return absl::StrCat(task, "-", slot);
}

std::string TaskOfSlot(const std::string& slot) {
  return slot.substr(0, slot.rfind('-'));
}

std::string RequestName(const std::string& slot) {
  return absl::StrCat(slot, ".request.json");
}

std::string AnswerName(const std::string& slot) {
  return absl::StrCat(slot, kAnswerEnding);
}

bool IsAnswer(const std::string& name) {
  return absl::EndsWith(name, kAnswerEnding);
}

std::string MakeToken() {
  char host[256] = "";
  gethostname(host, sizeof(host) - 1);
  std::random_device random;
  return absl::StrCat(host, "-", getpid(), "-", absl::Hex(random()),
                      absl::Hex(random()));
}

}  // namespace tuning
}  // namespace cartographer_ext
