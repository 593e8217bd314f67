// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
#ifndef CARTOGRAPHER_IO_PROTO_STREAM_H_
#define CARTOGRAPHER_IO_PROTO_STREAM_H_

#include <fstream>
#include <string>

#include "cartographer/io/proto_stream_interface.h"

namespace cartographer {
namespace io {

// Layout of a stream: the magic number 0x7b1d1f7b5bf501db, then per message the
// size of its compressed form and one gzip member. Numbers are 8 bytes,
// little-endian.
class ProtoStreamWriter : public ProtoStreamWriterInterface {
 public:
  // A file that cannot be created is fatal.
  explicit ProtoStreamWriter(const std::string& filename);
  ProtoStreamWriter(const ProtoStreamWriter&) = delete;
  ProtoStreamWriter& operator=(const ProtoStreamWriter&) = delete;

  void WriteProto(const google::protobuf::Message& proto) override;
  void WriteSerialized(
      const std::function<void(const Write&)>& pieces) override;
  bool Close() override;

 private:
  std::ofstream out_;
};

class ProtoStreamReader : public ProtoStreamReaderInterface {
 public:
  // A file that cannot be opened or is no proto stream is fatal; tools look at
  // files first with cartographer_ext/io/pbstream/pbstream_reader.h.
  explicit ProtoStreamReader(const std::string& filename);

  bool ReadProto(google::protobuf::Message* proto) override;
  bool eof() const override;

 private:
  std::ifstream in_;
};

}  // namespace io
}  // namespace cartographer

#endif  // CARTOGRAPHER_IO_PROTO_STREAM_H_
