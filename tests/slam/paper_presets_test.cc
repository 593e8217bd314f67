// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
//
// The presets of the papers have the values that third_party_notes lists.
#include <fstream>
#include <map>
#include <sstream>
#include <string>
#include <vector>

#include "absl/strings/numbers.h"
#include "absl/strings/str_cat.h"
#include "absl/strings/str_split.h"
#include "absl/strings/strip.h"
#include "cartographer_ext/configuration/slam_configuration.h"
#include "cartographer_ext/front_end/front_end_options.h"
#include "cartographer_ext/loop_closure/loop_options.h"
#include "cartographer_ext/optimization/selection/loop_selection.h"
#include "cartographer_ext/options/extension_field.h"
#include "cartographer_ext/robust_optimization_options.pb.h"
#include "cartographer_ext/scan_matcher_options.pb.h"
#include "cartographer_ext/scan_matching/scan_information.h"
#include "gmock/gmock.h"
#include "gtest/gtest.h"

namespace cartographer_ext {
namespace evaluation {
namespace {

using loop_closure::LoopOptions;
using Values = std::map<std::string, std::string>;

std::string Text(const bool value) { return value ? "true" : "false"; }
std::string Text(const double value) { return absl::StrCat(value); }
std::string Text(const int value) { return absl::StrCat(value); }

// The rows "| `name` | value | source |" behind a heading.
Values Listed(const std::string& filename, const std::string& heading) {
  std::ifstream file(filename);
  EXPECT_TRUE(file.is_open()) << filename;
  std::stringstream content;
  content << file.rdbuf();
  Values values;
  bool is_inside = false;
  for (const absl::string_view line : absl::StrSplit(content.str(), '\n')) {
    if (absl::StartsWith(line, "## ")) is_inside = line == heading;
    if (!is_inside || !absl::StartsWith(line, "| `")) continue;
    const std::vector<std::string> cells = absl::StrSplit(line, '|');
    EXPECT_EQ(cells.size(), 5u) << line;
    const std::string name(
        absl::StripPrefix(absl::StripSuffix(cells[1], "` "), " `"));
    values[name] = std::string(absl::StripAsciiWhitespace(cells[2]));
  }
  return values;
}

SlamConfiguration Load(const std::string& basename) {
  const auto configuration =
      LoadSlamConfiguration({"configuration_files"}, basename);
  CHECK(configuration.ok()) << configuration.status();
  return *configuration;
}

LoopOptions LoopsOf(const SlamConfiguration& configuration) {
  proto::LoopClosureOptions message;
  EXPECT_TRUE(options::GetExtension(
      configuration.map_builder_options.pose_graph_options()
          .constraint_builder_options(),
      &message));
  return loop_closure::ToLoopOptions(message);
}

Values StagesOf(const LoopOptions& loops) {
  return {
      {"search.enabled", Text(loops.search.enabled)},
      {"temporal.enabled", Text(loops.temporal.enabled)},
      {"threshold.enabled", Text(loops.threshold.enabled)},
      {"fusion.enabled", Text(loops.fusion.enabled)},
      {"information.enabled", Text(loops.information.enabled)},
      {"compatible_subset.enabled", Text(loops.compatible_subset.enabled)},
      {"innovation_veto.enabled", Text(loops.innovation_veto.enabled)},
      {"relocalization.enabled", Text(loops.relocalization.enabled)},
  };
}

TEST(PaperPresetsTest, OptimisedCartographer2025) {
  const SlamConfiguration configuration = Load("paper_2025.lua");
  const LoopOptions loops = LoopsOf(configuration);
  const auto& comparison = loops.temporal.comparison;
  Values values = StagesOf(loops);
  values.insert({
      {"temporal.window.base", Text(loops.temporal.window.base)},
      {"temporal.window.span", Text(loops.temporal.window.span)},
      {"temporal.window.gamma", Text(loops.temporal.window.gamma)},
      {"temporal.spacing", Text(loops.temporal.spacing)},
      {"temporal.comparison.minimum_length", Text(comparison.minimum_length)},
      {"temporal.comparison.step",
       comparison.step == loop_closure::WarpingStep::kSymmetric ? "symmetric"
                                                                : ""},
      {"temporal.comparison.comparison",
       comparison.comparison == loop_closure::ScanComparison::kSectors
           ? "sectors"
           : ""},
      {"temporal.comparison.signature.num_sectors",
       Text(comparison.signature.num_sectors)},
      {"temporal.comparison.signature.rays_per_sector",
       Text(comparison.signature.rays_per_sector)},
      {"temporal.comparison.signature.max_range",
       Text(comparison.signature.max_range)},
      {"temporal.comparison.signature.clip", Text(comparison.signature.clip)},
      {"temporal.comparison.signature.minimum_overlap",
       Text(comparison.signature.minimum_overlap)},
      {"threshold.direction",
       loops.threshold.direction == loop_closure::ThresholdDirection::kAsPrinted
           ? "as printed"
           : ""},
      {"threshold.low", Text(loops.threshold.low)},
      {"threshold.span", Text(loops.threshold.span)},
      {"threshold.sensitivity", Text(loops.threshold.sensitivity)},
      {"threshold.window", Text(loops.threshold.window)},
      {"threshold.base_threshold", Text(loops.threshold.base_threshold)},
      {"fusion.mode", loops.fusion.mode == loop_closure::FusionMode::kAsPrinted
                          ? "as printed"
                          : ""},
      {"fusion.min_final_score", Text(loops.fusion.min_final_score)},
      {"fusion.blend.window", Text(loops.fusion.blend.window)},
      {"information.alpha", Text(loops.information.alpha)},
      {"information.beta", Text(loops.information.beta)},
      {"information.reference_score", Text(loops.information.reference_score)},
      {"information.full_matrix", Text(loops.information.full_matrix)},
  });
  EXPECT_EQ(values,
            Listed("third_party_notes/paper_optimised_cartographer_2025.md",
                   "## Values of `paper_2025.lua`"));
  // Local SLAM and optimisation are Cartographer's.
  EXPECT_FALSE(options::HasExtension(configuration.trajectory_builder_options
                                         .trajectory_builder_2d_options()));
  EXPECT_FALSE(options::HasExtension(
      configuration.map_builder_options.pose_graph_options()
          .optimization_problem_options()));
}

Values LocalSlamOf(const SlamConfiguration& configuration) {
  const auto& stock =
      configuration.trajectory_builder_options.trajectory_builder_2d_options();
  proto::FrontEndOptions message;
  EXPECT_TRUE(options::GetExtension(stock, &message));
  const front_end::FrontEndOptions own = front_end::ToFrontEndOptions(message);
  proto::ScanMatcherOptions matcher;
  EXPECT_TRUE(
      options::GetExtension(stock.ceres_scan_matcher_options(), &matcher));
  return {
      {"front_end.match_features_only", Text(own.match_features_only)},
      {"front_end.features.num_neighbors", Text(own.features.num_neighbors)},
      {"front_end.features.distance_weighted",
       Text(own.features.distance_weighted)},
      {"front_end.features.min_points", Text(own.features.min_points)},
      {"front_end.prediction.use_odometry", Text(own.prediction.use_odometry)},
      {"front_end.prediction.imu.enabled", Text(own.prediction.imu.enabled)},
      {"front_end.prediction.time_offset.estimate",
       Text(own.prediction.time_offset.estimate)},
      {"front_end.prediction.calibration.estimate_odometry_scale",
       Text(own.prediction.calibration.estimate_odometry_scale)},
      {"front_end.prediction.calibration.estimate_rotation",
       Text(own.prediction.calibration.estimate_rotation)},
      {"front_end.prediction.check.enabled",
       Text(own.prediction.check.enabled)},
      {"front_end.search.enabled", Text(own.search.enabled)},
      {"front_end.fill_walls", Text(own.fill_walls)},
      {"front_end.smooth_ranges", Text(own.smooth_ranges)},
      {"front_end.estimate_beam_order", Text(own.estimate_beam_order)},
      {"scan_matcher.mode",
       matcher.paper_mode().eigenvalue_ratio() ? "eigenvalue ratio" : ""},
      {"scan_matcher.paper_ratio",
       Text(scan_matching::ScanInformationOptions().paper_ratio)},
  };
}

TEST(PaperPresetsTest, ImprovedGraphOptimisation2024) {
  const SlamConfiguration configuration = Load("paper_2024.lua");
  const LoopOptions loops = LoopsOf(configuration);
  const auto& subset = loops.compatible_subset;
  proto::RobustOptimizationOptions back_end;
  EXPECT_TRUE(options::GetExtension(
      configuration.map_builder_options.pose_graph_options()
          .optimization_problem_options(),
      &back_end));
  Values values = StagesOf(loops);
  for (const auto& value : LocalSlamOf(configuration)) values.insert(value);
  values.insert({
      {"compatible_subset.cycle.test",
       subset.cycle.test == uncertainty::CycleTest::kFixedBound ? "fixed bound"
                                                                : ""},
      {"compatible_subset.cycle.translation_bound",
       Text(subset.cycle.translation_bound)},
      {"compatible_subset.cycle.rotation_bound",
       Text(subset.cycle.rotation_bound)},
      {"compatible_subset.informative_sigma", Text(subset.informative_sigma)},
      {"compatible_subset.tolerance", Text(subset.tolerance)},
      {"compatible_subset.predicted_tolerance",
       Text(subset.predicted_tolerance)},
      {"compatible_subset.accepted_weight", Text(subset.accepted_weight)},
      {"compatible_subset.min_revisits", Text(subset.min_revisits)},
      {"compatible_subset.single_strong_enabled",
       Text(subset.single_strong_enabled)},
      {"compatible_subset.weak_prior_revisits",
       Text(subset.weak_prior_revisits)},
      {"compatible_subset.unpredicted_revisits",
       Text(subset.unpredicted_revisits)},
      {"back_end.robust_loops", Text(back_end.robust_loops())},
      {"back_end.odometry_check", Text(back_end.odometry_check())},
      {"back_end.odometry_gate",
       Text(optimization::LoopSelectionOptions().odometry_gate)},
  });
  EXPECT_EQ(values, Listed("third_party_notes/"
                           "paper_improved_graph_optimisation_2024.md",
                           "## Values of `paper_2024.lua`"));
}

}  // namespace
}  // namespace evaluation
}  // namespace cartographer_ext
