// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
//
// Edits the pose graph of a written state. Its other records, the grids and
// clouds, stay as they are, byte for byte: parsed they would take thirty times
// the memory.
#ifndef CARTOGRAPHER_EXT_IO_PBSTREAM_POSE_GRAPH_EDIT_H_
#define CARTOGRAPHER_EXT_IO_PBSTREAM_POSE_GRAPH_EDIT_H_

#include <cstdint>
#include <functional>
#include <string>

#include "absl/status/status.h"
#include "absl/status/statusor.h"
#include "absl/strings/string_view.h"
#include "cartographer/mapping/proto/pose_graph.pb.h"

namespace cartographer_ext {
namespace io {

// Removes the withdrawn loops and their marks (common/withdrawn_loops.h), which
// programs without our optimization problem would use. Returns how many
// constraints were removed.
int64_t RemoveWithdrawnLoops(
    cartographer::mapping::proto::PoseGraph* pose_graph);

// The state `content`, a file in memory, after `edit`. `name` is for errors:
// InvalidArgument where it is no state, DataLoss where it is damaged.
absl::StatusOr<std::string> WithEditedPoseGraph(
    absl::string_view content, const std::string& name,
    const std::function<void(cartographer::mapping::proto::PoseGraph*)>& edit);

// The same for the file `written`, of which only what precedes the submaps is held
// in memory. Writes the whole file `filename` or nothing.
absl::Status CopyWithEditedPoseGraph(
    const std::string& written, const std::string& filename,
    const std::function<void(cartographer::mapping::proto::PoseGraph*)>& edit);

}  // namespace io
}  // namespace cartographer_ext

#endif  // CARTOGRAPHER_EXT_IO_PBSTREAM_POSE_GRAPH_EDIT_H_
