// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
#include "cartographer_ext/experiments/golden_search.h"

#include <algorithm>
#include <cmath>

#include "absl/memory/memory.h"
#include "absl/status/status.h"
#include "absl/strings/str_cat.h"
#include "absl/strings/str_format.h"
#include "absl/strings/str_join.h"
#include "cartographer/mapping/internal/2d/scan_matching/ceres_scan_matcher_2d.h"
#include "cartographer/mapping/internal/2d/scan_matching/fast_correlative_scan_matcher_2d.h"
#include "cartographer/sensor/compressed_point_cloud.h"
#include "cartographer/transform/rigid_transform.h"
#include "cartographer_ext/common/thread_time.h"
#include "cartographer_ext/scan_matching/dropin/fast_correlative_matcher_2d.h"

namespace cartographer_ext {
namespace evaluation {
namespace {

using cartographer::mapping::Grid2D;
using cartographer::mapping::NodeId;
using cartographer::mapping::Submap2D;
using cartographer::mapping::SubmapId;
using cartographer::mapping::scan_matching::CeresScanMatcher2D;
using cartographer::mapping::scan_matching::FastCorrelativeScanMatcher2D;
using cartographer::sensor::CompressedPointCloud;
using cartographer::sensor::PointCloud;
using cartographer::transform::Rigid2d;

Rigid2d ToRigid(const Pose2& pose) {
  return Rigid2d({pose.x, pose.y}, pose.theta);
}

Pose2 FromRigid(const Rigid2d& pose) {
  return Pose2(pose.translation().x(), pose.translation().y(),
               pose.rotation().angle());
}

double Distance(const Pose2& a, const Pose2& b) {
  return std::hypot(a.x - b.x, a.y - b.y);
}

double AngleBetween(const Pose2& a, const Pose2& b) {
  return std::abs(NormalizeAngle(a.theta - b.theta));
}

cartographer::mapping::scan_matching::proto::CeresScanMatcherOptions2D
RefinementOptions() {
  cartographer::mapping::scan_matching::proto::CeresScanMatcherOptions2D
      options;
  options.set_occupied_space_weight(20.);
  options.set_translation_weight(10.);
  options.set_rotation_weight(1.);
  options.mutable_ceres_solver_options()->set_use_nonmonotonic_steps(true);
  options.mutable_ceres_solver_options()->set_max_num_iterations(10);
  options.mutable_ceres_solver_options()->set_num_threads(1);
  return options;
}

cartographer::mapping::scan_matching::proto::FastCorrelativeScanMatcherOptions2D
SearchOptions() {
  cartographer::mapping::scan_matching::proto::
      FastCorrelativeScanMatcherOptions2D options;
  options.set_linear_search_window(7.);
  options.set_angular_search_window(DegToRad(30.));
  options.set_branch_and_bound_depth(7);
  return options;
}

// Either matcher, made for one grid.
class Searcher {
 public:
  Searcher(const GoldenMatcher kind, const Grid2D& grid) {
    if (kind == GoldenMatcher::kStock) {
      stock_ = absl::make_unique<FastCorrelativeScanMatcher2D>(grid,
                                                               SearchOptions());
    } else {
      ours_ = absl::make_unique<scan_matching::FastCorrelativeMatcher2D>(
          grid, SearchOptions());
    }
  }

  // Only our matcher writes `statistics`.
  bool Run(const GoldenPair& golden, const PointCloud& cloud,
           float* const score, Rigid2d* const pose,
           scan_matching::SearchStatistics* const statistics) const {
    const float min_score = static_cast<float>(golden.min_score);
    const Rigid2d initial = ToRigid(golden.initial_pose);
    if (stock_ != nullptr) {
      return golden.full_submap
                 ? stock_->MatchFullSubmap(cloud, min_score, score, pose)
                 : stock_->Match(initial, cloud, min_score, score, pose);
    }
    const scan_matching::SearchBudget no_limit;
    const scan_matching::SearchResult result =
        golden.full_submap
            ? ours_->MatchFullSubmap(cloud, min_score, no_limit)
            : ours_->Match(initial, cloud, ours_->search().options().window,
                           min_score, no_limit);
    *statistics = result.statistics;
    if (!result.found) return false;
    *score = result.score;
    *pose = ToRigid(result.pose);
    return true;
  }

  double Bytes(const Grid2D& grid) const {
    if (ours_ != nullptr) return static_cast<double>(ours_->MemoryBytes());
    const auto& size = grid.limits().cell_limits();
    double bytes = 0.;
    for (int level = 0; level != SearchOptions().branch_and_bound_depth();
         ++level) {
      const int more = (1 << level) - 1;
      bytes += (size.num_x_cells + more) *
               static_cast<double>(size.num_y_cells + more);
    }
    return bytes;
  }

