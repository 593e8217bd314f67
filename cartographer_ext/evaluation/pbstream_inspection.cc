// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
#include "cartographer_ext/evaluation/pbstream_inspection.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <set>
#include <utility>

#include "absl/strings/str_cat.h"
#include "absl/strings/str_format.h"
#include "cartographer_ext/evaluation/host_types.h"
#include "cartographer_ext/evaluation/map_graph.h"
#include "cartographer_ext/evaluation/pbstream_map.h"
#include "cartographer_ext/evaluation/stored_options.h"
#include "cartographer_ext/io/pbstream_validation.h"

namespace cartographer_ext {
namespace evaluation {
namespace {

using nlohmann::ordered_json;

constexpr double kLocalTolerance = 1e-3;  // metres, radians
// What comparing a pose with itself may give.
constexpr double kRounding = 1e-9;  // metres, radians
// Options named in a comparison.
constexpr size_t kMaxNamedOptions = 40;

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

// Largest and mean difference of poses.
struct PoseDifferences {
  int64_t count = 0;
  double max_translation = 0., max_rotation = 0., sum_translation = 0.;

  void Add(const Pose2& a, const Pose2& b) {
    const Pose2 difference = Between(a, b);
    ++count;
    const double translation = difference.translation().norm();
    max_translation = std::max(max_translation, translation);
    max_rotation = std::max(max_rotation, std::abs(difference.theta));
    sum_translation += translation;
  }
  bool any() const {
    return max_translation > kRounding || max_rotation > kRounding;
  }
  ordered_json ToJson() const {
    return {{"count", count},
            {"max_translation", max_translation},
            {"max_rotation", max_rotation},
            {"mean_translation",
             count == 0 ? 0. : sum_translation / static_cast<double>(count)}};
  }
  std::string ToText() const {
    return absl::StrFormat("up to %.6f m and %.6f rad (mean %.6f m)",
                           max_translation, max_rotation,
                           count == 0 ? 0. : sum_translation / count);
  }
};

class Comparison {
 public:
  Comparison(const io::Pbstream& first, const io::Pbstream& second)
      : first_(first),
        second_(second),
        first_graph_(MakeMapGraph(first)),
        second_graph_(MakeMapGraph(second)) {}

  PbstreamDifference Run() {
    ComparePoses("nodes", first_graph_.nodes, second_graph_.nodes);
    ComparePoses("submaps", first_graph_.submaps, second_graph_.submaps);
    CompareConstraints();
    CompareMotion();
    CompareRecords("grids", first_.submaps, second_.submaps,
                   [](const cartographer::mapping::proto::Submap& submap) {
                     return std::make_pair(
                         GraphId{submap.submap_id().trajectory_id(),
                                 submap.submap_id().submap_index()},
                         submap.submap_2d().grid().SerializeAsString());
                   });
    CompareRecords("point clouds", first_.nodes, second_.nodes,
                   [](const cartographer::mapping::proto::Node& node) {
                     return std::make_pair(
                         GraphId{node.node_id().trajectory_id(),
                                 node.node_id().node_index()},
                         node.node_data()
                             .filtered_gravity_aligned_point_cloud()
                             .SerializeAsString());
                   });
    if (first_.options.SerializeAsString() !=
        second_.options.SerializeAsString()) {
      Differ("the trajectory builder options differ");
      const auto lines = DescribeOptionDifferences(
          first_.options, second_.options, kMaxNamedOptions);
      for (const std::string& line : lines) Differ(line);
      result_.numbers["options"] = lines;
    }
    CompareCount("odometry readings", first_.odometry_data.size(),
                 second_.odometry_data.size());
    CompareCount("IMU readings", first_.imu_data.size(),
                 second_.imu_data.size());
    CompareCount("landmark observations", first_.landmark_data.size(),
                 second_.landmark_data.size());
    result_.identical = result_.differences.empty();
    return std::move(result_);
  }

