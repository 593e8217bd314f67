// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
#include "cartographer_ext/repair/local_rerun.h"

#include <algorithm>
#include <map>
#include <memory>
#include <utility>
#include <vector>

#include "absl/strings/str_cat.h"
#include "cartographer/mapping/2d/submap_2d.h"
#include "cartographer/mapping/internal/2d/local_trajectory_builder_2d.h"
#include "cartographer/mapping/trajectory_node.h"
#include "cartographer/sensor/range_data.h"
#include "cartographer/transform/transform.h"
#include "cartographer_ext/map/host_types.h"
#include "cartographer_ext/repair/stored_gyroscope.h"

namespace cartographer_ext {
namespace repair {
namespace {

using cartographer::mapping::LocalTrajectoryBuilder2D;
using cartographer::mapping::Submap2D;
using cartographer::mapping::TrajectoryNode;
using cartographer::mapping::proto::LocalTrajectoryBuilderOptions2D;
using cartographer::mapping::proto::PoseGraph;
using cartographer::sensor::ImuData;
using cartographer::sensor::OdometryData;
using cartographer::sensor::PointCloud;
using cartographer::transform::Rigid3d;
using evaluation::GraphId;

constexpr char kSensor[] = "scan";
// Stock's weights of insertions, where the map has none.
constexpr double kTranslationWeight = 5e2;
constexpr double kRotationWeight = 1.6e3;

GraphId IdOf(const cartographer::mapping::proto::Node& node) {
  return {node.node_id().trajectory_id(), node.node_id().node_index()};
}

// (gravity aligned <- planar tracking frame): the rotation about the vertical
// axis of the gravity alignment.
Rigid3d AlignedFromPlanar(const TrajectoryNode::Data& node) {
  return Rigid3d::Rotation(
      Eigen::AngleAxisd(cartographer::transform::GetYaw(node.gravity_alignment),
                        Eigen::Vector3d::UnitZ()));
}

// The cloud of a node in its planar tracking frame.
PointCloud PlanarCloud(const TrajectoryNode::Data& node) {
  return cartographer::sensor::TransformPointCloud(
      node.filtered_gravity_aligned_point_cloud,
      AlignedFromPlanar(node).inverse().cast<float>());
}

// Submaps of one trajectory in the order in which they were begun.
struct NewSubmaps {
  std::vector<std::shared_ptr<const Submap2D>> submaps;

  int IndexOf(const std::shared_ptr<const Submap2D>& submap) {
    for (size_t i = submaps.size(); i > 0; --i) {
      if (submaps[i - 1] == submap) return static_cast<int>(i) - 1;
    }
    submaps.push_back(submap);
    return static_cast<int>(submaps.size()) - 1;
  }
};

// What the map has received besides scans during one trajectory, by time.
struct Readings {
  std::vector<OdometryData> odometry;
  std::vector<ImuData> imu;  // see stored_gyroscope.h
};

LocalTrajectoryBuilderOptions2D WithImu(LocalTrajectoryBuilderOptions2D options,
                                        const bool has_imu) {
  options.set_use_imu_data(has_imu);
  return options;
}

// Local SLAM of one trajectory, node by node.
class NodeMapper {
 public:
  // The odometry is fed to the front end if the matching asks for it.
  NodeMapper(const LocalTrajectoryBuilderOptions2D& options,
             const NodeMatching matching, Readings readings)
      : matching_(matching),
        readings_(std::move(readings)),
        builder_(WithImu(options, !readings_.imu.empty()), {kSensor}),
        active_submaps_(options.submaps_options()) {}

  // The pose of the node (local <- planar tracking frame) and, in `inserted`,
  // the indices of its submaps.
  Pose2 Add(const TrajectoryNode::Data& node, const Pose2& chain,
            std::vector<int>* const inserted) {
    // Without a match, the chain alone.
    const Pose2 predicted =
        has_pose_ ? pose_ * Between(last_chain_, chain) : Pose2();
    if (matching_ == NodeMatching::kNone) {
      AddByChain(node, predicted);
    } else {
      AddReadings(node.time, chain);
      AddByFrontEnd(node, predicted);
    }
    has_pose_ = true;
    last_chain_ = chain;
    *inserted = last_inserted_;
    return pose_;
  }

  const std::vector<std::shared_ptr<const Submap2D>>& submaps() const {
    return submaps_.submaps;
  }

