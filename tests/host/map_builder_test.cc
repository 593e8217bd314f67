// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
#include "cartographer/mapping/map_builder.h"

#include <cmath>
#include <cstdio>
#include <fstream>
#include <map>
#include <memory>
#include <set>
#include <sstream>
#include <string>
#include <vector>

#include "cartographer/io/proto_stream.h"
#include "cartographer/mapping/proto/serialization.pb.h"
#include "cartographer/transform/transform.h"
#include "gtest/gtest.h"
#include "tests/host/slam_test_helpers.h"

namespace cartographer {
namespace mapping {
namespace {

using Constraint = PoseGraphInterface::Constraint;
using SensorId = MapBuilder::SensorId;
using TrajectoryState = PoseGraphInterface::TrajectoryState;
using transform::Rigid3d;

const SensorId kLaser{SensorId::SensorType::RANGE, "laser"};
const SensorId kOdometry{SensorId::SensorType::ODOMETRY, "wheels"};
const SensorId kImu{SensorId::SensorType::IMU, "imu"};

constexpr char kChanges[] = R"(
  TRAJECTORY_BUILDER_2D.use_imu_data = false
  TRAJECTORY_BUILDER_2D.use_online_correlative_scan_matching = true
  TRAJECTORY_BUILDER_2D.submaps.num_range_data = 8
  MAP_BUILDER.num_background_threads = 1
  POSE_GRAPH.optimize_every_n_nodes = 20
  POSE_GRAPH.global_sampling_ratio = 0.1
  POSE_GRAPH.constraint_builder.log_matches = false
  POSE_GRAPH.constraint_builder.sampling_ratio = 0.3
  POSE_GRAPH.constraint_builder.fast_correlative_scan_matcher = {
    linear_search_window = 2.,
    angular_search_window = math.rad(15.),
    branch_and_bound_depth = 5,
  }
)";
constexpr int kNumScans = 100;

std::string ReadFile(const std::string& filename) {
  std::ifstream in(filename, std::ios::binary);
  std::ostringstream content;
  content << in.rdbuf();
  return content.str();
}

void ExpectSame(const Rigid3d& actual, const Rigid3d& expected) {
  EXPECT_LT((actual.translation() - expected.translation()).norm(), 1e-9);
  EXPECT_LT(transform::GetAngle(actual.inverse() * expected), 1e-7);
}

struct Drive {
  int trajectory_id;
  std::vector<Rigid3d> local_poses;
  std::vector<Rigid3d> truth;
  int num_insertions = 0;
};

class MapBuilderTest : public ::testing::Test {
 protected:
  void SetUp() override { Build(""); }

  void Build(const std::string& changes) {
    options_ = test::LoadSlamOptions(kChanges + changes);
    builder_ = CreateMapBuilder(options_.map_builder);
  }

  // Drives round `num_rounds` times through the room.
  Drive Run(const double first_second, const double num_rounds = 1.,
            const int num_scans = kNumScans) {
    Drive drive;
    drive.trajectory_id = builder_->AddTrajectoryBuilder(
        {kLaser, kOdometry}, options_.trajectory_builder,
        [&drive](int, common::Time, const Rigid3d local_pose, sensor::RangeData,
                 const std::unique_ptr<
                     const TrajectoryBuilderInterface::InsertionResult>
                     insertion_result) {
          drive.local_poses.push_back(local_pose);
          drive.num_insertions += insertion_result != nullptr;
        });
    auto* const trajectory =
        builder_->GetTrajectoryBuilder(drive.trajectory_id);
    for (int i = 0; i < num_scans; ++i) {
      const Rigid3d pose = test::Drive(num_rounds * i / num_scans);
      const common::Time time = test::At(first_second + 0.3 * i);
      drive.truth.push_back(pose);
      trajectory->AddSensorData(kOdometry.id, sensor::OdometryData{time, pose});
      trajectory->AddSensorData(kLaser.id, test::Scan(pose, time));
    }
    builder_->FinishTrajectory(drive.trajectory_id);
    return drive;
  }

  int Count(const Constraint::Tag tag, const bool across = false) {
    int count = 0;
    for (const Constraint& constraint : builder_->pose_graph()->constraints()) {
      count += constraint.tag == tag &&
               (!across || constraint.node_id.trajectory_id !=
                               constraint.submap_id.trajectory_id);
    }
    return count;
  }

