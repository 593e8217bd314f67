// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
//
// Compressed logs that are damaged or were cut off: what is whole before is
// read.
#include <algorithm>
#include <cmath>
#include <cstdint>
#include <sstream>
#include <string>

#include "absl/strings/str_cat.h"
#include "boost/iostreams/copy.hpp"
#include "boost/iostreams/filter/bzip2.hpp"
#include "boost/iostreams/filter/gzip.hpp"
#include "boost/iostreams/filter/lzma.hpp"
#include "boost/iostreams/filtering_streambuf.hpp"
#include "cartographer_ext/io/sensor_source.h"
#include "gmock/gmock.h"
#include "gtest/gtest.h"
#include "tests/mutation.h"

namespace cartographer_ext {
namespace io {
namespace {

using ::testing::AllOf;
using ::testing::ElementsAre;
using ::testing::HasSubstr;

constexpr int kScans = 5000;

// Numbers that hardly compress.
std::string Log() {
  std::string text;
  uint32_t noise = 1;
  for (int i = 0; i < kScans; ++i) {
    absl::StrAppend(&text, "FLASER 60");
    for (int k = 0; k < 60; ++k) {
      noise = noise * 1664525u + 1013904223u;
      absl::StrAppend(&text, " ", 1 + (noise >> 16) % 7, ".", noise >> 22);
    }
    absl::StrAppend(&text, " 0 0 0 0 0 0 ", 100 + i, " robot ", i, "\n");
  }
  return text;
}

// bzip2 works in blocks of 900 kB, and a damaged block is lost as a whole: the
// log has three, and is damaged in the second one.
int ScansOfABlock() {
  return static_cast<int>(int64_t{900000} * kScans /
                          static_cast<int64_t>(Log().size()));
}

std::string Compressed(const std::string& format) {
  namespace streams = boost::iostreams;
  std::stringstream in(Log()), out;
  streams::filtering_istreambuf filter;
  if (format == "gz") filter.push(streams::gzip_compressor());
  if (format == "bz2") filter.push(streams::bzip2_compressor());
  if (format == "xz") filter.push(streams::lzma_compressor());
  filter.push(in);
  streams::copy(filter, out);
  return out.str();
}

class DamagedLogTest : public ::testing::TestWithParam<const char*> {
 protected:
  // Scans at 100 s, 101 s, ..., with some lost at the end.
  void ExpectBeginning(const std::string& bytes, const int least,
                       const int most) {
    test::TemporaryFile file(absl::StrCat(".log.", GetParam()));
    test::WriteBytes(file.path(), bytes);
    auto source = OpenSensorSource(file.path(), {});
    ASSERT_TRUE(source.ok()) << source.status();
    const SensorSourceInfo& info = (*source)->info();
    EXPECT_GE(info.num_scans, least);
    EXPECT_LE(info.num_scans, most);
    ASSERT_FALSE(info.warnings.empty());
    EXPECT_THAT(
        info.warnings.front(),
        AllOf(HasSubstr(file.path() +
                        ": compressed data is damaged or truncated before "
                        "byte "),
              HasSubstr(absl::StrCat(" of ", bytes.size())),
              HasSubstr("; read up to line "), HasSubstr(", to the stamp "),
              HasSubstr("what is behind it is lost")));
    SensorEvent event;
    int64_t num_scans = 0;
    while ((*source)->Next(&event).value()) {
      num_scans += absl::holds_alternative<LaserScan>(event);
    }
    EXPECT_EQ(num_scans, info.num_scans);
  }
};

TEST_P(DamagedLogTest, ALogThatWasCutOffIsReadUpToThere) {
  const std::string bytes = Compressed(GetParam());
  const int least =
      std::string(GetParam()) == "bz2" ? ScansOfABlock() : 3 * kScans / 4;
  ExpectBeginning(bytes.substr(0, bytes.size() * 3 / 4), least - 50,
                  3 * kScans / 4 + 50);
  // Only the checksum is missing.
  ExpectBeginning(bytes.substr(0, bytes.size() - 1), kScans - 50, kScans);
}

TEST_P(DamagedLogTest, FlippedBitsEndTheReading) {
  std::string bytes = Compressed(GetParam());
  bytes[bytes.size() * 3 / 4] ^= 0x40;
  // Of gzip the checksum comes at the end.
  ExpectBeginning(bytes, std::min(ScansOfABlock() - 50, kScans / 2), kScans);
}

TEST_P(DamagedLogTest, NothingUsableIsAnError) {
  test::TemporaryFile file(".log");
  test::WriteBytes(file.path(), Compressed(GetParam()).substr(0, 40));
  const auto source = OpenSensorSource(file.path(), {});
  EXPECT_EQ(source.status().code(), absl::StatusCode::kDataLoss);
  EXPECT_THAT(std::string(source.status().message()),
              HasSubstr("damaged or truncated"));
}

INSTANTIATE_TEST_SUITE_P(All, DamagedLogTest,
                         ::testing::Values("gz", "bz2", "xz"));

}  // namespace
}  // namespace io
}  // namespace cartographer_ext
