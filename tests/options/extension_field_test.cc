// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
#include "cartographer_ext/options/extension_field.h"

#include <string>

#include "cartographer/mapping/proto/pose_graph/constraint_builder_options.pb.h"
#include "cartographer/mapping/proto/pose_graph_options.pb.h"
#include "cartographer_ext/options/option_description.h"
#include "gtest/gtest.h"
#include "sample_options.pb.h"

namespace cartographer_ext {
namespace options {
namespace {

using cartographer::mapping::constraints::proto::ConstraintBuilderOptions;
using cartographer::mapping::proto::PoseGraphOptions;

test::SampleOptions Sample(const int length) {
  test::SampleOptions sample;
  SetDefaults(&sample);
  sample.mutable_window()->set_length(length);
  return sample;
}

TEST(ExtensionFieldTest, AbsentLeavesTheStockMessageAlone) {
  ConstraintBuilderOptions stock;
  stock.set_min_score(0.55);
  test::SampleOptions sample;
  EXPECT_FALSE(HasExtension(stock));
  EXPECT_FALSE(GetExtension(stock, &sample));
}

TEST(ExtensionFieldTest, SurvivesNestingCopyAndSerialisation) {
  PoseGraphOptions outer;
  SetExtension(Sample(7), outer.mutable_constraint_builder_options());
  outer.mutable_constraint_builder_options()->set_min_score(0.6);
  PoseGraphOptions parsed;
  ASSERT_TRUE(
      parsed.ParseFromString(PoseGraphOptions(outer).SerializeAsString()));
  const ConstraintBuilderOptions copy = parsed.constraint_builder_options();
  EXPECT_EQ(copy.min_score(), 0.6);
  test::SampleOptions back;
  ASSERT_TRUE(GetExtension(copy, &back));
  EXPECT_EQ(back.window().length(), 7);
  EXPECT_EQ(back.schema(), kSchema);
}

TEST(ExtensionFieldTest, SetReplacesAndMergedEntriesMerge) {
  ConstraintBuilderOptions stock;
  SetExtension(Sample(7), &stock);
  SetExtension(Sample(8), &stock);
  EXPECT_EQ(stock.GetReflection()->GetUnknownFields(stock).field_count(), 1);
  ConstraintBuilderOptions other;
  SetExtension(Sample(9), &other);
  stock.MergeFrom(other);
  test::SampleOptions back;
  ASSERT_TRUE(GetExtension(stock, &back));
  EXPECT_EQ(back.window().length(), 9);
}

TEST(ExtensionFieldDeathTest, NewerSchemaAndGarbageAreRefused) {
  ConstraintBuilderOptions stock;
  test::NewerOptions newer;
  newer.set_schema(kSchema + 1);
  auto* const fields = stock.GetReflection()->MutableUnknownFields(&stock);
  fields->AddLengthDelimited(kExtensionFieldNumber, newer.SerializeAsString());
  test::SampleOptions back;
  EXPECT_DEATH(GetExtension(stock, &back), "was written with schema 3");
  fields->Clear();
  fields->AddLengthDelimited(kExtensionFieldNumber, "\xff\xff");
  EXPECT_DEATH(GetExtension(stock, &back), "does not hold");
  fields->Clear();
  fields->AddVarint(kExtensionFieldNumber, 3);
  EXPECT_DEATH(GetExtension(stock, &back), "does not hold");
}

}  // namespace
}  // namespace options
}  // namespace cartographer_ext
