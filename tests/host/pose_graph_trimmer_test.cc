// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
#include "cartographer/mapping/pose_graph_trimmer.h"

#include <algorithm>
#include <map>
#include <memory>
#include <vector>

#include "absl/memory/memory.h"
#include "cartographer/mapping/2d/probability_grid.h"
#include "cartographer/mapping/2d/submap_2d.h"
#include "cartographer/mapping/internal/2d/overlapping_submaps_trimmer_2d.h"
#include "cartographer/transform/transform.h"
#include "gtest/gtest.h"
#include "tests/host/slam_test_helpers.h"

namespace cartographer {
namespace mapping {
namespace {

using Constraint = PoseGraphInterface::Constraint;
using TrajectoryState = PoseGraphInterface::TrajectoryState;

// A graph that lives in the test.
class FakeTrimmable : public Trimmable {
 public:
  int num_submaps(const int trajectory_id) const override {
    return submaps.SizeOfTrajectoryOrZero(trajectory_id);
  }
  std::vector<SubmapId> GetSubmapIds(const int trajectory_id) const override {
    std::vector<SubmapId> ids;
    for (const auto& submap : submaps.trajectory(trajectory_id)) {
      ids.push_back(submap.id);
    }
    return ids;
  }
  MapById<SubmapId, PoseGraphInterface::SubmapData> GetOptimizedSubmapData()
      const override {
    return submaps;
  }
  const MapById<NodeId, TrajectoryNode>& GetTrajectoryNodes() const override {
    return nodes;
  }
  const std::vector<Constraint>& GetConstraints() const override {
    return constraints;
  }
  void TrimSubmap(const SubmapId& submap_id) override {
    trimmed.push_back(submap_id);
    submaps.Trim(submap_id);
    constraints.erase(
        std::remove_if(constraints.begin(), constraints.end(),
                       [&submap_id](const Constraint& constraint) {
                         return constraint.submap_id == submap_id;
                       }),
        constraints.end());
  }
  bool IsFinished(const int trajectory_id) const override {
    return finished.count(trajectory_id) > 0;
  }
  void SetTrajectoryState(const int trajectory_id,
                          const TrajectoryState state) override {
    states[trajectory_id] = state;
  }

  MapById<SubmapId, PoseGraphInterface::SubmapData> submaps;
  MapById<NodeId, TrajectoryNode> nodes;
  std::vector<Constraint> constraints;
  std::set<int> finished;
  std::map<int, TrajectoryState> states;
  std::vector<SubmapId> trimmed;
};

TEST(PureLocalizationTrimmerTest, KeepsTheNewestSubmaps) {
  FakeTrimmable graph;
  for (int i = 0; i < 5; ++i) graph.submaps.Append(7, {});
  graph.submaps.Append(8, {});
  PureLocalizationTrimmer trimmer(7, 3);
  trimmer.Trim(&graph);
  EXPECT_EQ(graph.trimmed,
            (std::vector<SubmapId>{SubmapId(7, 0), SubmapId(7, 1)}));
  EXPECT_FALSE(trimmer.IsFinished());
  trimmer.Trim(&graph);
  EXPECT_EQ(graph.trimmed.size(), 2);
  EXPECT_TRUE(graph.states.empty());
}

TEST(PureLocalizationTrimmerTest, RemovesAFinishedTrajectory) {
  FakeTrimmable graph;
  for (int i = 0; i < 2; ++i) graph.submaps.Append(7, {});
  graph.finished.insert(7);
  PureLocalizationTrimmer trimmer(7, 3);
  trimmer.Trim(&graph);
  EXPECT_TRUE(trimmer.IsFinished());
  EXPECT_EQ(graph.trimmed.size(), 2);
  EXPECT_EQ(graph.states.at(7), TrajectoryState::DELETED);
}

TEST(PureLocalizationTrimmerDeathTest, LocalSlamNeedsTwoSubmaps) {
  EXPECT_DEATH(PureLocalizationTrimmer(0, 1), "two newest");
}

class OverlappingSubmapsTrimmerTest : public ::testing::Test {
 protected:
  // A submap that knows a square of `num_cells` cells of 1 m, its corner of
  // largest coordinates at (x, y), last seen at `seconds`.
  void AddSubmap(const double x, const double y, const int num_cells,
                 const double seconds, const bool finished = true) {
    auto grid = absl::make_unique<ProbabilityGrid>(
        MapLimits(1., Eigen::Vector2d(20., 20.), CellLimits(40, 40)), &tables_);
    for (int i = 0; i < num_cells; ++i) {
      for (int j = 0; j < num_cells; ++j) {
        grid->SetProbability(Eigen::Array2i(20 + i, 20 + j), 0.7f);
      }
    }
    auto submap = std::make_shared<Submap2D>(Eigen::Vector2f::Zero(),
                                             std::move(grid), &tables_);
    submap->set_insertion_finished(finished);
    const SubmapId submap_id =
        graph_.submaps.Append(0, {submap, test::Planar(x, y, 0.)});
    auto data = std::make_shared<TrajectoryNode::Data>();
    data->time = test::At(seconds);
    const NodeId node_id = graph_.nodes.Append(0, TrajectoryNode{data, {}});
    graph_.constraints.push_back(
        Constraint{submap_id, node_id, {}, Constraint::INTRA_SUBMAP});
    // Does not make any submap newer.
    graph_.constraints.push_back(
        Constraint{SubmapId(0, 0), node_id, {}, Constraint::INTER_SUBMAP});
  }

