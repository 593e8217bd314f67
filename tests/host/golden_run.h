// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
//
// A simulated log (tests/data/cartographer/loop.clf) run through the classes of
// Cartographer's API, step by step and as a whole. Every result becomes a named
// row of numbers. tests/data/cartographer/golden.txt has the rows that the real
// Cartographer gives.
#ifndef TESTS_HOST_GOLDEN_RUN_H_
#define TESTS_HOST_GOLDEN_RUN_H_

#include <cmath>
#include <fstream>
#include <memory>
#include <sstream>
#include <string>
#include <utility>
#include <vector>

#include "cartographer/common/thread_pool.h"
#include "cartographer/common/time.h"
#include "cartographer/mapping/2d/probability_grid.h"
#include "cartographer/mapping/2d/submap_2d.h"
#include "cartographer/mapping/internal/2d/local_trajectory_builder_2d.h"
#include "cartographer/mapping/internal/2d/pose_graph_2d.h"
#include "cartographer/mapping/internal/2d/scan_matching/ceres_scan_matcher_2d.h"
#include "cartographer/mapping/internal/2d/scan_matching/fast_correlative_scan_matcher_2d.h"
#include "cartographer/mapping/internal/2d/scan_matching/real_time_correlative_scan_matcher_2d.h"
#include "cartographer/mapping/internal/motion_filter.h"
#include "cartographer/mapping/internal/optimization/optimization_problem_2d.h"
#include "cartographer/mapping/pose_extrapolator.h"
#include "cartographer/mapping/proto/local_trajectory_builder_options_2d.pb.h"
#include "cartographer/mapping/proto/pose_graph_options.pb.h"
#include "cartographer/sensor/internal/voxel_filter.h"
#include "cartographer/transform/transform.h"
#include "glog/logging.h"
#include "google/protobuf/text_format.h"
#include "tests/host/golden_log.h"

namespace golden_run {

namespace mapping = cartographer::mapping;

struct Row {
  std::string name;
  std::vector<double> values;
};

inline void Append(const transform::Rigid2d& pose,
                   std::vector<double>* const values) {
  values->push_back(pose.translation().x());
  values->push_back(pose.translation().y());
  values->push_back(pose.normalized_angle());
}

inline std::vector<double> Values(const transform::Rigid2d& pose) {
  std::vector<double> values;
  Append(pose, &values);
  return values;
}

template <typename Options>
Options Parse(const std::string& text) {
  Options options;
  CHECK(google::protobuf::TextFormat::ParseFromString(text, &options));
  return options;
}

// The stock values, but with submaps of 20 scans, the correlative matcher in
// front of Ceres, and no background optimisation: what the real pose graph
// finds would then depend on timing.
inline mapping::proto::LocalTrajectoryBuilderOptions2D LocalOptions() {
  return Parse<mapping::proto::LocalTrajectoryBuilderOptions2D>(R"(
      use_imu_data: false min_range: 0.1 max_range: 7.5 min_z: -0.8 max_z: 2
      missing_data_ray_length: 5 num_accumulated_range_data: 1
      voxel_filter_size: 0.025 imu_gravity_time_constant: 10
      use_online_correlative_scan_matching: true
      adaptive_voxel_filter_options {
        max_length: 0.5 min_num_points: 100 max_range: 50 }
      loop_closure_adaptive_voxel_filter_options {
        max_length: 0.9 min_num_points: 100 max_range: 50 }
      real_time_correlative_scan_matcher_options {
        linear_search_window: 0.1 angular_search_window: 0.2
        translation_delta_cost_weight: 0.1 rotation_delta_cost_weight: 0.1 }
      ceres_scan_matcher_options {
        occupied_space_weight: 1 translation_weight: 10 rotation_weight: 40
        ceres_solver_options {
          use_nonmonotonic_steps: false max_num_iterations: 20 num_threads: 1 } }
      pose_extrapolator_options { constant_velocity {
        imu_gravity_time_constant: 10 pose_queue_duration: 0.001 } }
      motion_filter_options {
        max_time_seconds: 5 max_distance_meters: 0.2 max_angle_radians: 0.0175 }
      submaps_options {
        num_range_data: 10
        grid_options_2d { grid_type: PROBABILITY_GRID resolution: 0.05 }
        range_data_inserter_options {
          range_data_inserter_type: PROBABILITY_GRID_INSERTER_2D
          probability_grid_range_data_inserter_options_2d {
            hit_probability: 0.55 miss_probability: 0.49
            insert_free_space: true } } })");
}

inline mapping::proto::PoseGraphOptions GraphOptions() {
  return Parse<mapping::proto::PoseGraphOptions>(R"(
      optimize_every_n_nodes: 0 max_num_final_iterations: 200
      matcher_translation_weight: 500 matcher_rotation_weight: 1600
      global_sampling_ratio: 0.003
      global_constraint_search_after_n_seconds: 10
      constraint_builder_options {
        sampling_ratio: 0.3 max_constraint_distance: 4 min_score: 0.6
        global_localization_min_score: 0.65
        loop_closure_translation_weight: 11000
        loop_closure_rotation_weight: 100000
        fast_correlative_scan_matcher_options {
          linear_search_window: 1 angular_search_window: 0.3
          branch_and_bound_depth: 5 }
        ceres_scan_matcher_options {
          occupied_space_weight: 20 translation_weight: 10 rotation_weight: 1
          ceres_solver_options {
            use_nonmonotonic_steps: true max_num_iterations: 10
            num_threads: 1 } } }
      optimization_problem_options {
        huber_scale: 10 local_slam_pose_translation_weight: 100000
        local_slam_pose_rotation_weight: 100000
        odometry_translation_weight: 100000 odometry_rotation_weight: 100000
        fixed_frame_pose_translation_weight: 10
        fixed_frame_pose_rotation_weight: 100
        ceres_solver_options {
          use_nonmonotonic_steps: false max_num_iterations: 50
          num_threads: 1 } })");
}

class Run {
 public:
  explicit Run(const std::string& log_filename)
      : log_(ReadLog(log_filename)), local_options_(LocalOptions()) {}

