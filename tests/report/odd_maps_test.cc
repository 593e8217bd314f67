// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
//
// Maps as people have them: of several runs, trimmed, cut short, old. Each is
// written, read, judged, run again with stock and with ours, and reported.
#include <algorithm>
#include <functional>
#include <set>
#include <string>
#include <utility>

#include "absl/strings/str_cat.h"
#include "cartographer_ext/io/pbstream/pbstream_writer.h"
#include "cartographer_ext/map/pbstream_map.h"
#include "cartographer_ext/report/map_runs.h"
#include "cartographer_ext/report/report.h"
#include "gmock/gmock.h"
#include "gtest/gtest.h"
#include "tests/slam/room_map.h"

namespace cartographer_ext {
namespace report {
namespace {

using cartographer::mapping::proto::PoseGraph;
using cartographer::mapping::proto::PoseGraphOptions;
using testing::HasSubstr;

class OddMapsTest : public testing::Test {
 protected:
  static void SetUpTestSuite() {
    room_ = new io::Pbstream(test::MakeRoomMap(
        testing::TempDir() + "/odd_maps_test_room.pbstream", 260));
  }
  static void TearDownTestSuite() { delete room_; }

  static PoseGraphOptions Options(const std::string& more = "") {
    PoseGraphOptions options =
        test::RoomConfiguration(more).map_builder_options.pose_graph_options();
    auto* const builder = options.mutable_constraint_builder_options();
    builder->set_sampling_ratio(0.03);
    builder->mutable_fast_correlative_scan_matcher_options()
        ->set_linear_search_window(0.3);
    return options;
  }

  // Through a file, so that maps no tool could have read are noticed.
  void Report(const io::Pbstream& map) {
    const std::string filename = testing::TempDir() + "/odd_maps_test.pbstream";
    ASSERT_TRUE(io::WritePbstream(map, filename).ok());
    auto read = io::ReadPbstream(filename);
    ASSERT_TRUE(read.ok()) << read.status();
    pbstream_ = *std::move(read);
    graph_ = evaluation::MakeMapGraph(pbstream_);
    contents_ = evaluation::ReadMapContents(pbstream_, {});
    odometry_ = evaluation::ReadOdometry(pbstream_);
    RunInputs inputs;
    inputs.pbstream = &pbstream_;
    inputs.graph = &graph_;
    inputs.contents = &contents_;
    inputs.odometry = &odometry_;
    inputs.truth = &truth_;
    inputs.rerun.follow_recording = true;
    inputs.evaluation.trajectory_id = graph_.nodes.begin()->first.trajectory_id;
    evaluation::MapToEvaluate to_evaluate;
    to_evaluate.graph = &graph_;
    to_evaluate.contents = &contents_;
    to_evaluate.odometry = &odometry_;
    const auto stored =
        evaluation::EvaluateMap(to_evaluate, truth_, inputs.evaluation);
    ASSERT_TRUE(stored.ok()) << stored.status();
    data_ = ReportData();
    data_.title = "odd";
    data_.contents = &contents_;
    data_.runs.push_back(StoredRun(inputs, *stored));
    evaluation::RerunConfiguration configuration;
    configuration.stock_is_known = true;
    configuration.stock = Options();
    configuration.ours = Options("include \"loop_closure_default.lua\"");
    status_ = AddReruns(inputs, configuration, &data_);
    const auto page = MakeReport(data_);
    ASSERT_TRUE(page.ok()) << page.status();
    EXPECT_THAT(*page, testing::Not(HasSubstr("nan\"")));
    EXPECT_THAT(*page, testing::Not(HasSubstr(">nan")));
    EXPECT_FALSE(LoopsToCsv(data_).empty());
    EXPECT_FALSE(RunsToJson(data_).empty());
  }

  // After a report in which everything was run.
  const evaluation::Rerun& StockRun() const { return *data_.runs.at(1).rerun; }
  bool AllWasRun() const { return status_.ok() && data_.runs.size() == 3u; }

  static void RemoveConstraints(
      const std::function<bool(const PoseGraph::Constraint&)>& which,
      io::Pbstream* const map) {
    auto* const constraints = map->pose_graph.mutable_constraint();
    constraints->erase(
        std::remove_if(constraints->begin(), constraints->end(), which),
        constraints->end());
  }

