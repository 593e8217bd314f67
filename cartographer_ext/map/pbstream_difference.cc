// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
#include "cartographer_ext/map/pbstream_difference.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <utility>

#include "absl/strings/str_cat.h"
#include "absl/strings/str_format.h"
#include "cartographer_ext/configuration/stored_options.h"
#include "cartographer_ext/map/pbstream_map.h"

namespace cartographer_ext {
namespace evaluation {
namespace {

using nlohmann::ordered_json;

// The rounding error of comparing a pose with itself.
constexpr double kRounding = 1e-9;  // metres, radians
// Options named in a comparison.
constexpr size_t kMaxNamedOptions = 40;

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
          "local SLAM: %d common stamps; from node to node %.2f %% of %d "
          "motions agree within 2 cm and 0.2 degrees (%.2f %% within 2 cm), "
          "the worst differs by %.4f m and %.4f degrees",
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
