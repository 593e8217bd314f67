// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
#include "cartographer_ext/io/ros/rosbag2_reader.h"

#include <dirent.h>
#include <sqlite3.h>

#include <algorithm>
#include <utility>
#include <vector>

#include "absl/memory/memory.h"
#include "absl/status/status.h"
#include "absl/strings/match.h"
#include "absl/strings/str_cat.h"
#include "absl/strings/str_join.h"
#include "cartographer_ext/io/ros/mcap_reader.h"
#include "cartographer_ext/io/ros/sqlite_database.h"

namespace cartographer_ext {
namespace io {
namespace {

// No message of a planar robot is larger, but a damaged file may claim one.
constexpr int kMaxMessageSize = 1 << 28;

struct FinalizeStatement {
  void operator()(sqlite3_stmt* statement) const {
    sqlite3_finalize(statement);
  }
};
using Statement = std::unique_ptr<sqlite3_stmt, FinalizeStatement>;

std::string Text(sqlite3_stmt* statement, const int column) {
  const unsigned char* text = sqlite3_column_text(statement, column);
  return text == nullptr ? "" : reinterpret_cast<const char*>(text);
}

class Db3Container : public RosContainer {
 public:
  explicit Db3Container(const std::string& filename) : filename_(filename) {}

  absl::Status Open() {
    sqlite3* raw = nullptr;
    const int code =
        sqlite3_open_v2(filename_.c_str(), &raw,
                        SQLITE_OPEN_READONLY | SQLITE_OPEN_NOMUTEX, nullptr);
    database_.reset(raw);
    if (code != SQLITE_OK) return Error();
    sqlite3_limit(raw, SQLITE_LIMIT_LENGTH, kMaxMessageSize);
    auto statement = Prepare(
        "SELECT name, type, serialization_format FROM topics ORDER BY id");
    if (!statement.ok()) return statement.status();
    int step;
    while ((step = sqlite3_step(statement->get())) == SQLITE_ROW) {
      RosTopicType type = TypeOfRos2(Text(statement->get(), 1));
      if (Text(statement->get(), 2) != "cdr") type.md5sum.clear();
      topics_[Text(statement->get(), 0)] = type;
    }
    return step == SQLITE_DONE ? absl::OkStatus() : Error();
  }

  std::string format() const override { return "db3"; }
  RosEncoding encoding() const override { return RosEncoding::kCdr; }
  const RosTopics& topics() const override { return topics_; }

  absl::Status Rewind(const std::set<std::string>& topics) override {
    messages_.reset();
    wanted_ = topics;
    // In the order of recording. A statement that sorts or joins would read
    // the whole file first.
    auto statement = Prepare("SELECT id, name FROM topics");
    if (!statement.ok()) return statement.status();
    names_.clear();
    int step;
    while ((step = sqlite3_step(statement->get())) == SQLITE_ROW) {
      names_[sqlite3_column_int64(statement->get(), 0)] =
          Text(statement->get(), 1);
    }
    if (step != SQLITE_DONE) return Error();
    auto messages =
        Prepare("SELECT topic_id, timestamp, data FROM messages ORDER BY id");
    if (!messages.ok()) return messages.status();
    messages_ = std::move(*messages);
    return absl::OkStatus();
  }

  absl::StatusOr<bool> Next(RosMessage* message) override {
    if (messages_ == nullptr) return false;
    while (true) {
      const int step = sqlite3_step(messages_.get());
      if (step == SQLITE_DONE) {
        messages_.reset();
        return false;
      }
      if (step != SQLITE_ROW) return Error();
      const auto name = names_.find(sqlite3_column_int64(messages_.get(), 0));
      if (name == names_.end() || wanted_.count(name->second) == 0) continue;
      message->topic = name->second;
      message->received = sqlite3_column_int64(messages_.get(), 1);
      const void* data = sqlite3_column_blob(messages_.get(), 2);
      const int size = sqlite3_column_bytes(messages_.get(), 2);
      message->data.assign(static_cast<const char*>(data),
                           data == nullptr ? 0 : static_cast<size_t>(size));
      return true;
    }
  }

 private:
  absl::Status Error() const {
    const int code = sqlite3_errcode(database_.get());
    const std::string text =
        absl::StrCat(filename_, ": ", sqlite3_errmsg(database_.get()));
    if (code == SQLITE_NOTADB) return absl::DataLossError(text);
    if (code == SQLITE_CORRUPT) {
      return absl::DataLossError(
          absl::StrCat(text,
                       "; the file is cut off or damaged: try sqlite3 FILE "
                       ".recover | sqlite3 NEW, then ros2 bag reindex"));
    }
    return absl::InvalidArgumentError(
        absl::StrCat(text, " (not a database of rosbag2?)"));
  }

