// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
#include "cartographer_ext/map/pbstream_inspection.h"

#include <cmath>
#include <map>
#include <set>
#include <utility>

#include "absl/strings/str_cat.h"
#include "absl/strings/str_format.h"
#include "cartographer_ext/configuration/stored_options.h"
#include "cartographer_ext/io/pbstream/pbstream_validation.h"
#include "cartographer_ext/map/host_types.h"
#include "cartographer_ext/map/map_graph.h"
#include "cartographer_ext/map/pbstream_map.h"

namespace cartographer_ext {
namespace evaluation {
namespace {

using nlohmann::ordered_json;

constexpr double kLocalTolerance = 1e-3;  // metres, radians

template <typename Records>
std::map<int, int64_t> CountByTrajectory(const Records& records) {
  std::map<int, int64_t> counts;
  for (const auto& record : records) ++counts[record.trajectory_id()];
  return counts;
}

int64_t CountOf(const std::map<int, int64_t>& counts, const int id) {
  const auto it = counts.find(id);
  return it == counts.end() ? 0 : it->second;
}

// Trajectories that say which nodes were inserted into which submap. One that
// was loaded as a frozen map, for localisation, does not: Cartographer keeps no
// constraints of it, as none of its poses moves.
std::set<int> TrajectoriesWithInsertions(const MapGraph& graph) {
  std::set<int> ids;
  for (const GraphConstraint& constraint : graph.constraints) {
    if (!constraint.is_loop) ids.insert(constraint.submap_id.trajectory_id);
  }
  return ids;
}

ordered_json SensorNames(
    const cartographer::mapping::proto::TrajectoryBuilderOptionsWithSensorIds&
        options) {
  ordered_json names = ordered_json::array();
  for (const auto& sensor : options.sensor_id()) {
    names.push_back(absl::StrCat(
        cartographer::mapping::proto::SensorId::SensorType_Name(sensor.type()),
        ":", sensor.id()));
  }
  return names;
}

ordered_json SummariseTrajectory(const io::Pbstream& pbstream,
                                 const MapGraph& graph, const int position) {
  const auto& trajectory = pbstream.pose_graph.trajectory(position);
  const int id = trajectory.trajectory_id();
  ordered_json json;
  json["trajectory_id"] = id;
  int64_t nodes = 0, submaps = 0, finished = 0, intra = 0, inter = 0;
  double resolution = 0.;
  for (const auto& entry : graph.nodes) {
    if (entry.first.trajectory_id == id) ++nodes;
  }
  for (const auto& record : pbstream.submaps) {
    if (record.submap_id().trajectory_id() != id) continue;
    ++submaps;
    if (record.submap_2d().finished()) ++finished;
    resolution = record.submap_2d().grid().limits().resolution();
  }
  for (const GraphConstraint& constraint : graph.constraints) {
    if (constraint.node_id.trajectory_id != id) continue;
    ++(constraint.is_loop ? inter : intra);
  }
  json["nodes"] = nodes;
  json["submaps"] = submaps;
  json["finished_submaps"] = finished;
  json["constraints"] = {{"inter", inter}, {"intra", intra}};
  const Trajectory poses = graph.GlobalTrajectory(id);
  json["metres"] = poses.Length();
  json["has_insertions"] = intra > 0;
  if (!poses.empty()) {
    json["begin_seconds"] = io::ToSeconds(poses.poses().front().time);
    json["end_seconds"] = io::ToSeconds(poses.poses().back().time);
  }
  json["grid_resolution"] = resolution;
  json["odometry_readings"] =
      CountOf(CountByTrajectory(pbstream.odometry_data), id);
  json["imu_readings"] = CountOf(CountByTrajectory(pbstream.imu_data), id);
  json["fixed_frame_poses"] =
      CountOf(CountByTrajectory(pbstream.fixed_frame_pose_data), id);
  json["landmark_observations"] =
      CountOf(CountByTrajectory(pbstream.landmark_data), id);
  if (position < pbstream.options.options_with_sensor_ids_size()) {
    const auto& options = pbstream.options.options_with_sensor_ids(position);
    json["sensors"] = SensorNames(options);
    const std::vector<std::string> blocks =
        DescribeBlocks(options.trajectory_builder_options());
    json["has_extension_options"] = !blocks.empty();
    json["extension_options"] = blocks;
  }
  return json;
}

std::string ShortPose(const Pose2& pose) {
  return absl::StrFormat("%.4f m, %.5f rad", pose.translation().norm(),
                         std::abs(pose.theta));
}

}  // namespace

ordered_json Summarise(const io::Pbstream& pbstream) {
  const MapGraph graph = MakeMapGraph(pbstream);
  ordered_json json;
  json["format_version"] = pbstream.header.format_version();
  json["nodes"] = pbstream.nodes.size();
  json["submaps"] = pbstream.submaps.size();
  json["constraints"] = {
      {"inter", graph.num_loops()},
      {"intra",
       static_cast<int64_t>(graph.constraints.size()) - graph.num_loops()}};
  int64_t between_trajectories = 0;
  std::set<GraphId> inserted;
  for (const GraphConstraint& constraint : graph.constraints) {
    if (!constraint.is_loop) {
      inserted.insert(constraint.node_id);
    } else if (constraint.submap_id.trajectory_id !=
               constraint.node_id.trajectory_id) {
      ++between_trajectories;
    }
  }
  json["constraints"]["between_trajectories"] = between_trajectories;
  int64_t in_no_submap = 0;
  const std::set<int> known = TrajectoriesWithInsertions(graph);
  for (const auto& node : graph.nodes) {
    if (known.count(node.first.trajectory_id) == 0) continue;
    in_no_submap += inserted.count(node.first) == 0 ? 1 : 0;
  }
  json["nodes_in_no_submap"] = in_no_submap;
  json["landmarks"] = pbstream.pose_graph.landmark_poses_size();
  json["unknown_records"] = pbstream.num_unknown_records;
  json["trajectories"] = ordered_json::array();
  for (int i = 0; i < pbstream.pose_graph.trajectory_size(); ++i) {
    json["trajectories"].push_back(SummariseTrajectory(pbstream, graph, i));
  }
  return json;
}

std::string SummaryToText(const ordered_json& summary) {
  std::string text = absl::StrFormat(
      "format version %d, %d nodes, %d submaps, %d loops, %d insertions\n",
      summary["format_version"].get<int>(), summary["nodes"].get<int64_t>(),
      summary["submaps"].get<int64_t>(),
      summary["constraints"]["inter"].get<int64_t>(),
      summary["constraints"]["intra"].get<int64_t>());
  if (summary["nodes_in_no_submap"].get<int64_t>() > 0) {
    absl::StrAppendFormat(&text,
                          "%d nodes are in no stored submap (unfinished "
                          "submaps may not have been saved)\n",
                          summary["nodes_in_no_submap"].get<int64_t>());
  }
  if (summary["constraints"]["between_trajectories"].get<int64_t>() > 0) {
    absl::StrAppendFormat(
        &text, "%d loops between trajectories\n",
        summary["constraints"]["between_trajectories"].get<int64_t>());
  }
  for (const ordered_json& trajectory : summary["trajectories"]) {
    absl::StrAppendFormat(
        &text,
        "trajectory %d: %d nodes, %d submaps (%d finished, cells of %.3f m), "
        "%d loops, %.1f m",
        trajectory["trajectory_id"].get<int>(),
        trajectory["nodes"].get<int64_t>(),
        trajectory["submaps"].get<int64_t>(),
        trajectory["finished_submaps"].get<int64_t>(),
        trajectory["grid_resolution"].get<double>(),
        trajectory["constraints"]["inter"].get<int64_t>(),
        trajectory["metres"].get<double>());
    if (trajectory.contains("begin_seconds")) {
      absl::StrAppendFormat(&text, ", %.3f s to %.3f s",
                            trajectory["begin_seconds"].get<double>(),
                            trajectory["end_seconds"].get<double>());
    }
    absl::StrAppendFormat(&text, ", %d odometry readings\n",
                          trajectory["odometry_readings"].get<int64_t>());
    if (!trajectory["has_insertions"].get<bool>() &&
        trajectory["submaps"].get<int64_t>() > 0) {
      absl::StrAppend(
          &text,
          "  a map that was loaded frozen: which nodes are in which "
          "submap is not stored\n");
    }
    if (trajectory.contains("sensors")) {
      absl::StrAppend(&text, "  sensors:");
      for (const ordered_json& name : trajectory["sensors"]) {
        absl::StrAppend(&text, " ", name.get<std::string>());
      }
      absl::StrAppend(&text, trajectory["has_extension_options"].get<bool>()
                                 ? "; options of cartographer_ext\n"
                                 : "\n");
      for (const ordered_json& block : trajectory["extension_options"]) {
        absl::StrAppend(&text, "  ", block.get<std::string>(), "\n");
      }
    }
  }
  return text;
}

std::vector<std::string> FindProblems(const io::Pbstream& pbstream,
                                      const size_t max_problems) {
  std::vector<std::string> problems =
      io::FindPbstreamProblems(pbstream, max_problems);
  const auto add = [&](const std::string& problem) {
    if (problems.size() < max_problems) problems.push_back(problem);
  };
  const MapGraph graph = MakeMapGraph(pbstream);
  const auto inserted = graph.InsertedNodes();
  std::set<std::pair<GraphId, GraphId>> insertions;
  for (const GraphConstraint& constraint : graph.constraints) {
    if (constraint.is_loop) continue;
    insertions.emplace(constraint.submap_id, constraint.node_id);
    const auto submap = graph.submaps.find(constraint.submap_id);
    const auto node = graph.nodes.find(constraint.node_id);
    if (submap == graph.submaps.end() || node == graph.nodes.end()) continue;
    const Pose2 difference =
        Between(constraint.relative_pose,
                Between(submap->second.local_pose, node->second.local_pose));
    if (!(difference.translation().norm() <= kLocalTolerance) ||
        !(std::abs(difference.theta) <= kLocalTolerance)) {
      add(absl::StrCat("insertion of node ", ToString(constraint.node_id),
                       " in submap ", ToString(constraint.submap_id),
                       " disagrees with the local poses by ",
                       ShortPose(difference)));
    }
  }
  for (const GraphConstraint& constraint : graph.constraints) {
    if (constraint.is_loop &&
        insertions.count({constraint.submap_id, constraint.node_id}) > 0) {
      add(absl::StrCat("loop from submap ", ToString(constraint.submap_id),
                       " to node ", ToString(constraint.node_id),
                       ", which was inserted into it"));
    }
  }
  const std::set<int> known = TrajectoriesWithInsertions(graph);
  for (const auto& entry : graph.submaps) {
    if (known.count(entry.first.trajectory_id) > 0 &&
        inserted.count(entry.first) == 0) {
      add(absl::StrCat("submap ", ToString(entry.first), " has no nodes"));
    }
  }
  return problems;
}

}  // namespace evaluation
}  // namespace cartographer_ext
