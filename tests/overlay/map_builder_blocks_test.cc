// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
//
// A whole MapBuilder with each of our blocks and with all of them, on whichever
// host is behind the overlay: maps are right, streams carry the options and
// load where no block is, and the other way round.
#include <algorithm>
#include <cmath>
#include <cstdio>
#include <fstream>
#include <iterator>
#include <map>
#include <memory>
#include <string>
#include <vector>

#include "cartographer/io/proto_stream.h"
#include "cartographer/io/proto_stream_deserializer.h"
#include "cartographer/mapping/map_builder.h"
#include "cartographer/transform/transform.h"
#include "cartographer_ext/options/extension_field.h"
#include "cartographer_ext/swaps.h"
#include "gtest/gtest.h"
#include "tests/host/slam_test_helpers.h"

namespace cartographer_ext {
namespace overlay {
namespace {

namespace mapping = cartographer::mapping;
namespace test = mapping::test;
using cartographer::transform::Rigid3d;
using mapping::MapBuilderInterface;
using Constraint = mapping::PoseGraphInterface::Constraint;
using SensorId = mapping::TrajectoryBuilderInterface::SensorId;

const SensorId kLaser{SensorId::SensorType::RANGE, "laser"};
const SensorId kOdometry{SensorId::SensorType::ODOMETRY, "wheels"};
constexpr int kNumScans = 100;

constexpr char kChanges[] = R"(
  TRAJECTORY_BUILDER_2D.use_imu_data = false
  TRAJECTORY_BUILDER_2D.use_online_correlative_scan_matching = true
  TRAJECTORY_BUILDER_2D.submaps.num_range_data = 8
  MAP_BUILDER.num_background_threads = 1
  POSE_GRAPH.optimize_every_n_nodes = 20
  POSE_GRAPH.constraint_builder.log_matches = false
  POSE_GRAPH.constraint_builder.sampling_ratio = 0.5
  POSE_GRAPH.constraint_builder.fast_correlative_scan_matcher = {
    linear_search_window = 2.,
    angular_search_window = math.rad(15.),
    branch_and_bound_depth = 5,
  }
)";

// A name and lines of Lua that switch our classes on.
struct Blocks {
  std::string name;
  std::string lua;
};

std::vector<Blocks> AllBlocks() {
  std::vector<Blocks> blocks;
#ifdef CARTOGRAPHER_EXT_SWAP_CONSTRAINT_BUILDER
  blocks.push_back({"constraint_builder",
                    "POSE_GRAPH.constraint_builder.cartographer_ext = {}\n"});
#endif
#ifdef CARTOGRAPHER_EXT_SWAP_CERES_SCAN_MATCHER
  blocks.push_back(
      {"ceres_scan_matcher",
       "TRAJECTORY_BUILDER_2D.ceres_scan_matcher.cartographer_ext = {}\n"
       "POSE_GRAPH.constraint_builder.ceres_scan_matcher.cartographer_ext = "
       "{}\n"});
#endif
#ifdef CARTOGRAPHER_EXT_SWAP_OPTIMIZATION_PROBLEM
  blocks.push_back({"optimization_problem",
                    "POSE_GRAPH.optimization_problem.cartographer_ext = {}\n"});
#endif
#ifdef CARTOGRAPHER_EXT_SWAP_LOCAL_TRAJECTORY_BUILDER
  blocks.push_back({"local_trajectory_builder",
                    "TRAJECTORY_BUILDER_2D.cartographer_ext = {}\n"});
#endif
  Blocks all{"all", ""};
  for (const Blocks& one : blocks) all.lua += one.lua;
  blocks.push_back(all);
  return blocks;
}

std::string TemporaryFile(const std::string& name) {
  return testing::TempDir() + "map_builder_blocks_" + name + ".pbstream";
}

struct Travel {
  std::vector<Rigid3d> local_poses;
  std::vector<Rigid3d> truth;
};

// The first scans of a round through the room.
Travel Drive(const mapping::proto::TrajectoryBuilderOptions& options,
             MapBuilderInterface* const builder,
             const int num_scans = kNumScans) {
  Travel run;
  const int trajectory_id = builder->AddTrajectoryBuilder(
      {kLaser, kOdometry}, options,
      [&run](int, cartographer::common::Time, const Rigid3d local_pose,
             cartographer::sensor::RangeData,
             const std::unique_ptr<
                 const mapping::TrajectoryBuilderInterface::InsertionResult>) {
        run.local_poses.push_back(local_pose);
      });
  auto* const trajectory = builder->GetTrajectoryBuilder(trajectory_id);
  for (int i = 0; i != num_scans; ++i) {
    const Rigid3d pose = test::Drive(static_cast<double>(i) / kNumScans);
    const cartographer::common::Time time = test::At(0.3 * i);
    run.truth.push_back(pose);
    trajectory->AddSensorData(kOdometry.id,
                              cartographer::sensor::OdometryData{time, pose});
    trajectory->AddSensorData(kLaser.id, test::Scan(pose, time));
  }
  builder->FinishTrajectory(trajectory_id);
  builder->pose_graph()->RunFinalOptimization();
  return run;
}

double LargestError(const std::vector<Rigid3d>& poses,
                    const std::vector<Rigid3d>& truth) {
  double largest = 0.;
  // A builder may keep the first scans back.
  const size_t missing = truth.size() - poses.size();
  const Rigid3d to_truth = truth[missing] * poses[0].inverse();
  for (size_t i = 0; i != poses.size(); ++i) {
    largest = std::max(largest, (truth[missing + i].translation() -
                                 (to_truth * poses[i]).translation())
                                    .norm());
  }
  return largest;
}

#ifdef CARTOGRAPHER_EXT_SWAP_LOCAL_TRAJECTORY_BUILDER
// Odometry that comes twice, or again after a later one, would end a stock
// program. With our local SLAM it changes nothing.
TEST(MapBuilderOdometryTest, ReadingsThatAreNotLaterAreDropped) {
  const test::SlamOptions options = test::LoadSlamOptions(
      std::string(kChanges) + "TRAJECTORY_BUILDER_2D.cartographer_ext = {}\n");
  std::vector<std::string> poses(2);
  for (const bool repeated : {false, true}) {
    const auto builder = mapping::CreateMapBuilder(options.map_builder);
    std::string* const text = &poses[repeated ? 1 : 0];
    const int trajectory_id = builder->AddTrajectoryBuilder(
        {kLaser, kOdometry}, options.trajectory_builder,
        [text](
            int, cartographer::common::Time, const Rigid3d local_pose,
            cartographer::sensor::RangeData,
            const std::unique_ptr<
                const mapping::TrajectoryBuilderInterface::InsertionResult>) {
          *text +=
              cartographer::transform::ToProto(local_pose).SerializeAsString();
        });
    auto* const trajectory = builder->GetTrajectoryBuilder(trajectory_id);
    for (int i = 0; i != kNumScans / 5; ++i) {
      const Rigid3d pose = test::Drive(static_cast<double>(i) / kNumScans);
      const auto time = test::At(0.3 * i);
      trajectory->AddSensorData(kOdometry.id,
                                cartographer::sensor::OdometryData{time, pose});
      if (repeated) {
        for (const double late : {0., 0.1, 2.}) {
          trajectory->AddSensorData(kOdometry.id,
                                    cartographer::sensor::OdometryData{
                                        test::At(0.3 * i - late), Rigid3d()});
        }
      }
      trajectory->AddSensorData(kLaser.id, test::Scan(pose, time));
    }
    builder->FinishTrajectory(trajectory_id);
    builder->pose_graph()->RunFinalOptimization();
  }
  EXPECT_GT(poses[0].size(), 100u);
  EXPECT_EQ(poses[0], poses[1]);
}
#endif

#if defined(CARTOGRAPHER_EXT_SWAP_LOCAL_TRAJECTORY_BUILDER) && \
    defined(CARTOGRAPHER_EXT_SWAP_CONSTRAINT_BUILDER)
int CountLines(const std::string& filename) {
  std::ifstream file(filename);
  return static_cast<int>(std::count(std::istreambuf_iterator<char>(file),
                                     std::istreambuf_iterator<char>(), '\n'));
}

// Without a program that asks for the records, as in an unedited node.
TEST(MapBuilderLogTest, RecordsAreWrittenWhileTheProgramRuns) {
  const std::string folder = testing::TempDir() + "map_builder_log_test";
  const std::string log = " = { log = { directory = '" + folder + "' } }\n";
  const test::SlamOptions options = test::LoadSlamOptions(
      kChanges + ("TRAJECTORY_BUILDER_2D.cartographer_ext" + log) +
      "POSE_GRAPH.constraint_builder.cartographer_ext" + log);
  const auto builder = mapping::CreateMapBuilder(options.map_builder);
  const Travel run = Drive(options.trajectory_builder, builder.get());
  // A head line, and one for each scan.
  EXPECT_EQ(CountLines(folder + "/nodes-1.csv"),
            1 + static_cast<int>(run.local_poses.size()));
  EXPECT_GT(CountLines(folder + "/loops-1.csv"), 10);
  for (const char* name :
       {"/nodes-1.csv", "/nodes-1.pb", "/loops-1.csv", "/loops-1.pb"}) {
    EXPECT_EQ(std::remove((folder + name).c_str()), 0) << name;
  }
  std::remove(folder.c_str());
}
#endif

class MapBuilderBlocksTest : public testing::TestWithParam<Blocks> {};

TEST_P(MapBuilderBlocksTest, MapsARoom) {
  const test::SlamOptions options =
      test::LoadSlamOptions(kChanges + GetParam().lua);
  const auto builder = mapping::CreateMapBuilder(options.map_builder);
  const Travel run = Drive(options.trajectory_builder, builder.get());
  ASSERT_GE(run.local_poses.size(), kNumScans - 2u);
  EXPECT_LT(LargestError(run.local_poses, run.truth), 0.15);
  const auto nodes = builder->pose_graph()->GetTrajectoryNodePoses();
  EXPECT_GE(nodes.SizeOfTrajectoryOrZero(0), 30u);
  for (const auto& node : nodes) {
    EXPECT_TRUE(node.data.global_pose.IsValid());
  }
  int loops = 0;
  for (const Constraint& constraint : builder->pose_graph()->constraints()) {
    if (constraint.tag != Constraint::INTER_SUBMAP) continue;
    ++loops;
    EXPECT_GT(constraint.pose.translation_weight, 0.);
    EXPECT_GT(constraint.pose.rotation_weight, 0.);
  }
  // The room is always in view.
  EXPECT_GE(loops, 1);
}

TEST(MapBuilderAllBlocksTest, IsDeterministic) {
  const std::string all_blocks = AllBlocks().back().lua;
  std::vector<std::string> poses(2);
  for (std::string& text : poses) {
    const test::SlamOptions options =
        test::LoadSlamOptions(kChanges + all_blocks);
    const auto builder = mapping::CreateMapBuilder(options.map_builder);
    for (const Rigid3d& pose :
         Drive(options.trajectory_builder, builder.get()).local_poses) {
      text += cartographer::transform::ToProto(pose).SerializeAsString();
    }
  }
  EXPECT_EQ(poses[0], poses[1]);
}

// Both directions: a map made with blocks is loaded, frozen, by a builder
// without, and one made without by a builder with them, which goes on mapping.
TEST_P(MapBuilderBlocksTest, StreamsGoBothWays) {
  const test::SlamOptions with =
      test::LoadSlamOptions(kChanges + GetParam().lua);
  const test::SlamOptions without = test::LoadSlamOptions(kChanges);
  for (const bool write_with : {true, false}) {
    const test::SlamOptions& writing = write_with ? with : without;
    const test::SlamOptions& reading = write_with ? without : with;
    const std::string file = TemporaryFile(GetParam().name);
    const auto writer = mapping::CreateMapBuilder(writing.map_builder);
    Drive(writing.trajectory_builder, writer.get(), kNumScans / 2);
    ASSERT_TRUE(writer->SerializeStateToFile(true, file));
    const auto reader = mapping::CreateMapBuilder(reading.map_builder);
    reader->LoadStateFromFile(file, /*load_frozen_state=*/true);
    const auto nodes = reader->pose_graph()->GetTrajectoryNodePoses();
    const auto written = writer->pose_graph()->GetTrajectoryNodePoses();
    ASSERT_EQ(nodes.size(), written.size());
    for (const auto& node : written) {
      EXPECT_LT((nodes.at(node.id).global_pose.translation() -
                 node.data.global_pose.translation())
                    .norm(),
                1e-9);
    }
    const Travel run =
        Drive(reading.trajectory_builder, reader.get(), kNumScans / 5);
    EXPECT_LT(LargestError(run.local_poses, run.truth), 0.15);
    std::remove(file.c_str());
  }
}

// What belongs to the trajectory is in the stream, as the user wrote it.
TEST_P(MapBuilderBlocksTest, StreamsCarryTheOptions) {
  const test::SlamOptions options =
      test::LoadSlamOptions(kChanges + GetParam().lua);
  const auto builder = mapping::CreateMapBuilder(options.map_builder);
  Drive(options.trajectory_builder, builder.get(), kNumScans / 5);
  const std::string file = TemporaryFile("options_" + GetParam().name);
  ASSERT_TRUE(builder->SerializeStateToFile(true, file));
  cartographer::io::ProtoStreamReader reader(file);
  cartographer::io::ProtoStreamDeserializer deserializer(&reader);
  const auto& stored = deserializer.all_trajectory_builder_options()
                           .options_with_sensor_ids(0)
                           .trajectory_builder_options()
                           .trajectory_builder_2d_options();
  const auto& local =
      options.trajectory_builder.trajectory_builder_2d_options();
  EXPECT_EQ(stored.SerializeAsString(), local.SerializeAsString());
  EXPECT_EQ(options::HasExtension(stored), options::HasExtension(local));
  EXPECT_EQ(options::HasExtension(stored.ceres_scan_matcher_options()),
            options::HasExtension(local.ceres_scan_matcher_options()));
  std::remove(file.c_str());
}

INSTANTIATE_TEST_SUITE_P(EachAndAll, MapBuilderBlocksTest,
                         testing::ValuesIn(AllBlocks()),
                         [](const testing::TestParamInfo<Blocks>& info) {
                           return info.param.name;
                         });

}  // namespace
}  // namespace overlay
}  // namespace cartographer_ext
