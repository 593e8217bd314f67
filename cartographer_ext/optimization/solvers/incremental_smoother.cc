// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
#include "cartographer_ext/optimization/solvers/incremental_smoother.h"

#include <algorithm>
#include <cmath>

#include "Eigen/Cholesky"
#include "Eigen/Eigenvalues"
#include "Eigen/LU"
#include "absl/strings/str_cat.h"
#include "cartographer_ext/common/thread_time.h"
#include "cartographer_ext/optimization/solvers/loop_evidence.h"

namespace cartographer_ext {
namespace optimization {
namespace {

// Odds, times the number of rejected loops, that the evidence of a loop must
// exceed: of all that are certain a few at most are expected to be wrong.
constexpr double kOddsOfCertain = 10.;
// Share of the poses after which an epoch on a large map ends in any case.
constexpr double kLargeMapShare = 0.1;
// Multiplications with a block, of an update and of a prediction.
constexpr double kWorkOfUpdate = 54., kWorkOfPrediction = 27.;

}  // namespace

double MinimizeSwitch(const Eigen::Vector3d& squared_innovation,
                      const Eigen::Vector3d& predicted_variance,
                      const double penalty) {
  const auto cost = [&](const double s) {
    double sum = penalty * (1. - s) * (1. - s);
    for (int i = 0; i != 3; ++i) {
      sum += squared_innovation[i] * s * s /
             (1. + s * s * std::max(0., predicted_variance[i]));
    }
    return sum;
  };
  // Up to two minima: a grid finds the better one, finer near 0 where both
  // terms of an uncertain loop are decided; then golden section.
  constexpr int kGrid = 24;
  const auto at = [](const int k) {
    const double t = static_cast<double>(k) / kGrid;
    return t * t;
  };
  int best = 0;
  double best_cost = cost(0.);
  for (int k = 1; k <= kGrid; ++k) {
    const double value = cost(at(k));
    if (value < best_cost) {
      best_cost = value;
      best = k;
    }
  }
  double low = at(std::max(0, best - 1)), high = at(std::min(kGrid, best + 1));
  const double golden = 0.6180339887498949;
  for (int k = 0; k != 30; ++k) {
    const double left = high - golden * (high - low);
    const double right = low + golden * (high - low);
    if (cost(left) < cost(right)) {
      high = right;
    } else {
      low = left;
    }
  }
  return 0.5 * (low + high);
}

IncrementalSmoother::IncrementalSmoother(const SmootherOptions& options,
                                         const Pose2& origin)
    : options_(options), poses_({origin}), linearization_poses_({origin}) {
  factor_.Reset(BlockLdlt(), Eigen::VectorXd(0));
}

Eigen::Vector3d IncrementalSmoother::Offset(const int pose) const {
  return Eigen::Vector3d(
      poses_[pose].x - linearization_poses_[pose].x,
      poses_[pose].y - linearization_poses_[pose].y,
      NormalizeAngle(poses_[pose].theta - linearization_poses_[pose].theta));
}

LinearFactor IncrementalSmoother::LinearizeEdge(
    const WhitenedEdge& edge) const {
  // At the current estimate, expressed as an offset from the point where the
  // pose was linearised first: J x = J offset - r.
  LinearFactor result;
  result.a = edge.from - 1;
  result.b = edge.to - 1;
  const Eigen::Vector3d residual =
      Linearize(edge, poses_[edge.from], poses_[edge.to], &result.jacobian_a,
                &result.jacobian_b);
  result.target = result.jacobian_a * Offset(edge.from) +
                  result.jacobian_b * Offset(edge.to) - residual;
  return result;
}

absl::Status IncrementalSmoother::AddPose(
    const std::vector<PoseGraphEdge>& edges, StepReport* const report) {
  const double start = ThreadCpuSeconds();
  if (!status_.ok()) return status_;
  const int number = num_poses();
  const PoseGraphEdge* odometry = nullptr;
  for (const PoseGraphEdge& edge : edges) {
    const int other = edge.from == number ? edge.to : edge.from;
    if (std::max(edge.from, edge.to) != number || other < 0 ||
        other >= number) {
      return absl::InvalidArgumentError(
          absl::StrCat("edge ", edge.from, " -> ", edge.to,
                       " does not join new pose ", number, " to an old one"));
    }
    if (odometry == nullptr && !edge.is_loop) odometry = &edge;
  }
  if (odometry == nullptr) {
    return absl::InvalidArgumentError(
        absl::StrCat("pose ", number, " comes without odometry"));
  }
  StepReport result;
  batch_iterations_ = 0;
  TakeOverEpoch();
  if (!status_.ok()) return status_;
  for (const PoseGraphEdge& edge : edges) {
    if (!edge.is_loop) RefreshPose(std::min(edge.from, edge.to));
  }
  AppendPose(*odometry);
  for (const PoseGraphEdge& edge : edges) {
    const int index = edges_.size();
    edges_.push_back(Whiten(edge));
    accepted_.push_back(!edge.is_loop);
    decided_.push_back(!edge.is_loop);
    if (edge.is_loop) {
      waiting_.push_back(index);
    } else if (&edge == odometry) {
      NoteUpdate(factor_.Attach(LinearizeEdge(edges_.back())));
    } else {
      NoteUpdate(factor_.Update(LinearizeEdge(edges_.back()), 1.));
      estimate_outdated_ = true;
    }
  }
  while (status_.ok() && !waiting_.empty() &&
         result.loops_tested < options_.max_loops_per_step) {
    result.loops_entered += TestLoop(waiting_.front());
    ++result.loops_tested;
    waiting_.pop_front();
  }
  covariances_.resize(num_poses(), factor_.LastCovariance());
  if (EpochIsDue()) {
    SolveEpoch();
    if (num_poses() <= options_.two_step_map) TakeOverEpoch();
    result.epoch = true;
  }
  result.batch_iterations = batch_iterations_;
  result.cpu_seconds = ThreadCpuSeconds() - start;
  if (report != nullptr) *report = result;
  return status_;
}

void IncrementalSmoother::AppendPose(const PoseGraphEdge& odometry) {
  const int number = num_poses();
  uncertainty::UncertainPose motion{odometry.measurement,
                                    odometry.information.inverse()};
  if (odometry.from == number) motion = uncertainty::Invert(motion);
  drift_ = uncertainty::Compose(drift_, motion);
  const Pose2 pose = poses_[std::min(odometry.from, odometry.to)] * motion.pose;
  poses_.push_back(pose);
  linearization_poses_.push_back(pose);
  factor_.Append();
  ++poses_in_epoch_;
}

bool IncrementalSmoother::EpochIsDue() const {
  // The end of an epoch takes time in proportion to the poses, so that epochs
  // of a fixed length would take time in proportion to their square.
  const double share =
      num_poses() <= options_.large_map || work_of_steps_ > work_of_last_end_
          ? options_.epoch_share
          : kLargeMapShare;
  return poses_in_epoch_ >=
         std::max<double>(options_.epoch_poses, share * num_poses());
}

void IncrementalSmoother::NoteUpdate(const bool succeeded) {
  work_of_steps_ += kWorkOfUpdate * factor_.last_update_blocks();
  if (!succeeded) {
    status_ = absl::InternalError(
        absl::StrCat("the factor is lost to rounding at pose ", num_poses() - 1,
                     ": information matrices are too uneven"));
  }
}

double IncrementalSmoother::EstimateSwitch(
    const LinearFactor& factor, const Eigen::Vector3d& residual) const {
  const double w = options_.switch_penalty;
  if (options_.switch_estimate == SwitchEstimate::kPointwise) {
    return w / (w + residual.squaredNorm());
  }
  Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> eigen;
  eigen.computeDirect(factor_.PredictedCovariance(factor));
  const Eigen::Vector3d u = eigen.eigenvectors().transpose() * residual;
  return MinimizeSwitch(u.cwiseAbs2(), eigen.eigenvalues(), w);
}

bool IncrementalSmoother::SaysLittle(const WhitenedEdge& edge,
                                     const LinearFactor& factor) const {
  const int newest = num_poses() - 1;
  Eigen::Matrix3d jacobian =
      edge.from == newest ? factor.jacobian_a : factor.jacobian_b;
  const double c = std::cos(poses_[newest].theta);
  const double s = std::sin(poses_[newest].theta);
  jacobian.leftCols<2>() *= (Eigen::Matrix2d() << c, -s, s, c).finished();
  return (jacobian * drift_.covariance * jacobian.transpose()).trace() < 1.;
}

bool IncrementalSmoother::IsCertain(const WhitenedEdge& edge,
                                    const LinearFactor& factor,
                                    const Eigen::Vector3d& residual) {
  // The difference of two poses varies by at most twice the sum of their
  // covariances, which saves most predictions.
  Eigen::Matrix3d bound = Eigen::Matrix3d::Identity();
  const auto add = [&](const int pose, const Eigen::Matrix3d& jacobian) {
    if (pose == 0) return;
    const Eigen::Matrix3d& covariance =
        pose < static_cast<int>(covariances_.size()) ? covariances_[pose]
                                                     : factor_.LastCovariance();
    bound += 2. * jacobian * covariance * jacobian.transpose();
  };
  add(edge.from, factor.jacobian_a);
  add(edge.to, factor.jacobian_b);
  if (residual.dot(bound.llt().solve(residual)) >= options_.gate) return false;
  const Eigen::LLT<Eigen::Matrix3d> root(Eigen::Matrix3d::Identity() +
                                         factor_.PredictedCovariance(factor));
  work_of_steps_ += kWorkOfPrediction * factor_.last_prediction_blocks();
  Innovation innovation;
  innovation.chi2 = residual.dot(root.solve(residual));
  innovation.log_determinant =
      2. * root.matrixLLT().diagonal().array().log().sum();
  return innovation.chi2 < options_.gate &&
         LogEvidence(edge, innovation, log_area_) >
             std::log(kOddsOfCertain * (1. + num_rejected_));
}

bool IncrementalSmoother::TestLoop(const int edge_index) {
  const WhitenedEdge& edge = edges_[edge_index];
  RefreshPose(edge.from);
  RefreshPose(edge.to);
  const LinearFactor factor = LinearizeEdge(edge);
  const Eigen::Vector3d residual =
      Residual(edge, poses_[edge.from], poses_[edge.to]);
  if (num_poses() > options_.large_map &&
      residual.squaredNorm() < options_.gate && SaysLittle(edge, factor)) {
    return false;
  }
  const double s = EstimateSwitch(factor, residual);
  double weight = s * s;
  if (weight < options_.skip_weight) {
    if (num_poses() <= options_.large_map ||
        !IsCertain(edge, factor, residual)) {
      ++num_rejected_;
      return false;
    }
    weight = 1.;
    predicted_.push_back(edge_index);
  }
  NoteUpdate(factor_.Update(factor, weight));
  drift_ = uncertainty::UncertainPose();
  accepted_[edge_index] = true;
  estimate_outdated_ = true;
  return true;
}

void IncrementalSmoother::RefreshPose(const int pose) {
  if (!estimate_outdated_) return;
  const Eigen::Vector3d offset = factor_.SolveFor(pose - 1);
  const Pose2& origin = linearization_poses_[pose];
  poses_[pose] = Pose2(origin.x + offset.x(), origin.y + offset.y(),
                       NormalizeAngle(origin.theta + offset.z()));
}

const std::vector<Pose2>& IncrementalSmoother::poses() const {
  if (estimate_outdated_) UpdateEstimate();
  return poses_;
}

void IncrementalSmoother::UpdateEstimate() const {
  Eigen::VectorXd offsets;
  factor_.Solve(&offsets);
  for (size_t i = 1; i != poses_.size(); ++i) {
    const Pose2& origin = linearization_poses_[i];
    poses_[i] =
        Pose2(origin.x + offsets[3 * i - 3], origin.y + offsets[3 * i - 2],
              NormalizeAngle(origin.theta + offsets[3 * i - 1]));
  }
  estimate_outdated_ = false;
}

absl::Status Replay(const PoseGraph& graph, const SmootherOptions& options,
                    ReplayResult* const result) {
  const double start = ThreadCpuSeconds();
  std::vector<std::vector<int>> edges_of_pose(graph.poses.size());
  for (size_t i = 0; i != graph.edges.size(); ++i) {
    edges_of_pose[std::max(graph.edges[i].from, graph.edges[i].to)].push_back(
        i);
  }
  IncrementalSmoother smoother(options, graph.poses[0]);
  std::vector<int> arrived;
  result->step_seconds.clear();
  for (size_t k = 1; k != graph.poses.size(); ++k) {
    std::vector<PoseGraphEdge> edges;
    for (const int e : edges_of_pose[k]) {
      edges.push_back(graph.edges[e]);
      arrived.push_back(e);
    }
    StepReport report;
    const absl::Status status = smoother.AddPose(edges, &report);
    if (!status.ok()) return status;
    result->step_seconds.push_back(report.cpu_seconds);
  }
  smoother.Finish();
  if (!smoother.status().ok()) return smoother.status();
  result->poses = smoother.poses();
  result->accepted.assign(graph.edges.size(), false);
  for (size_t i = 0; i != arrived.size(); ++i) {
    result->accepted[arrived[i]] = smoother.accepted()[i];
  }
  result->cpu_seconds = ThreadCpuSeconds() - start;
  return absl::OkStatus();
}

}  // namespace optimization
}  // namespace cartographer_ext
