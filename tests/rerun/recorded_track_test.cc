// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
#include "cartographer_ext/rerun/recorded_track.h"

#include <cmath>
#include <string>

#include "cartographer/sensor/compressed_point_cloud.h"
#include "cartographer/sensor/point_cloud.h"
#include "cartographer_ext/map/pbstream_map.h"
#include "cartographer_ext/rerun/loop_comparison.h"
#include "cartographer_ext/rerun/rerun.h"
#include "gtest/gtest.h"
#include "tests/slam/room_map.h"

namespace cartographer_ext {
namespace evaluation {
namespace {

using cartographer::mapping::proto::PoseGraphOptions;

class RecordedTrackTest : public testing::Test {
 protected:
  static void SetUpTestSuite() {
    pbstream_ = new io::Pbstream(test::MakeRoomMap(
        testing::TempDir() + "/recorded_track_test.pbstream"));
  }
  static void TearDownTestSuite() { delete pbstream_; }

  // A distance limit inside the room, so that candidates cross it. The map is
  // what a run with it leaves.
  static PoseGraphOptions Options() {
    PoseGraphOptions options =
        test::RoomConfiguration().map_builder_options.pose_graph_options();
    auto* const builder = options.mutable_constraint_builder_options();
    builder->set_max_constraint_distance(2.5);
    builder->set_sampling_ratio(0.1);
    builder->mutable_fast_correlative_scan_matcher_options()
        ->set_linear_search_window(0.3);
    return options;
  }
  static Rerun Run(const io::Pbstream& pbstream, const bool follow,
                   const PoseGraphOptions& pose_graph_options = Options()) {
    RerunOptions options;
    options.follow_recording = follow;
    const auto rerun = RerunPoseGraph(pbstream, pose_graph_options, options);
    CHECK(rerun.ok()) << rerun.status();
    return *rerun;
  }
  // The room with the loops of a run in place of its own.
  static io::Pbstream WithLoopsOf(const Rerun& run) {
    io::Pbstream result = *pbstream_;
    auto* const constraints = result.pose_graph.mutable_constraint();
    for (int i = constraints->size() - 1; i >= 0; --i) {
      if (constraints->Get(i).tag() ==
          cartographer::mapping::proto::PoseGraph::Constraint::INTER_SUBMAP) {
        constraints->DeleteSubrange(i, 1);
      }
    }
    for (const GraphConstraint& loop : run.graph.constraints) {
      if (!loop.is_loop) continue;
      auto* const record = result.pose_graph.add_constraint();
      record->mutable_submap_id()->set_submap_index(loop.submap_id.index);
      record->mutable_node_id()->set_node_index(loop.node_id.index);
      record->set_tag(
          cartographer::mapping::proto::PoseGraph::Constraint::INTER_SUBMAP);
      auto* const pose = record->mutable_relative_pose();
      pose->mutable_translation()->set_x(loop.relative_pose.x);
      pose->mutable_translation()->set_y(loop.relative_pose.y);
      pose->mutable_rotation()->set_w(std::cos(loop.relative_pose.theta / 2.));
      pose->mutable_rotation()->set_z(std::sin(loop.relative_pose.theta / 2.));
    }
    return result;
  }

