// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
#include "cartographer_ext/loop_closure/dropin/submap_store.h"

#include <memory>

#include "absl/memory/memory.h"
#include "cartographer/mapping/2d/probability_grid.h"
#include "gtest/gtest.h"
#include "tests/host/mapping_test_helpers.h"
#include "tests/host/slam_test_helpers.h"
#include "tests/uncertainty/random_walk.h"

namespace cartographer_ext {
namespace loop_closure {
namespace {

namespace host = cartographer::mapping;
using uncertainty::NodeId;
using uncertainty::SubmapId;

class SubmapStoreTest : public testing::Test {
 protected:
  SubmapStoreTest()
      : submap_(Eigen::Vector2f(1.f, 0.f),
                host::test::RoomGrid(&tables_, 0.05, 5), &tables_),
        paths_(uncertainty::RandomWalk(), 1000) {
    submap_.Finish();
    store_ =
        absl::make_unique<SubmapStore>(host::test::LoadSlamOptions("")
                                           .map_builder.pose_graph_options()
                                           .constraint_builder_options(),
                                       LoopOptions());
    for (int i = 0; i < 30; ++i) paths_.Add(NodeId{0, i}, Pose2(i, 0., 0.));
  }

  std::shared_ptr<SubmapEntry> Add(const int submap_index, const int node) {
    store_->AddNode(NodeId{0, node}, 10 * node);
    const auto entry = store_->AddPair(SubmapId{0, submap_index}, &submap_, 0);
    store_->EndGroup();
    return entry;
  }

  host::ValueConversionTables tables_;
  host::Submap2D submap_;
  uncertainty::PathUncertainty paths_;
  std::unique_ptr<SubmapStore> store_;
};

TEST_F(SubmapStoreTest, BoundsTheNodesOfASubmap) {
  const auto entry = Add(3, 8);
  EXPECT_EQ(entry->newest_node_at_first, 8);
  EXPECT_EQ(entry->time_at_first, 80);
  EXPECT_EQ(entry->local_pose.x, 1.);
  EXPECT_EQ(entry->newest_node_bound, SubmapEntry::kUnknownNode);
  EXPECT_EQ(Add(3, 9)->newest_node_bound, 9);
  EXPECT_EQ(Add(3, 12)->newest_node_bound, 9);
  EXPECT_TRUE(store_->HasSubmapsOf(0));
  EXPECT_FALSE(store_->HasSubmapsOf(1));
  EXPECT_EQ(store_->Erase(SubmapId{0, 3}), 9);
  EXPECT_EQ(store_->Erase(SubmapId{0, 3}), SubmapEntry::kUnknownNode);
  EXPECT_FALSE(store_->HasSubmapsOf(0));
}

TEST_F(SubmapStoreTest, AnchorsCandidatesAtANodeOrTheSubmap) {
  const auto entry = Add(3, 8);
  const LoopCandidate same =
      store_->MakeCandidate(SubmapId{0, 3}, *entry, 0, paths_);
  ASSERT_TRUE(same.anchor.has_value());
  // The node at the origin of the submap.
  EXPECT_EQ(*same.anchor, uncertainty::VertexId(NodeId{0, 1}));
  const LoopCandidate other =
      store_->MakeCandidate(SubmapId{0, 3}, *entry, 1, paths_);
  EXPECT_EQ(*other.anchor, uncertainty::VertexId(SubmapId{0, 3}));
}

TEST_F(SubmapStoreTest, MapsAreThoseOfSubmapsNearASearch) {
  Add(3, 8);
  Add(5, 9);
  Add(6, 10);
  const auto num_maps = [this](const int submap_index) {
    LoopCandidate candidate;
    candidate.submap = SubmapId{0, submap_index};
    store_->AddMaps(&candidate);
    EXPECT_EQ(candidate.maps.size(), candidate.views.size());
    return candidate.maps.size();
  };
  EXPECT_EQ(num_maps(3), 0u);
  store_->AnnounceSearch(SubmapId{0, 3});
  EXPECT_EQ(num_maps(3), 2u);
  EXPECT_EQ(num_maps(6), 1u);
  store_->AnnounceSearch(SubmapId{0, 5});
  EXPECT_EQ(num_maps(6), 2u);

  LoopCandidate candidate;
  candidate.submap = SubmapId{0, 3};
  store_->AddMaps(&candidate);
  EXPECT_GT(store_->cache()->bytes(), 0u);
  for (const int index : {3, 5, 6}) store_->Erase(SubmapId{0, index});
  EXPECT_EQ(store_->cache()->bytes(), 0u);
  // They outlive the submap.
  EXPECT_EQ(candidate.maps[0].view, candidate.views[0].get());
}

}  // namespace
}  // namespace loop_closure
}  // namespace cartographer_ext
