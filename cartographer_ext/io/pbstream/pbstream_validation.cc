// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
#include "cartographer_ext/io/pbstream/pbstream_validation.h"

#include <cmath>
#include <cstdint>
#include <limits>
#include <map>
#include <utility>

#include "absl/container/flat_hash_map.h"
#include "absl/container/flat_hash_set.h"
#include "absl/strings/str_cat.h"
#include "absl/strings/str_format.h"
#include "absl/strings/string_view.h"
#include "cartographer_ext/common/host_ticks.h"
#include "cartographer_ext/io/pbstream/grid_validation.h"

namespace cartographer_ext {
namespace io {
namespace {

namespace mapping = cartographer::mapping::proto;
namespace sensor = cartographer::sensor::proto;
namespace transform = cartographer::transform::proto;

// Trajectory and index.
using Id = std::pair<int, int>;

constexpr double kMaxQuaternionError = 1e-3;

bool IsFinite(const transform::Vector3d& v) {
  return std::isfinite(v.x()) && std::isfinite(v.y()) && std::isfinite(v.z());
}

bool IsRotation(const transform::Quaterniond& q) {
  const double norm =
      std::sqrt(q.w() * q.w() + q.x() * q.x() + q.y() * q.y() + q.z() * q.z());
  return std::abs(norm - 1.) < kMaxQuaternionError;  // false for NaN
}

bool IsPose(const transform::Rigid3d& pose) {
  const transform::Vector3d& t = pose.translation();
  return IsFinite(t) && std::abs(t.x()) < kMaxCoordinate &&
         std::abs(t.y()) < kMaxCoordinate && std::abs(t.z()) < kMaxCoordinate &&
         IsRotation(pose.rotation());
}

bool IsWeight(const double weight) {
  return std::isfinite(weight) && weight >= 0.;
}

std::string Name(absl::string_view kind, const Id& id) {
  return absl::StrFormat("%s (%d, %d)", kind, id.first, id.second);
}

Id IdOf(const mapping::NodeId& id) {
  return {id.trajectory_id(), id.node_index()};
}

Id IdOf(const mapping::SubmapId& id) {
  return {id.trajectory_id(), id.submap_index()};
}

// Blocks of a count, three cube coordinates and that many points.
bool CanBeUnpacked(const sensor::CompressedPointCloud& cloud) {
  constexpr int kHeaderSize = 4;
  constexpr int kMaxCube = 1 << 13;  // 23 bits of millimetres in all
  int64_t num_points = 0;
  int position = 0;
  while (position < cloud.point_data_size()) {
    const int count = cloud.point_data(position);
    const int left = cloud.point_data_size() - position;
    if (count <= 0 || left <= kHeaderSize || count > left - kHeaderSize) {
      return false;
    }
    for (int i = 1; i != kHeaderSize; ++i) {
      const int cube = cloud.point_data(position + i);
      if (cube < -kMaxCube || cube > kMaxCube) return false;
    }
    num_points += count;
    position += kHeaderSize + count;
  }
  return num_points == cloud.num_points();
}

class Checker {
 public:
  Checker(const Pbstream& pbstream, const bool with_grids,
          const size_t max_problems)
      : pbstream_(pbstream),
        with_grids_(with_grids),
        max_problems_(max_problems) {}

  std::vector<std::string> Run() {
    CheckTrajectories();
    CheckSubmaps();
    CheckNodes();
    CheckConstraints();
    CheckLandmarkPoses();
    CheckTrajectoryData();
    CheckReadings();
    return std::move(problems_);
  }

 private:
  // Adds a problem unless `holds`; returns `holds`.
  template <typename... Parts>
  bool Expect(const bool holds, const Parts&... parts) {
    if (!holds && problems_.size() < max_problems_) {
      problems_.push_back(absl::StrCat(parts...));
    }
    return holds;
  }

