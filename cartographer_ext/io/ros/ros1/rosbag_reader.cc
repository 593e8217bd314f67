// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
#include "cartographer_ext/io/ros/ros1/rosbag_reader.h"

#include <algorithm>
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
#include "cartographer_ext/io/ros/damage_report.h"
#include "cartographer_ext/io/ros/ros1/rosbag_records.h"
#include "cartographer_ext/io/ros/ros_container.h"

namespace cartographer_ext {
namespace io {
namespace {

constexpr char kMagic[] = "#ROSBAG V2.0\n";
// Of the index; a recorder makes chunks of about a megabyte.
constexpr size_t kMaxChunks = 1 << 20;

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
    if (index_position_ == 0 && problem_.empty()) problem_ = "it has no index";
    return damage_.any_message() ? absl::OkStatus() : damage_.first_problem();
  }

  std::string format() const override { return "rosbag"; }
  RosEncoding encoding() const override { return RosEncoding::kRos1; }
  const RosTopics& topics() const override { return topics_; }
  std::vector<std::string> warnings() const override {
    std::vector<std::string> warnings;
    if (!problem_.empty()) {
      warnings.push_back(
          absl::StrCat(filename_, ": ", problem_,
                       "; read from the beginning without the index "
                       "(\"rosbag reindex\" writes a new one)"));
    }
    if (!damage_.empty()) {
      warnings.push_back(absl::StrCat(damage_.first_problem().message(), "; ",
                                      damage_.Text(file_.size())));
    }
    return warnings;
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
    num_chunks_ = 0;
    last_whole_ = 0;
    last_known_ = 0;
    num_reread_ = 0;
    damage_ = DamageReport();
    budget_.emplace(static_cast<int64_t>(file_.size()));
  }

  absl::Status Damaged(const std::string& what) const {
    return absl::DataLossError(
        absl::StrCat(filename_, ": at byte ", position_, ": ", what));
  }

  // Reads the next record; true if it is a wanted message. What is damaged is
  // left out once the bag has begun.
  absl::StatusOr<bool> Step(RosMessage* message) {
    const bool in_chunk = !chunk_rest_.empty();
    const absl::StatusOr<bool> found =
        in_chunk ? StepInChunk(message) : StepInFile();
    if (!absl::IsDataLoss(found.status()) || !has_file_header_) return found;
    if (!in_chunk) LeaveOut(found.status());
    return false;
  }

  absl::StatusOr<bool> StepInChunk(RosMessage* message) {
    const size_t rest_size = chunk_rest_.size();
    RosbagRecord record;
    absl::StatusOr<bool> found = false;
    if (!TakeRosbagRecord(&chunk_rest_, &record)) {
      chunk_rest_ = absl::string_view();
      found = Damaged("a damaged record in a chunk");
    } else if (record.op == kRosbagMessage) {
      found = TakeMessage(record, message);
    } else if (record.op == kRosbagConnection) {
      found = TakeConnection(record);
    } else {
      found = Damaged("a chunk with records that do not belong there");
    }
    if (!found.ok()) {
      // Of the compressed chunk, as much as this is of what it expands to.
      const double share = static_cast<double>(rest_size - chunk_rest_.size()) /
                           static_cast<double>(chunk_content_size_);
      damage_.AddDamage(
          num_chunks_,
          static_cast<uint64_t>(share * static_cast<double>(chunk_size_)),
          found.status());
    }
    return found;
  }

  absl::StatusOr<bool> StepInFile() {
    if (rest_.empty()) {
      at_end_ = true;
      return false;
    }
    position_ = rest_.data() - file_.data();
    is_chunk_ = false;
    if (RosbagRecordIsCutOff(rest_)) {
      // The index is behind it, so its length is wrong.
      if (position_ < index_position_) return Unframed("a record without end");
      at_end_ = true;
      problem_ = absl::StrCat("cut off at byte ", position_);
      return false;
    }
    RosbagRecord record;
    if (!TakeRosbagRecord(&rest_, &record)) return Unframed("a damaged record");
    const absl::StatusOr<bool> taken = TakeOuter(record);
    if (taken.ok()) last_whole_ = position_;
    return taken;
  }

  // Damage that hides where the next record begins.
  absl::Status Unframed(const std::string& what) {
    rest_ = absl::string_view();
    return Damaged(what);
  }

  // Goes on at the next chunk that the index knows. Without an index at the
  // next record, if it is known where that begins.
  void LeaveOut(const absl::Status& problem) {
    if (index_position_ > 0 && position_ >= index_position_) {
      at_end_ = true;
      problem_ = absl::StrCat("its index is damaged at byte ", position_);
      return;
    }
    uint64_t next = file_.size() - rest_.size();
    if (ReadIndex()) {
      // Bytes behind the last whole record may have passed for records.
      const uint64_t known = chunk_positions_.count(position_) > 0
                                 ? position_
                                 : std::max(last_whole_, last_known_);
      const auto chunk = chunk_positions_.upper_bound(known);
      next = chunk == chunk_positions_.end() ? index_position_ : *chunk;
      // No more is read again than there is.
      if (next < position_) num_reread_ += position_ - next;
      if (num_reread_ > file_.size()) next = index_position_;
      last_known_ = next;
    }
    damage_.AddDamage(is_chunk_ ? num_chunks_ : 0,
                      next - std::min(next, position_), problem);
    rest_ = Bytes().substr(next);
  }

  // Takes the connections and the places of the chunks from the end of the bag;
  // false if there are none.
  bool ReadIndex() {
    if (has_read_index_) return !chunk_positions_.empty();
    has_read_index_ = true;
    absl::string_view rest = Bytes().substr(index_position_);
    RosbagRecord record;
    uint64_t chunk;
    while (index_position_ > 0 && chunk_positions_.size() < kMaxChunks &&
           TakeRosbagRecord(&rest, &record)) {
      if (record.op == kRosbagConnection) {
        TakeConnection(record).status().IgnoreError();
      } else if (record.op == kRosbagChunkInfo &&
                 record.header.Number("chunk_pos", &chunk) &&
                 chunk < index_position_ &&
                 StartsLikeRosbagRecord(Bytes().substr(chunk))) {
        chunk_positions_.insert(chunk);
      }
    }
    return !chunk_positions_.empty();
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
        // Behind the end of what was cut off.
        index_position_ = index_position < file_.size() ? index_position : 0;
        return false;
      }
      case kRosbagChunk: {
        ++num_chunks_;
        is_chunk_ = true;
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
        chunk_size_ = record.data.size();
        chunk_content_size_ = content->size();
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
    // Seconds in the lower half.
    const TimeNs received =
        static_cast<TimeNs>(time & 0xffffffff) * 1000000000 +
        static_cast<TimeNs>(time >> 32);
    damage_.AddMessage(received);
    // Connections may be described at the end of the bag only.
    const auto topic = connections_.find(connection);
    if (topic == connections_.end() || wanted_.count(topic->second) == 0) {
      return false;
    }
    message->topic = topic->second;
    message->received = received;
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
  uint64_t index_position_ = 0;  // 0: none
  bool has_read_index_ = false;
  std::set<uint64_t> chunk_positions_;  // of the index
  int64_t num_chunks_ = 0;              // so far
  uint64_t chunk_size_ = 0;             // of the last, in the file
  uint64_t chunk_content_size_ = 0;
  bool is_chunk_ = false;    // the record being read
  uint64_t last_whole_ = 0;  // record
  uint64_t last_known_ = 0;  // chunk of the index behind damage
  uint64_t num_reread_ = 0;  // bytes
  DamageReport damage_;      // of this reading
  std::string problem_;      // that could be lived with
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
