// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
//
// States that Cartographer itself has written.
#include <string>

#include "cartographer/sensor/compressed_point_cloud.h"
#include "cartographer_ext/io/pbstream/pbstream_reader.h"
#include "cartographer_ext/io/pbstream/pbstream_writer.h"
#include "gtest/gtest.h"
#include "tests/test_data.h"

namespace cartographer_ext {
namespace io {
namespace {

class PbstreamSharedDataTest : public ::testing::TestWithParam<const char*> {};

TEST_P(PbstreamSharedDataTest, LoadSaveLoad) {
  const std::string path =
      test::SharedData(std::string("pbstream/") + GetParam() + ".pbstream");
  CARTOGRAPHER_EXT_SKIP_WITHOUT(path);
  const auto first = ReadPbstream(path);
  ASSERT_TRUE(first.ok()) << first.status();
  EXPECT_EQ(first->num_unknown_records, 0);
  EXPECT_GT(first->nodes.size(), 500);
  EXPECT_GT(first->submaps.size(), 3);
  const std::string saved = SerializePbstream(*first);
  const auto second = ParsePbstream(saved, "saved");
  ASSERT_TRUE(second.ok()) << second.status();
  const auto expect_equal = [](const auto& a, const auto& b) {
    ASSERT_EQ(a.size(), b.size());
    for (size_t i = 0; i != a.size(); ++i) {
      ASSERT_EQ(a[i].SerializeAsString(), b[i].SerializeAsString()) << i;
    }
  };
  EXPECT_EQ(first->header.SerializeAsString(),
            second->header.SerializeAsString());
  EXPECT_EQ(first->pose_graph.SerializeAsString(),
            second->pose_graph.SerializeAsString());
  EXPECT_EQ(first->options.SerializeAsString(),
            second->options.SerializeAsString());
  expect_equal(first->submaps, second->submaps);
  expect_equal(first->nodes, second->nodes);
  expect_equal(first->trajectory_data, second->trajectory_data);
  expect_equal(first->imu_data, second->imu_data);
  expect_equal(first->odometry_data, second->odometry_data);
  expect_equal(first->fixed_frame_pose_data, second->fixed_frame_pose_data);
  expect_equal(first->landmark_data, second->landmark_data);
}

// Packing what was unpacked gives the stored bytes, so the host's clouds are
// those of Cartographer.
TEST_P(PbstreamSharedDataTest, PointCloudsRepack) {
  const std::string path =
      test::SharedData(std::string("pbstream/") + GetParam() + ".pbstream");
  CARTOGRAPHER_EXT_SKIP_WITHOUT(path);
  const auto pbstream = ReadPbstream(path);
  ASSERT_TRUE(pbstream.ok()) << pbstream.status();
  for (const auto& node : pbstream->nodes) {
    const auto& stored =
        node.node_data().filtered_gravity_aligned_point_cloud();
    const cartographer::sensor::CompressedPointCloud packed(
        cartographer::sensor::CompressedPointCloud(stored).Decompress());
    ASSERT_TRUE(packed.ToProto().SerializeAsString() ==
                stored.SerializeAsString())
        << node.node_id().ShortDebugString();
  }
}

INSTANTIATE_TEST_SUITE_P(All, PbstreamSharedDataTest,
                         ::testing::Values("AGV_NAV-map", "Racelien-map",
                                           "aces-made-by-cartographer",
                                           "aces-sound-by-cartographer",
                                           "csail-made-by-cartographer",
                                           "csail-sound-by-cartographer",
                                           "forzaeth-JFR_racingv6",
                                           "forzaeth-hangar", "legndy-map"));

}  // namespace
}  // namespace io
}  // namespace cartographer_ext