  void CheckTrajectories() {
    const mapping::PoseGraph& graph = pbstream_.pose_graph;
    const int num_options = pbstream_.options.options_with_sensor_ids_size();
    Expect(graph.trajectory_size() == num_options, "the pose graph has ",
           graph.trajectory_size(), " trajectories, but there are options for ",
           num_options);
    for (int i = 0; i != num_options; ++i) {
      const int64_t time = pbstream_.options.options_with_sensor_ids(i)
                               .trajectory_builder_options()
                               .initial_trajectory_pose()
                               .timestamp();
      ExpectTime(absl::StrCat("options ", i, " have an initial pose at ", time),
                 time);
    }
    for (const mapping::Trajectory& trajectory : graph.trajectory()) {
      const int id = trajectory.trajectory_id();
      Expect(id >= 0, "a trajectory has the negative id ", id);
      Expect(trajectories_.insert(id).second, "trajectory ", id,
             " is there twice");
      int last_index = -1;
      for (const auto& submap : trajectory.submap()) {
        const Id submap_id(id, submap.submap_index());
        Expect(submap_id.second > last_index, Name("submap", submap_id),
               " of the pose graph is out of order");
        last_index = submap_id.second;
        Expect(IsPose(submap.pose()), Name("submap", submap_id),
               " has no valid global pose");
        submap_poses_.insert(submap_id);
      }
      last_index = -1;
      int64_t last_time = std::numeric_limits<int64_t>::min();
      for (const auto& node : trajectory.node()) {
        const Id node_id(id, node.node_index());
        Expect(node_id.second > last_index, Name("node", node_id),
               " of the pose graph is out of order");
        last_index = node_id.second;
        Expect(node.timestamp() >= last_time, Name("node", node_id),
               " is older than the node before it");
        last_time = node.timestamp();
        ExpectTime(absl::StrCat(Name("node", node_id), " is at ", last_time),
                   last_time);
        Expect(IsPose(node.pose()), Name("node", node_id),
               " has no valid global pose");
        node_times_.emplace(node_id, node.timestamp());
      }
    }
  }

  void CheckSubmaps() {
    for (const mapping::Submap& submap : pbstream_.submaps) {
      const Id id = IdOf(submap.submap_id());
      const std::string name = Name("submap", id);
      Expect(submap_poses_.contains(id), name, " is not in the pose graph");
      Expect(submaps_.insert(id).second, name, " is there twice");
      if (!Expect(submap.has_submap_2d() && !submap.has_submap_3d(), name,
                  " is not a 2D submap")) {
        continue;
      }
      const mapping::Submap2D& submap_2d = submap.submap_2d();
      Expect(IsPose(submap_2d.local_pose()), name, " has no valid local pose");
      Expect(submap_2d.num_range_data() >= 0, name,
             " has a negative number of scans");
      if (with_grids_ && submap_2d.has_grid()) {
        for (const std::string& problem :
             FindGridProblems(submap_2d.grid(), name)) {
          Expect(false, problem);
        }
      }
    }
  }

  void CheckNodes() {
    for (const mapping::Node& node : pbstream_.nodes) {
      const Id id = IdOf(node.node_id());
      const std::string name = Name("node", id);
      Expect(nodes_.insert(id).second, name, " is there twice");
      const mapping::TrajectoryNodeData& data = node.node_data();
      const auto time = node_times_.find(id);
      if (Expect(time != node_times_.end(), name,
                 " is not in the pose graph")) {
        Expect(time->second == data.timestamp(), name,
               " has another time in the pose graph");
      }
      Expect(IsRotation(data.gravity_alignment()), name,
             " has no valid gravity alignment");
      Expect(IsPose(data.local_pose()), name, " has no valid local pose");
      Expect(CanBeUnpacked(data.filtered_gravity_aligned_point_cloud()) &&
                 CanBeUnpacked(data.high_resolution_point_cloud()) &&
                 CanBeUnpacked(data.low_resolution_point_cloud()),
             name, " has a corrupt point cloud");
    }
  }

  void CheckConstraints() {
    using Constraint = mapping::PoseGraph::Constraint;
    int index = 0;
    for (const Constraint& constraint : pbstream_.pose_graph.constraint()) {
      const std::string name = absl::StrCat("constraint ", index++);
      const Id submap = IdOf(constraint.submap_id());
      const Id node = IdOf(constraint.node_id());
      Expect(submaps_.contains(submap), name, " refers to ",
             Name("submap", submap), ", which does not exist");
      Expect(nodes_.contains(node), name, " refers to ", Name("node", node),
             ", which does not exist");
      Expect(IsPose(constraint.relative_pose()), name, " has no valid pose");
      Expect(constraint.tag() == Constraint::INTRA_SUBMAP ||
                 constraint.tag() == Constraint::INTER_SUBMAP,
             name, " has the unknown tag ", constraint.tag());
      Expect(IsWeight(constraint.translation_weight()) &&
                 IsWeight(constraint.rotation_weight()),
             name, " has no valid weights");
    }
  }

  void CheckLandmarkPoses() {
    absl::flat_hash_set<std::string> ids;
    for (const auto& landmark : pbstream_.pose_graph.landmark_poses()) {
      Expect(ids.insert(landmark.landmark_id()).second, "landmark '",
             landmark.landmark_id(), "' is there twice");
      Expect(IsPose(landmark.global_pose()), "landmark '",
             landmark.landmark_id(), "' has no valid pose");
    }
  }

