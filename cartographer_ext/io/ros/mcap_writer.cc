// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
#include "cartographer_ext/io/ros/mcap_writer.h"

#include <algorithm>

#include "absl/status/statusor.h"
#include "cartographer_ext/io/ros/mcap_format.h"

namespace cartographer_ext {
namespace io {
namespace {

constexpr size_t kChunkSize = 768 * 1024;

template <typename T>
void Put(const T value, std::string* record) {
  record->append(reinterpret_cast<const char*>(&value), sizeof(T));
}

void PutBytes(const absl::string_view bytes, std::string* record) {
  Put(static_cast<uint32_t>(bytes.size()), record);
  record->append(bytes.data(), bytes.size());
}

void AppendRecord(const uint8_t opcode, const absl::string_view content,
                  std::string* to) {
  Put(opcode, to);
  Put(static_cast<uint64_t>(content.size()), to);
  to->append(content.data(), content.size());
}

}  // namespace

McapWriter::McapWriter(std::ostream* const out, std::string compression)
    : out_(out), compression_(std::move(compression)) {
  out_->write(kMcapMagic, kMcapMagicSize);
  offset_ = kMcapMagicSize;
  std::string header;
  PutBytes("ros2", &header);
  PutBytes("cartographer_ext", &header);
  WriteRecord(kMcapHeader, header);
}

void McapWriter::WriteRecord(const uint8_t opcode, const std::string& content) {
  std::string record;
  AppendRecord(opcode, content, &record);
  out_->write(record.data(), static_cast<std::streamsize>(record.size()));
  offset_ += record.size();
}

uint16_t McapWriter::AddChannel(const std::string& topic,
                                const std::string& type,
                                const std::string& definition) {
  const auto schema =
      schema_ids_.emplace(type, static_cast<uint16_t>(schema_ids_.size() + 1));
  if (schema.second) {
    std::string record;
    Put(schema.first->second, &record);
    PutBytes(type, &record);
    PutBytes("ros2msg", &record);
    PutBytes(definition, &record);
    schemas_.push_back(record);
    AppendRecord(kMcapSchema, record, &chunk_);
  }
  const uint16_t id = static_cast<uint16_t>(channels_.size() + 1);
  std::string record;
  Put(id, &record);
  Put(schema.first->second, &record);
  PutBytes(topic, &record);
  PutBytes("cdr", &record);
  PutBytes("", &record);  // metadata
  channels_.push_back(record);
  AppendRecord(kMcapChannel, record, &chunk_);
  return id;
}

absl::Status McapWriter::Write(const uint16_t channel, const TimeNs time,
                               const absl::string_view data) {
  const uint64_t stamp = static_cast<uint64_t>(time);
  chunk_messages_[channel].emplace_back(stamp, chunk_.size());
  std::string head;
  Put(channel, &head);
  Put(sequences_[channel]++, &head);
  Put(stamp, &head);  // logged
  Put(stamp, &head);  // published
  Put(static_cast<uint8_t>(kMcapMessage), &chunk_);
  Put(static_cast<uint64_t>(head.size() + data.size()), &chunk_);
  chunk_ += head;
  chunk_.append(data.data(), data.size());
  begin_time_ = num_messages_ == 0 ? stamp : std::min(begin_time_, stamp);
  end_time_ = std::max(end_time_, stamp);
  ++num_messages_;
  ++message_counts_[channel];
  return chunk_.size() < kChunkSize ? absl::OkStatus() : FinishChunk();
}

absl::Status McapWriter::FinishChunk() {
  if (chunk_.empty()) return absl::OkStatus();
  const absl::StatusOr<std::string> data = McapCompress(compression_, chunk_);
  if (!data.ok()) return data.status();
  ChunkIndex index{};
  index.begin_time = ~uint64_t{0};
  for (const auto& channel : chunk_messages_) {
    for (const auto& message : channel.second) {
      index.begin_time = std::min(index.begin_time, message.first);
      index.end_time = std::max(index.end_time, message.first);
    }
  }
  if (chunk_messages_.empty()) index.begin_time = 0;
  index.offset = offset_;
  index.size = chunk_.size();
  index.compressed_size = data->size();
  std::string record;
  Put(index.begin_time, &record);
  Put(index.end_time, &record);
  Put(index.size, &record);
  Put(McapChecksum(chunk_), &record);
  PutBytes(compression_, &record);
  Put(index.compressed_size, &record);
  record += *data;
  WriteRecord(kMcapChunk, record);
  index.length = offset_ - index.offset;
  for (const auto& channel : chunk_messages_) {
    index.message_indexes.emplace_back(channel.first, offset_);
    std::string messages;
    for (const auto& message : channel.second) {
      Put(message.first, &messages);
      Put(message.second, &messages);
    }
    record.clear();
    Put(channel.first, &record);
    PutBytes(messages, &record);
    WriteRecord(kMcapMessageIndex, record);
  }
  index.index_length = offset_ - index.offset - index.length;
  chunks_.push_back(std::move(index));
  chunk_.clear();
  chunk_messages_.clear();
  return absl::OkStatus();
}

std::string McapWriter::ChunkIndexRecord(const ChunkIndex& index) const {
  std::string offsets;
  for (const auto& channel : index.message_indexes) {
    Put(channel.first, &offsets);
    Put(channel.second, &offsets);
  }
  std::string record;
  for (const uint64_t value :
       {index.begin_time, index.end_time, index.offset, index.length})
    Put(value, &record);
  PutBytes(offsets, &record);
  Put(index.index_length, &record);
  PutBytes(compression_, &record);
  Put(index.compressed_size, &record);
  Put(index.size, &record);
  return record;
}

std::string McapWriter::StatisticsRecord() const {
  std::string counts;
  for (const auto& channel : message_counts_) {
    Put(channel.first, &counts);
    Put(channel.second, &counts);
  }
  std::string record;
  Put(num_messages_, &record);
  Put(static_cast<uint16_t>(schemas_.size()), &record);
  Put(static_cast<uint32_t>(channels_.size()), &record);
  Put(uint32_t{0}, &record);  // attachments
  Put(uint32_t{0}, &record);  // metadata
  Put(static_cast<uint32_t>(chunks_.size()), &record);
  Put(begin_time_, &record);
  Put(end_time_, &record);
  PutBytes(counts, &record);
  return record;
}

absl::Status McapWriter::Finish() {
  const absl::Status status = FinishChunk();
  if (!status.ok()) return status;
  std::string checksum;
  Put(uint32_t{0}, &checksum);  // none
  WriteRecord(kMcapDataEnd, checksum);
  const uint64_t summary = offset_;
  for (const std::string& schema : schemas_) WriteRecord(kMcapSchema, schema);
  for (const std::string& channel : channels_)
    WriteRecord(kMcapChannel, channel);
  WriteRecord(kMcapStatistics, StatisticsRecord());
  for (const ChunkIndex& chunk : chunks_)
    WriteRecord(kMcapChunkIndex, ChunkIndexRecord(chunk));
  std::string footer;
  Put(summary, &footer);
  Put(uint64_t{0}, &footer);  // no summary offsets
  Put(uint32_t{0}, &footer);  // no checksum
  WriteRecord(kMcapFooter, footer);
  out_->write(kMcapMagic, kMcapMagicSize);
  return absl::OkStatus();
}

}  // namespace io
}  // namespace cartographer_ext