  // As a trimmer leaves it: the submap, its constraints, and nodes that were in
  // no other.
  static void TrimSubmap(const int index, io::Pbstream* const map) {
    RemoveConstraints(
        [index](const PoseGraph::Constraint& constraint) {
          return constraint.submap_id().submap_index() == index;
        },
        map);
    std::set<int> kept;
    for (const auto& constraint : map->pose_graph.constraint()) {
      if (constraint.tag() == PoseGraph::Constraint::INTRA_SUBMAP) {
        kept.insert(constraint.node_id().node_index());
      }
    }
    const auto is_trimmed = [&kept](const int node) {
      return kept.count(node) == 0;
    };
    RemoveConstraints(
        [&](const PoseGraph::Constraint& constraint) {
          return is_trimmed(constraint.node_id().node_index());
        },
        map);
    auto& submaps = map->submaps;
    submaps.erase(std::remove_if(submaps.begin(), submaps.end(),
                                 [index](const auto& submap) {
                                   return submap.submap_id().submap_index() ==
                                          index;
                                 }),
                  submaps.end());
    auto& nodes = map->nodes;
    nodes.erase(std::remove_if(nodes.begin(), nodes.end(),
                               [&](const auto& node) {
                                 return is_trimmed(node.node_id().node_index());
                               }),
                nodes.end());
    auto* const trajectory = map->pose_graph.mutable_trajectory(0);
    auto* const node_poses = trajectory->mutable_node();
    node_poses->erase(std::remove_if(node_poses->begin(), node_poses->end(),
                                     [&](const auto& node) {
                                       return is_trimmed(node.node_index());
                                     }),
                      node_poses->end());
    auto* const submap_poses = trajectory->mutable_submap();
    submap_poses->erase(
        std::remove_if(submap_poses->begin(), submap_poses->end(),
                       [index](const auto& submap) {
                         return submap.submap_index() == index;
                       }),
        submap_poses->end());
  }

  // Adds the room once more as another trajectory, a thousand seconds later.
  static void AddTrajectory(const int id, io::Pbstream* const map) {
    constexpr int64_t kLater = 1000LL * 10000000LL;
    for (auto submap : room_->submaps) {
      submap.mutable_submap_id()->set_trajectory_id(id);
      map->submaps.push_back(submap);
    }
    for (auto node : room_->nodes) {
      node.mutable_node_id()->set_trajectory_id(id);
      auto* const data = node.mutable_node_data();
      data->set_timestamp(data->timestamp() + kLater);
      map->nodes.push_back(node);
    }
    for (auto odometry : room_->odometry_data) {
      odometry.set_trajectory_id(id);
      auto* const data = odometry.mutable_odometry_data();
      data->set_timestamp(data->timestamp() + kLater);
      map->odometry_data.push_back(odometry);
    }
    for (auto constraint : room_->pose_graph.constraint()) {
      constraint.mutable_submap_id()->set_trajectory_id(id);
      constraint.mutable_node_id()->set_trajectory_id(id);
      *map->pose_graph.add_constraint() = constraint;
    }
    auto trajectory = room_->pose_graph.trajectory(0);
    trajectory.set_trajectory_id(id);
    for (auto& node : *trajectory.mutable_node()) {
      node.set_timestamp(node.timestamp() + kLater);
    }
    *map->pose_graph.add_trajectory() = trajectory;
    *map->options.add_options_with_sensor_ids() =
        room_->options.options_with_sensor_ids(0);
  }

