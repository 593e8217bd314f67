// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
//
// Damaged inputs for loaders: byte flips, truncation, duplicated, removed and
// shuffled lines or blocks, and numbers replaced by nasty ones. The same seed
// gives the same damage on every platform.
//
//   test::ForEachMutation(sample, [&](const std::string& damaged) {
//     test::WriteBytes(file, damaged);
//     LoadSomething(file);  // Must return, with or without an error.
//   });
//
// CARTOGRAPHER_EXT_FUZZ_ITERATIONS sets how many (default 300),
// CARTOGRAPHER_EXT_FUZZ_SEED which, any number.
// An input that takes longer than a minute ends the program.
#ifndef TESTS_MUTATION_H_
#define TESTS_MUTATION_H_

#include <unistd.h>

#include <algorithm>
#include <cstdio>
#include <cstdlib>
#include <fstream>
#include <iterator>
#include <string>
#include <utility>
#include <vector>

#include "cartographer_ext/common/random.h"
#include "gtest/gtest.h"

namespace cartographer_ext {
namespace test {

inline int FuzzIterations(int default_count = 300) {
  const char* const text = std::getenv("CARTOGRAPHER_EXT_FUZZ_ITERATIONS");
  return text == nullptr ? default_count : std::max(1, std::atoi(text));
}

inline std::string ReadBytes(const std::string& path) {
  std::ifstream file(path, std::ios::binary);
  return std::string(std::istreambuf_iterator<char>(file),
                     std::istreambuf_iterator<char>());
}

inline void WriteBytes(const std::string& path, const std::string& bytes) {
  std::ofstream file(path, std::ios::binary | std::ios::trunc);
  file.write(bytes.data(), static_cast<std::streamsize>(bytes.size()));
}

// A file name of this process in the folder for temporary files, removed at
// the end.
class TemporaryFile {
 public:
  explicit TemporaryFile(const std::string& suffix)
      : path_(::testing::TempDir() + "cartographer_ext_" +
              std::to_string(::getpid()) + "_" + std::to_string(Next()) +
              suffix) {}
  ~TemporaryFile() { std::remove(path_.c_str()); }
  TemporaryFile(const TemporaryFile&) = delete;
  TemporaryFile& operator=(const TemporaryFile&) = delete;
  const std::string& path() const { return path_; }

 private:
  static int Next() {
    static int counter = 0;
    return counter++;
  }
  const std::string path_;
};

class Mutator {
 public:
  explicit Mutator(uint64_t seed) : random_(seed) {}

  // One to four kinds of damage. Text and binary files get the same, as the
  // loaders cannot know which of them they are given.
  std::string Mutate(std::string data) {
    const int64_t count = random_.UniformInt(1, 4);
    for (int64_t i = 0; i < count; ++i) {
      switch (random_.UniformInt(0, 9)) {
        case 0:
        case 1:
          FlipBits(&data);
          break;
        case 2:
          SetBytes(&data);
          break;
        case 3:
          data.resize(Place(data));
          break;
        case 4:
          DuplicateBlock(&data);
          break;
        case 5:
          RemoveBlock(&data);
          break;
        case 6:
          MoveLines(&data);
          break;
        default:
          ReplaceNumber(&data);
      }
    }
    return data;
  }