 private:
  // In the order in which the robot had them.
  void AddReadings(const cartographer::common::Time time, const Pose2& chain) {
    const std::vector<OdometryData>& odometry = readings_.odometry;
    while (matching_ == NodeMatching::kRecordedOdometry &&
           next_odometry_ < odometry.size() &&
           odometry[next_odometry_].time <= time) {
      AddImu(odometry[next_odometry_].time);
      builder_.AddOdometryData(odometry[next_odometry_++]);
    }
    AddImu(time);
    if (matching_ == NodeMatching::kFrontEnd) {
      builder_.AddOdometryData({time, evaluation::ToHostPose(chain)});
    }
  }

  // Up to `time`.
  void AddImu(const cartographer::common::Time time) {
    for (; next_imu_ < readings_.imu.size() &&
           readings_.imu[next_imu_].time <= time;
         ++next_imu_) {
      builder_.AddImuData(readings_.imu[next_imu_]);
    }
  }

  void AddByFrontEnd(const TrajectoryNode::Data& node, const Pose2& predicted) {
    cartographer::sensor::TimedPointCloudData scan;
    scan.time = node.time;
    scan.origin = Eigen::Vector3f::Zero();
    for (const auto& point : PlanarCloud(node)) {
      scan.ranges.push_back({point.position, 0.f});
    }
    pose_ = predicted;
    if (scan.ranges.empty()) return;
    const auto result = builder_.AddRangeData(kSensor, scan);
    if (result == nullptr || result->insertion_result == nullptr) return;
    pose_ = evaluation::ToPlanarPose(result->local_pose);
    Remember(result->insertion_result->insertion_submaps);
  }

  void AddByChain(const TrajectoryNode::Data& node, const Pose2& predicted) {
    const PointCloud cloud = PlanarCloud(node);
    pose_ = predicted;
    if (cloud.empty()) return;
    cartographer::sensor::RangeData range_data{
        Eigen::Vector3f::Zero(), cloud, {}};
    Remember(active_submaps_.InsertRangeData(
        cartographer::sensor::TransformRangeData(
            range_data, evaluation::ToHostPose(pose_).cast<float>())));
  }

  void Remember(const std::vector<std::shared_ptr<const Submap2D>>& inserted) {
    last_inserted_.clear();
    for (const auto& submap : inserted) {
      last_inserted_.push_back(submaps_.IndexOf(submap));
    }
  }

