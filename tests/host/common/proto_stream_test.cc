// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
#include "cartographer/io/proto_stream.h"

#include <cstdio>
#include <fstream>
#include <iterator>
#include <string>

#include "cartographer/common/port.h"
#include "cartographer/io/proto_stream_deserializer.h"
#include "cartographer/mapping/proto/serialization.pb.h"
#include "gtest/gtest.h"

namespace cartographer {
namespace io {
namespace {

class ProtoStreamTest : public ::testing::Test {
 protected:
  ProtoStreamTest()
      : path_(::testing::TempDir() + "/" +
              ::testing::UnitTest::GetInstance()->current_test_info()->name() +
              ".pbstream") {}
  ~ProtoStreamTest() override { std::remove(path_.c_str()); }

  std::string Content() const {
    std::ifstream file(path_, std::ios::binary);
    return std::string(std::istreambuf_iterator<char>(file), {});
  }
  void SetContent(const std::string& content) const {
    std::ofstream(path_, std::ios::binary) << content;
  }

  // A state with one empty trajectory.
  void WriteState(const int version, const int num_options,
                  const bool in_order = true) const {
    ProtoStreamWriter writer(path_);
    mapping::proto::SerializationHeader header;
    header.set_format_version(version);
    writer.WriteProto(header);
    mapping::proto::SerializedData pose_graph, options, node;
    pose_graph.mutable_pose_graph()->add_trajectory()->set_trajectory_id(3);
    options.mutable_all_trajectory_builder_options();
    for (int i = 0; i != num_options; ++i) {
      options.mutable_all_trajectory_builder_options()
          ->add_options_with_sensor_ids();
    }
    writer.WriteProto(in_order ? pose_graph : options);
    writer.WriteProto(in_order ? options : pose_graph);
    node.mutable_node()->mutable_node_id()->set_node_index(7);
    writer.WriteProto(node);
    EXPECT_TRUE(writer.Close());
  }
  void Deserialize() const {
    ProtoStreamReader reader(path_);
    ProtoStreamDeserializer deserializer(&reader);
  }

  const std::string path_;
};

mapping::proto::NodeId Id(const int index) {
  mapping::proto::NodeId id;
  id.set_node_index(index);
  return id;
}

TEST_F(ProtoStreamTest, Layout) {
  ProtoStreamWriter writer(path_);
  writer.WriteProto(Id(5));
  ASSERT_TRUE(writer.Close());
  const std::string content = Content();
  ASSERT_GT(content.size(), 16);
  EXPECT_EQ(content.substr(0, 8), "\xdb\x01\xf5\x5b\x7b\x1f\x1d\x7b");
  EXPECT_EQ(static_cast<unsigned char>(content[8]), content.size() - 16);
  EXPECT_EQ(content.substr(9, 7), std::string(7, '\0'));
  std::string data;
  common::FastGunzipString(content.substr(16), &data);
  EXPECT_EQ(data, Id(5).SerializeAsString());
}

TEST_F(ProtoStreamTest, WritesAndReads) {
  ProtoStreamWriter writer(path_);
  for (int i = 0; i != 20; ++i) writer.WriteProto(Id(i));
  ASSERT_TRUE(writer.Close());
  ProtoStreamReader reader(path_);
  mapping::proto::NodeId id;
  for (int i = 0; i != 20; ++i) {
    ASSERT_TRUE(reader.ReadProto(&id));
    EXPECT_EQ(id.node_index(), i);
    EXPECT_FALSE(reader.eof());
  }
  EXPECT_FALSE(reader.ReadProto(&id));
  EXPECT_TRUE(reader.eof());
}

TEST_F(ProtoStreamTest, TruncatedRecordsAreNotRead) {
  ProtoStreamWriter writer(path_);
  writer.WriteProto(Id(5));
  ASSERT_TRUE(writer.Close());
  const std::string content = Content();
  for (size_t size = 8; size != content.size(); ++size) {
    SetContent(content.substr(0, size));
    ProtoStreamReader reader(path_);
    mapping::proto::NodeId id;
    EXPECT_FALSE(reader.ReadProto(&id)) << size;
  }
}

TEST_F(ProtoStreamTest, WrongSizesCostNoMemory) {
  SetContent(std::string("\xdb\x01\xf5\x5b\x7b\x1f\x1d\x7b") +
             std::string(8, '\xff') + "x");
  ProtoStreamReader reader(path_);
  mapping::proto::NodeId id;
  EXPECT_FALSE(reader.ReadProto(&id));
}

TEST_F(ProtoStreamTest, Deserializer) {
  for (const int version : {1, 2}) {
    WriteState(version, 1);
    ProtoStreamReader reader(path_);
    ProtoStreamDeserializer deserializer(&reader);
    EXPECT_EQ(deserializer.header().format_version(), version);
    EXPECT_EQ(deserializer.pose_graph().trajectory(0).trajectory_id(), 3);
    EXPECT_EQ(deserializer.all_trajectory_builder_options()
                  .options_with_sensor_ids_size(),
              1);
    mapping::proto::SerializedData data;
    ASSERT_TRUE(deserializer.ReadNextSerializedData(&data));
    EXPECT_EQ(data.node().node_id().node_index(), 7);
    EXPECT_FALSE(deserializer.ReadNextSerializedData(&data));
  }
  EXPECT_EQ(DeserializePoseGraphFromFile(path_).trajectory_size(), 1);
}

using ProtoStreamDeathTest = ProtoStreamTest;

TEST_F(ProtoStreamDeathTest, WhatIsNoStream) {
  EXPECT_DEATH(ProtoStreamReader{path_}, "Cannot open");
  SetContent("");
  EXPECT_DEATH(ProtoStreamReader{path_}, "not a proto stream");
  SetContent("something else entirely");
  EXPECT_DEATH(ProtoStreamReader{path_}, "not a proto stream");
  EXPECT_DEATH(ProtoStreamWriter("/nonexistent/file"), "Cannot create");
}

TEST_F(ProtoStreamDeathTest, WhatIsNoState) {
  SetContent("\xdb\x01\xf5\x5b\x7b\x1f\x1d\x7b");
  EXPECT_DEATH(Deserialize(), "header");
  WriteState(3, 1);
  EXPECT_DEATH(Deserialize(), "format version 3");
  WriteState(0, 1);
  EXPECT_DEATH(Deserialize(), "format version 0");
  WriteState(2, 2);
  EXPECT_DEATH(Deserialize(), "As many trajectories");
  WriteState(2, 1, false);
  EXPECT_DEATH(Deserialize(), "start with a pose graph");
}

}  // namespace
}  // namespace io
}  // namespace cartographer
