// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
//
// Damaged states: the reader must return, and what it takes the host must take.
#include <cstdint>
#include <string>
#include <utility>
#include <vector>

#include "cartographer/common/configuration_file_resolver.h"
#include "cartographer/common/lua_parameter_dictionary.h"
#include "cartographer/mapping/map_builder.h"
#include "cartographer_ext/common/random.h"
#include "cartographer_ext/io/pbstream/pbstream_reader.h"
#include "cartographer_ext/io/pbstream/pbstream_records.h"
#include "cartographer_ext/io/pbstream/pbstream_validation.h"
#include "cartographer_ext/io/pbstream/pbstream_writer.h"
#include "gtest/gtest.h"
#include "tests/io/pbstream/pbstream_example.h"
#include "tests/mutation.h"
#include "tests/test_data.h"

namespace cartographer_ext {
namespace io {
namespace {

class NoLimit : public ContentLimit {
 public:
  int64_t For(absl::string_view, int64_t) const override {
    return int64_t{1} << 40;
  }
};

std::vector<std::string> ExpandedRecords(const std::string& content) {
  PbstreamRecords records(content, "sample");
  std::vector<std::string> result;
  std::string record;
  while (records.Next(NoLimit(), &record).value()) result.push_back(record);
  return result;
}

// Damage below the compression, which a checksum would notice otherwise.
std::string DamageRecords(std::vector<std::string> records,
                          const uint64_t seed) {
  Random random(seed);
  const auto any = [&random, &records]() {
    return static_cast<size_t>(
        random.UniformInt(0, static_cast<int64_t>(records.size()) - 1));
  };
  const int64_t count = random.UniformInt(1, 3);
  for (int64_t i = 0; i != count && !records.empty(); ++i) {
    switch (random.UniformInt(0, 6)) {
      case 0:
        std::swap(records[any()], records[any()]);
        break;
      case 1: {
        const std::string copy = records[any()];
        records.insert(records.begin() + any(), copy);
        break;
      }
      case 2:
        records.erase(records.begin() + any());
        break;
      case 3: {
        // A piece of one record in another.
        std::string& target = records[any()];
        const std::string& source = records[any()];
        const size_t from =
            static_cast<size_t>(random.UniformInt(0, source.size()));
        const std::string piece = source.substr(from, random.UniformInt(0, 64));
        target.insert(random.UniformInt(0, target.size()), piece);
        break;
      }
      default: {
        // In place, so that the outer sizes stay right more often.
        std::string& record = records[any()];
        if (record.empty()) break;
        for (int64_t k = random.UniformInt(1, 4); k > 0; --k) {
          const int64_t last = static_cast<int64_t>(record.size()) - 1;
          record[random.UniformInt(0, last)] =
              static_cast<char>(random.UniformInt(0, 255));
        }
      }
    }
  }
  std::string content(PbstreamMagic());
  for (const std::string& record : records) {
    AppendPbstreamRecord(record, &content);
  }
  return content;
}

class PbstreamFuzzTest : public ::testing::Test {
 protected:
  PbstreamFuzzTest() : file_(".pbstream") {
    cartographer::common::ConfigurationFileResolver resolver(
        {"configuration_files"});
    auto file_resolver =
        std::make_unique<cartographer::common::ConfigurationFileResolver>(
            resolver);
    const auto dictionary =
        cartographer::common::LuaParameterDictionary::NonReferenceCounted(
            resolver.GetFileContentOrDie("stock.lua"),
            std::move(file_resolver));
    options_ = cartographer::mapping::CreateMapBuilderOptions(
        dictionary->GetDictionary("map_builder").get());
    options_.set_num_background_threads(1);
  }

  // The reader's answer; what it takes must survive a round trip and the host.
  void Load(const std::string& content) {
    const absl::StatusOr<Pbstream> loaded = ParsePbstream(content, "damaged");
    if (!loaded.ok()) {
      EXPECT_FALSE(loaded.status().message().empty());
      ++num_refused_;
      return;
    }
    ++num_taken_;
    const std::string saved = SerializePbstream(*loaded);
    const absl::StatusOr<Pbstream> again = ParsePbstream(saved, "saved");
    ASSERT_TRUE(again.ok()) << again.status();
    EXPECT_EQ(SerializePbstream(*again), saved);

    test::WriteBytes(file_.path(), content);
    const auto builder = cartographer::mapping::CreateMapBuilder(options_);
    const size_t num_trajectories = loaded->pose_graph.trajectory_size();
    EXPECT_EQ(
        builder->LoadStateFromFile(file_.path(), num_taken_ % 2 == 0).size(),
        num_trajectories);
  }

  void ExpectBothAnswers() const {
    EXPECT_GT(num_refused_, 0);
    EXPECT_GT(num_taken_, 0);
    RecordProperty("refused", num_refused_);
    RecordProperty("taken", num_taken_);
  }

  const test::TemporaryFile file_;
  cartographer::mapping::proto::MapBuilderOptions options_;
  int num_refused_ = 0;
  int num_taken_ = 0;
};

TEST_F(PbstreamFuzzTest, DamagedBytes) {
  const std::string sample = SerializePbstream(ExamplePbstream());
  test::ForEachMutation(sample,
                        [this](const std::string& damaged) { Load(damaged); });
  EXPECT_GT(num_refused_, 0);
}

TEST_F(PbstreamFuzzTest, DamagedRecords) {
  const std::vector<std::string> records =
      ExpandedRecords(SerializePbstream(ExamplePbstream()));
  for (int i = 0; i != test::FuzzIterations(); ++i) {
    Load(DamageRecords(records, i));
  }
  ExpectBothAnswers();
}

// A piece of a real state: larger records, real values.
TEST_F(PbstreamFuzzTest, DamagedRealRecords) {
  const std::string path = test::SharedData("pbstream/legndy-map.pbstream");
  CARTOGRAPHER_EXT_SKIP_WITHOUT(path);
  auto pbstream = ReadPbstream(path);
  ASSERT_TRUE(pbstream.ok()) << pbstream.status();
  pbstream->submaps.resize(1);
  pbstream->nodes.resize(20);
  pbstream->odometry_data.resize(
      std::min<size_t>(pbstream->odometry_data.size(), 20));
  auto* const constraints = pbstream->pose_graph.mutable_constraint();
  for (int i = constraints->size() - 1; i >= 0; --i) {
    const auto& constraint = constraints->Get(i);
    if (constraint.node_id().node_index() >= 20 ||
        constraint.submap_id().submap_index() >= 1) {
      constraints->DeleteSubrange(i, 1);
    }
  }
  ASSERT_EQ(FindPbstreamProblems(*pbstream), std::vector<std::string>());
  const std::vector<std::string> records =
      ExpandedRecords(SerializePbstream(*pbstream));
  for (int i = 0; i != std::max(1, test::FuzzIterations() / 5); ++i) {
    Load(DamageRecords(records, i));
  }
  ExpectBothAnswers();
}

}  // namespace
}  // namespace io
}  // namespace cartographer_ext