 private:
  void Differ(const std::string& sentence) {
    result_.differences.push_back(sentence);
  }

  void CompareCount(const std::string& what, const size_t first,
                    const size_t second) {
    if (first != second) {
      Differ(absl::StrCat(what, ": ", first, " and ", second));
    }
  }

  void OnlyIn(const std::string& what, const size_t only_first,
              const size_t only_second) {
    if (only_first > 0 || only_second > 0) {
      Differ(absl::StrCat(what, ": ", only_first, " only in the first, ",
                          only_second, " only in the second"));
    }
  }

  template <typename Items>
  void ComparePoses(const std::string& what, const Items& first,
                    const Items& second) {
    PoseDifferences local, global;
    size_t common = 0;
    for (const auto& entry : first) {
      const auto other = second.find(entry.first);
      if (other == second.end()) continue;
      ++common;
      local.Add(entry.second.local_pose, other->second.local_pose);
      global.Add(entry.second.global_pose, other->second.global_pose);
    }
    OnlyIn(what, first.size() - common, second.size() - common);
    if (local.any()) {
      Differ(absl::StrCat("local poses of ", what, " differ ", local.ToText()));
    }
    if (global.any()) {
      Differ(
          absl::StrCat("global poses of ", what, " differ ", global.ToText()));
    }
    result_.numbers[what] = {{"common", common},
                             {"only_first", first.size() - common},
                             {"only_second", second.size() - common},
                             {"local_poses", local.ToJson()},
                             {"global_poses", global.ToJson()}};
  }

  void CompareMotion() {
    const LocalAgreement agreement =
        CompareLocalSlam(first_graph_, second_graph_);
    result_.numbers["local_slam"] = {
        {"common_stamps", agreement.common_stamps},
        {"pairs", agreement.pairs},
        {"fraction_alike", agreement.fraction_alike},
        {"fraction_alike_translation", agreement.fraction_alike_translation},
        {"max_translation", agreement.max_translation},
        {"max_rotation", agreement.max_rotation}};
    if (agreement.max_translation > kRounding ||
        agreement.max_rotation > kRounding) {
      Differ(absl::StrFormat(
          "local SLAM: %d stamps in common; from node to node %.2f %% of %d "
          "motions are alike to 2 cm and 0.2 degrees (%.2f %% to 2 cm), the "
          "worst is off by %.4f m and %.4f degrees",
          agreement.common_stamps, 100. * agreement.fraction_alike,
          agreement.pairs, 100. * agreement.fraction_alike_translation,
          agreement.max_translation, RadToDeg(agreement.max_rotation)));
    }
  }

  void CompareConstraints() {
    using Key = std::pair<GraphId, GraphId>;
    for (const bool loops : {true, false}) {
      std::map<Key, const GraphConstraint*> first, second;
      for (const auto& constraint : first_graph_.constraints) {
        if (constraint.is_loop != loops) continue;
        first[{constraint.submap_id, constraint.node_id}] = &constraint;
      }
      for (const auto& constraint : second_graph_.constraints) {
        if (constraint.is_loop != loops) continue;
        second[{constraint.submap_id, constraint.node_id}] = &constraint;
      }
      PoseDifferences poses;
      size_t common = 0;
      for (const auto& entry : first) {
        const auto other = second.find(entry.first);
        if (other == second.end()) continue;
        ++common;
        poses.Add(entry.second->relative_pose, other->second->relative_pose);
      }
      const std::string what = loops ? "loops" : "insertions";
      OnlyIn(what, first.size() - common, second.size() - common);
      if (poses.any()) {
        Differ(absl::StrCat("poses of ", what, " differ ", poses.ToText()));
      }
      result_.numbers[what] = {{"common", common},
                               {"only_first", first.size() - common},
                               {"only_second", second.size() - common},
                               {"relative_poses", poses.ToJson()}};
    }
  }

