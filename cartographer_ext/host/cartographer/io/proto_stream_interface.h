// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
#ifndef CARTOGRAPHER_IO_PROTO_STREAM_INTERFACE_H_
#define CARTOGRAPHER_IO_PROTO_STREAM_INTERFACE_H_

#include <functional>
#include <string>

#include "google/protobuf/message.h"

namespace cartographer {
namespace io {

class ProtoStreamWriterInterface {
 public:
  virtual ~ProtoStreamWriterInterface() {}

  virtual void WriteProto(const google::protobuf::Message& proto) = 0;
  // Not part of Cartographer: a serialized message in pieces, which `pieces`
  // passes to the function that it is given.
  using Write = std::function<void(const std::string&)>;
  virtual void WriteSerialized(
      const std::function<void(const Write&)>& pieces) = 0;
  // Nothing may be written afterwards. False when something went wrong.
  virtual bool Close() = 0;
};

class ProtoStreamReaderInterface {
 public:
  ProtoStreamReaderInterface() = default;
  virtual ~ProtoStreamReaderInterface() {}
  ProtoStreamReaderInterface(const ProtoStreamReaderInterface&) = delete;
  ProtoStreamReaderInterface& operator=(const ProtoStreamReaderInterface&) =
      delete;

  // False at the end and on broken data; eof() says which.
  virtual bool ReadProto(google::protobuf::Message* proto) = 0;
  virtual bool eof() const = 0;
};

}  // namespace io
}  // namespace cartographer

#endif  // CARTOGRAPHER_IO_PROTO_STREAM_INTERFACE_H_
