// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
#include "cartographer_ext/io/ros/mcap_reader.h"

#include <algorithm>
#include <fstream>
#include <map>
#include <set>
#include <utility>

#include "absl/memory/memory.h"
#include "absl/status/status.h"
#include "absl/strings/str_cat.h"
#include "absl/types/optional.h"
#include "cartographer_ext/io/expansion_budget.h"
#include "cartographer_ext/io/ros/damage_report.h"
#include "cartographer_ext/io/ros/mcap_format.h"

namespace cartographer_ext {
namespace io {
namespace {

// No sensor message is larger, and no chunk of a sensible recorder.
constexpr uint64_t kMaxRecordSize = uint64_t{1} << 30;
// Nor is the summary of any.
constexpr uint64_t kMaxSummarySize = uint64_t{1} << 26;
// Start of the summary, start of its offsets, checksum.
constexpr uint64_t kFooterSize = 20;

struct Channel {
  std::string topic;
  bool cdr = false;
  uint16_t schema = 0;
};

class McapContainer : public RosContainer {
 public:
  explicit McapContainer(const std::string& filename)
      : filename_(filename), file_(filename, std::ios::binary) {}

  // Reads the whole file once to find its topics and whether it is complete.
  absl::Status Survey() {
    file_.seekg(0, std::ios::end);
    file_size_ = static_cast<uint64_t>(file_.tellg());
    absl::Status status = Restart();
    RosMessage message;
    while (status.ok() && !at_end_) {
      const absl::StatusOr<bool> more = Step(&message);
      status = more.status();
    }
    if (!status.ok()) return status;
    if (!damage_.any_message() && !damage_.empty()) {
      return damage_.first_problem();
    }
    for (const auto& channel : channels_) {
      const auto schema = schemas_.find(channel.second.schema);
      RosTopicType type =
          TypeOfRos2(schema == schemas_.end() ? "unknown" : schema->second);
      if (!channel.second.cdr) type.md5sum.clear();
      topics_[channel.second.topic] = type;
    }
    return absl::OkStatus();
  }

  std::string format() const override { return "mcap"; }
  RosEncoding encoding() const override { return RosEncoding::kCdr; }
  const RosTopics& topics() const override { return topics_; }
  std::vector<std::string> warnings() const override {
    std::vector<std::string> warnings;
    if (cut_off_at_ > 0) {
      warnings.push_back(absl::StrCat(filename_, ": cut off; read up to byte ",
                                      cut_off_at_, " of ", file_size_));
    }
    if (!damage_.empty()) {
      warnings.push_back(absl::StrCat(
          damage_.first_problem().message(), "; ", damage_.Text(file_size_),
          " (\"mcap recover\" writes a file of the same)"));
    }
    return warnings;
  }

  absl::Status Rewind(const std::set<std::string>& topics) override {
    wanted_ = topics;
    return Restart();
  }

  absl::StatusOr<bool> Next(RosMessage* message) override {
    while (!at_end_) {
      const absl::StatusOr<bool> found = Step(message);
      if (!found.ok() || *found) return found;
    }
    return false;
  }

 private:
  absl::Status Restart() {
    file_.clear();
    file_.seekg(0);
    char magic[kMcapMagicSize];
    if (!file_.read(magic, sizeof(magic)) ||
        std::string(magic, sizeof(magic)) != kMcapMagic) {
      return absl::InvalidArgumentError(
          absl::StrCat(filename_, ": not an MCAP file of version 0"));
    }
    offset_ = kMcapMagicSize;
    chunk_.clear();
    chunk_rest_ = McapFields(absl::string_view());
    at_end_ = false;
    num_chunks_ = 0;
    last_whole_ = 0;
    last_known_ = 0;
    num_reread_ = 0;
    damage_ = DamageReport();
    budget_.emplace(static_cast<int64_t>(file_size_));
    return absl::OkStatus();
  }

  absl::Status Damaged(const std::string& what) const {
    return absl::DataLossError(absl::StrCat(
        filename_, ": ", what, " (record at byte ", record_offset_, ")"));
  }

