// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
#include "cartographer_ext/slam/match_files.h"

#include <iterator>
#include <map>

#include "cartographer/common/time.h"
#include "cartographer_ext/front_end/match_record.h"
#include "cartographer_ext/map/host_types.h"
#include "cartographer_ext/slam/side_files.h"

namespace cartographer_ext {
namespace evaluation {
namespace {

using proto::MatchRecord;

bool PositionIsDegenerate(const MatchRecord& record) {
  return record.degeneracy() == MatchRecord::TRANSLATION ||
         record.degeneracy() == MatchRecord::TRANSLATION_AND_ROTATION ||
         record.degeneracy() == MatchRecord::POSITION ||
         record.degeneracy() == MatchRecord::EVERYTHING;
}

// The node nearest in time; null if there is none.
GraphNode* Nearest(const std::map<io::TimeNs, GraphNode*>& nodes,
                   const io::TimeNs time) {
  if (nodes.empty()) return nullptr;
  auto after = nodes.lower_bound(time);
  if (after == nodes.end()) return nodes.rbegin()->second;
  if (after == nodes.begin()) return after->second;
  const auto before = std::prev(after);
  return time - before->first < after->first - time ? before->second
                                                    : after->second;
}

}  // namespace

std::string MatchRecordsFilename(const std::string& pbstream_filename) {
  return SideFilename(pbstream_filename, ".nodes.pb");
}

std::string MatchCsvFilename(const std::string& pbstream_filename) {
  return SideFilename(pbstream_filename, ".nodes.csv");
}

absl::Status WriteMatchesBeside(const std::string& pbstream_filename,
                                const std::vector<MatchRecord>& records) {
  std::string bytes;
  for (const MatchRecord& record : records) {
    front_end::AppendRecord(record, &bytes);
  }
  SideFileWriter files(MatchRecordsFilename(pbstream_filename),
                       MatchCsvFilename(pbstream_filename));
  if (!records.empty()) files.Add(bytes, front_end::RecordCsv(records));
  return files.Finish();
}

absl::StatusOr<std::vector<MatchRecord>> ReadMatches(
    const std::string& records_filename) {
  return ReadTimedSideFile<MatchRecord>(
      records_filename, "match", front_end::ParseRecords,
      [](const MatchRecord& record) { return record.time(); });
}

void MarkMatches(const std::vector<MatchRecord>& records,
                 MapGraph* const graph) {
  std::map<int, std::map<io::TimeNs, GraphNode*>> nodes;
  for (auto& entry : graph->nodes) {
    nodes[entry.first.trajectory_id][entry.second.time] = &entry.second;
  }
  for (const MatchRecord& record : records) {
    const bool is_fault = front_end::IsOdometryFault(record);
    const bool is_degenerate = record.is_node() && PositionIsDegenerate(record);
    if (!is_fault && !is_degenerate) continue;
    const auto trajectory = nodes.find(record.builder());
    if (trajectory == nodes.end()) continue;
    GraphNode* const node = Nearest(
        trajectory->second,
        FromHostTime(cartographer::common::FromUniversal(record.time())));
    if (node == nullptr) continue;
    if (is_fault) node->odometry_fault = true;
    if (is_degenerate) {
      node->weak_direction_is_known = true;
      // From the local frame into that of the map.
      node->weak_direction = record.weak_direction() + node->global_pose.theta -
                             node->local_pose.theta;
    }
  }
}

MatchCounts CountMatches(const std::vector<MatchRecord>& records) {
  MatchCounts counts;
  for (const MatchRecord& record : records) counts.Add(record);
  return counts;
}

}  // namespace evaluation
}  // namespace cartographer_ext
