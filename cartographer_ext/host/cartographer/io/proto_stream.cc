// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
#include "cartographer/io/proto_stream.h"

#include <algorithm>
#include <cstdint>

#include "cartographer/common/port.h"
#include "glog/logging.h"

namespace cartographer {
namespace io {

namespace {

constexpr uint64 kMagic = 0x7b1d1f7b5bf501dbull;

void WriteNumber(uint64 number, std::ostream* const out) {
  char bytes[8];
  for (char& byte : bytes) {
    byte = static_cast<char>(number & 0xff);
    number >>= 8;
  }
  out->write(bytes, sizeof(bytes));
}

bool ReadNumber(std::istream* const in, uint64* const number) {
  unsigned char bytes[8];
  if (!in->read(reinterpret_cast<char*>(bytes), sizeof(bytes))) return false;
  *number = 0;
  for (int i = 7; i >= 0; --i) *number = (*number << 8) | bytes[i];
  return true;
}

void WriteRecord(const std::string& compressed, std::ostream* const out) {
  WriteNumber(compressed.size(), out);
  out->write(compressed.data(), compressed.size());
}

}  // namespace

ProtoStreamWriter::ProtoStreamWriter(const std::string& filename)
    : out_(filename, std::ios::out | std::ios::binary) {
  CHECK(out_.good()) << "Cannot create '" << filename << "'.";
  WriteNumber(kMagic, &out_);
}

void ProtoStreamWriter::WriteProto(const google::protobuf::Message& proto) {
  std::string data;
  CHECK(proto.SerializeToString(&data));
  std::string compressed;
  common::FastGzipString(data, &compressed);
  WriteRecord(compressed, &out_);
}

void ProtoStreamWriter::WriteSerialized(
    const std::function<void(const Write&)>& pieces) {
  std::string compressed;
  common::FastGzipPieces(pieces, &compressed);
  WriteRecord(compressed, &out_);
}

bool ProtoStreamWriter::Close() {
  out_.close();
  return !out_.fail();
}

ProtoStreamReader::ProtoStreamReader(const std::string& filename)
    : in_(filename, std::ios::in | std::ios::binary) {
  CHECK(in_.good()) << "Cannot open '" << filename << "'.";
  uint64 magic;
  CHECK(ReadNumber(&in_, &magic) && magic == kMagic)
      << "'" << filename << "' is not a proto stream.";
}

bool ProtoStreamReader::ReadProto(google::protobuf::Message* const proto) {
  uint64 size;
  if (!ReadNumber(&in_, &size)) return false;
  // Read in pieces, so that a wrong size does not allocate memory.
  std::string compressed;
  char piece[1 << 16];
  while (compressed.size() < size) {
    const uint64 wanted =
        std::min<uint64>(sizeof(piece), size - compressed.size());
    if (!in_.read(piece, wanted)) return false;
    compressed.append(piece, wanted);
  }
  std::string data;
  common::FastGunzipString(compressed, &data);
  return proto->ParseFromString(data);
}

bool ProtoStreamReader::eof() const { return in_.eof(); }

}  // namespace io
}  // namespace cartographer