  static io::Pbstream* room_;
  const evaluation::GroundTruth truth_;
  io::Pbstream pbstream_;
  evaluation::MapGraph graph_;
  evaluation::MapContents contents_;
  std::map<int, evaluation::Trajectory> odometry_;
  ReportData data_;
  absl::Status status_;
};

io::Pbstream* OddMapsTest::room_ = nullptr;

TEST_F(OddMapsTest, TwoTrajectories) {
  io::Pbstream map = *room_;
  AddTrajectory(1, &map);
  Report(map);
  ASSERT_TRUE(AllWasRun()) << status_;
  EXPECT_EQ(StockRun().nodes, 2 * room_->nodes.size());
  EXPECT_EQ(StockRun().graph.submaps.size(), 2 * room_->submaps.size());
}

TEST_F(OddMapsTest, AFirstTrajectoryThatWasDeleted) {
  io::Pbstream map = *room_;
  AddTrajectory(1, &map);
  map.submaps.erase(map.submaps.begin(),
                    map.submaps.begin() + room_->submaps.size());
  map.nodes.erase(map.nodes.begin(), map.nodes.begin() + room_->nodes.size());
  RemoveConstraints(
      [](const PoseGraph::Constraint& constraint) {
        return constraint.node_id().trajectory_id() == 0;
      },
      &map);
  map.pose_graph.mutable_trajectory(0)->clear_node();
  map.pose_graph.mutable_trajectory(0)->clear_submap();
  Report(map);
  ASSERT_TRUE(AllWasRun()) << status_;
  EXPECT_EQ(StockRun().nodes, room_->nodes.size());
  EXPECT_EQ(StockRun().graph.nodes.begin()->first.trajectory_id, 1);
}

TEST_F(OddMapsTest, SubmapsTrimmedInBetween) {
  io::Pbstream map = *room_;
  for (const int index : {2, 3, 4, 9}) TrimSubmap(index, &map);
  ASSERT_LT(map.nodes.size(), room_->nodes.size());
  Report(map);
  ASSERT_TRUE(AllWasRun()) << status_;
  EXPECT_EQ(StockRun().nodes, map.nodes.size());
  EXPECT_EQ(StockRun().graph.submaps.size(), map.submaps.size());
}

TEST_F(OddMapsTest, TheBeginningWasTrimmed) {
  // As pure localisation leaves its own trajectory.
  io::Pbstream map = *room_;
  const int last = map.submaps.back().submap_id().submap_index();
  for (int index = 0; index + 3 < last; ++index) TrimSubmap(index, &map);
  Report(map);
  ASSERT_TRUE(AllWasRun()) << status_;
  EXPECT_EQ(StockRun().nodes, map.nodes.size());
}

TEST_F(OddMapsTest, WithoutConstraints) {
  io::Pbstream map = *room_;
  map.pose_graph.clear_constraint();
  Report(map);
  ASSERT_TRUE(AllWasRun()) << status_;
  EXPECT_EQ(StockRun().searches, 0);
  EXPECT_EQ(StockRun().placeholders, 1);
}

TEST_F(OddMapsTest, OneNode) {
  io::Pbstream map = *room_;
  for (int index = map.submaps.back().submap_id().submap_index(); index > 0;
       --index) {
    TrimSubmap(index, &map);
  }
  map.nodes.resize(1);
  RemoveConstraints(
      [](const PoseGraph::Constraint& constraint) {
        return constraint.node_id().node_index() != 0;
      },
      &map);
  auto* const nodes = map.pose_graph.mutable_trajectory(0)->mutable_node();
  nodes->DeleteSubrange(1, nodes->size() - 1);
  Report(map);
  ASSERT_TRUE(AllWasRun()) << status_;
  EXPECT_EQ(StockRun().nodes, 1);
}

TEST_F(OddMapsTest, WithoutSensorDataAndContentsOfOptions) {
  io::Pbstream map = *room_;
  for (auto& options : *map.options.mutable_options_with_sensor_ids()) {
    options.Clear();
  }
  map.odometry_data.clear();
  map.trajectory_data.clear();
  Report(map);
  ASSERT_TRUE(AllWasRun()) << status_;
  // No tool of the host takes a map with fewer options than trajectories.
  map.options.clear_options_with_sensor_ids();
  const std::string filename = testing::TempDir() + "/odd_maps_test.pbstream";
  ASSERT_TRUE(io::WritePbstream(map, filename).ok());
  EXPECT_THAT(std::string(io::ReadPbstream(filename).status().message()),
              HasSubstr("there are options for 0"));
}

TEST_F(OddMapsTest, Landmarks) {
  io::Pbstream map = *room_;
  for (size_t i = 0; i < map.nodes.size(); i += 7) {
    cartographer::mapping::proto::LandmarkData record;
    auto* const data = record.mutable_landmark_data();
    data->set_timestamp(map.nodes[i].node_data().timestamp());
    auto* const observation = data->add_landmark_observations();
    observation->set_id(absl::StrCat("pole ", i % 3));
    observation->mutable_landmark_to_tracking_transform()
        ->mutable_translation()
        ->set_x(1.);
    observation->mutable_landmark_to_tracking_transform()
        ->mutable_rotation()
        ->set_w(1.);
    observation->set_translation_weight(1.);
    observation->set_rotation_weight(1.);
    map.landmark_data.push_back(record);
  }
  for (int i = 0; i < 3; ++i) {
    auto* const pose = map.pose_graph.add_landmark_poses();
    pose->set_landmark_id(absl::StrCat("pole ", i));
    pose->mutable_global_pose()->mutable_translation();
    pose->mutable_global_pose()->mutable_rotation()->set_w(1.);
  }
  Report(map);
  ASSERT_TRUE(AllWasRun()) << status_;
}

TEST_F(OddMapsTest, FormatVersionOne) {
  io::Pbstream map = *room_;
  map.header.set_format_version(1);
  Report(map);
  ASSERT_TRUE(AllWasRun()) << status_;
  EXPECT_GT(data_.runs[1].graph.num_loops(), 0);
}

TEST_F(OddMapsTest, WhatCannotBeRunAgainIsStillReported) {
  io::Pbstream map = *room_;
  auto* const constraint = map.pose_graph.add_constraint();
  *constraint = map.pose_graph.constraint(0);
  constraint->mutable_node_id()->set_node_index(
      room_->nodes.back().node_id().node_index());
  Report(map);
  EXPECT_FALSE(status_.ok());
  EXPECT_THAT(std::string(status_.message()), HasSubstr("was inserted in"));
  EXPECT_EQ(data_.runs.size(), 1u);
}

}  // namespace
}  // namespace report
}  // namespace cartographer_ext