  // Where the file ends within the record. False unless the summary behind it
  // shows that its length is wrong.
  absl::StatusOr<bool> CutOff() {
    next_is_known_ = false;
    if (ReadSummary() && record_offset_ < summary_offset_) {
      return Damaged("a record of wrong length");
    }
    cut_off_at_ = record_offset_;
    at_end_ = true;
    return false;
  }

  // Reads the next record; true if it is a wanted message. What is damaged is
  // left out.
  absl::StatusOr<bool> Step(RosMessage* message) {
    const bool in_chunk = !chunk_rest_.rest().empty();
    const absl::StatusOr<bool> found =
        in_chunk ? StepInChunk(message) : StepInFile(message);
    if (!absl::IsDataLoss(found.status()) &&
        !absl::IsUnimplemented(found.status())) {
      return found;
    }
    if (!in_chunk) LeaveOut(found.status());
    return false;
  }

  absl::StatusOr<bool> StepInChunk(RosMessage* message) {
    const size_t rest_size = chunk_rest_.rest().size();
    const uint8_t opcode = chunk_rest_.Take<uint8_t>();
    const absl::string_view content =
        chunk_rest_.TakeBytes(chunk_rest_.Take<uint64_t>());
    absl::StatusOr<bool> found = false;
    if (chunk_rest_.ok()) {
      found = Take(opcode, content, /*in_chunk=*/true, message);
    } else {
      chunk_rest_ = McapFields(absl::string_view());
      found = Damaged("a chunk ends within a record");
    }
    if (!found.ok()) {
      // Of the compressed chunk, as much as this is of what it expands to.
      const double share =
          static_cast<double>(rest_size - chunk_rest_.rest().size()) /
          static_cast<double>(chunk_.size());
      ReadSummary();  // may know the channel
      damage_.AddDamage(
          num_chunks_,
          static_cast<uint64_t>(share * static_cast<double>(record_.size())),
          found.status());
    }
    return found;
  }

  absl::StatusOr<bool> StepInFile(RosMessage* message) {
    record_offset_ = offset_;
    is_chunk_ = false;
    next_is_known_ = true;
    char head[kMcapRecordHeadSize];
    if (!file_.read(head, sizeof(head))) return CutOff();
    McapFields fields(absl::string_view(head, sizeof(head)));
    const uint8_t opcode = fields.Take<uint8_t>();
    const uint64_t size = fields.Take<uint64_t>();
    if (size > file_size_ - offset_ - sizeof(head)) return CutOff();
    offset_ += sizeof(head) + size;
    // The data end here; what follows is for random access.
    if (opcode == kMcapDataEnd || opcode == kMcapFooter) {
      at_end_ = true;
      return false;
    }
    const bool needed = opcode == kMcapSchema || opcode == kMcapChannel ||
                        opcode == kMcapMessage || opcode == kMcapChunk;
    if (!needed) {
      file_.seekg(static_cast<std::streamoff>(offset_));
      return false;
    }
    if (size > kMaxRecordSize) {
      return Damaged(absl::StrCat("a record of ", size, " bytes"));
    }
    record_.resize(size);
    if (!file_.read(&record_[0], static_cast<std::streamsize>(size))) {
      return absl::DataLossError(
          absl::StrCat(filename_, ": cannot be read at byte ", record_offset_));
    }
    is_chunk_ = opcode == kMcapChunk;
    num_chunks_ += is_chunk_ ? 1 : 0;
    const absl::StatusOr<bool> taken =
        Take(opcode, record_, /*in_chunk=*/false, message);
    if (taken.ok()) last_whole_ = record_offset_;
    return taken;
  }

