// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
#include "cartographer_ext/uncertainty/drift_model.h"

#include "cartographer_ext/common/pose_graph_context.h"
#include "gtest/gtest.h"

namespace cartographer_ext {
namespace uncertainty {
namespace {

PathNoiseOptions Noise() {
  PathNoiseOptions noise;
  noise.translation_per_metre = 0.1;
  noise.translation_per_radian = 0.02;
  noise.rotation_per_metre = 0.01;
  noise.rotation_per_radian = 0.03;
  noise.heading_drift = 0.001;
  noise.scale_error = 0.005;
  noise.jump_threshold_metres = 0.5;
  noise.jump_threshold_radians = 0.4;
  return noise;
}

TEST(DriftModelTest, ScalesTranslationAndRotation) {
  const PathNoiseOptions scaled = Scaled(Noise(), DriftFactors{2., 3., 5.});
  EXPECT_DOUBLE_EQ(scaled.translation_per_metre, 0.2);
  EXPECT_DOUBLE_EQ(scaled.translation_per_radian, 0.04);
  EXPECT_DOUBLE_EQ(scaled.scale_error, 0.005);
  EXPECT_DOUBLE_EQ(scaled.rotation_per_metre, 0.03);
  EXPECT_DOUBLE_EQ(scaled.rotation_per_radian, 0.15);
  EXPECT_DOUBLE_EQ(scaled.heading_drift, 0.001);
  EXPECT_DOUBLE_EQ(scaled.jump_threshold_metres, 0.5);
  EXPECT_DOUBLE_EQ(scaled.jump_threshold_radians, 0.4);
}

TEST(DriftModelTest, AsALineOfTheLog) {
  EXPECT_EQ(ToText({}), "");
  DriftEstimate prior;
  EXPECT_EQ(ToText({{0, prior}}), "");
  DriftEstimate known;
  known.mean.translation_per_metre = 0.02;
  known.mean.rotation_per_metre = 0.005;
  known.num_cycles = 12;
  // The newest of which something is known. 0.02 m and 0.286 deg times
  // the square root of 10.
  EXPECT_EQ(ToText({{0, prior}, {1, known}, {2, prior}}),
            "local SLAM of trajectory 1 drifts by 0.063 m and 0.91 deg "
            "(standard deviations) in 10 m, estimated from 12 cycles");
}

TEST(DriftModelTest, PriorUntilEstimated) {
  PoseGraphContext context;
  DriftModel* const model = context.Get<DriftModel>();
  EXPECT_DOUBLE_EQ(model->Of(0).mean.translation_per_metre,
                   PathNoiseOptions().translation_per_metre);
  model->SetPrior(Noise());
  EXPECT_DOUBLE_EQ(model->Of(0).mean.translation_per_metre, 0.1);
  EXPECT_DOUBLE_EQ(model->Of(0).upper.rotation_per_metre, 0.01);
  EXPECT_EQ(model->Of(0).num_cycles, 0);
  EXPECT_DOUBLE_EQ(model->Of(0).common.covariance(0, 0), 1e-6);
  EXPECT_TRUE(model->All().empty());

  DriftEstimate estimate;
  estimate.mean = Scaled(Noise(), DriftFactors{2., 2., 2.});
  estimate.upper = Scaled(Noise(), DriftFactors{4., 4., 4.});
  estimate.num_cycles = 7;
  model->Set(1, estimate);
  EXPECT_DOUBLE_EQ(model->Of(1).mean.translation_per_metre, 0.2);
  EXPECT_DOUBLE_EQ(model->Of(1).upper.translation_per_metre, 0.4);
  EXPECT_EQ(model->Of(1).num_cycles, 7);
  EXPECT_DOUBLE_EQ(model->Of(0).mean.translation_per_metre, 0.1);
  EXPECT_EQ(model->All().size(), 1u);
  model->DeleteTrajectory(1);
  EXPECT_DOUBLE_EQ(model->Of(1).upper.translation_per_metre, 0.1);
}

}  // namespace
}  // namespace uncertainty
}  // namespace cartographer_ext
