// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
//
// Records of local SLAM beside a map: run.pbstream has run.nodes.pb
// (length-delimited MatchRecord messages, one per matched scan) and
// run.nodes.csv (the same as a table), if it was made by our local SLAM.
#ifndef CARTOGRAPHER_EXT_SLAM_MATCH_FILES_H_
#define CARTOGRAPHER_EXT_SLAM_MATCH_FILES_H_

#include <cstdint>
#include <string>
#include <vector>

#include "absl/status/status.h"
#include "absl/status/statusor.h"
#include "cartographer_ext/front_end/match_counts.h"
#include "cartographer_ext/map/map_graph.h"
#include "cartographer_ext/match_record.pb.h"

namespace cartographer_ext {
namespace evaluation {

std::string MatchRecordsFilename(const std::string& pbstream_filename);
std::string MatchCsvFilename(const std::string& pbstream_filename);

// Writes both files atomically; without records it removes those of an earlier
// run, which do not belong to the map.
absl::Status WriteMatchesBeside(const std::string& pbstream_filename,
                                const std::vector<proto::MatchRecord>& records);

absl::StatusOr<std::vector<proto::MatchRecord>> ReadMatches(
    const std::string& records_filename);

// Marks the nodes of `graph` for the picture: those with a degenerate scan,
// with the direction, and those near an odometry fault. Records of trajectories
// that the graph does not have are ignored.
void MarkMatches(const std::vector<proto::MatchRecord>& records,
                 MapGraph* graph);

using MatchCounts = front_end::MatchCounts;

MatchCounts CountMatches(const std::vector<proto::MatchRecord>& records);

}  // namespace evaluation
}  // namespace cartographer_ext

#endif  // CARTOGRAPHER_EXT_SLAM_MATCH_FILES_H_