  // Goes on at the next chunk of the summary. Without one at the next record,
  // if it is known where that begins.
  void LeaveOut(const absl::Status& problem) {
    if (ReadSummary() && !chunk_offsets_.empty()) {
      // Bytes behind the last whole record may have passed for records.
      const uint64_t known = chunk_offsets_.count(record_offset_) > 0
                                 ? record_offset_
                                 : std::max(last_whole_, last_known_);
      const auto chunk = chunk_offsets_.upper_bound(known);
      offset_ = chunk == chunk_offsets_.end() ? summary_offset_ : *chunk;
      // No more is read again than there is.
      if (offset_ < record_offset_) num_reread_ += record_offset_ - offset_;
      if (num_reread_ > file_size_) offset_ = summary_offset_;
      last_known_ = offset_;
    } else if (!next_is_known_) {
      offset_ = file_size_;
    }
    at_end_ = summary_offset_ > 0 && offset_ >= summary_offset_;
    damage_.AddDamage(is_chunk_ ? num_chunks_ : 0,
                      offset_ - std::min(offset_, record_offset_), problem);
    file_.clear();
    file_.seekg(static_cast<std::streamoff>(offset_));
  }

  // Takes schemas, channels and the places of the chunks from the end of the
  // file; false where a file has no summary.
  bool ReadSummary() {
    if (has_read_summary_) return summary_offset_ > 0;
    has_read_summary_ = true;
    constexpr uint64_t kTailSize =
        kMcapRecordHeadSize + kFooterSize + kMcapMagicSize;
    if (file_size_ < kMcapMagicSize + kTailSize) return false;
    const std::string tail = ReadAt(file_size_ - kTailSize, kTailSize);
    McapFields footer(tail);
    if (footer.Take<uint8_t>() != kMcapFooter ||
        footer.Take<uint64_t>() != kFooterSize) {
      return false;
    }
    const uint64_t begin = footer.Take<uint64_t>();
    const uint64_t end = file_size_ - kTailSize;
    if (!footer.ok() || begin < kMcapMagicSize || begin > end ||
        end - begin > kMaxSummarySize) {
      return false;
    }
    summary_offset_ = begin;
    const std::string summary = ReadAt(begin, end - begin);
    McapFields rest(summary);
    while (!rest.rest().empty()) {
      const uint8_t opcode = rest.Take<uint8_t>();
      McapFields content(rest.TakeBytes(rest.Take<uint64_t>()));
      if (!rest.ok()) break;
      if (opcode == kMcapSchema) {
        TakeSchema(content.rest()).status().IgnoreError();
      } else if (opcode == kMcapChannel) {
        TakeChannel(content.rest()).status().IgnoreError();
      } else if (opcode == kMcapChunkIndex) {
        content.Take<uint64_t>();  // first and
        content.Take<uint64_t>();  // last time
        const uint64_t offset = content.Take<uint64_t>();
        if (content.ok() && offset >= kMcapMagicSize && offset < begin) {
          chunk_offsets_.insert(offset);
        }
      }
    }
    return true;
  }

  // Fewer bytes where the file cannot be read. The place of reading stays.
  std::string ReadAt(const uint64_t offset, const uint64_t size) {
    std::string bytes(size, '\0');
    file_.clear();
    const std::streamoff before = file_.tellg();
    file_.seekg(static_cast<std::streamoff>(offset));
    file_.read(&bytes[0], static_cast<std::streamsize>(size));
    bytes.resize(static_cast<size_t>(file_.gcount()));
    file_.clear();
    file_.seekg(before);
    return bytes;
  }

  absl::StatusOr<bool> Take(const uint8_t opcode,
                            const absl::string_view content,
                            const bool in_chunk, RosMessage* message) {
    switch (opcode) {
      case kMcapSchema:
        return TakeSchema(content);
      case kMcapChannel:
        return TakeChannel(content);
      case kMcapMessage:
        return TakeMessage(content, message);
      case kMcapChunk:
        if (in_chunk) return Damaged("a chunk within a chunk");
        return TakeChunk(content);
      default:
        return false;
    }
  }

  absl::StatusOr<bool> TakeSchema(const absl::string_view content) {
    McapFields fields(content);
    const uint16_t id = fields.Take<uint16_t>();
    const absl::string_view name = fields.TakeString();
    if (!fields.ok() || id == 0) return Damaged("a damaged schema");
    schemas_[id] = std::string(name);
    return false;
  }