  std::vector<Row> All() {
    FilterClouds();
    FilterMotion();
    Extrapolate();
    BuildAndMatch();
    Map();
    return std::move(rows_);
  }

 private:
  void Add(const std::string& name, std::vector<double> values) {
    rows_.push_back(Row{name, std::move(values)});
  }

  static bool IsScan(const Message& message) { return !message.points.empty(); }

  static sensor::PointCloud Cloud(const Message& message) {
    sensor::PointCloud cloud;
    for (const auto& point : message.points) {
      cloud.push_back(sensor::RangefinderPoint{point.position});
    }
    return cloud;
  }

  static sensor::RangeData RangeDataAt(const Message& message,
                                       const transform::Rigid3d& pose) {
    const transform::Rigid3f pose_f = pose.cast<float>();
    return sensor::RangeData{
        pose_f.translation(),
        sensor::TransformPointCloud(Cloud(message), pose_f),
        {}};
  }

  void AddCloud(const std::string& name, const sensor::PointCloud& cloud) {
    std::vector<double> values;
    for (const sensor::RangefinderPoint& point : cloud) {
      values.push_back(point.position.x());
      values.push_back(point.position.y());
    }
    Add(name, values);
  }

  // Which point of a voxel is kept, and which edge the adaptive filter takes.
  void FilterClouds() {
    int count = 0;
    for (const Message& message : log_) {
      if (!IsScan(message) || ++count % 50 != 1) continue;
      const sensor::PointCloud cloud = Cloud(message);
      AddCloud("voxel_filter", sensor::VoxelFilter(cloud, 0.15f));
      AddCloud("adaptive_voxel_filter",
               sensor::AdaptiveVoxelFilter(
                   cloud, local_options_.adaptive_voxel_filter_options()));
    }
  }

  void FilterMotion() {
    mapping::MotionFilter filter(local_options_.motion_filter_options());
    std::vector<double> similar;
    for (const Message& message : log_) {
      similar.push_back(filter.IsSimilar(message.time, message.odometry));
    }
    Add("motion_filter", similar);
  }

