// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
#include "cartographer_ext/uncertainty/ids.h"

#include <set>

#include "gtest/gtest.h"

namespace cartographer_ext {
namespace uncertainty {
namespace {

TEST(IdsTest, NodesAndSubmapsOfEqualNumbersDiffer) {
  const VertexId node = NodeId{1, 2};
  const VertexId submap = SubmapId{1, 2};
  EXPECT_NE(node, submap);
  EXPECT_TRUE(node.is_node());
  EXPECT_TRUE(submap.is_submap());
  EXPECT_FALSE(node.InSequenceWith(submap));
  EXPECT_TRUE(node.InSequenceWith(NodeId{1, 7}));
  EXPECT_FALSE(node.InSequenceWith(NodeId{2, 2}));
  EXPECT_TRUE(node.IsNodeOf(1));
  EXPECT_FALSE(node.IsNodeOf(2));
  EXPECT_FALSE(node.IsSubmapOf(1));
  EXPECT_TRUE(submap.IsSubmapOf(1));
}

TEST(IdsTest, OrderKeepsSequencesTogether) {
  const std::set<VertexId> sorted = {NodeId{0, 1}, SubmapId{1, 0},
                                     NodeId{0, 0}, SubmapId{0, 3},
                                     NodeId{1, 0}, NodeId{0, 1}};
  ASSERT_EQ(sorted.size(), 5u);
  auto it = sorted.begin();
  EXPECT_EQ(*it++, VertexId(SubmapId{0, 3}));
  EXPECT_EQ(*it++, VertexId(SubmapId{1, 0}));
  EXPECT_EQ(*it++, VertexId(NodeId{0, 0}));
  EXPECT_EQ(*it++, VertexId(NodeId{0, 1}));
  EXPECT_EQ(*it++, VertexId(NodeId{1, 0}));
}

TEST(IdsTest, Comparisons) {
  EXPECT_EQ((NodeId{1, 2}), (NodeId{1, 2}));
  EXPECT_NE((NodeId{1, 2}), (NodeId{1, 3}));
  EXPECT_LT((NodeId{0, 9}), (NodeId{1, 2}));
  EXPECT_EQ((SubmapId{1, 2}), (SubmapId{1, 2}));
  EXPECT_NE((SubmapId{1, 2}), (SubmapId{0, 2}));
  EXPECT_LT((SubmapId{1, 2}), (SubmapId{1, 3}));
}

}  // namespace
}  // namespace uncertainty
}  // namespace cartographer_ext