  absl::StatusOr<Statement> Prepare(const char* sql) {
    sqlite3_stmt* raw = nullptr;
    if (sqlite3_prepare_v2(database_.get(), sql, -1, &raw, nullptr) !=
        SQLITE_OK)
      return Error();
    return Statement(raw);
  }

  const std::string filename_;
  SqliteDatabase database_;
  Statement messages_;  // destroyed before the database
  std::map<int64_t, std::string> names_;
  RosTopics topics_;
  std::set<std::string> wanted_;
};

// The files of a folder one after another.
class SplitContainer : public RosContainer {
 public:
  explicit SplitContainer(std::vector<std::unique_ptr<RosContainer>> parts)
      : parts_(std::move(parts)) {
    for (const auto& part : parts_)
      topics_.insert(part->topics().begin(), part->topics().end());
  }

  std::string format() const override { return parts_.front()->format(); }
  RosEncoding encoding() const override { return RosEncoding::kCdr; }
  const RosTopics& topics() const override { return topics_; }
  std::vector<std::string> warnings() const override {
    std::vector<std::string> all;
    for (const auto& part : parts_) {
      for (const std::string& warning : part->warnings())
        all.push_back(warning);
    }
    return all;
  }

  absl::Status Rewind(const std::set<std::string>& topics) override {
    for (const auto& part : parts_) {
      const absl::Status status = part->Rewind(topics);
      if (!status.ok()) return status;
    }
    at_ = 0;
    return absl::OkStatus();
  }

  absl::StatusOr<bool> Next(RosMessage* message) override {
    for (; at_ < parts_.size(); ++at_) {
      const absl::StatusOr<bool> more = parts_[at_]->Next(message);
      if (!more.ok() || *more) return more;
    }
    return false;
  }

 private:
  const std::vector<std::unique_ptr<RosContainer>> parts_;
  RosTopics topics_;
  size_t at_ = 0;
};

// "run_10.db3" comes after "run_9.db3".
bool BeforeByNumber(const std::string& a, const std::string& b) {
  return a.size() != b.size() ? a.size() < b.size() : a < b;
}

}  // namespace

absl::StatusOr<std::unique_ptr<RosContainer>> OpenDb3(
    const std::string& filename) {
  auto container = absl::make_unique<Db3Container>(filename);
  const absl::Status status = container->Open();
  if (!status.ok()) return status;
  return std::unique_ptr<RosContainer>(std::move(container));
}

absl::StatusOr<std::unique_ptr<RosContainer>> OpenRosbag2Folder(
    const std::string& folder) {
  std::vector<std::string> names;
  std::vector<std::string> compressed;
  const std::unique_ptr<DIR, int (*)(DIR*)> directory(opendir(folder.c_str()),
                                                      &closedir);
  if (directory == nullptr)
    return absl::InvalidArgumentError(absl::StrCat(folder, ": cannot be read"));
  while (const dirent* entry = readdir(directory.get())) {
    const std::string name = entry->d_name;
    if (absl::EndsWith(name, ".db3") || absl::EndsWith(name, ".mcap"))
      names.push_back(name);
    if (absl::EndsWith(name, ".zstd")) compressed.push_back(name);
  }
  if (names.empty() && !compressed.empty()) {
    return absl::InvalidArgumentError(
        absl::StrCat(folder, ": its files are compressed as a whole (",
                     compressed.front(), "); unpack them with unzstd first"));
  }
  if (names.empty()) {
    return absl::InvalidArgumentError(absl::StrCat(
        folder,
        ": a folder without .db3 and .mcap files, so not a rosbag2 recording"));
  }
  std::sort(names.begin(), names.end(), BeforeByNumber);
  std::vector<std::unique_ptr<RosContainer>> parts;
  for (const std::string& name : names) {
    const std::string path = absl::StrCat(folder, "/", name);
    auto part = absl::EndsWith(name, ".mcap") ? OpenMcap(path) : OpenDb3(path);
    if (!part.ok()) return part.status();
    parts.push_back(std::move(*part));
  }
  return std::unique_ptr<RosContainer>(
      absl::make_unique<SplitContainer>(std::move(parts)));
}

}  // namespace io
}  // namespace cartographer_ext
