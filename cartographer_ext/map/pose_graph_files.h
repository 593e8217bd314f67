// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
//
// Pose graphs of the optimisation module from and to files.
#ifndef CARTOGRAPHER_EXT_MAP_POSE_GRAPH_FILES_H_
#define CARTOGRAPHER_EXT_MAP_POSE_GRAPH_FILES_H_

#include <string>
#include <vector>

#include "absl/status/status.h"
#include "absl/status/statusor.h"
#include "cartographer_ext/io/g2o.h"
#include "cartographer_ext/optimization/graph/pose_graph.h"
#include "cartographer_ext/optimization/offline/optimize.h"

namespace cartographer_ext {
namespace evaluation {

// Vertices in order of id; loops by optimization::MarkLoops. The graph is
// checked (optimization::ValidatePoseGraph).
absl::StatusOr<optimization::PoseGraph> ToPoseGraph(const io::G2oGraph& g2o);

// ReadG2o and ToPoseGraph, errors with the name of the file.
absl::StatusOr<optimization::PoseGraph> ReadPoseGraph(
    const std::string& filename);

// The graph with these poses in place of its own.
absl::Status WritePoseGraph(const optimization::PoseGraph& graph,
                            const std::vector<Pose2>& poses,
                            const std::string& filename);

// Ground truth in any format of io::ReadPosesById, for the poses of `graph`:
// the pose of the same id or, if not all ids are present, the pose that
// AssociateByPath finds for `estimate`.
absl::StatusOr<std::vector<Pose2>> ReadTruth(
    const optimization::PoseGraph& graph, const std::vector<Pose2>& estimate,
    const std::string& filename);

// One line per loop: edge,from,to,chi2,weight,accepted.
std::string VerdictTable(const optimization::PoseGraph& graph,
                         const optimization::OptimizeResult& result);

// Path and loops, before left of after; accepted loops green, rejected red.
absl::Status WriteComparisonPicture(const optimization::PoseGraph& graph,
                                    const optimization::OptimizeResult& result,
                                    const std::string& title,
                                    const std::string& filename);

}  // namespace evaluation
}  // namespace cartographer_ext

#endif  // CARTOGRAPHER_EXT_MAP_POSE_GRAPH_FILES_H_
