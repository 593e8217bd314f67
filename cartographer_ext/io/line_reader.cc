// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
#include "cartographer_ext/io/line_reader.h"

#include <sys/stat.h>

#include <algorithm>
#include <cerrno>
#include <cstring>
#include <exception>
#include <fstream>
#include <memory>
#include <utility>

#include "absl/strings/match.h"
#include "absl/strings/str_cat.h"
#include "boost/iostreams/concepts.hpp"
#include "boost/iostreams/device/file.hpp"
#include "boost/iostreams/filter/bzip2.hpp"
#include "boost/iostreams/filter/gzip.hpp"
#include "boost/iostreams/filter/lzma.hpp"
#include "boost/iostreams/filtering_streambuf.hpp"
#include "boost/iostreams/read.hpp"
#include "cartographer_ext/common/byte_order_mark.h"
#include "cartographer_ext/io/expansion_budget.h"

namespace cartographer_ext {
namespace io {
namespace {

constexpr size_t kReadSize = 1 << 16;
// Buffers behind a decompressor: what is in them when it meets damage is lost.
constexpr size_t kExpandedSize = 1 << 12;

class ExpandsTooMuch : public std::exception {
 public:
  explicit ExpandsTooMuch(const ExpansionBudget& budget) : budget_(budget) {}
  const char* what() const noexcept override { return "expands too much"; }
  const ExpansionBudget& budget() const { return budget_; }

 private:
  const ExpansionBudget budget_;
};

// A filter after the decompressor that stops reading when the budget is
// exhausted.
class ExpansionLimit : public boost::iostreams::multichar_input_filter {
 public:
  explicit ExpansionLimit(const ExpansionBudget& budget) : budget_(budget) {}

  template <typename Source>
  std::streamsize read(Source& source, char* const to,
                       const std::streamsize size) {
    const std::streamsize count = boost::iostreams::read(source, to, size);
    if (!budget_.Take(std::max<std::streamsize>(0, count))) {
      throw ExpandsTooMuch(budget_);
    }
    return count;
  }

 private:
  ExpansionBudget budget_;
};

// A filter before the decompressor that counts what it has read.
class ByteCounter : public boost::iostreams::multichar_input_filter {
 public:
  explicit ByteCounter(std::shared_ptr<int64_t> count)
      : count_(std::move(count)) {}

  template <typename Source>
  std::streamsize read(Source& source, char* const to,
                       const std::streamsize size) {
    const std::streamsize count = boost::iostreams::read(source, to, size);
    *count_ += std::max<std::streamsize>(0, count);
    return count;
  }

