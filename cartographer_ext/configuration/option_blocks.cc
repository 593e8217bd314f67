// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
#include "cartographer_ext/configuration/option_blocks.h"

#include <memory>
#include <utility>

#include "cartographer_ext/options/extension_field.h"
#include "cartographer_ext/options/option_description.h"
#include "cartographer_ext/swaps.h"
#ifdef CARTOGRAPHER_EXT_SWAP_CONSTRAINT_BUILDER
#include "cartographer_ext/loop_closure_options.pb.h"
#endif
#ifdef CARTOGRAPHER_EXT_SWAP_CERES_SCAN_MATCHER
#include "cartographer_ext/scan_matcher_options.pb.h"
#endif
#ifdef CARTOGRAPHER_EXT_SWAP_OPTIMIZATION_PROBLEM
#include "cartographer_ext/robust_optimization_options.pb.h"
#endif
#ifdef CARTOGRAPHER_EXT_SWAP_LOCAL_TRAJECTORY_BUILDER
#include "cartographer_ext/front_end_options.pb.h"
#endif

namespace cartographer_ext {
namespace evaluation {
namespace {

template <typename Extension>
options::OptionBlock Block(const char* const stock_path, const char* const name,
                           const char* const summary,
                           const google::protobuf::Message& stock) {
  options::OptionBlock block;
  block.stock_path = stock_path;
  block.name = name;
  block.summary = summary;
  block.options = std::make_unique<Extension>();
  block.present = options::GetExtension(stock, block.options.get());
  if (!block.present) options::SetDefaults(block.options.get());
  return block;
}

}  // namespace

std::vector<options::OptionBlock> OptionBlocks(
    const SlamConfiguration& configuration) {
  std::vector<options::OptionBlock> blocks;
  const auto& local =
      configuration.trajectory_builder_options.trajectory_builder_2d_options();
  const auto& pose_graph =
      configuration.map_builder_options.pose_graph_options();
  (void)local;
  (void)pose_graph;
#ifdef CARTOGRAPHER_EXT_SWAP_LOCAL_TRAJECTORY_BUILDER
  blocks.push_back(Block<proto::FrontEndOptions>(
      "TRAJECTORY_BUILDER_2D", "trajectory_builder_2d",
      "Local SLAM with motion prediction from odometry and IMU, fault "
      "detection and online calibration.",
      local));
#endif
#ifdef CARTOGRAPHER_EXT_SWAP_CERES_SCAN_MATCHER
  blocks.push_back(Block<proto::ScanMatcherOptions>(
      "TRAJECTORY_BUILDER_2D.ceres_scan_matcher", "ceres_scan_matcher",
      "Scan matching that follows the prediction along degenerate directions.",
      local.ceres_scan_matcher_options()));
#endif
#ifdef CARTOGRAPHER_EXT_SWAP_CONSTRAINT_BUILDER
  blocks.push_back(Block<proto::LoopClosureOptions>(
      "POSE_GRAPH.constraint_builder", "constraint_builder",
      "Loop closure with temporal verification, consensus and confidence "
      "weights.",
      pose_graph.constraint_builder_options()));
#endif
#ifdef CARTOGRAPHER_EXT_SWAP_CERES_SCAN_MATCHER
  blocks.push_back(Block<proto::ScanMatcherOptions>(
      "POSE_GRAPH.constraint_builder.ceres_scan_matcher", "ceres_scan_matcher",
      "Scan matching that follows the prediction along degenerate directions.",
      pose_graph.constraint_builder_options().ceres_scan_matcher_options()));
#endif
#ifdef CARTOGRAPHER_EXT_SWAP_OPTIMIZATION_PROBLEM
  blocks.push_back(Block<proto::RobustOptimizationOptions>(
      "POSE_GRAPH.optimization_problem", "optimization_problem",
      "Robust optimisation that disables wrong loops.",
      pose_graph.optimization_problem_options()));
#endif
  return blocks;
}

}  // namespace evaluation
}  // namespace cartographer_ext
