// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
#include "cartographer_ext/io/pbstream/message_size.h"

#include "cartographer/mapping/proto/pose_graph.pb.h"
#include "cartographer/mapping/proto/serialization.pb.h"
#include "gtest/gtest.h"
#include "tests/io/pbstream/pbstream_example.h"

namespace cartographer_ext {
namespace io {
namespace {

constexpr int64_t kNoLimit = int64_t{1} << 40;

template <typename Message>
void ExpectNearTruth(const Message& message) {
  const std::string bytes = message.SerializeAsString();
  const int64_t estimate =
      EstimateParsedSize(*Message::descriptor(), bytes, kNoLimit);
  Message parsed;
  ASSERT_TRUE(parsed.ParseFromString(bytes));
  const auto truth = static_cast<int64_t>(parsed.SpaceUsedLong());
  EXPECT_GE(estimate, truth / 2) << parsed.GetTypeName();
  EXPECT_LE(estimate, truth * 3 / 2 + 100) << parsed.GetTypeName();
}

TEST(MessageSizeTest, IsNearTheMemoryOfTheParsedMessage) {
  const Pbstream example = ExamplePbstream();
  ExpectNearTruth(example.pose_graph);
  for (const auto& submap : example.submaps) ExpectNearTruth(submap);
  for (const auto& node : example.nodes) ExpectNearTruth(node);
  for (const auto& landmark : example.landmark_data) ExpectNearTruth(landmark);
  cartographer::mapping::proto::PoseGraph graph;
  for (int i = 0; i != 1000; ++i) graph.add_constraint();
  ExpectNearTruth(graph);
  cartographer::mapping::proto::Submap submap;
  submap.mutable_submap_2d()->mutable_grid()->mutable_cells()->Resize(100000,
                                                                      300);
  ExpectNearTruth(submap);
}

TEST(MessageSizeTest, EndsAtTheLimitAndAtDamage) {
  cartographer::mapping::proto::PoseGraph graph;
  for (int i = 0; i != 1000; ++i) graph.add_constraint();
  const std::string bytes = graph.SerializeAsString();
  const auto& type = *graph.GetDescriptor();
  const int64_t limited = EstimateParsedSize(type, bytes, 5000);
  EXPECT_GT(limited, 5000);
  EXPECT_LT(limited, 6000);
  const int64_t whole = EstimateParsedSize(type, bytes, kNoLimit);
  EXPECT_LT(EstimateParsedSize(type, bytes.substr(0, 999), kNoLimit), whole);
  EXPECT_GT(EstimateParsedSize(type, "\xff\xff\xff", kNoLimit), 0);
  EXPECT_GT(EstimateParsedSize(type, "", kNoLimit), 0);
}

}  // namespace
}  // namespace io
}  // namespace cartographer_ext