  // Without and with odometry and IMU. Where a scan comes, the odometry of the
  // log plays the matched pose, a little off; predictions are taken in between.
  void Extrapolate() {
    for (const int sensors : {0, 1, 2, 3}) {
      mapping::PoseExtrapolator extrapolator(common::FromSeconds(0.001), 10.);
      bool has_pose = false;
      common::Time last_time = log_.front().time;
      transform::Rigid3d last_pose = log_.front().odometry;
      for (const Message& message : log_) {
        const double seconds = common::ToSeconds(message.time - last_time);
        if ((sensors & 2) != 0 && seconds > 0.) {
          const Eigen::Vector3d turn =
              transform::RotationQuaternionToAngleAxisVector(
                  last_pose.rotation().inverse() * message.odometry.rotation());
          extrapolator.AddImuData(sensor::ImuData{
              message.time, Eigen::Vector3d(0.2, -0.1 * turn.z(), 9.7),
              turn / seconds + Eigen::Vector3d(0.001, 0.002, 0.003)});
        }
        last_time = message.time;
        last_pose = message.odometry;
        if (!IsScan(message)) {
          if ((sensors & 1) != 0 && has_pose) {
            extrapolator.AddOdometryData(
                sensor::OdometryData{message.time, message.odometry});
          }
          if (has_pose) {
            const transform::Rigid3d pose = extrapolator.ExtrapolatePose(
                message.time + common::FromSeconds(0.01));
            Add("pose_extrapolator", Values(transform::Project2D(pose)));
          }
          continue;
        }
        const auto offset =
            transform::Embed3D(transform::Rigid2d({0.01, -0.02}, 0.005));
        extrapolator.AddPose(message.time, message.odometry * offset);
        has_pose = true;
        const Eigen::Quaterniond gravity =
            extrapolator.EstimateGravityOrientation(message.time);
        Add("gravity", {gravity.w(), gravity.x(), gravity.y(), gravity.z()});
      }
    }
  }

  // A submap from the odometry of the first scans, and matches against it.
  void BuildAndMatch() {
    mapping::ActiveSubmaps2D submaps(local_options_.submaps_options());
    std::vector<Message> later;
    int count = 0;
    for (const Message& message : log_) {
      if (!IsScan(message)) continue;
      if (++count <= 20) {
        submaps.InsertRangeData(RangeDataAt(message, message.odometry));
      } else if (count <= 40 && count % 2 == 0) {
        later.push_back(message);
      }
    }
    const mapping::Grid2D& grid = *submaps.submaps().front()->grid();
    AddGrid(grid);

    namespace scan_matching = mapping::scan_matching;
    const scan_matching::RealTimeCorrelativeScanMatcher2D real_time(
        local_options_.real_time_correlative_scan_matcher_options());
    const auto builder_options = GraphOptions().constraint_builder_options();
    const scan_matching::FastCorrelativeScanMatcher2D fast(
        grid, builder_options.fast_correlative_scan_matcher_options());
    const scan_matching::CeresScanMatcher2D local_ceres(
        local_options_.ceres_scan_matcher_options());
    const scan_matching::CeresScanMatcher2D loop_ceres(
        builder_options.ceres_scan_matcher_options());
    for (const Message& message : later) {
      const sensor::PointCloud cloud = sensor::AdaptiveVoxelFilter(
          Cloud(message), local_options_.adaptive_voxel_filter_options());
      const transform::Rigid2d initial =
          transform::Project2D(message.odometry) *
          transform::Rigid2d({0.06, -0.04}, 0.03);
      transform::Rigid2d pose = initial;
      AddMatch("real_time_match", real_time.Match(initial, cloud, grid, &pose),
               pose);
      float score = 0.f;
      pose = initial;
      const bool found = fast.Match(initial, cloud, 0.4f, &score, &pose);
      AddMatch("fast_match", found ? score : 0., found ? pose : initial);
      score = 0.f;
      pose = initial;
      const bool found_anywhere =
          fast.MatchFullSubmap(cloud, 0.4f, &score, &pose);
      AddMatch("fast_match_full", found_anywhere ? score : 0.,
               found_anywhere ? pose : initial);
      for (const auto* const ceres : {&local_ceres, &loop_ceres}) {
        ceres::Solver::Summary summary;
        ceres->Match(initial.translation(), initial, cloud, grid, &pose,
                     &summary);
        AddMatch("ceres_match", summary.final_cost, pose);
      }
    }
  }

