// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
//
// Options for the re-run of a stored map. A map stores the options of its local
// SLAM but not those of the pose graph, so these come from a Lua file or are
// assumed; the weights of the constraints are taken from the map.
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
  // The file was named and had no blocks to remove: the map may have been made
  // with it.
  bool stock_is_known = false;
  cartographer::mapping::proto::PoseGraphOptions stock;
  std::string ours_name;
  // Absent if the file has none of our blocks.
  absl::optional<cartographer::mapping::proto::PoseGraphOptions> ours;
  // Assumptions, and values taken from the map; sentences without full stop.
  std::vector<std::string> assumptions;
};

// `basename`: the file with our blocks; stock is the same file without them.
// With `stock_basename`, stock is that file, and ours is that file with the
// blocks of `basename` inserted, so that only the blocks differ. With neither,
// stock.lua is assumed. Errors are those of LoadSlamConfiguration.
absl::StatusOr<RerunConfiguration> LoadRerunConfiguration(
    const std::vector<std::string>& directories, const std::string& basename,
    const std::string& stock_basename, const MapGraph& graph);

}  // namespace evaluation
}  // namespace cartographer_ext

#endif  // CARTOGRAPHER_EXT_RERUN_RERUN_CONFIGURATION_H_