  // Largest distance between nodes and truth, which begin at the same pose.
  double LargestNodeError(const int trajectory_id, const double first_second) {
    double largest = 0.;
    const auto nodes = builder_->pose_graph()->GetTrajectoryNodePoses();
    for (const auto& node : nodes.trajectory(trajectory_id)) {
      const double seconds = common::ToSeconds(
          node.data.constant_pose_data->time - test::At(first_second));
      const Rigid3d truth = test::Drive(seconds / 0.3 / kNumScans);
      largest = std::max(
          largest,
          (truth.translation() - node.data.global_pose.translation()).norm());
    }
    return largest;
  }

  std::string SaveToString(const std::string& name,
                           const bool include_unfinished_submaps = true) {
    const std::string filename = ::testing::TempDir() + name;
    EXPECT_TRUE(
        builder_->SerializeStateToFile(include_unfinished_submaps, filename));
    const std::string content = ReadFile(filename);
    std::remove(filename.c_str());
    return content;
  }

  test::SlamOptions options_;
  std::unique_ptr<MapBuilderInterface> builder_;
};

TEST_F(MapBuilderTest, AddAndFinishTrajectory) {
  const int id = builder_->AddTrajectoryBuilder(
      {kLaser}, options_.trajectory_builder, nullptr);
  EXPECT_EQ(id, 0);
  EXPECT_EQ(builder_->num_trajectory_builders(), 1);
  EXPECT_NE(builder_->GetTrajectoryBuilder(0), nullptr);
  EXPECT_EQ(builder_->GetAllTrajectoryBuilderOptions().size(), 1);
  builder_->FinishTrajectory(id);
  builder_->pose_graph()->RunFinalOptimization();
  EXPECT_TRUE(builder_->pose_graph()->IsTrajectoryFinished(id));
  proto::SubmapQuery::Response response;
  EXPECT_NE(builder_->SubmapToProto(SubmapId(1, 0), &response), "");
  EXPECT_NE(builder_->SubmapToProto(SubmapId(0, 0), &response), "");
}

TEST_F(MapBuilderTest, LocalSlam) {
  const Drive drive = Run(0.);
  ASSERT_EQ(drive.local_poses.size(), kNumScans);
  EXPECT_GT(drive.num_insertions, 80);
  const Eigen::Vector3d error =
      drive.local_poses.back().translation() - drive.truth.back().translation();
  EXPECT_LT(error.norm(), 0.1);
}

TEST_F(MapBuilderTest, GlobalSlam) {
  const Drive drive = Run(0., 2., 2 * kNumScans);
  builder_->pose_graph()->RunFinalOptimization();
  auto* const graph = builder_->pose_graph();
  EXPECT_EQ(graph->GetTrajectoryNodes().SizeOfTrajectoryOrZero(0),
            drive.num_insertions);
  EXPECT_GE(graph->GetTrajectoryNodes().size(), 20);
  EXPECT_GE(graph->GetAllSubmapData().size(), 5);
  EXPECT_GE(graph->constraints().size(), 50);
  EXPECT_GE(Count(Constraint::INTER_SUBMAP), 1);
  EXPECT_LT(LargestNodeError(0, 0.), 0.1);
  // The frames of local and global SLAM agree.
  EXPECT_LT(graph->GetLocalToGlobalTransform(0).translation().norm(), 0.1);
  proto::SubmapQuery::Response response;
  EXPECT_EQ(builder_->SubmapToProto(SubmapId(0, 0), &response), "");
  EXPECT_GT(response.textures_size(), 0);
}

TEST_F(MapBuilderTest, DeleteFinishedTrajectory) {
  const int first = Run(0.).trajectory_id;
  builder_->pose_graph()->RunFinalOptimization();
  EXPECT_TRUE(builder_->pose_graph()->IsTrajectoryFinished(first));
  EXPECT_GT(builder_->pose_graph()->GetTrajectoryNodes().size(), 0);
  const int second = Run(100.).trajectory_id;
  builder_->pose_graph()->DeleteTrajectory(first);
  builder_->pose_graph()->RunFinalOptimization();
  auto* const graph = builder_->pose_graph();
  EXPECT_EQ(graph->GetTrajectoryStates().at(first), TrajectoryState::DELETED);
  EXPECT_EQ(graph->GetTrajectoryStates().at(second), TrajectoryState::FINISHED);
  EXPECT_EQ(graph->GetTrajectoryNodes().SizeOfTrajectoryOrZero(first), 0);
  EXPECT_EQ(graph->GetAllSubmapData().SizeOfTrajectoryOrZero(first), 0);
  EXPECT_GT(graph->GetTrajectoryNodes().SizeOfTrajectoryOrZero(second), 20);
  for (const Constraint& constraint : graph->constraints()) {
    EXPECT_EQ(constraint.submap_id.trajectory_id, second);
    EXPECT_EQ(constraint.node_id.trajectory_id, second);
  }
  // What is left can be stored and loaded.
  const std::string filename = ::testing::TempDir() + "deleted.pbstream";
  ASSERT_TRUE(builder_->SerializeStateToFile(true, filename));
  Build("");
  EXPECT_EQ(builder_->LoadStateFromFile(filename, false),
            (std::map<int, int>{{second, 0}}));
  std::remove(filename.c_str());
}

TEST_F(MapBuilderTest, SaveAndLoad) {
  Run(0., 2., 2 * kNumScans);
  builder_->pose_graph()->RunFinalOptimization();
  const auto nodes = builder_->pose_graph()->GetTrajectoryNodes();
  const auto submaps = builder_->pose_graph()->GetAllSubmapData();
  const auto constraints = builder_->pose_graph()->constraints();
  const std::string filename = ::testing::TempDir() + "saved.pbstream";
  ASSERT_TRUE(builder_->SerializeStateToFile(true, filename));
  const std::string content = ReadFile(filename);

  Build("");
  EXPECT_EQ(builder_->LoadStateFromFile(filename, false),
            (std::map<int, int>{{0, 0}}));
  std::remove(filename.c_str());
  EXPECT_EQ(builder_->num_trajectory_builders(), 1);
  EXPECT_EQ(builder_->GetTrajectoryBuilder(0), nullptr);
  // Without an optimisation in between everything is as it was.
  const std::string filename_again = ::testing::TempDir() + "again.pbstream";
  ASSERT_TRUE(builder_->SerializeStateToFile(true, filename_again));
  EXPECT_NEAR(1. * ReadFile(filename_again).size() / content.size(), 1., 0.01);
  std::remove(filename_again.c_str());
  const auto loaded_nodes = builder_->pose_graph()->GetTrajectoryNodes();
  ASSERT_EQ(loaded_nodes.size(), nodes.size());
  for (const auto& node : loaded_nodes) {
    const TrajectoryNode& stored = nodes.at(node.id);
    EXPECT_EQ(node.data.time(), stored.time());
    EXPECT_EQ(
        node.data.constant_data->filtered_gravity_aligned_point_cloud.size(),
        stored.constant_data->filtered_gravity_aligned_point_cloud.size());
    ExpectSame(node.data.global_pose, stored.global_pose);
    ExpectSame(node.data.constant_data->local_pose,
               stored.constant_data->local_pose);
  }
  const auto loaded_submaps = builder_->pose_graph()->GetAllSubmapData();
  ASSERT_EQ(loaded_submaps.size(), submaps.size());
  for (const auto& submap : loaded_submaps) {
    const auto& stored = submaps.at(submap.id);
    ExpectSame(submap.data.pose, stored.pose);
    EXPECT_TRUE(submap.data.submap->ToProto(true).SerializeAsString() ==
                stored.submap->ToProto(true).SerializeAsString());
  }
  const auto loaded_constraints = builder_->pose_graph()->constraints();
  ASSERT_EQ(loaded_constraints.size(), constraints.size());
  for (size_t i = 0; i < constraints.size(); ++i) {
    EXPECT_EQ(loaded_constraints[i].submap_id, constraints[i].submap_id);
    EXPECT_EQ(loaded_constraints[i].node_id, constraints[i].node_id);
    EXPECT_EQ(loaded_constraints[i].tag, constraints[i].tag);
    EXPECT_EQ(loaded_constraints[i].pose.translation_weight,
              constraints[i].pose.translation_weight);
    ExpectSame(loaded_constraints[i].pose.zbar_ij, constraints[i].pose.zbar_ij);
  }
  builder_->pose_graph()->RunFinalOptimization();
  for (const auto& node : builder_->pose_graph()->GetTrajectoryNodes()) {
    EXPECT_LT((node.data.global_pose.translation() -
               nodes.at(node.id).global_pose.translation())
                  .norm(),
              0.01);
  }
}

TEST_F(MapBuilderTest, LocalizationOnFrozenTrajectory) {
  Run(0.);
  builder_->pose_graph()->RunFinalOptimization();
  const std::string filename = ::testing::TempDir() + "frozen.pbstream";
  ASSERT_TRUE(builder_->SerializeStateToFile(true, filename));
  Build("");
  const auto ids = builder_->LoadStateFromFile(filename, true);
  std::remove(filename.c_str());
  ASSERT_EQ(ids.size(), 1);
  const auto frozen_poses = builder_->pose_graph()->GetTrajectoryNodePoses();
  const Drive drive = Run(100.);
  EXPECT_EQ(drive.trajectory_id, 1);
  builder_->pose_graph()->RunFinalOptimization();
  EXPECT_TRUE(builder_->pose_graph()->IsTrajectoryFrozen(0));
  EXPECT_GE(Count(Constraint::INTER_SUBMAP, true), 3);
  EXPECT_GE(builder_->pose_graph()->constraints().size(), 50);
  EXPECT_LT(LargestNodeError(1, 100.), 0.15);
  for (const auto& node : builder_->pose_graph()->GetTrajectoryNodePoses()) {
    if (node.id.trajectory_id == 0) {
      EXPECT_LT((node.data.global_pose.translation() -
                 frozen_poses.at(node.id).global_pose.translation())
                    .norm(),
                1e-12);
    }
  }
}

TEST_F(MapBuilderTest, PureLocalizationKeepsFewSubmaps) {
  Build(
      "TRAJECTORY_BUILDER.pure_localization_trimmer = "
      "{ max_submaps_to_keep = 3 }");
  const int id = builder_->AddTrajectoryBuilder(
      {kLaser}, options_.trajectory_builder, nullptr);
  for (int i = 0; i < kNumScans; ++i) {
    builder_->GetTrajectoryBuilder(id)->AddSensorData(
        kLaser.id,
        test::Scan(test::Drive(1. * i / kNumScans), test::At(0.3 * i)));
  }
  builder_->pose_graph()->RunFinalOptimization();
  auto* const graph = builder_->pose_graph();
  EXPECT_EQ(graph->GetAllSubmapData().size(), 3);
  EXPECT_LE(graph->GetTrajectoryNodes().size(), 32);
  EXPECT_GT(graph->GetTrajectoryNodes().begin()->id.node_index, 10);
  // What is left belongs to it alone, so it goes when the trajectory ends.
  builder_->FinishTrajectory(id);
  graph->RunFinalOptimization();
  EXPECT_TRUE(graph->GetAllSubmapData().empty());
  EXPECT_EQ(graph->GetTrajectoryStates().at(id), TrajectoryState::DELETED);
}

TEST_F(MapBuilderTest, InitialTrajectoryPose) {
  Run(0.);
  builder_->pose_graph()->RunFinalOptimization();
  auto* const initial =
      options_.trajectory_builder.mutable_initial_trajectory_pose();
  initial->set_to_trajectory_id(0);
  initial->set_timestamp(common::ToUniversal(test::At(-50.)));
  *initial->mutable_relative_pose() =
      transform::ToProto(test::Planar(0.3, 0.2, 0.1));
  const int id = builder_->AddTrajectoryBuilder(
      {kLaser}, options_.trajectory_builder, nullptr);
  builder_->GetTrajectoryBuilder(id)->AddSensorData(
      kLaser.id, test::Scan(test::Drive(0.), test::At(100.)));
  builder_->GetTrajectoryBuilder(id)->AddSensorData(
      kLaser.id, test::Scan(test::Drive(0.), test::At(106.)));
  builder_->FinishTrajectory(id);
  const Rigid3d pose = builder_->pose_graph()->GetLocalToGlobalTransform(id);
  const auto nodes = builder_->pose_graph()->GetTrajectoryNodePoses();
  const Rigid3d first = nodes.at(NodeId(0, 0)).global_pose;
  EXPECT_LT(
      ((first.inverse() * pose).translation() - Eigen::Vector3d(0.3, 0.2, 0.))
          .norm(),
      1e-6);
}

TEST_F(MapBuilderTest, ImuIsNeededWhereItIsConfigured) {
  Build(R"(
    TRAJECTORY_BUILDER_2D.use_imu_data = true
    TRAJECTORY_BUILDER_2D.pose_extrapolator.constant_velocity.imu_gravity_time_constant = 0.01
  )");
  std::vector<Rigid3d> poses;
  const int id = builder_->AddTrajectoryBuilder(
      {kLaser, kImu}, options_.trajectory_builder,
      [&poses](
          int, common::Time, const Rigid3d pose, sensor::RangeData,
          std::unique_ptr<const TrajectoryBuilderInterface::InsertionResult>) {
        poses.push_back(pose);
      });
  auto* const trajectory = builder_->GetTrajectoryBuilder(id);
  // The robot is on a slope of atan(1 / 10).
  const Eigen::Vector3d up(0.98, 0., 9.8);
  trajectory->AddSensorData(kLaser.id,
                            test::Scan(test::Drive(0.), test::At(0.)));
  for (int i = 1; i < 20; ++i) {
    trajectory->AddSensorData(
        kImu.id,
        sensor::ImuData{test::At(0.05 * i), up, Eigen::Vector3d::Zero()});
    trajectory->AddSensorData(
        kLaser.id, test::Scan(test::Drive(0.), test::At(0.05 * i + 0.01)));
  }
  builder_->FinishTrajectory(id);
  ASSERT_GT(poses.size(), 10);
  EXPECT_NEAR((poses.back().rotation() * up.normalized()).z(), 1., 1e-3);
}

// The whole state, for two runs and for several numbers of threads.
TEST_F(MapBuilderTest, ResultsDoNotDependOnThreads) {
  std::vector<std::string> states;
  for (const char* const threads : {"1", "1", "2", "4"}) {
    Build(std::string("MAP_BUILDER.num_background_threads = ") + threads);
    Run(0.);
    Run(100., 0.5, kNumScans / 2);
    builder_->pose_graph()->RunFinalOptimization();
    EXPECT_GT(Count(Constraint::INTER_SUBMAP), 10);
    states.push_back(SaveToString(std::string("threads_") + threads));
  }
  for (const std::string& state : states) {
    EXPECT_TRUE(state == states[0]);
  }
}

TEST_F(MapBuilderTest, UnfinishedSubmapsAreLeftOutOnDemand) {
  Run(0.);
  builder_->pose_graph()->RunFinalOptimization();
  const std::string filename = ::testing::TempDir() + "finished.pbstream";
  ASSERT_TRUE(builder_->SerializeStateToFile(false, filename));
  const size_t num_submaps = builder_->pose_graph()->GetAllSubmapData().size();
  const size_t num_nodes = builder_->pose_graph()->GetTrajectoryNodes().size();
  Build("");
  ASSERT_EQ(builder_->LoadStateFromFile(filename, false).size(), 1);
  std::remove(filename.c_str());
  const auto submaps = builder_->pose_graph()->GetAllSubmapData();
  EXPECT_EQ(submaps.size(), num_submaps - 2);
  for (const auto& submap : submaps) {
    EXPECT_TRUE(submap.data.submap->insertion_finished());
  }
  EXPECT_EQ(builder_->pose_graph()->GetTrajectoryNodes().size(), num_nodes);
}

TEST_F(MapBuilderTest, TrajectoriesWithoutDataSurviveStoring) {
  for (int i = 0; i < 2; ++i) {
    const int id = builder_->AddTrajectoryBuilder(
        {kLaser}, options_.trajectory_builder, nullptr);
    if (i == 1) {
      builder_->GetTrajectoryBuilder(id)->AddSensorData(
          kLaser.id, test::Scan(test::Drive(0.), test::At(1.)));
    }
    builder_->FinishTrajectory(id);
  }
  const std::string filename = ::testing::TempDir() + "empty.pbstream";
  ASSERT_TRUE(builder_->SerializeStateToFile(true, filename));
  Build("");
  EXPECT_EQ(builder_->LoadStateFromFile(filename, true),
            (std::map<int, int>{{0, 0}, {1, 1}}));
  std::remove(filename.c_str());
  EXPECT_EQ(builder_->pose_graph()->GetTrajectoryNodes().size(), 1);
}

TEST_F(MapBuilderTest, AFileThatCannotBeWritten) {
  EXPECT_FALSE(builder_->SerializeStateToFile(true, "/nowhere/at/all"));
}

TEST(MapBuilderDeathTest, ThreeDimensionsAreRefused) {
  proto::MapBuilderOptions options;
  options.set_use_trajectory_builder_3d(true);
  options.set_num_background_threads(1);
  EXPECT_DEATH(MapBuilder{options}, "2D only");
}

}  // namespace
}  // namespace mapping
}  // namespace cartographer
