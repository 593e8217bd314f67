// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
#include "cartographer/metrics/register.h"

#include "cartographer/mapping/internal/2d/local_trajectory_builder_2d.h"
#include "cartographer/mapping/internal/2d/pose_graph_2d.h"
#include "cartographer/mapping/internal/constraints/constraint_builder_2d.h"
#include "cartographer/mapping/internal/global_trajectory_builder.h"
#include "cartographer/sensor/internal/trajectory_collator.h"

namespace cartographer {
namespace metrics {

void RegisterAllMetrics(FamilyFactory* const registry) {
  mapping::LocalTrajectoryBuilder2D::RegisterMetrics(registry);
  mapping::GlobalTrajectoryBuilderRegisterMetrics(registry);
  mapping::constraints::ConstraintBuilder2D::RegisterMetrics(registry);
  mapping::PoseGraph2D::RegisterMetrics(registry);
  sensor::TrajectoryCollator::RegisterMetrics(registry);
}

}  // namespace metrics
}  // namespace cartographer
