// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
//
// With which options a stored map is run again. A map keeps the options of its
// local SLAM but not those of the pose graph, so these come from a Lua file or
// are assumed; what the map does store, the weights of its constraints, is taken
// from it.
#ifndef CARTOGRAPHER_EXT_RERUN_RERUN_CONFIGURATION_H_
#define CARTOGRAPHER_EXT_RERUN_RERUN_CONFIGURATION_H_

#include <string>
#include <vector>

#include "absl/status/statusor.h"
#include "absl/types/optional.h"
#include "cartographer/mapping/proto/pose_graph_options.pb.h"
#include "cartographer_ext/map/map_graph.h"

namespace cartographer_ext {
namespace evaluation {

struct RerunConfiguration {
  std::string stock_name;  // of the Lua file
  // The file was named and had no blocks to be taken out: the map may have been
  // made with it.
  bool stock_is_known = false;
  cartographer::mapping::proto::PoseGraphOptions stock;
  std::string ours_name;
  // Absent when the file has no block of ours.
  absl::optional<cartographer::mapping::proto::PoseGraphOptions> ours;
  // What is not known but supposed, and what came from the map; a sentence each
  // without full stop.
  std::vector<std::string> assumptions;
};

// `basename`: the file whose blocks of ours are tried; stock is the same file
// without them. With `stock_basename`, stock is that file, and ours is that
// file with the blocks of `basename` put in, so that nothing but the blocks
// differs. With neither, stock.lua is assumed. Errors are those of
// LoadSlamConfiguration.
absl::StatusOr<RerunConfiguration> LoadRerunConfiguration(
    const std::vector<std::string>& directories, const std::string& basename,
    const std::string& stock_basename, const MapGraph& graph);

}  // namespace evaluation
}  // namespace cartographer_ext

#endif  // CARTOGRAPHER_EXT_RERUN_RERUN_CONFIGURATION_H_