  absl::StatusOr<bool> TakeChannel(const absl::string_view content) {
    McapFields fields(content);
    const uint16_t id = fields.Take<uint16_t>();
    Channel channel;
    channel.schema = fields.Take<uint16_t>();
    channel.topic = std::string(fields.TakeString());
    channel.cdr = fields.TakeString() == "cdr";
    if (!fields.ok()) return Damaged("a damaged channel");
    channels_[id] = std::move(channel);
    return false;
  }

  absl::StatusOr<bool> TakeMessage(const absl::string_view content,
                                   RosMessage* message) {
    McapFields fields(content);
    const uint16_t id = fields.Take<uint16_t>();
    fields.Take<uint32_t>();  // sequence number
    const uint64_t logged = fields.Take<uint64_t>();
    fields.Take<uint64_t>();  // when it was published
    if (!fields.ok()) return Damaged("a damaged message");
    const auto received =
        static_cast<TimeNs>(std::min<uint64_t>(logged, kMaxRecorded));
    damage_.AddMessage(received);
    const auto channel = channels_.find(id);
    if (channel == channels_.end())
      return Damaged(absl::StrCat("a message on the unknown channel ", id));
    if (wanted_.count(channel->second.topic) == 0) return false;
    message->topic = channel->second.topic;
    message->received = received;
    message->data.assign(fields.rest().data(), fields.rest().size());
    return true;
  }

  absl::StatusOr<bool> TakeChunk(const absl::string_view content) {
    McapFields fields(content);
    fields.Take<uint64_t>();  // first and
    fields.Take<uint64_t>();  // last time
    const uint64_t size = fields.Take<uint64_t>();
    const uint32_t checksum = fields.Take<uint32_t>();
    const absl::string_view compression = fields.TakeString();
    const absl::string_view data = fields.TakeBytes(fields.Take<uint64_t>());
    if (!fields.ok()) return Damaged("a damaged chunk");
    if (!compression.empty() && !budget_->Take(size)) {
      return budget_->Error(filename_);
    }
    absl::StatusOr<std::string> records =
        McapDecompress(compression, data, size);
    if (!records.ok()) {
      return absl::Status(
          records.status().code(),
          Damaged(std::string(records.status().message())).message());
    }
    if (checksum != 0 && checksum != McapChecksum(*records))
      return Damaged("a chunk with a wrong checksum");
    chunk_ = std::move(*records);
    chunk_rest_ = McapFields(chunk_);
    return false;
  }

  const std::string filename_;
  std::ifstream file_;
  uint64_t file_size_ = 0;
  uint64_t offset_ = 0;         // of the next record
  uint64_t record_offset_ = 0;  // of the one being read
  uint64_t cut_off_at_ = 0;     // 0: the file is whole
  bool has_read_summary_ = false;
  uint64_t summary_offset_ = 0;       // 0: none
  std::set<uint64_t> chunk_offsets_;  // of the summary
  int64_t num_chunks_ = 0;            // so far
  bool is_chunk_ = false;             // the record being read
  bool next_is_known_ = true;         // where the next one begins
  uint64_t last_whole_ = 0;           // record
  uint64_t last_known_ = 0;           // chunk of the summary behind damage
  uint64_t num_reread_ = 0;           // bytes
  DamageReport damage_;               // of this reading
  bool at_end_ = true;
  absl::optional<ExpansionBudget> budget_;  // of this reading
  std::string record_;
  std::string chunk_;
  McapFields chunk_rest_{absl::string_view()};
  std::map<uint16_t, std::string> schemas_;
  std::map<uint16_t, Channel> channels_;
  RosTopics topics_;
  std::set<std::string> wanted_;
};

}  // namespace

absl::StatusOr<std::unique_ptr<RosContainer>> OpenMcap(
    const std::string& filename) {
  auto container = absl::make_unique<McapContainer>(filename);
  const absl::Status status = container->Survey();
  if (!status.ok()) return status;
  return std::unique_ptr<RosContainer>(std::move(container));
}

}  // namespace io
}  // namespace cartographer_ext