 private:
  std::unique_ptr<FastCorrelativeScanMatcher2D> stock_;
  std::unique_ptr<scan_matching::FastCorrelativeMatcher2D> ours_;
};

// Lowers `*minimum` to the CPU time that `run` takes.
template <typename Function>
void Time(double* const minimum, const Function& run) {
  const double start = ThreadCpuSeconds();
  run();
  const double time = 1e6 * (ThreadCpuSeconds() - start);
  if (*minimum == 0. || time < *minimum) *minimum = time;
}

void Refine(const GoldenPair& golden, const CeresScanMatcher2D& refiner,
            const Grid2D& grid, const PointCloud& cloud, const int repeat,
            GoldenPair* const ours) {
  const Rigid2d initial = ToRigid(golden.pose);
  Rigid2d refined;
  ceres::Solver::Summary summary;
  for (int i = 0; i != repeat; ++i) {
    Time(&ours->refine_microseconds, [&] {
      refiner.Match(initial.translation(), initial, cloud, grid, &refined,
                    &summary);
    });
  }
  ours->refined_pose = FromRigid(refined);
  ours->final_cost = summary.final_cost;
}

void Compare(const GoldenTolerance& tolerance, GoldenOutcome* const outcome) {
  const GoldenPair& golden = outcome->golden;
  const GoldenPair& ours = outcome->ours;
  if (ours.found != golden.found) {
    outcome->mismatch = golden.found ? "not found" : "found";
    return;
  }
  if (!golden.found) return;
  std::vector<std::string> complaints;
  if (std::abs(ours.score - golden.score) > tolerance.score) {
    complaints.push_back(
        absl::StrFormat("score %.7f, not %.7f", ours.score, golden.score));
  }
  const double translation = Distance(ours.pose, golden.pose);
  const double rotation = AngleBetween(ours.pose, golden.pose);
  // Another pose with the same score is as good.
  outcome->tie =
      complaints.empty() && (translation > tolerance.search_translation ||
                             rotation > tolerance.search_rotation);
  if (!outcome->tie) outcome->translation_deviation = translation;

  outcome->refined_translation_deviation =
      Distance(ours.refined_pose, golden.refined_pose);
  outcome->refined_rotation_deviation =
      AngleBetween(ours.refined_pose, golden.refined_pose);
  outcome->relative_cost_deviation =
      std::abs(ours.final_cost - golden.final_cost) /
      std::max(golden.final_cost, 1e-9);
  if (outcome->refined_translation_deviation > tolerance.refined_translation ||
      outcome->refined_rotation_deviation > tolerance.refined_rotation) {
    complaints.push_back(absl::StrFormat("refined pose off by %.5f m, %.5f rad",
                                         outcome->refined_translation_deviation,
                                         outcome->refined_rotation_deviation));
  }
  if (outcome->relative_cost_deviation > tolerance.relative_cost) {
    complaints.push_back(absl::StrFormat("final cost %.6g, not %.6g",
                                         ours.final_cost, golden.final_cost));
  }
  outcome->mismatch = absl::StrJoin(complaints, "; ");
}

void AddToReport(const GoldenOutcome& outcome, GoldenReport* const report) {
  const auto raise = [](const double value, double* const maximum) {
    *maximum = std::max(*maximum, value);
  };
  if (!outcome.mismatch.empty()) ++report->num_mismatches;
  if (outcome.golden.found && outcome.ours.found) {
    ++report->num_found;
    if (outcome.tie) ++report->num_ties;
    raise(std::abs(outcome.ours.score - outcome.golden.score),
          &report->max_score_deviation);
    raise(outcome.translation_deviation, &report->max_translation_deviation);
    raise(outcome.refined_translation_deviation,
          &report->max_refined_translation_deviation);
    raise(outcome.refined_rotation_deviation,
          &report->max_refined_rotation_deviation);
    raise(outcome.relative_cost_deviation,
          &report->max_relative_cost_deviation);
  }
  report->outcomes.push_back(outcome);
}

}  // namespace

GoldenTimes MeanTimes(const GoldenReport& report, const bool ours) {
  GoldenTimes sum;
  int num_refined = 0;
  for (const GoldenOutcome& outcome : report.outcomes) {
    const GoldenPair& times = ours ? outcome.ours : outcome.golden;
    sum.search_microseconds += times.search_microseconds;
    sum.build_microseconds += times.build_microseconds;
    if (outcome.golden.found) {
      sum.refine_microseconds += times.refine_microseconds;
      ++num_refined;
    }
  }
  const double num_pairs = std::max<size_t>(1, report.outcomes.size());
  sum.search_microseconds /= num_pairs;
  sum.build_microseconds /= num_pairs;
  sum.refine_microseconds /= std::max(1, num_refined);
  return sum;
}

absl::StatusOr<GoldenMap> GoldenMap::Create(
    const io::Pbstream& pbstream, const std::vector<GoldenPair>& pairs) {
  std::map<SubmapId, const cartographer::mapping::proto::Submap*> submaps;
  for (const auto& submap : pbstream.submaps) {
    submaps[SubmapId{submap.submap_id().trajectory_id(),
                     submap.submap_id().submap_index()}] = &submap;
  }
  std::map<NodeId, const cartographer::mapping::proto::Node*> nodes;
  for (const auto& node : pbstream.nodes) {
    nodes[NodeId{node.node_id().trajectory_id(), node.node_id().node_index()}] =
        &node;
  }
  GoldenMap map;
  map.tables_ =
      absl::make_unique<cartographer::mapping::ValueConversionTables>();
  for (const GoldenPair& pair : pairs) {
    const auto submap = submaps.find(pair.submap_id);
    if (submap == submaps.end() || !submap->second->submap_2d().has_grid()) {
      return absl::InvalidArgumentError(
          absl::StrCat("golden line ", pair.line, ": the state has no submap ",
                       pair.submap_id.trajectory_id, ":",
                       pair.submap_id.submap_index, " with a grid"));
    }
    auto& grid = map.submaps_[pair.submap_id];
    if (grid == nullptr) {
      grid = absl::make_unique<const Submap2D>(submap->second->submap_2d(),
                                               map.tables_.get());
    }
    const auto node = nodes.find(pair.node_id);
    PointCloud& cloud = map.clouds_[pair.node_id];
    if (node != nodes.end() && cloud.empty()) {
      cloud =
          CompressedPointCloud(
              node->second->node_data().filtered_gravity_aligned_point_cloud())
              .Decompress();
    }
    if (static_cast<int>(cloud.size()) != pair.num_points) {
      return absl::InvalidArgumentError(
          absl::StrCat("golden line ", pair.line, ": the state has no node ",
                       pair.node_id.trajectory_id, ":", pair.node_id.node_index,
                       " with ", pair.num_points, " points"));
    }
  }
  return map;
}

std::vector<GoldenReport> CheckGoldenPairs(const std::vector<GoldenPair>& pairs,
                                           const GoldenMap& map,
                                           const GoldenCheckOptions& options) {
  const CeresScanMatcher2D refiner(RefinementOptions());
  const size_t num_matchers = options.matchers.size();
  const int repeat = std::max(1, options.repeat);
  std::vector<GoldenReport> reports(num_matchers);
  std::vector<std::unique_ptr<Searcher>> searchers(num_matchers);
  std::vector<double> build_microseconds(num_matchers, 0.);
  SubmapId searcher_submap{-1, -1};
  int num_builds = 0;
  int num_done = 0;
  for (size_t k = 0; k != num_matchers; ++k) {
    reports[k].matcher = options.matchers[k];
  }
  for (const GoldenPair& golden : pairs) {
    const Grid2D& grid = map.grid(golden.submap_id);
    const PointCloud& cloud = map.cloud(golden.node_id);
    if (num_builds == 0 || golden.submap_id != searcher_submap) {
      searcher_submap = golden.submap_id;
      ++num_builds;
      build_microseconds.assign(num_matchers, 0.);
      for (int i = 0; i != repeat; ++i) {
        for (size_t k = 0; k != num_matchers; ++k) {
          searchers[k].reset();
          Time(&build_microseconds[k], [&] {
            searchers[k] =
                absl::make_unique<Searcher>(options.matchers[k], grid);
          });
        }
      }
      for (size_t k = 0; k != num_matchers; ++k) {
        reports[k].mean_matcher_bytes += searchers[k]->Bytes(grid);
      }
    }
    std::vector<GoldenOutcome> outcomes(num_matchers);
    std::vector<scan_matching::SearchStatistics> statistics(num_matchers);
    for (int i = 0; i != repeat; ++i) {
      for (size_t k = 0; k != num_matchers; ++k) {
        GoldenPair& ours = outcomes[k].ours;
        float score = 0.f;
        Rigid2d pose;
        Time(&ours.search_microseconds, [&] {
          ours.found =
              searchers[k]->Run(golden, cloud, &score, &pose, &statistics[k]);
        });
        if (!ours.found) continue;
        ours.score = score;
        ours.pose = FromRigid(pose);
      }
    }
    for (size_t k = 0; k != num_matchers; ++k) {
      outcomes[k].golden = golden;
      outcomes[k].ours.build_microseconds = build_microseconds[k];
      if (golden.found) {
        Refine(golden, refiner, grid, cloud, repeat, &outcomes[k].ours);
      }
      Compare(options.tolerance, &outcomes[k]);
      AddToReport(outcomes[k], &reports[k]);
      reports[k].statistics.Add(statistics[k]);
      reports[k].num_rejected_early += statistics[k].rejected_early;
    }
    if (options.progress) options.progress(++num_done);
  }
  for (GoldenReport& report : reports) {
    report.mean_matcher_bytes /= std::max(1, num_builds);
  }
  return reports;
}

}  // namespace evaluation
}  // namespace cartographer_ext