  const NodeMatching matching_;
  const Readings readings_;
  size_t next_odometry_ = 0;
  size_t next_imu_ = 0;
  LocalTrajectoryBuilder2D builder_;
  cartographer::mapping::ActiveSubmaps2D active_submaps_;
  NewSubmaps submaps_;
  bool has_pose_ = false;
  Pose2 pose_, last_chain_;
  std::vector<int> last_inserted_;
};

struct Weights {
  double translation = kTranslationWeight;
  double rotation = kRotationWeight;
};

Weights InsertionWeights(const PoseGraph& graph) {
  Weights weights;
  for (const auto& constraint : graph.constraint()) {
    if (constraint.tag() == PoseGraph::Constraint::INTRA_SUBMAP) {
      weights.translation = constraint.translation_weight();
      weights.rotation = constraint.rotation_weight();
      break;
    }
  }
  return weights;
}

// The readings of the map by trajectory, in their order of time.
std::map<int, std::vector<OdometryData>> OdometryReadings(
    const io::Pbstream& pbstream) {
  std::map<int, std::vector<OdometryData>> readings;
  for (const auto& record : pbstream.odometry_data) {
    readings[record.trajectory_id()].push_back(
        cartographer::sensor::FromProto(record.odometry_data()));
  }
  for (auto& entry : readings) {
    std::stable_sort(entry.second.begin(), entry.second.end(),
                     [](const OdometryData& a, const OdometryData& b) {
                       return a.time < b.time;
                     });
  }
  return readings;
}

void StoreSubmaps(const std::map<int, NodeMapper>& mappers,
                  io::Pbstream* const pbstream) {
  pbstream->submaps.clear();
  for (auto& trajectory : *pbstream->pose_graph.mutable_trajectory()) {
    trajectory.clear_submap();
    const auto mapper = mappers.find(trajectory.trajectory_id());
    if (mapper == mappers.end()) continue;
    int index = 0;
    for (const auto& submap : mapper->second.submaps()) {
      auto proto = submap->ToProto(true);
      proto.mutable_submap_id()->set_trajectory_id(trajectory.trajectory_id());
      proto.mutable_submap_id()->set_submap_index(index);
      pbstream->submaps.push_back(std::move(proto));
      auto* const placed = trajectory.add_submap();
      placed->set_submap_index(index++);
      *placed->mutable_pose() =
          cartographer::transform::ToProto(submap->local_pose());
    }
  }
}

}  // namespace

LocalTrajectoryBuilderOptions2D OptionsForClouds(
    const LocalTrajectoryBuilderOptions2D& base,
    const LocalTrajectoryBuilderOptions2D& stored) {
  LocalTrajectoryBuilderOptions2D options = base;
  options.set_use_imu_data(false);
  options.set_num_accumulated_range_data(1);
  options.set_min_range(0.f);
  options.set_max_range(1e4f);
  options.set_min_z(-1e4f);
  options.set_max_z(1e4f);
  options.set_voxel_filter_size(0.01f);
  auto* const filter = options.mutable_motion_filter_options();
  filter->set_max_time_seconds(0.);
  filter->set_max_distance_meters(0.);
  filter->set_max_angle_radians(0.);
  auto* const submaps = options.mutable_submaps_options();
  if (stored.submaps_options().num_range_data() > 0) {
    submaps->set_num_range_data(stored.submaps_options().num_range_data());
  }
  const double resolution =
      stored.submaps_options().grid_options_2d().resolution();
  if (resolution > 0.) {
    submaps->mutable_grid_options_2d()->set_resolution(resolution);
  }
  return options;
}

absl::StatusOr<io::Pbstream> RerunLocalSlam(
    const io::Pbstream& pbstream, const MotionChain& chain,
    const NodeMatching matching, const bool use_gyroscope,
    const LocalTrajectoryBuilderOptions2D& options) {
  io::Pbstream result = pbstream;
  const Weights weights = InsertionWeights(pbstream.pose_graph);
  result.pose_graph.clear_constraint();
  auto odometry = OdometryReadings(pbstream);
  auto imu = use_gyroscope ? StoredGyroscopeReadings(pbstream)
                           : std::map<int, std::vector<ImuData>>();
  std::map<int, NodeMapper> mappers;
  std::map<GraphId, Rigid3d> local_poses;
  for (auto& record : result.nodes) {
    const GraphId id = IdOf(record);
    if (mappers.count(id.trajectory_id) == 0) {
      mappers.emplace(
          std::piecewise_construct, std::forward_as_tuple(id.trajectory_id),
          std::forward_as_tuple(options, matching,
                                Readings{std::move(odometry[id.trajectory_id]),
                                         std::move(imu[id.trajectory_id])}));
    }
    NodeMapper& mapper = mappers.at(id.trajectory_id);
    const auto data = cartographer::mapping::FromProto(record.node_data());
    std::vector<int> inserted;
    const Pose2 pose = mapper.Add(data, chain.at(id), &inserted);
    if (inserted.empty()) {
      return absl::FailedPreconditionError(
          absl::StrCat("the first node ", evaluation::ToString(id),
                       " has no cloud, so local SLAM cannot be re-run"));
    }
    const Rigid3d local = evaluation::ToHostPose(pose) *
                          AlignedFromPlanar(data).inverse() *
                          Rigid3d::Rotation(data.gravity_alignment);
    local_poses[id] = local;
    *record.mutable_node_data()->mutable_local_pose() =
        cartographer::transform::ToProto(local);
    for (const int index : inserted) {
      auto* const constraint = result.pose_graph.add_constraint();
      constraint->mutable_submap_id()->set_trajectory_id(id.trajectory_id);
      constraint->mutable_submap_id()->set_submap_index(index);
      constraint->mutable_node_id()->set_trajectory_id(id.trajectory_id);
      constraint->mutable_node_id()->set_node_index(id.index);
      *constraint->mutable_relative_pose() = cartographer::transform::ToProto(
          mapper.submaps()[index]->local_pose().inverse() * local);
      constraint->set_translation_weight(weights.translation);
      constraint->set_rotation_weight(weights.rotation);
      constraint->set_tag(PoseGraph::Constraint::INTRA_SUBMAP);
    }
  }
  StoreSubmaps(mappers, &result);
  for (auto& trajectory : *result.pose_graph.mutable_trajectory()) {
    for (auto& node : *trajectory.mutable_node()) {
      const auto pose =
          local_poses.find({trajectory.trajectory_id(), node.node_index()});
      if (pose == local_poses.end()) continue;
      *node.mutable_pose() = cartographer::transform::ToProto(pose->second);
    }
  }
  return result;
}

}  // namespace repair
}  // namespace cartographer_ext
