// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
#include "cartographer_ext/scan_matching/dropin/degeneracy_aware_scan_matcher_2d.h"

#include <utility>
#include <vector>

#include "cartographer_ext/common/dropin/pose_conversion.h"
#include "cartographer_ext/scan_matching/dropin/grid_cells.h"
#include "cartographer_ext/scan_matching/scan_match.h"
#include "glog/logging.h"

namespace cartographer_ext {
namespace scan_matching {
namespace {

namespace mapping = cartographer::mapping;
namespace sensor = cartographer::sensor;
namespace transform = cartographer::transform;
using StockOptions = mapping::scan_matching::proto::CeresScanMatcherOptions2D;

std::vector<Eigen::Vector2d> ToPoints(const sensor::PointCloud& cloud) {
  std::vector<Eigen::Vector2d> points;
  points.reserve(cloud.size());
  for (const sensor::RangefinderPoint& point : cloud) {
    points.emplace_back(point.position.x(), point.position.y());
  }
  return points;
}

ScanMatchOptions ToOptions(const StockOptions& stock,
                           const proto::ScanMatcherOptions& extension) {
  ScanMatchOptions options;
  options.occupied_space_weight = stock.occupied_space_weight();
  options.translation_weight = stock.translation_weight();
  options.rotation_weight = stock.rotation_weight();
  options.solver.max_iterations =
      stock.ceres_solver_options().max_num_iterations();
  options.remap = extension.degeneracy().enabled();
  options.information.translation_floor =
      extension.degeneracy().translation_floor();
  options.information.mode = extension.paper_mode().eigenvalue_ratio()
                                 ? DegeneracyMode::kPaperLiteral
                                 : DegeneracyMode::kNoiseFloor;
  return options;
}

void FillSummary(const MatchReport& report,
                 ceres::Solver::Summary* const summary) {
  *summary = ceres::Solver::Summary();
  summary->termination_type =
      report.converged ? ceres::CONVERGENCE : ceres::NO_CONVERGENCE;
  summary->message = "degeneracy-aware scan matcher";
  summary->initial_cost = report.initial_cost;
  summary->final_cost = report.final_cost;
  summary->fixed_cost = 0.;
  summary->num_successful_steps = report.iterations;
  summary->num_parameters = 3;
}

}  // namespace

DegeneracyAwareScanMatcher2D::DegeneracyAwareScanMatcher2D(
    const StockOptions& options, const proto::ScanMatcherOptions& extension)
    : options_(ToOptions(options, extension)), stock_(options) {
  CHECK_GT(options.occupied_space_weight(), 0.);
  CHECK_GT(options.translation_weight(), 0.);
  CHECK_GT(options.rotation_weight(), 0.);
}

DegeneracyAwareScanMatcher2D::~DegeneracyAwareScanMatcher2D() = default;

void DegeneracyAwareScanMatcher2D::Match(
    const Eigen::Vector2d& target_translation,
    const transform::Rigid2d& initial_pose_estimate,
    const sensor::PointCloud& point_cloud, const mapping::Grid2D& grid,
    transform::Rigid2d* const pose_estimate,
    ceres::Solver::Summary* const summary) const {
  if (grid.GetGridType() == mapping::GridType::TSDF) {
    ceres::Solver::Summary unused;
    stock_.Match(target_translation, initial_pose_estimate, point_cloud, grid,
                 pose_estimate, summary == nullptr ? &unused : summary);
    return;
  }
  Prediction prediction;
  prediction.pose = Pose2(target_translation.x(), target_translation.y(),
                          initial_pose_estimate.rotation().angle());
  MatchReport report;
  MatchWithPrediction(prediction, initial_pose_estimate, point_cloud, grid,
                      pose_estimate, summary == nullptr ? nullptr : &report);
  if (summary != nullptr) FillSummary(report, summary);
}

void DegeneracyAwareScanMatcher2D::MatchWithPrediction(
    const Prediction& prediction,
    const transform::Rigid2d& initial_pose_estimate,
    const sensor::PointCloud& point_cloud, const mapping::Grid2D& grid,
    transform::Rigid2d* const pose_estimate, MatchReport* const report) const {
  if (grid.GetGridType() == mapping::GridType::TSDF) {
    MatchTsdf(prediction, initial_pose_estimate, point_cloud, grid,
              pose_estimate, report);
    return;
  }
  const Pose2 pose =
      MatchScan(options_, prediction, ToUnwrappedPose2(initial_pose_estimate),
                ToPoints(point_cloud), GridCells(&grid), report);
  *pose_estimate = ToRigid2d(pose);
}

void DegeneracyAwareScanMatcher2D::MatchTsdf(
    const Prediction& prediction,
    const transform::Rigid2d& initial_pose_estimate,
    const sensor::PointCloud& point_cloud, const mapping::Grid2D& grid,
    transform::Rigid2d* const pose_estimate, MatchReport* const report) const {
  ceres::Solver::Summary summary;
  stock_.Match(prediction.pose.translation(), initial_pose_estimate,
               point_cloud, grid, pose_estimate, &summary);
  if (report == nullptr) return;
  // The uncertainty of the match is unknown, so that of the prediction is used.
  *report = MatchReport();
  const double t = options_.prediction_translation_sigma;
  const double r = options_.prediction_rotation_sigma;
  report->covariance = Eigen::Vector3d(t * t, t * t, r * r).asDiagonal();
  report->information =
      Eigen::Vector3d(1. / (t * t), 1. / (t * t), 1. / (r * r)).asDiagonal();
  report->match = ToUnwrappedPose2(*pose_estimate);
  report->disagreement << report->match.x - prediction.pose.x,
      report->match.y - prediction.pose.y,
      NormalizeAngle(report->match.theta - prediction.pose.theta);
  report->degrees_of_freedom = 3;
  report->initial_cost = summary.initial_cost;
  report->final_cost = summary.final_cost;
  report->iterations = static_cast<int>(summary.iterations.size());
  report->converged = summary.termination_type == ceres::CONVERGENCE;
}

}  // namespace scan_matching
}  // namespace cartographer_ext
