// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
#include "cartographer_ext/io/ros/ros1/rosbag_reader.h"

#include <exception>
#include <map>
#include <set>
#include <utility>

#include "absl/memory/memory.h"
#include "absl/strings/match.h"
#include "absl/strings/str_cat.h"
#include "absl/types/optional.h"
#include "boost/iostreams/device/mapped_file.hpp"
#include "cartographer_ext/io/expansion_budget.h"
#include "cartographer_ext/io/ros/ros1/rosbag_records.h"
#include "cartographer_ext/io/ros/ros_container.h"

namespace cartographer_ext {
namespace io {
namespace {

constexpr char kMagic[] = "#ROSBAG V2.0\n";

class RosbagContainer : public RosContainer {
 public:
  // Throws where the file cannot be mapped.
  explicit RosbagContainer(const std::string& filename)
      : filename_(filename), file_(filename) {}

  // Reads the whole file once to find its topics and whether it is complete.
  absl::Status Survey() {
    if (!absl::StartsWith(Bytes(), kMagic)) {
      return absl::InvalidArgumentError(
          absl::StrCat(filename_,
                       ": only bags of format 2.0 are read; \"rosbag fix\" "
                       "converts others"));
    }
    Restart();
    RosMessage message;
    while (!at_end_) {
      const absl::StatusOr<bool> more = Step(&message);
      if (!more.ok()) return more.status();
    }
    if (!has_file_header_) {
      return absl::DataLossError(
          absl::StrCat(filename_, ": the bag ends before its first record"));
    }
    if (!has_index_ && problem_.empty()) problem_ = "it has no index";
    return absl::OkStatus();
  }

  std::string format() const override { return "rosbag"; }
  RosEncoding encoding() const override { return RosEncoding::kRos1; }
  const RosTopics& topics() const override { return topics_; }
  std::vector<std::string> warnings() const override {
    if (problem_.empty()) return {};
    return {absl::StrCat(filename_, ": ", problem_,
                         "; read from the beginning without the index")};
  }

  absl::Status Rewind(const std::set<std::string>& topics) override {
    wanted_ = topics;
    Restart();
    return absl::OkStatus();
  }

  absl::StatusOr<bool> Next(RosMessage* message) override {
    while (!at_end_) {
      const absl::StatusOr<bool> found = Step(message);
      if (!found.ok() || *found) return found;
    }
    return false;
  }

 private:
  absl::string_view Bytes() const {
    return absl::string_view(file_.data(), file_.size());
  }

  void Restart() {
    rest_ = Bytes();
    rest_.remove_prefix(sizeof(kMagic) - 1);
    chunk_rest_ = absl::string_view();
    at_end_ = false;
    budget_.emplace(static_cast<int64_t>(file_.size()));
  }

  absl::Status Damaged(const std::string& what) const {
    return absl::DataLossError(
        absl::StrCat(filename_, ": at byte ", position_, ": ", what));
  }

  // Reads the next record; true if it is a wanted message.
  absl::StatusOr<bool> Step(RosMessage* message) {
    RosbagRecord record;
    if (!chunk_rest_.empty()) {
      if (!TakeRosbagRecord(&chunk_rest_, &record)) {
        return Damaged("a damaged record in a chunk");
      }
      if (record.op == kRosbagMessage) return TakeMessage(record, message);
      if (record.op == kRosbagConnection) return TakeConnection(record);
      return Damaged("a chunk with records that do not belong there");
    }
    if (rest_.empty()) {
      at_end_ = true;
      return false;
    }
    position_ = rest_.data() - file_.data();
    if (RosbagRecordIsCutOff(rest_)) {
      at_end_ = true;
      problem_ = absl::StrCat("cut off at byte ", position_);
      return false;
    }
    if (!TakeRosbagRecord(&rest_, &record)) {
      return Damaged("a damaged record");
    }
    return TakeOuter(record);
  }