 private:
  const std::shared_ptr<int64_t> count_;
};

// Knows how much of the file has been read.
struct Decompressed : public boost::iostreams::filtering_istreambuf {
  std::shared_ptr<int64_t> num_read = std::make_shared<int64_t>(0);
  int64_t file_size = 0;
};

// Up to `size` bytes; exceptions of the decompressors become errors.
absl::StatusOr<size_t> ReadSome(std::streambuf* content, char* to, size_t size,
                                const std::string& filename) {
  try {
    // No more than one buffer: an exception in the next one would lose it.
    if (content->sgetc() == std::streambuf::traits_type::eof())
      return size_t{0};
    const auto available =
        static_cast<size_t>(std::max<std::streamsize>(1, content->in_avail()));
    return static_cast<size_t>(std::max<std::streamsize>(
        0, content->sgetn(to, std::min(size, available))));
  } catch (const ExpandsTooMuch& exception) {
    return exception.budget().Error(filename);
  } catch (const std::exception& exception) {
    const auto* const file = dynamic_cast<const Decompressed*>(content);
    return absl::DataLossError(absl::StrCat(
        filename, ": compressed data is damaged or truncated",
        file == nullptr ? ""
                        : absl::StrCat(" before byte ", *file->num_read, " of ",
                                       file->file_size),
        " (", exception.what(), ")"));
  }
}

}  // namespace

absl::StatusOr<std::unique_ptr<std::streambuf>> OpenDecompressed(
    const std::string& filename) {
  namespace streams = boost::iostreams;
  struct stat info;
  if (::stat(filename.c_str(), &info) != 0) {
    return absl::ErrnoToStatus(errno, absl::StrCat("cannot open ", filename));
  }
  if (S_ISDIR(info.st_mode)) {
    return absl::InvalidArgumentError(absl::StrCat(filename, " is a folder"));
  }
  errno = 0;
  std::ifstream file(filename, std::ios::binary);
  if (!file.is_open()) {
    return absl::ErrnoToStatus(errno == 0 ? EIO : errno,
                               absl::StrCat("cannot open ", filename));
  }
  char magic[6] = {};
  file.read(magic, sizeof(magic));
  const absl::string_view head(magic, file.gcount());
  file.close();
  try {
    std::unique_ptr<Decompressed> result(new Decompressed);
    result->file_size = info.st_size;
    const ByteCounter counter(result->num_read);
    const ExpansionLimit limit{ExpansionBudget(info.st_size)};
    if (absl::StartsWith(head, "\x1f\x8b")) {
      result->push(limit, kExpandedSize);
      result->push(streams::gzip_decompressor(), kExpandedSize);
      result->push(counter, kReadSize);
    } else if (absl::StartsWith(head, "BZh")) {
      result->push(limit, kExpandedSize);
      result->push(streams::bzip2_decompressor(), kExpandedSize);
      result->push(counter, kReadSize);
    } else if (head == absl::string_view("\xfd"
                                         "7zXZ\0",
                                         6)) {
      result->push(limit, kExpandedSize);
      result->push(streams::lzma_decompressor(), kExpandedSize);
      result->push(counter, kReadSize);
    }
    result->push(streams::file_source(filename, std::ios::binary), kReadSize);
    return std::unique_ptr<std::streambuf>(std::move(result));
  } catch (const std::exception& exception) {
    return absl::UnavailableError(
        absl::StrCat("cannot open ", filename, ": ", exception.what()));
  }
}

LineReader::LineReader(const std::string& filename,
                       std::unique_ptr<std::streambuf> content)
    : filename_(filename), content_(std::move(content)) {}

absl::StatusOr<std::unique_ptr<LineReader>> LineReader::Open(
    const std::string& filename) {
  auto content = OpenDecompressed(filename);
  if (!content.ok()) return content.status();
  return std::unique_ptr<LineReader>(
      new LineReader(filename, std::move(*content)));
}

absl::Status LineReader::Fill() {
  if (begin_ > 0) {
    std::memmove(buffer_.data(), buffer_.data() + begin_, end_ - begin_);
    end_ -= begin_;
    begin_ = 0;
  }
  if (buffer_.size() < end_ + kReadSize) buffer_.resize(end_ + kReadSize);
  const auto size =
      ReadSome(content_.get(), buffer_.data() + end_, kReadSize, filename_);
  if (!size.ok()) return size.status();
  end_ += *size;
  if (*size == 0) {
    at_end_ = true;
    content_.reset();  // xz may hold a dictionary of 64 MiB.
  }
  return absl::OkStatus();
}

absl::StatusOr<bool> LineReader::Next(absl::string_view* line) {
  truncated_ = false;
  size_t skipped = 0;   // Bytes of the line that were dropped.
  size_t searched = 0;  // Bytes behind `begin_` known to hold no line end.
  while (true) {
    const char* const begin = buffer_.data() + begin_;
    const char* const newline =
        begin_ + searched < end_
            ? static_cast<const char*>(
                  std::memchr(begin + searched, '\n', end_ - begin_ - searched))
            : nullptr;
    if (newline != nullptr || at_end_) {
      if (newline == nullptr && begin_ == end_) return false;
      unterminated_ = newline == nullptr;
      size_t length = newline != nullptr ? newline - begin : end_ - begin_;
      begin_ += length + (newline != nullptr ? 1 : 0);
      // The head of an overlong line was kept; the rest of it is dropped.
      length = std::min(length, kMaxLineLength);
      if (length > 0 && begin[length - 1] == '\r') --length;
      *line = absl::string_view(begin, length);
      if (++line_number_ == 1) *line = WithoutByteOrderMark(*line);
      return true;
    }
    searched = end_ - begin_;
    if (searched > kMaxLineLength) {
      truncated_ = true;
      skipped += searched - kMaxLineLength;
      if (skipped > kMaxSkippedLength) {
        return absl::InvalidArgumentError(absl::StrCat(
            filename_, ":", line_number_ + 1, ": a line of more than ",
            kMaxSkippedLength >> 20, " MB; this is not a text file"));
      }
      end_ = begin_ + kMaxLineLength;
      searched = kMaxLineLength;
    }
    const absl::Status status = Fill();
    if (!status.ok()) return status;
  }
}

std::string LineReader::Location() const {
  return absl::StrCat(filename_, ":", line_number_);
}

absl::StatusOr<std::string> ReadFile(const std::string& filename,
                                     size_t max_size) {
  auto content = OpenDecompressed(filename);
  if (!content.ok()) return content.status();
  std::string result;
  while (true) {
    const size_t old_size = result.size();
    if (old_size > max_size) {
      return absl::OutOfRangeError(
          absl::StrCat(filename, " is larger than ", max_size, " bytes"));
    }
    result.resize(old_size + kReadSize);
    const auto size =
        ReadSome(content->get(), &result[old_size], kReadSize, filename);
    if (!size.ok()) return size.status();
    result.resize(old_size + *size);
    if (*size == 0) return result;
  }
}

absl::Status ForEachRecord(const std::string& filename,
                           const std::function<absl::Status(Tokens*)>& parse) {
  auto reader = LineReader::Open(filename);
  if (!reader.ok()) return reader.status();
  absl::string_view text;
  while (true) {
    const auto more = (*reader)->Next(&text);
    if (!more.ok()) return more.status();
    if (!*more) return absl::OkStatus();
    Tokens tokens(text);
    if (!tokens.More() || tokens.rest()[0] == '#') continue;
    const absl::Status status = parse(&tokens);
    if (!status.ok()) {
      return absl::InvalidArgumentError(
          absl::StrCat((*reader)->Location(), ": ", status.message()));
    }
  }
}

}  // namespace io
}  // namespace cartographer_ext
