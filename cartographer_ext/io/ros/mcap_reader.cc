// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
#include "cartographer_ext/io/ros/mcap_reader.h"

#include <fstream>
#include <map>
#include <utility>

#include "absl/memory/memory.h"
#include "absl/status/status.h"
#include "absl/strings/str_cat.h"
#include "absl/types/optional.h"
#include "cartographer_ext/io/expansion_budget.h"
#include "cartographer_ext/io/ros/mcap_format.h"

namespace cartographer_ext {
namespace io {
namespace {

// No sensor message is larger, and no chunk of a sensible recorder.
constexpr uint64_t kMaxRecordSize = uint64_t{1} << 30;

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
    if (cut_off_at_ == 0) return {};
    return {absl::StrCat(filename_, ": cut off; read up to byte ", cut_off_at_,
                         " of ", file_size_)};
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
    budget_.emplace(static_cast<int64_t>(file_size_));
    return absl::OkStatus();
  }

  absl::Status Damaged(const std::string& what) const {
    return absl::DataLossError(absl::StrCat(
        filename_, ": ", what, " (record at byte ", record_offset_, ")"));
  }

  void CutOff() {
    cut_off_at_ = record_offset_;
    at_end_ = true;
  }

  // Reads the next record; true if it is a wanted message.
  absl::StatusOr<bool> Step(RosMessage* message) {
    if (!chunk_rest_.rest().empty()) {
      const uint8_t opcode = chunk_rest_.Take<uint8_t>();
      const absl::string_view content =
          chunk_rest_.TakeBytes(chunk_rest_.Take<uint64_t>());
      if (!chunk_rest_.ok()) return Damaged("a chunk ends within a record");
      return Take(opcode, content, /*in_chunk=*/true, message);
    }
    record_offset_ = offset_;
    char head[kMcapRecordHeadSize];
    if (!file_.read(head, sizeof(head))) {
      CutOff();
      return false;
    }
    McapFields fields(absl::string_view(head, sizeof(head)));
    const uint8_t opcode = fields.Take<uint8_t>();
    const uint64_t size = fields.Take<uint64_t>();
    if (size > file_size_ - offset_ - sizeof(head)) {
      CutOff();
      return false;
    }
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
    if (size > kMaxRecordSize)
      return Damaged(absl::StrCat("a record of ", size, " bytes"));
    record_.resize(size);
    if (!file_.read(&record_[0], static_cast<std::streamsize>(size))) {
      return absl::DataLossError(
          absl::StrCat(filename_, ": cannot be read at byte ", record_offset_));
    }
    return Take(opcode, record_, /*in_chunk=*/false, message);
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
    const auto channel = channels_.find(id);
    if (channel == channels_.end())
      return Damaged(absl::StrCat("a message on the unknown channel ", id));
    if (wanted_.count(channel->second.topic) == 0) return false;
    message->topic = channel->second.topic;
    message->received = static_cast<TimeNs>(logged);
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