  absl::StatusOr<bool> TakeOuter(const RosbagRecord& record) {
    if ((record.op == kRosbagFileHeader) != (position_ == sizeof(kMagic) - 1)) {
      return Damaged("no file header at the beginning");
    }
    switch (record.op) {
      case kRosbagFileHeader: {
        uint64_t index_position;
        if (!record.header.Number("index_pos", &index_position)) {
          return Damaged("the file header lacks fields");
        }
        if (!record.header.Text("encryptor").empty()) {
          return Damaged("the bag is encrypted");
        }
        has_file_header_ = true;
        has_index_ = index_position != 0;
        return false;
      }
      case kRosbagChunk: {
        uint32_t size;
        if (record.header.Text("compression") != "none" &&
            record.header.Number("size", &size) && !budget_->Take(size)) {
          return budget_->Error(filename_);
        }
        const absl::StatusOr<absl::string_view> content =
            RosbagChunkContent(record, &chunk_);
        if (!content.ok()) {
          return Damaged(std::string(content.status().message()));
        }
        chunk_rest_ = *content;
        return false;
      }
      case kRosbagConnection:
        return TakeConnection(record);
      case kRosbagIndex:
        return SkipIndex(record);
      case kRosbagChunkInfo:
        return false;
      default:
        return Damaged("a record of unknown kind");
    }
  }

  // The index of a chunk is not needed, but some writers give it a wrong
  // length, and the next record begins where its entries end.
  absl::StatusOr<bool> SkipIndex(const RosbagRecord& record) {
    constexpr uint64_t kEntrySize = 12;
    uint32_t count;
    if (!record.header.Number("count", &count)) {
      return Damaged("a damaged index record");
    }
    if (record.data.size() == kEntrySize * count ||
        StartsLikeRosbagRecord(rest_)) {
      return false;
    }
    absl::string_view after = Bytes();
    after.remove_prefix(record.data.data() - file_.data());
    if (after.size() < kEntrySize * count) {
      return Damaged("an index record of wrong length");
    }
    after.remove_prefix(kEntrySize * count);
    if (!StartsLikeRosbagRecord(after)) {
      return Damaged("an index record of wrong length");
    }
    problem_ = absl::StrCat("the index record at byte ", position_,
                            " has a wrong length");
    rest_ = after;
    return false;
  }

  absl::StatusOr<bool> TakeConnection(const RosbagRecord& record) {
    RosbagFields data;
    uint32_t connection;
    const absl::string_view topic = record.header.Text("topic");
    if (!record.header.Number("conn", &connection) || topic.empty() ||
        !data.Parse(record.data) || data.Text("type").empty() ||
        data.Text("md5sum").empty()) {
      return Damaged("a damaged connection record");
    }
    connections_[connection] = std::string(topic);
    topics_[std::string(topic)] = RosTopicType{
        std::string(data.Text("type")), std::string(data.Text("md5sum"))};
    return false;
  }

  absl::StatusOr<bool> TakeMessage(const RosbagRecord& record,
                                   RosMessage* message) {
    uint32_t connection;
    uint64_t time;
    if (!record.header.Number("conn", &connection) ||
        !record.header.Number("time", &time)) {
      return Damaged("a damaged message record");
    }
    // Connections may be described at the end of the bag only.
    const auto topic = connections_.find(connection);
    if (topic == connections_.end() || wanted_.count(topic->second) == 0) {
      return false;
    }
    message->topic = topic->second;
    // Seconds in the lower half.
    message->received = static_cast<TimeNs>(time & 0xffffffff) * 1000000000 +
                        static_cast<TimeNs>(time >> 32);
    message->data.assign(record.data.data(), record.data.size());
    return true;
  }

  const std::string filename_;
  const boost::iostreams::mapped_file_source file_;
  absl::string_view rest_;  // of the file
  uint64_t position_ = 0;   // of the record being read
  std::string chunk_;       // decompressed
  absl::string_view chunk_rest_;
  absl::optional<ExpansionBudget> budget_;  // of this reading
  bool at_end_ = true;
  bool has_file_header_ = false;
  bool has_index_ = false;
  std::string problem_;  // that could be lived with
  std::map<uint32_t, std::string> connections_;
  RosTopics topics_;
  std::set<std::string> wanted_;
};

}  // namespace

absl::StatusOr<std::unique_ptr<SensorSource>> OpenRosbag(
    const std::string& filename, const SensorSourceOptions& options) {
  std::unique_ptr<RosbagContainer> container;
  try {
    container = absl::make_unique<RosbagContainer>(filename);
  } catch (const std::exception& exception) {
    return absl::DataLossError(absl::StrCat(filename, ": ", exception.what()));
  }
  const absl::Status status = container->Survey();
  if (!status.ok()) return status;
  return OpenRosRecording(filename, std::move(container), options);
}

}  // namespace io
}  // namespace cartographer_ext
