// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
//
// Writes MCAP files with chunks, indexes and a summary, for tools with random
// access.
#ifndef CARTOGRAPHER_EXT_IO_ROS_MCAP_WRITER_H_
#define CARTOGRAPHER_EXT_IO_ROS_MCAP_WRITER_H_

#include <cstdint>
#include <map>
#include <ostream>
#include <string>
#include <utility>
#include <vector>

#include "absl/status/status.h"
#include "absl/strings/string_view.h"
#include "cartographer_ext/io/sensor_source.h"

namespace cartographer_ext {
namespace io {

class McapWriter {
 public:
  // `compression`: "" (none), "lz4" or "zstd". `out` must outlive the writer;
  // the caller checks its state.
  McapWriter(std::ostream* out, std::string compression);

  // The id of a new channel for messages of a ROS 2 type in CDR.
  uint16_t AddChannel(const std::string& topic, const std::string& type,
                      const std::string& definition);
  absl::Status Write(uint16_t channel, TimeNs time, absl::string_view data);
  absl::Status Finish();

 private:
  struct ChunkIndex {
    uint64_t begin_time, end_time, offset, length, index_length,
        compressed_size, size;
    std::vector<std::pair<uint16_t, uint64_t>>
        message_indexes;  // channel, offset
  };

  void WriteRecord(uint8_t opcode, const std::string& content);
  absl::Status FinishChunk();
  std::string ChunkIndexRecord(const ChunkIndex& index) const;
  std::string StatisticsRecord() const;

  std::ostream* const out_;
  const std::string compression_;
  uint64_t offset_ = 0;  // in the file
  std::vector<std::string> schemas_, channels_;
  std::map<std::string, uint16_t> schema_ids_;
  std::string chunk_;
  // Of the chunk: by channel, (time, offset in the chunk) of its messages.
  std::map<uint16_t, std::vector<std::pair<uint64_t, uint64_t>>>
      chunk_messages_;
  std::vector<ChunkIndex> chunks_;
  std::map<uint16_t, uint64_t> message_counts_;
  uint64_t begin_time_ = 0, end_time_ = 0, num_messages_ = 0;
  std::map<uint16_t, uint32_t> sequences_;
};

}  // namespace io
}  // namespace cartographer_ext

#endif  // CARTOGRAPHER_EXT_IO_ROS_MCAP_WRITER_H_
