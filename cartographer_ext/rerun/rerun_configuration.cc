// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
#include "cartographer_ext/rerun/rerun_configuration.h"

#include <utility>

#include "absl/strings/str_cat.h"
#include "absl/strings/str_format.h"
#include "cartographer_ext/configuration/option_messages.h"
#include "cartographer_ext/configuration/slam_configuration.h"

namespace cartographer_ext {
namespace evaluation {
namespace {

using cartographer::mapping::proto::PoseGraphOptions;

constexpr char kAssumedBasename[] = "stock.lua";

// The pair of weights that the constraints of one kind have in common.
struct Weights {
  double translation = 0.;
  double rotation = 0.;
  bool found = false;
  bool unique = true;
};

Weights CommonWeights(const MapGraph& graph, const bool loops) {
  Weights weights;
  for (const GraphConstraint& constraint : graph.constraints) {
    if (constraint.is_loop != loops) continue;
    if (!weights.found) {
      weights.found = true;
      weights.translation = constraint.translation_weight;
      weights.rotation = constraint.rotation_weight;
    }
    weights.unique = weights.unique &&
                     weights.translation == constraint.translation_weight &&
                     weights.rotation == constraint.rotation_weight;
  }
  return weights;
}

void TakeWeights(const MapGraph& graph, PoseGraphOptions* const options) {
  const Weights loops = CommonWeights(graph, true);
  if (loops.found && loops.unique) {
    auto* const builder = options->mutable_constraint_builder_options();
    builder->set_loop_closure_translation_weight(loops.translation);
    builder->set_loop_closure_rotation_weight(loops.rotation);
  }
  const Weights insertions = CommonWeights(graph, false);
  if (insertions.found && insertions.unique) {
    options->set_matcher_translation_weight(insertions.translation);
    options->set_matcher_rotation_weight(insertions.rotation);
  }
}

}  // namespace

absl::StatusOr<RerunConfiguration> LoadRerunConfiguration(
    const std::vector<std::string>& directories, const std::string& basename,
    const std::string& stock_basename, const MapGraph& graph) {
  RerunConfiguration result;
  std::string stock_name = stock_basename;
  if (!basename.empty()) {
    auto configuration = LoadSlamConfiguration(directories, basename);
    if (!configuration.ok()) return configuration.status();
    PoseGraphOptions options =
        configuration->map_builder_options.pose_graph_options();
    TakeWeights(graph, &options);
    PoseGraphOptions without = options;
    if (RemoveExtensions(&without)) {
      result.ours = options;
      result.ours_name = basename;
    }
    if (stock_name.empty()) {
      result.stock = std::move(without);
      result.stock_name = basename;
      result.stock_is_known = !result.ours.has_value();
      if (result.ours.has_value()) {
        result.assumptions.push_back(
            absl::StrCat("stock is ", basename, " without our blocks"));
      }
    }
  }
  if (result.stock_name.empty()) {
    const bool assumed = stock_name.empty();
    if (assumed) stock_name = kAssumedBasename;
    auto configuration = LoadSlamConfiguration(directories, stock_name);
    if (!configuration.ok()) return configuration.status();
    result.stock = configuration->map_builder_options.pose_graph_options();
    TakeWeights(graph, &result.stock);
    result.stock_is_known = !RemoveExtensions(&result.stock) && !assumed;
    result.stock_name = stock_name;
    if (result.ours.has_value()) {
      PoseGraphOptions ours = result.stock;
      CopyExtensions(*result.ours, &ours);
      result.ours = std::move(ours);
      result.ours_name =
          absl::StrCat(stock_name, " with the blocks of ", basename);
      result.assumptions.push_back(absl::StrCat("ours is ", result.ours_name));
    }
    if (assumed) {
      result.assumptions.push_back(absl::StrCat(
          "no configuration was given, so the defaults (", stock_name,
          ") are assumed; a map does not store the options of its pose graph"));
    }
  }
  const Weights loops = CommonWeights(graph, true);
  const Weights insertions = CommonWeights(graph, false);
  if (loops.found && loops.unique) {
    result.assumptions.push_back(absl::StrFormat(
        "the weights of loops are taken from the map, %g and %g",
        loops.translation, loops.rotation));
  } else if (loops.found) {
    result.assumptions.push_back(
        "the loops of the map have various weights; those of the "
        "configuration are used");
  }
  if (insertions.found && insertions.unique) {
    result.assumptions.push_back(absl::StrFormat(
        "the weights of insertions are taken from the map, %g and %g",
        insertions.translation, insertions.rotation));
  }
  return result;
}

}  // namespace evaluation
}  // namespace cartographer_ext