  static io::Pbstream* pbstream_;
};

io::Pbstream* RecordedTrackTest::pbstream_ = nullptr;

TEST_F(RecordedTrackTest, KnowsWhichCandidatesAreSearched) {
  // Every pair is a stored loop, so there is a outcome for each.
  Rerun every;
  const MapGraph graph = MakeMapGraph(*pbstream_);
  for (const auto& submap : graph.submaps) {
    for (const auto& node : graph.nodes) {
      GraphConstraint loop;
      loop.submap_id = submap.first;
      loop.node_id = node.first;
      loop.is_loop = true;
      every.graph.constraints.push_back(loop);
    }
  }
  const Rerun run = Run(WithLoopsOf(every), false);
  int64_t searched = 0, too_far = 0, not_sampled = 0;
  for (const auto& entry : run.outcomes) {
    searched += entry.second.kind == LoopOutcome::Kind::kSearched;
    too_far += entry.second.kind == LoopOutcome::Kind::kTooFar;
    not_sampled += entry.second.kind == LoopOutcome::Kind::kNotSampled;
    EXPECT_EQ(entry.second.distance > 2.5,
              entry.second.kind == LoopOutcome::Kind::kTooFar);
  }
  // As many as the pose graph itself searched, and the right ones.
  EXPECT_EQ(searched, run.searches);
  EXPECT_GT(too_far, 10);
  EXPECT_NEAR(0.1 * (searched + not_sampled), searched, graph.submaps.size());
  int64_t loops = 0;
  for (const GraphConstraint& loop : run.graph.constraints) {
    if (!loop.is_loop) continue;
    ++loops;
    EXPECT_EQ(run.outcomes.at({loop.submap_id, loop.node_id}).kind,
              LoopOutcome::Kind::kSearched);
  }
  EXPECT_GT(loops, 10);
}

TEST_F(RecordedTrackTest, FollowsLoopsAtTheStoredPlaceOnly) {
  const Rerun recorded = Run(*pbstream_, false);
  io::Pbstream map = WithLoopsOf(recorded);
  // One of them was somewhere else by more than rounding.
  auto* const last =
      map.pose_graph.mutable_constraint(map.pose_graph.constraint_size() - 1);
  auto* const translation =
      last->mutable_relative_pose()->mutable_translation();
  translation->set_x(translation->x() + 0.5);
  const Rerun run = Run(map, true);
  EXPECT_EQ(run.graph.num_loops(), recorded.graph.num_loops());
  EXPECT_EQ(run.followed_loops, recorded.graph.num_loops() - 1);
  EXPECT_EQ(Run(map, false).followed_loops, 0);
}

TEST_F(RecordedTrackTest, HoldsARunBesideTheRecordedOne) {
  const Rerun recorded = Run(*pbstream_, false);
  io::Pbstream map = WithLoopsOf(recorded);
  // Coarser clouds, as of a file that keeps half centimetres.
  for (auto& node : map.nodes) {
    auto* const proto = node.mutable_node_data()
                            ->mutable_filtered_gravity_aligned_point_cloud();
    cartographer::sensor::PointCloud cloud;
    for (const auto& point :
         cartographer::sensor::CompressedPointCloud(*proto).Decompress()) {
      cloud.push_back({Eigen::Vector3f(
          (point.position / 0.005f).array().round() * 0.005f)});
    }
    *proto = cartographer::sensor::CompressedPointCloud(cloud).ToProto();
  }
  const MapGraph stored = MakeMapGraph(map);
  const Rerun followed = Run(map, true);
  const LoopComparison comparison = CompareLoops(stored, followed.graph, {});
  EXPECT_GT(comparison.fraction_of_first, 0.97);
  for (const auto& node : recorded.graph.nodes) {
    ASSERT_LT(Between(node.second.global_pose,
                      followed.graph.nodes.at(node.first).global_pose)
                  .translation()
                  .norm(),
              5e-3);
  }
}

TEST_F(RecordedTrackTest, MissingLoopsAreExplained) {
  const Rerun recorded = Run(*pbstream_, false);
  const io::Pbstream map = WithLoopsOf(recorded);
  const MapGraph stored = MakeMapGraph(map);
  const auto compare = [&stored](const Rerun& run) {
    LoopComparisonOptions options;
    options.outcomes = &run.outcomes;
    return CompareLoops(stored, run.graph, options);
  };
  PoseGraphOptions options = Options();
  options.mutable_constraint_builder_options()->set_min_score(0.99);
  LoopComparison comparison = compare(Run(map, true, options));
  EXPECT_GT(comparison.no_match, 0);
  EXPECT_EQ(comparison.no_match + comparison.too_far + comparison.not_sampled,
            comparison.first - comparison.common);
  options = Options();
  options.mutable_constraint_builder_options()->set_max_constraint_distance(
      1e-3);
  comparison = compare(Run(map, true, options));
  EXPECT_EQ(comparison.common, 0);
  EXPECT_EQ(comparison.too_far, comparison.first);
  options = Options();
  options.mutable_constraint_builder_options()->set_sampling_ratio(1e-6);
  comparison = compare(Run(map, true, options));
  EXPECT_GT(comparison.not_sampled, comparison.first / 2);
}

}  // namespace
}  // namespace evaluation
}  // namespace cartographer_ext
