// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
#include "cartographer_ext/io/pbstream/pose_graph_edit.h"

#include <fstream>
#include <iterator>
#include <string>

#include "cartographer_ext/common/atomic_file.h"
#include "cartographer_ext/common/random.h"
#include "cartographer_ext/io/pbstream/pbstream_records.h"
#include "cartographer_ext/io/pbstream/pbstream_writer.h"
#include "gmock/gmock.h"
#include "gtest/gtest.h"
#include "tests/io/pbstream/pbstream_example.h"

namespace cartographer_ext {
namespace io {
namespace {

using cartographer::mapping::proto::PoseGraph;
using ::testing::EndsWith;
using ::testing::HasSubstr;

// A loop from submap 0 to a node; without weights the mark of a withdrawn one.
void AddLoop(const int node, const double weight, PoseGraph* const pose_graph) {
  auto* const loop = pose_graph->add_constraint();
  loop->mutable_submap_id();
  loop->mutable_node_id()->set_node_index(node);
  loop->set_tag(PoseGraph::Constraint::INTER_SUBMAP);
  SetPose(0., 0., loop->mutable_relative_pose());
  loop->set_translation_weight(weight);
  loop->set_rotation_weight(weight);
}

TEST(PoseGraphEditTest, RemovesWithdrawnLoopsAndTheirMarks) {
  PoseGraph pose_graph;
  EXPECT_EQ(RemoveWithdrawnLoops(&pose_graph), 0);
  AddLoop(3, 10., &pose_graph);
  AddLoop(4, 10., &pose_graph);
  EXPECT_EQ(RemoveWithdrawnLoops(&pose_graph), 0);
  AddLoop(3, 0., &pose_graph);
  AddLoop(5, 10., &pose_graph);
  EXPECT_EQ(RemoveWithdrawnLoops(&pose_graph), 2);
  ASSERT_EQ(pose_graph.constraint_size(), 2);
  EXPECT_EQ(pose_graph.constraint(0).node_id().node_index(), 4);
  EXPECT_EQ(pose_graph.constraint(1).node_id().node_index(), 5);
}

TEST(PoseGraphEditTest, KeepsTheBytesOfOtherRecords) {
  const Pbstream example = ExamplePbstream();
  std::string content = SerializePbstream(example);
  const std::string of_a_newer_version = "\xfa\x3f\x03new";
  AppendPbstreamRecord(of_a_newer_version, &content);
  const auto same = WithEditedPoseGraph(content, "a", [](PoseGraph*) {});
  ASSERT_TRUE(same.ok()) << same.status();
  EXPECT_EQ(*same, content);

  const auto edited = WithEditedPoseGraph(
      content, "a",
      [](PoseGraph* const pose_graph) { pose_graph->clear_constraint(); });
  ASSERT_TRUE(edited.ok()) << edited.status();
  // What follows the pose graph is most of the file.
  EXPECT_THAT(*edited, EndsWith(content.substr(content.size() / 2)));
  const auto read = ParsePbstream(*edited, "a");
  ASSERT_TRUE(read.ok()) << read.status();
  EXPECT_GT(example.pose_graph.constraint_size(), 0);
  EXPECT_EQ(read->pose_graph.constraint_size(), 0);
  EXPECT_EQ(read->nodes.size(), example.nodes.size());
  EXPECT_EQ(read->num_unknown_records, 1);
}

TEST(PoseGraphEditTest, NamesTheFileInErrors) {
  const auto edit = [](const std::string& content) {
    return WithEditedPoseGraph(content, "map.pbstream", [](PoseGraph*) {})
        .status();
  };
  EXPECT_THAT(edit("").message(), HasSubstr("map.pbstream: is empty"));
  EXPECT_EQ(edit("something else").code(), absl::StatusCode::kInvalidArgument);
  const std::string content = SerializePbstream(ExamplePbstream());
  EXPECT_EQ(edit(content.substr(0, content.size() - 1)).code(),
            absl::StatusCode::kDataLoss);
  std::string short_state(PbstreamMagic());
  AppendPbstreamRecord("\x08\x02", &short_state);
  EXPECT_THAT(edit(short_state).message(),
              HasSubstr("map.pbstream: ends before the pose graph"));
  AppendPbstreamRecord("\x08\x02", &short_state);
  EXPECT_THAT(edit(short_state).message(), HasSubstr("is not a pose graph"));
}

TEST(PoseGraphEditTest, CopiesAFile) {
  const std::string written = testing::TempDir() + "/written.pbstream";
  const std::string filename = testing::TempDir() + "/edited.pbstream";
  ASSERT_TRUE(WritePbstream(ExamplePbstream(), written).ok());
  const auto clear = [](PoseGraph* const graph) { graph->clear_constraint(); };
  ASSERT_TRUE(CopyWithEditedPoseGraph(written, filename, clear).ok());
  const auto read = ReadPbstream(filename);
  ASSERT_TRUE(read.ok()) << read.status();
  EXPECT_EQ(read->pose_graph.constraint_size(), 0);
  EXPECT_THAT(CopyWithEditedPoseGraph(written + "x", filename, clear).message(),
              HasSubstr("cannot open"));
}

// Whatever comes behind the pose graph is copied, however long the two are.
TEST(PoseGraphEditTest, CopiesALargeFile) {
  Random random(1);
  Pbstream large = ExamplePbstream();
  for (int i = 0; i < 200000; ++i) {
    auto* const pose =
        large.pose_graph.add_constraint()->mutable_relative_pose();
    pose->mutable_translation()->set_x(random.Uniform(0., 1.));
    pose->mutable_translation()->set_y(random.Uniform(0., 1.));
    pose->mutable_translation()->set_z(random.Uniform(0., 1.));
  }
  std::string content = SerializePbstream(large);
  ASSERT_GT(content.size(), 4u << 20);
  std::string noise(5 << 20, 0);
  for (char& byte : noise) byte = static_cast<char>(random.Uniform(0., 256.));
  AppendPbstreamRecord(noise, &content);
  const std::string written = testing::TempDir() + "/large.pbstream";
  const std::string filename = testing::TempDir() + "/large_edited.pbstream";
  ASSERT_TRUE(WriteFileAtomically(written, content).ok());
  const auto clear = [](PoseGraph* const graph) { graph->clear_constraint(); };
  ASSERT_TRUE(CopyWithEditedPoseGraph(written, filename, clear).ok());
  const auto expected = WithEditedPoseGraph(content, filename, clear);
  ASSERT_TRUE(expected.ok()) << expected.status();
  std::ifstream file(filename, std::ios::binary);
  const std::string copied((std::istreambuf_iterator<char>(file)),
                           std::istreambuf_iterator<char>());
  EXPECT_TRUE(copied == *expected);
}

}  // namespace
}  // namespace io
}  // namespace cartographer_ext
