// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
#include "cartographer_ext/configuration/stored_options.h"

#include "cartographer_ext/options/extension_field.h"
#include "cartographer_ext/scan_matcher_options.pb.h"
#include "gmock/gmock.h"
#include "google/protobuf/unknown_field_set.h"
#include "gtest/gtest.h"

namespace cartographer_ext {
namespace evaluation {
namespace {

using cartographer::mapping::proto::AllTrajectoryBuilderOptions;
using cartographer::mapping::proto::TrajectoryBuilderOptions;
using testing::ElementsAre;
using testing::HasSubstr;

TEST(StoredOptionsTest, NoBlocksNoLines) {
  TrajectoryBuilderOptions options;
  options.mutable_trajectory_builder_2d_options()->set_max_range(30.f);
  EXPECT_TRUE(DescribeBlocks(options).empty());
}

TEST(StoredOptionsTest, NamesBlocksAndWhatIsNoBlock) {
  TrajectoryBuilderOptions options;
  auto* const matcher = options.mutable_trajectory_builder_2d_options()
                            ->mutable_ceres_scan_matcher_options();
  options::SetExtension(proto::ScanMatcherOptions(), matcher);
  EXPECT_THAT(DescribeBlocks(options),
              ElementsAre(HasSubstr("trajectory_builder_2d_options.ceres_scan_"
                                    "matcher_options: schema: 2")));
  // Bytes that nobody understands do no harm.
  auto* const range = options.mutable_trajectory_builder_2d_options()
                          ->mutable_motion_filter_options();
  range->GetReflection()->MutableUnknownFields(range)->AddLengthDelimited(
      options::kExtensionFieldNumber, "\xff\xff");
  EXPECT_THAT(DescribeBlocks(options),
              testing::Contains(HasSubstr(
                  "motion_filter_options: 2 bytes that cannot be decoded")));
}

TEST(StoredOptionsTest, NamesKeysThatDiffer) {
  AllTrajectoryBuilderOptions first, second;
  first.add_options_with_sensor_ids()
      ->mutable_trajectory_builder_options()
      ->mutable_trajectory_builder_2d_options()
      ->set_max_range(30.f);
  second = first;
  EXPECT_TRUE(DescribeOptionDifferences(first, second, 10).empty());
  second.mutable_options_with_sensor_ids(0)
      ->mutable_trajectory_builder_options()
      ->mutable_trajectory_builder_2d_options()
      ->set_max_range(25.f);
  second.add_options_with_sensor_ids();
  EXPECT_THAT(
      DescribeOptionDifferences(first, second, 10),
      ElementsAre(
          "trajectory 0, trajectory_builder_2d_options.max_range: 30 -> 25",
          "options of 1 and of 2 trajectories"));
  EXPECT_THAT(DescribeOptionDifferences(first, second, 1),
              ElementsAre(HasSubstr("max_range"), "and 1 more options"));
}

}  // namespace
}  // namespace evaluation
}  // namespace cartographer_ext