 private:
  // 0 to the size, both included.
  size_t Place(const std::string& data) {
    return static_cast<size_t>(
        random_.UniformInt(0, static_cast<int64_t>(data.size())));
  }
  size_t Length(size_t limit) {
    // Small blocks are as likely as large ones.
    const int64_t bits = random_.UniformInt(0, 12);
    const int64_t length = random_.UniformInt(0, int64_t{1} << bits);
    return std::min<size_t>(limit, static_cast<size_t>(length));
  }
  void FlipBits(std::string* data) {
    if (data->empty()) return;
    const int64_t count = random_.UniformInt(1, 8);
    for (int64_t i = 0; i < count; ++i) {
      const size_t at = std::min(Place(*data), data->size() - 1);
      (*data)[at] =
          static_cast<char>((*data)[at] ^ (1 << random_.UniformInt(0, 7)));
    }
  }
  void SetBytes(std::string* data) {
    static const char kBytes[] = {'\0', '\xff', '\x7f', '\x80', '\n', ' ', '-'};
    if (data->empty()) return;
    const size_t at = std::min(Place(*data), data->size() - 1);
    const size_t length = std::max<size_t>(1, Length(data->size() - at));
    const char byte = kBytes[random_.UniformInt(0, 6)];
    std::fill(data->begin() + at, data->begin() + at + length, byte);
  }
  void DuplicateBlock(std::string* data) {
    const size_t at = Place(*data);
    const std::string block = data->substr(at, Length(data->size() - at));
    data->insert(Place(*data), block);
  }
  void RemoveBlock(std::string* data) {
    const size_t at = Place(*data);
    data->erase(at, Length(data->size() - at));
  }
  // Swaps two lines, or repeats or removes one.
  void MoveLines(std::string* data) {
    std::vector<std::string> lines;
    size_t begin = 0;
    while (begin < data->size()) {
      const size_t end = data->find('\n', begin);
      const size_t length =
          end == std::string::npos ? data->size() - begin : end + 1 - begin;
      lines.push_back(data->substr(begin, length));
      begin += length;
    }
    if (lines.empty()) return;
    const int64_t last = static_cast<int64_t>(lines.size()) - 1;
    const size_t a = static_cast<size_t>(random_.UniformInt(0, last));
    const size_t b = static_cast<size_t>(random_.UniformInt(0, last));
    switch (random_.UniformInt(0, 2)) {
      case 0:
        std::swap(lines[a], lines[b]);
        break;
      case 1: {
        const std::string copy = lines[a];
        lines.insert(lines.begin() + b, copy);
        break;
      }
      default:
        lines.erase(lines.begin() + a);
    }
    data->clear();
    for (const std::string& line : lines) *data += line;
  }
  void ReplaceNumber(std::string* data) {
    static const char* const kNumbers[] = {"0",
                                           "-1",
                                           "nan",
                                           "inf",
                                           "-inf",
                                           "1e308",
                                           "1e999",
                                           "-1e-320",
                                           "1e-999",
                                           "2147483648",
                                           "-2147483649",
                                           "-9223372036854775808",
                                           "9223372036854775807",
                                           "18446744073709551616",
                                           "99999999999999999999999999",
                                           "0x1p3",
                                           "1.5.2",
                                           "--3",
                                           "",
                                           "3.",
                                           ".5",
                                           "1e",
                                           "65536"};
    const size_t first = data->find_first_of("0123456789", Place(*data));
    if (first == std::string::npos) return;
    size_t end = data->find_first_not_of("0123456789.-+e", first);
    if (end == std::string::npos) end = data->size();
    data->replace(first, end - first, kNumbers[random_.UniformInt(0, 22)]);
  }

  Random random_;
};

inline uint64_t FuzzSeed() {
  const char* const text = std::getenv("CARTOGRAPHER_EXT_FUZZ_SEED");
  return text == nullptr ? 1 : std::strtoull(text, nullptr, 10);
}

// Calls `load` with damaged versions of `sample`, FuzzIterations() times.
template <typename Load>
void ForEachMutation(const std::string& sample, const Load& load,
                     int default_count = 300, uint64_t seed = FuzzSeed()) {
  constexpr unsigned int kMaxSeconds = 60;  // of one input
  const int count = FuzzIterations(default_count);
  for (int i = 0; i < count; ++i) {
    Mutator mutator(seed * 1000003u + static_cast<uint64_t>(i));
    ::alarm(kMaxSeconds);
    load(mutator.Mutate(sample));
  }
  ::alarm(0);
}

}  // namespace test
}  // namespace cartographer_ext

#endif  // TESTS_MUTATION_H_