  ValueConversionTables tables_;
  FakeTrimmable graph_;
};

TEST_F(OverlappingSubmapsTrimmerTest, RemovesACoveredSubmap) {
  AddSubmap(0., 0., 3, 1.);
  AddSubmap(0., 0., 4, 2.);
  OverlappingSubmapsTrimmer2D trimmer(1, 1., 0);
  trimmer.Trim(&graph_);
  EXPECT_EQ(graph_.trimmed, (std::vector<SubmapId>{SubmapId(0, 0)}));
  EXPECT_FALSE(trimmer.IsFinished());
}

TEST_F(OverlappingSubmapsTrimmerTest, KeepsWhatCoversEnoughOfItsOwn) {
  // Of nine cells, the newer one at an offset of one leaves five.
  AddSubmap(0., 0., 3, 1.);
  AddSubmap(1., 1., 3, 2.);
  OverlappingSubmapsTrimmer2D(1, 5., 0).Trim(&graph_);
  EXPECT_TRUE(graph_.trimmed.empty());
  OverlappingSubmapsTrimmer2D(1, 6., 0).Trim(&graph_);
  EXPECT_EQ(graph_.trimmed, (std::vector<SubmapId>{SubmapId(0, 0)}));
}

TEST_F(OverlappingSubmapsTrimmerTest, KeepsTheFreshOnes) {
  for (int i = 0; i < 4; ++i) AddSubmap(0., 0., 3, 10. - i);
  OverlappingSubmapsTrimmer2D(2, 1., 0).Trim(&graph_);
  // The later ones were seen earlier.
  EXPECT_EQ(graph_.trimmed,
            (std::vector<SubmapId>{SubmapId(0, 2), SubmapId(0, 3)}));
}

TEST_F(OverlappingSubmapsTrimmerTest, WaitsForEnoughNewSubmaps) {
  AddSubmap(0., 0., 3, 1.);
  AddSubmap(0., 0., 3, 2.);
  OverlappingSubmapsTrimmer2D trimmer(1, 1., 2);
  trimmer.Trim(&graph_);
  EXPECT_TRUE(graph_.trimmed.empty());
  AddSubmap(0., 0., 3, 3.);
  trimmer.Trim(&graph_);
  EXPECT_EQ(graph_.trimmed.size(), 2);
  AddSubmap(0., 0., 3, 4.);
  AddSubmap(0., 0., 3, 5.);
  trimmer.Trim(&graph_);
  EXPECT_EQ(graph_.trimmed.size(), 2);
  AddSubmap(0., 0., 3, 6.);
  trimmer.Trim(&graph_);
  EXPECT_EQ(graph_.trimmed.size(), 5);
}

TEST_F(OverlappingSubmapsTrimmerTest, LeavesGrowingSubmapsAlone) {
  AddSubmap(0., 0., 3, 1., false);
  AddSubmap(0., 0., 3, 2.);
  OverlappingSubmapsTrimmer2D(1, 1., 0).Trim(&graph_);
  EXPECT_TRUE(graph_.trimmed.empty());
}

}  // namespace
}  // namespace mapping
}  // namespace cartographer