  void CheckTrajectoryData() {
    for (const mapping::TrajectoryData& data : pbstream_.trajectory_data) {
      const std::string name =
          absl::StrCat("the data of trajectory ", data.trajectory_id());
      ExpectTrajectory(name, data.trajectory_id());
      Expect(std::isfinite(data.gravity_constant()), name,
             " has no finite gravity");
      Expect(!data.has_imu_calibration() || IsRotation(data.imu_calibration()),
             name, " has no valid IMU calibration");
      Expect(!data.has_fixed_frame_origin_in_map() ||
                 IsPose(data.fixed_frame_origin_in_map()),
             name, " has no valid origin of the fixed frame");
    }
  }

  void CheckReadings() {
    std::map<int, int64_t> last_times;
    for (const mapping::ImuData& reading : pbstream_.imu_data) {
      const sensor::ImuData& data = reading.imu_data();
      const std::string name =
          CheckReading("IMU", reading, data.timestamp(), &last_times);
      Expect(IsFinite(data.linear_acceleration()) &&
                 IsFinite(data.angular_velocity()),
             name, " is not finite");
    }
    last_times.clear();
    for (const mapping::OdometryData& reading : pbstream_.odometry_data) {
      const sensor::OdometryData& data = reading.odometry_data();
      const std::string name =
          CheckReading("odometry", reading, data.timestamp(), &last_times);
      Expect(IsPose(data.pose()), name, " has no valid pose");
    }
    last_times.clear();
    for (const auto& reading : pbstream_.fixed_frame_pose_data) {
      const sensor::FixedFramePoseData& data = reading.fixed_frame_pose_data();
      const std::string name =
          CheckReading("fixed frame", reading, data.timestamp(), &last_times);
      Expect(!data.has_pose() || IsPose(data.pose()), name,
             " has no valid pose");
    }
    for (const mapping::LandmarkData& reading : pbstream_.landmark_data) {
      const sensor::LandmarkData& data = reading.landmark_data();
      const std::string name =
          absl::StrFormat("the landmark reading of trajectory %d at %d",
                          reading.trajectory_id(), data.timestamp());
      ExpectTrajectory(name, reading.trajectory_id());
      ExpectTime(name, data.timestamp());
      for (const auto& seen : data.landmark_observations()) {
        Expect(IsPose(seen.landmark_to_tracking_transform()) &&
                   IsWeight(seen.translation_weight()) &&
                   IsWeight(seen.rotation_weight()),
               name, " has no valid pose or weights");
      }
    }
  }

  void ExpectTrajectory(const std::string& name, const int trajectory_id) {
    Expect(trajectories_.contains(trajectory_id), name,
           " is of a trajectory that does not exist");
  }

  // `what` ends with "at" and the time.
  void ExpectTime(absl::string_view what, const int64_t time) {
    Expect(AreHostTicks(time), what, ", which no clock can show");
  }

  template <typename Reading>
  std::string CheckReading(absl::string_view kind, const Reading& reading,
                           const int64_t time,
                           std::map<int, int64_t>* last_times) {
    const std::string name =
        absl::StrFormat("the %s reading of trajectory %d at %d", kind,
                        reading.trajectory_id(), time);
    ExpectTrajectory(name, reading.trajectory_id());
    ExpectTime(name, time);
    const auto last = last_times->emplace(reading.trajectory_id(), time);
    if (!last.second) {
      Expect(last.first->second < time, name, " is out of order");
      last.first->second = time;
    }
    return name;
  }

  const Pbstream& pbstream_;
  const bool with_grids_;
  const size_t max_problems_;
  std::vector<std::string> problems_;
  absl::flat_hash_set<int> trajectories_;
  absl::flat_hash_set<Id> submap_poses_;
  absl::flat_hash_set<Id> submaps_;
  absl::flat_hash_map<Id, int64_t> node_times_;
  absl::flat_hash_set<Id> nodes_;
};

}  // namespace

std::vector<std::string> FindPbstreamProblems(const Pbstream& pbstream,
                                              const size_t max_problems) {
  return Checker(pbstream, true, max_problems).Run();
}

std::vector<std::string> FindProblemsBesideGrids(const Pbstream& pbstream,
                                                 const size_t max_problems) {
  return Checker(pbstream, false, max_problems).Run();
}

}  // namespace io
}  // namespace cartographer_ext
