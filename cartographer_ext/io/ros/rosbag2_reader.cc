// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
#include "cartographer_ext/io/ros/rosbag2_reader.h"

#include <dirent.h>
#include <sqlite3.h>

#include <algorithm>
#include <limits>
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
// Nor has a recording more messages.
constexpr int64_t kMaxId = int64_t{1} << 48;
constexpr int64_t kMinId = std::numeric_limits<int64_t>::min();

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
    absl::Status status = ReadTopics();
    if (absl::IsDataLoss(status)) {
      // Cut off, for example. With this setting SQLite reads what is there.
      cut_off_ = status;
      sqlite3_db_config(raw, SQLITE_DBCONFIG_WRITABLE_SCHEMA, 1, nullptr);
      if (ReadTopics().ok()) status = absl::OkStatus();
    }
    return status;
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
    num_read_ = num_lost_ = 0;
    last_id_ = first_id_ = kMinId;
    problem_ = cut_off_;
    return ReadFrom(kMinId);
  }

  absl::StatusOr<bool> Next(RosMessage* message) override {
    while (messages_ != nullptr) {
      const int step = sqlite3_step(messages_.get());
      if (step == SQLITE_DONE) {
        messages_.reset();
        break;
      }
      if (step != SQLITE_ROW) {
        const absl::Status status = LeaveOut(Error());
        if (!status.ok()) return status;
        continue;
      }
      const int64_t id = sqlite3_column_int64(messages_.get(), 3);
      if (id < first_id_ || (id <= last_id_ && last_id_ != kMinId)) {
        const absl::Status status = LeaveOut(absl::DataLossError(
            absl::StrCat(filename_, ": message ", id, " is out of order")));
        if (!status.ok()) return status;
        continue;
      }
      last_id_ = id;
      const auto name = names_.find(sqlite3_column_int64(messages_.get(), 0));
      const bool wanted =
          name != names_.end() && wanted_.count(name->second) > 0;
      if (!wanted) {
        ++num_read_;
        continue;
      }
      message->topic = name->second;
      message->received =
          std::clamp<TimeNs>(sqlite3_column_int64(messages_.get(), 1),
                             -kMaxRecorded, kMaxRecorded);
      // Null for an empty message, and where the pages of a long one are
      // damaged.
      const void* data = sqlite3_column_blob(messages_.get(), 2);
      const int size = sqlite3_column_bytes(messages_.get(), 2);
      if (data == nullptr &&
          sqlite3_errcode(database_.get()) == SQLITE_CORRUPT) {
        if (problem_.ok()) problem_ = Error();
        ++num_lost_;
        continue;
      }
      ++num_read_;
      message->data.assign(static_cast<const char*>(data),
                           data == nullptr ? 0 : static_cast<size_t>(size));
      return true;
    }
    return false;
  }

  std::vector<std::string> warnings() const override {
    if (problem_.ok()) return {};
    return {absl::StrCat(problem_.message(), "; ",
                         num_lost_ > 0
                             ? absl::StrCat(num_lost_, " messages are lost, ")
                             : "the messages behind it are lost, ",
                         num_read_, " are read")};
  }

 private:
  absl::Status ReadTopics() {
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

  // Messages in the order of recording, from this ID on.
  absl::StatusOr<Statement> MessagesFrom(const int64_t id) {
    auto messages = Prepare(
        "SELECT topic_id, timestamp, data, id FROM messages WHERE id >= ? "
        "ORDER BY id");
    if (messages.ok()) sqlite3_bind_int64(messages->get(), 1, id);
    return messages;
  }

  absl::Status ReadFrom(const int64_t id) {
    auto messages = MessagesFrom(id);
    if (!messages.ok()) return messages.status();
    messages_ = std::move(*messages);
    return absl::OkStatus();
  }

  // Whether a message can be read that has this ID or is behind it, and its ID.
  bool CanReadFrom(const int64_t id, int64_t* const found) {
    const auto messages = MessagesFrom(id);
    if (!messages.ok() || sqlite3_step(messages->get()) != SQLITE_ROW) {
      return false;
    }
    *found = sqlite3_column_int64(messages->get(), 3);
    return *found >= id;
  }

  // Skips damaged pages: looks for the next ID that can be read, in steps that
  // double and then, between the last two of them, halve. An error if nothing
  // can be read.
  absl::Status LeaveOut(const absl::Status& problem) {
    if (!absl::IsDataLoss(problem)) return problem;
    if (problem_.ok()) problem_ = problem;
    messages_.reset();
    // Nothing was read since the last time: what was found then is damaged.
    const bool again = first_id_ > last_id_;
    const int64_t last =
        std::min(kMaxId, std::max(int64_t{0}, again ? first_id_ : last_id_));
    num_lost_ += again ? 1 : 0;
    constexpr int64_t kMaxStep = int64_t{1} << 40;
    int64_t step = 1, found = 0;
    while (step < kMaxStep && !CanReadFrom(last + step, &found)) step *= 2;
    if (step >= kMaxStep) {  // Up to the end
      return num_read_ > 0 ? absl::OkStatus() : problem_;
    }
    int64_t least = step / 2;  // cannot be read
    while (step - least > 1) {
      const int64_t middle = least + (step - least) / 2;
      (CanReadFrom(last + middle, &found) ? step : least) = middle;
    }
    CanReadFrom(last + step, &found);
    num_lost_ += found - last - 1;
    first_id_ = found;
    return ReadFrom(found);
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
  Statement messages_;    // destroyed before the database
  int64_t last_id_ = 0;   // of a message that could be read
  int64_t first_id_ = 0;  // behind the last damage
  int64_t num_read_ = 0;
  int64_t num_lost_ = 0;
  absl::Status cut_off_;  // OK: it is not
  absl::Status problem_;  // with the file, as far as it was read
  std::map<int64_t, std::string> names_;
  RosTopics topics_;
  std::set<std::string> wanted_;
};

// The files of a folder one after another.
class SplitContainer : public RosContainer {
 public:
  // `warnings` are of parts that cannot be read.
  SplitContainer(std::vector<std::unique_ptr<RosContainer>> parts,
                 std::vector<std::string> warnings)
      : parts_(std::move(parts)), warnings_(std::move(warnings)) {
    for (const auto& part : parts_)
      topics_.insert(part->topics().begin(), part->topics().end());
  }

  std::string format() const override { return parts_.front()->format(); }
  RosEncoding encoding() const override { return RosEncoding::kCdr; }
  const RosTopics& topics() const override { return topics_; }
  std::vector<std::string> warnings() const override {
    std::vector<std::string> all = warnings_;
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
  const std::vector<std::string> warnings_;
  RosTopics topics_;
  size_t at_ = 0;
};

// What the files of one recording have in common: "run_9.db3" and "run_10.db3"
// are "run.db3".
std::string WithoutNumber(const std::string& name) {
  const size_t dot = name.rfind('.');
  const size_t underscore = name.find_last_not_of("0123456789", dot - 1);
  return underscore < dot - 1 && name[underscore] == '_'
             ? name.substr(0, underscore) + name.substr(dot)
             : name;
}

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
  bool has_metadata = false;
  while (const dirent* entry = readdir(directory.get())) {
    const std::string name = entry->d_name;
    if (name.front() == '.') continue;  // of the system
    has_metadata |= name == "metadata.yaml";
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
  for (const std::string& name : names) {
    if (has_metadata || WithoutNumber(name) == WithoutNumber(names.front())) {
      continue;
    }
    return absl::InvalidArgumentError(absl::StrCat(
        folder, ": a folder with several recordings (", names.front(), ", ",
        name, "), and without metadata.yaml; name one of them"));
  }
  std::vector<std::unique_ptr<RosContainer>> parts;
  std::vector<std::string> warnings;
  absl::Status first_problem;
  for (const std::string& name : names) {
    const std::string path = absl::StrCat(folder, "/", name);
    auto part = absl::EndsWith(name, ".mcap") ? OpenMcap(path) : OpenDb3(path);
    if (part.ok()) {
      parts.push_back(std::move(*part));
    } else if (absl::IsResourceExhausted(part.status())) {
      return part.status();
    } else {
      warnings.push_back(
          absl::StrCat(part.status().message(), "; this file is left out"));
      if (first_problem.ok()) first_problem = part.status();
    }
  }
  if (parts.empty()) return first_problem;
  return std::unique_ptr<RosContainer>(
      absl::make_unique<SplitContainer>(std::move(parts), std::move(warnings)));
}

}  // namespace io
}  // namespace cartographer_ext
