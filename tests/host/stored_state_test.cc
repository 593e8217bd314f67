// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
#include "cartographer/mapping/internal/stored_state.h"

#include <deque>
#include <functional>
#include <map>
#include <string>

#include "cartographer/transform/transform.h"
#include "gmock/gmock.h"
#include "gtest/gtest.h"

namespace cartographer {
namespace mapping {
namespace {

using proto::SerializedData;

// Messages in memory.
class FakeReader : public io::ProtoStreamReaderInterface {
 public:
  bool ReadProto(google::protobuf::Message* const message) override {
    if (messages.empty()) return false;
    const std::string text = messages.front();
    messages.pop_front();
    return message->ParseFromString(text);
  }
  bool eof() const override { return messages.empty() && !damaged; }

  std::deque<std::string> messages;
  bool damaged = false;
};

// A state of one trajectory with one submap, one node and one constraint.
struct State {
  State() {
    header.set_format_version(2);
    auto* const trajectory = graph.mutable_pose_graph()->add_trajectory();
    trajectory->set_trajectory_id(3);
    *trajectory->add_submap()->mutable_pose() = Identity();
    *trajectory->add_node()->mutable_pose() = Identity();
    auto* const constraint = graph.mutable_pose_graph()->add_constraint();
    constraint->mutable_submap_id()->set_trajectory_id(3);
    constraint->mutable_node_id()->set_trajectory_id(3);
    *constraint->mutable_relative_pose() = Identity();
    options.mutable_all_trajectory_builder_options()
        ->add_options_with_sensor_ids();
    submap.mutable_submap()->mutable_submap_id()->set_trajectory_id(3);
    *submap.mutable_submap()->mutable_submap_2d()->mutable_local_pose() =
        Identity();
    node.mutable_node()->mutable_node_id()->set_trajectory_id(3);
    auto* const data = node.mutable_node()->mutable_node_data();
    *data->mutable_local_pose() = Identity();
    *data->mutable_gravity_alignment() =
        transform::ToProto(Eigen::Quaterniond::Identity());
    odometry.mutable_odometry_data()->set_trajectory_id(3);
    *odometry.mutable_odometry_data()->mutable_odometry_data()->mutable_pose() =
        Identity();
  }

  static transform::proto::Rigid3d Identity() {
    return transform::ToProto(transform::Rigid3d::Identity());
  }

  absl::StatusOr<StoredState> Read(const bool damaged = false) const {
    FakeReader reader;
    reader.damaged = damaged;
    reader.messages.push_back(header.SerializeAsString());
    for (const SerializedData* const record :
         {&graph, &options, &submap, &node, &odometry, &extra}) {
      if (record->data_case() != SerializedData::DATA_NOT_SET) {
        reader.messages.push_back(record->SerializeAsString());
      }
    }
    return ReadStoredState(&reader);
  }

  proto::SerializationHeader header;
  SerializedData graph, options, submap, node, odometry, extra;
};

TEST(StoredStateTest, ReadsAndRenumbers) {
  auto state = State().Read();
  ASSERT_TRUE(state.ok()) << state.status();
  EXPECT_EQ(state->records.size(), 3);
  state->Renumber({{3, 8}});
  EXPECT_TRUE(state->SubmapPoses().Contains(SubmapId(8, 0)));
  EXPECT_TRUE(state->NodePoses().Contains(NodeId(8, 0)));
  EXPECT_EQ(state->pose_graph.constraint(0).submap_id().trajectory_id(), 8);
  EXPECT_EQ(state->pose_graph.constraint(0).node_id().trajectory_id(), 8);
  EXPECT_EQ(state->records[0].submap().submap_id().trajectory_id(), 8);
  EXPECT_EQ(state->records[1].node().node_id().trajectory_id(), 8);
  EXPECT_EQ(state->records[2].odometry_data().trajectory_id(), 8);
}

TEST(StoredStateTest, Version1IsTheSameIn2D) {
  State state;
  state.header.set_format_version(1);
  EXPECT_TRUE(state.Read().ok());
}

TEST(StoredStateTest, RefusesWhatIsBroken) {
  struct Case {
    const char* message;
    std::function<void(State*)> damage;
  };
  const std::vector<Case> cases = {
      {"format version 3", [](State* s) { s->header.set_format_version(3); }},
      {"pose graph does not follow", [](State* s) { s->graph.Clear(); }},
      {"options do not follow", [](State* s) { s->options.Clear(); }},
      {"as many builder options",
       [](State* s) {
         s->options.mutable_all_trajectory_builder_options()
             ->add_options_with_sensor_ids();
       }},
      {"trajectory id -1",
       [](State* s) {
         s->graph.mutable_pose_graph()
             ->mutable_trajectory(0)
             ->set_trajectory_id(-1);
       }},
      {"node 0 of trajectory 3 has no usable pose",
       [](State* s) {
         *s->graph.mutable_pose_graph()->mutable_trajectory(0)->add_node() =
             s->graph.pose_graph().trajectory(0).node(0);
       }},
      {"submap 0 of trajectory 3 has no usable pose",
       [](State* s) {
         s->graph.mutable_pose_graph()
             ->mutable_trajectory(0)
             ->mutable_submap(0)
             ->clear_pose();
       }},
      {"trajectory that the pose graph lacks",
       [](State* s) {
         s->node.mutable_node()->mutable_node_id()->set_trajectory_id(4);
       }},
      {"only once", [](State* s) { s->extra = s->graph; }},
      {"is 3D",
       [](State* s) { s->submap.mutable_submap()->mutable_submap_3d(); }},
      {"occurs twice", [](State* s) { s->extra = s->submap; }},
      {"occurs twice", [](State* s) { s->extra = s->node; }},
      {"has no pose",
       [](State* s) {
         s->node.mutable_node()->mutable_node_data()->clear_gravity_alignment();
       }},
      {"odometry reading",
       [](State* s) {
         s->odometry.mutable_odometry_data()
             ->mutable_odometry_data()
             ->clear_pose();
       }},
      {"not both there", [](State* s) { s->submap.Clear(); }},
      {"constraint has no usable pose",
       [](State* s) {
         s->graph.mutable_pose_graph()
             ->mutable_constraint(0)
             ->clear_relative_pose();
       }},
      {"landmark 'tree'", [](State* s) {
         s->graph.mutable_pose_graph()->add_landmark_poses()->set_landmark_id(
             "tree");
       }}};
  for (const Case& broken : cases) {
    State state;
    broken.damage(&state);
    const auto result = state.Read();
    ASSERT_FALSE(result.ok()) << broken.message;
    EXPECT_THAT(std::string(result.status().message()),
                ::testing::HasSubstr(broken.message));
  }
  EXPECT_THAT(std::string(State().Read(true).status().message()),
              ::testing::HasSubstr("cut off"));
  FakeReader empty;
  EXPECT_FALSE(ReadStoredState(&empty).ok());
}

}  // namespace
}  // namespace mapping
}  // namespace cartographer