  void AddMatch(const std::string& name, const double score,
                const transform::Rigid2d& pose) {
    std::vector<double> values = {score};
    Append(pose, &values);
    Add(name, values);
  }

  // Limits, then the cells as pairs of value and count.
  void AddGrid(const mapping::Grid2D& grid) {
    const mapping::proto::Grid2D proto = grid.ToProto();
    Add("grid_limits",
        {proto.limits().resolution(), proto.limits().max().x(),
         proto.limits().max().y(),
         static_cast<double>(proto.limits().cell_limits().num_x_cells()),
         static_cast<double>(proto.limits().cell_limits().num_y_cells())});
    std::vector<double> runs;
    for (int i = 0; i < proto.cells_size(); ++i) {
      if (i == 0 || proto.cells(i) != proto.cells(i - 1)) {
        runs.push_back(proto.cells(i));
        runs.push_back(0);
      }
      ++runs.back();
    }
    Add("grid_cells", runs);
  }

  // Local SLAM with a pose graph behind it, which searches for loops at the
  // end.
  void Map() {
    common::ThreadPool pool(1);
    mapping::PoseGraph2D graph(
        GraphOptions(),
        std::make_unique<mapping::optimization::OptimizationProblem2D>(
            GraphOptions().optimization_problem_options()),
        &pool);
    mapping::LocalTrajectoryBuilder2D builder(local_options_, {"laser"});
    for (const Message& message : log_) {
      if (!IsScan(message)) {
        const sensor::OdometryData odometry{message.time, message.odometry};
        builder.AddOdometryData(odometry);
        graph.AddOdometryData(0, odometry);
        continue;
      }
      const auto result = builder.AddRangeData(
          "laser",
          sensor::TimedPointCloudData{
              message.time, Eigen::Vector3f::Zero(), message.points, {}});
      CHECK(result != nullptr);
      const bool inserted = result->insertion_result != nullptr;
      std::vector<double> values =
          Values(transform::Project2D(result->local_pose));
      values.insert(
          values.end(),
          {static_cast<double>(inserted),
           static_cast<double>(result->range_data_in_local.returns.size()),
           static_cast<double>(result->range_data_in_local.misses.size())});
      Add("local_slam", values);
      if (inserted) {
        graph.AddNode(result->insertion_result->constant_data, 0,
                      result->insertion_result->insertion_submaps);
      }
    }
    graph.FinishTrajectory(0);
    graph.RunFinalOptimization();
    for (const auto& constraint : graph.constraints()) {
      std::vector<double> values =
          Values(transform::Project2D(constraint.pose.zbar_ij));
      values.insert(values.end(),
                    {static_cast<double>(constraint.submap_id.submap_index),
                     static_cast<double>(constraint.node_id.node_index),
                     constraint.pose.translation_weight,
                     constraint.pose.rotation_weight});
      const bool is_loop =
          constraint.tag ==
          mapping::PoseGraphInterface::Constraint::INTER_SUBMAP;
      Add(is_loop ? "loop_constraint" : "intra_constraint", values);
    }
    for (const auto& submap : graph.GetAllSubmapPoses()) {
      Add("submap_pose", Values(transform::Project2D(submap.data.pose)));
    }
    for (const auto& node : graph.GetTrajectoryNodePoses()) {
      Add("node_pose", Values(transform::Project2D(node.data.global_pose)));
    }
  }

  const std::vector<Message> log_;
  const mapping::proto::LocalTrajectoryBuilderOptions2D local_options_;
  std::vector<Row> rows_;
};

inline void Write(const std::vector<Row>& rows, std::ostream* const out) {
  out->precision(9);
  for (const Row& row : rows) {
    *out << row.name;
    for (const double value : row.values) *out << ' ' << value;
    *out << '\n';
  }
}

inline std::vector<Row> Read(const std::string& filename) {
  std::ifstream file(filename);
  CHECK(file.good()) << "cannot read " << filename;
  std::vector<Row> rows;
  for (std::string line; std::getline(file, line);) {
    std::istringstream words(line);
    Row row;
    words >> row.name;
    for (double value; words >> value;) row.values.push_back(value);
    rows.push_back(row);
  }
  return rows;
}

}  // namespace golden_run

#endif  // TESTS_HOST_GOLDEN_RUN_H_
