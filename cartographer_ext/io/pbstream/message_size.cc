// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
#include "cartographer_ext/io/pbstream/message_size.h"

#include <algorithm>
#include <string>
#include <unordered_map>

#include "google/protobuf/io/coded_stream.h"
#include "google/protobuf/message.h"
#include "google/protobuf/wire_format_lite.h"

namespace cartographer_ext {
namespace io {
namespace {

using google::protobuf::Descriptor;
using google::protobuf::FieldDescriptor;
using google::protobuf::internal::WireFormatLite;

constexpr int kMaxDepth = 50;
constexpr int64_t kPointer = sizeof(void*);
// Memory of an unknown field.
constexpr int64_t kUnknownField = 16;

class Estimator {
 public:
  explicit Estimator(const int64_t limit) : limit_(limit) {}

  int64_t total() const { return total_; }

  // False where it stopped early.
  bool AddMessage(const Descriptor& type, absl::string_view bytes,
                  const int depth) {
    total_ += ObjectSize(type);
    google::protobuf::io::CodedInputStream stream(
        reinterpret_cast<const uint8_t*>(bytes.data()),
        static_cast<int>(bytes.size()));
    while (total_ <= limit_ && depth < kMaxDepth) {
      const uint32_t tag = stream.ReadTag();
      if (tag == 0) return stream.ConsumedEntireMessage();
      const FieldDescriptor* const field =
          type.FindFieldByNumber(WireFormatLite::GetTagFieldNumber(tag));
      if (WireFormatLite::GetTagWireType(tag) !=
          WireFormatLite::WIRETYPE_LENGTH_DELIMITED) {
        if (!WireFormatLite::SkipField(&stream, tag)) return false;
        total_ += field == nullptr ? kUnknownField : ElementSize(*field);
        continue;
      }
      uint32_t size = 0;
      if (!stream.ReadVarint32(&size)) return false;
      const auto position = static_cast<size_t>(stream.CurrentPosition());
      if (size > bytes.size() - position) return false;
      if (!AddContent(field, bytes.substr(position, size), depth) ||
          !stream.Skip(static_cast<int>(size))) {
        return false;
      }
    }
    return false;
  }

 private:
  bool AddContent(const FieldDescriptor* const field,
                  const absl::string_view content, const int depth) {
    const auto size = static_cast<int64_t>(content.size());
    if (field == nullptr) {
      total_ += kUnknownField + StringSize(size);
      return true;
    }
    switch (field->cpp_type()) {
      case FieldDescriptor::CPPTYPE_MESSAGE:
        if (field->is_repeated()) total_ += kPointer;
        return AddMessage(*field->message_type(), content, depth + 1);
      case FieldDescriptor::CPPTYPE_STRING:
        total_ += kPointer + StringSize(size);
        return true;
      default:
        total_ += NumElements(*field, content) * NumberSize(*field);
        return true;
    }
  }

  static int64_t StringSize(const int64_t size) {
    return static_cast<int64_t>(sizeof(std::string)) + size;
  }

  static int64_t NumberSize(const FieldDescriptor& field) {
    switch (field.cpp_type()) {
      case FieldDescriptor::CPPTYPE_INT64:
      case FieldDescriptor::CPPTYPE_UINT64:
      case FieldDescriptor::CPPTYPE_DOUBLE:
        return 8;
      case FieldDescriptor::CPPTYPE_BOOL:
        return 1;
      default:
        return 4;
    }
  }

  // A single number lies in its message.
  static int64_t ElementSize(const FieldDescriptor& field) {
    return field.is_repeated() ? NumberSize(field) : 0;
  }

  // Of a packed field.
  static int64_t NumElements(const FieldDescriptor& field,
                             const absl::string_view content) {
    if (field.cpp_type() == FieldDescriptor::CPPTYPE_DOUBLE ||
        field.cpp_type() == FieldDescriptor::CPPTYPE_FLOAT) {
      return static_cast<int64_t>(content.size()) / NumberSize(field);
    }
    // The last byte of each has no continuation bit. Fixed-size integers, which
    // no state has, are overestimated.
    return std::count_if(content.begin(), content.end(),
                         [](const char byte) { return (byte & 0x80) == 0; });
  }

  int64_t ObjectSize(const Descriptor& type) {
    const auto found = object_sizes_.find(&type);
    if (found != object_sizes_.end()) return found->second;
    const google::protobuf::Message* const prototype =
        google::protobuf::MessageFactory::generated_factory()->GetPrototype(
            &type);
    const int64_t size = prototype == nullptr
                             ? 0
                             : static_cast<int64_t>(prototype->SpaceUsedLong());
    object_sizes_[&type] = size;
    return size;
  }

  const int64_t limit_;
  int64_t total_ = 0;
  std::unordered_map<const Descriptor*, int64_t> object_sizes_;
};

}  // namespace

int64_t EstimateParsedSize(const Descriptor& type,
                           const absl::string_view bytes, const int64_t limit) {
  Estimator estimator(limit);
  estimator.AddMessage(type, bytes, 0);
  return estimator.total();
}

}  // namespace io
}  // namespace cartographer_ext