  // Counts common ids whose content is not the same, byte by byte.
  template <typename Records, typename Content>
  void CompareRecords(const std::string& what, const Records& first,
                      const Records& second, const Content& content) {
    std::map<GraphId, std::string> others;
    for (const auto& record : second) others.insert(content(record));
    size_t different = 0;
    for (const auto& record : first) {
      const auto entry = content(record);
      const auto other = others.find(entry.first);
      if (other != others.end() && other->second != entry.second) ++different;
    }
    if (different > 0) Differ(absl::StrCat(different, " ", what, " differ"));
    result_.numbers[what] = {{"different", different}};
  }

  const io::Pbstream& first_;
  const io::Pbstream& second_;
  const MapGraph first_graph_;
  const MapGraph second_graph_;
  PbstreamDifference result_;
};

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
  for (const auto& node : graph.nodes) {
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
                          "%d nodes lie in no stored submap (unfinished ones "
                          "may have been left out)\n",
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
                       " contradicts the local poses by ",
                       ShortPose(difference)));
    }
  }
  for (const GraphConstraint& constraint : graph.constraints) {
    if (constraint.is_loop &&
        insertions.count({constraint.submap_id, constraint.node_id}) > 0) {
      add(absl::StrCat("loop from submap ", ToString(constraint.submap_id),
                       " to node ", ToString(constraint.node_id),
                       ", which was inserted in it"));
    }
  }
  for (const auto& entry : graph.submaps) {
    if (inserted.count(entry.first) == 0) {
      add(absl::StrCat("submap ", ToString(entry.first), " has no nodes"));
    }
  }
  return problems;
}

LocalAgreement CompareLocalSlam(const MapGraph& first, const MapGraph& second) {
  constexpr double kAlikeTranslation = 0.02;
  const double alike_rotation = DegToRad(0.2);
  constexpr io::TimeNs kSameStamp = 100000;
  std::map<std::pair<int, io::TimeNs>, Pose2> others;
  for (const auto& entry : second.nodes) {
    others[{entry.first.trajectory_id, entry.second.time}] =
        entry.second.local_pose;
  }
  LocalAgreement result;
  result.nodes_first = static_cast<int64_t>(first.nodes.size());
  result.nodes_second = static_cast<int64_t>(second.nodes.size());
  int64_t alike = 0, alike_translation = 0;
  const Pose2* previous = nullptr;
  const Pose2* previous_other = nullptr;
  int trajectory_id = -1;
  for (const auto& entry : first.nodes) {
    const auto it = others.lower_bound(
        {entry.first.trajectory_id, entry.second.time - kSameStamp});
    const bool found = it != others.end() &&
                       it->first.first == entry.first.trajectory_id &&
                       it->first.second <= entry.second.time + kSameStamp;
    const Pose2* const other = found ? &it->second : nullptr;
    if (other != nullptr) ++result.common_stamps;
    if (entry.first.trajectory_id == trajectory_id && other != nullptr &&
        previous_other != nullptr) {
      const Pose2 difference =
          Between(Between(*previous, entry.second.local_pose),
                  Between(*previous_other, *other));
      const double translation = difference.translation().norm();
      const double rotation = std::abs(difference.theta);
      ++result.pairs;
      if (translation <= kAlikeTranslation) {
        ++alike_translation;
        if (rotation <= alike_rotation) ++alike;
      }
      result.max_translation = std::max(result.max_translation, translation);
      result.max_rotation = std::max(result.max_rotation, rotation);
    }
    trajectory_id = entry.first.trajectory_id;
    previous = &entry.second.local_pose;
    previous_other = other;
  }
  if (result.pairs > 0) {
    const double pairs = static_cast<double>(result.pairs);
    result.fraction_alike = static_cast<double>(alike) / pairs;
    result.fraction_alike_translation =
        static_cast<double>(alike_translation) / pairs;
  }
  return result;
}

PbstreamDifference Compare(const io::Pbstream& first,
                           const io::Pbstream& second) {
  return Comparison(first, second).Run();
}

}  // namespace evaluation
}  // namespace cartographer_ext
