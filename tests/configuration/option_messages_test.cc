// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
#include "cartographer_ext/configuration/option_messages.h"

#include "cartographer/mapping/proto/pose_graph_options.pb.h"
#include "cartographer_ext/loop_closure_options.pb.h"
#include "cartographer_ext/options/extension_field.h"
#include "gmock/gmock.h"
#include "gtest/gtest.h"

namespace cartographer_ext {
namespace evaluation {
namespace {

using cartographer::mapping::proto::PoseGraphOptions;

TEST(OptionMessagesTest, DescribesDifferences) {
  PoseGraphOptions first, second;
  first.mutable_constraint_builder_options()->set_min_score(0.5);
  second.mutable_constraint_builder_options()->set_min_score(0.75);
  EXPECT_THAT(DescribeDifferences(first, second),
              testing::ElementsAre(
                  "constraint_builder_options.min_score: 0.5 -> 0.75"));
  EXPECT_TRUE(DescribeDifferences(first, first).empty());
}

TEST(OptionMessagesTest, CopiesAndRemovesBlocks) {
  PoseGraphOptions source;
  options::SetExtension(proto::LoopClosureOptions(),
                        source.mutable_constraint_builder_options());
  PoseGraphOptions target;
  target.mutable_constraint_builder_options()->set_min_score(0.5);
  CopyExtensions(source, &target);
  EXPECT_TRUE(options::HasExtension(target.constraint_builder_options()));
  EXPECT_EQ(target.constraint_builder_options().min_score(), 0.5);
  EXPECT_TRUE(RemoveExtensions(&target));
  EXPECT_FALSE(options::HasExtension(target.constraint_builder_options()));
  EXPECT_FALSE(RemoveExtensions(&target));
  // A part that the target does not have is not created.
  PoseGraphOptions empty;
  CopyExtensions(source, &empty);
  EXPECT_FALSE(empty.has_constraint_builder_options());
}

}  // namespace
}  // namespace evaluation
}  // namespace cartographer_ext
