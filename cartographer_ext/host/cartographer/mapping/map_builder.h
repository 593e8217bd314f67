// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
//
// The 2D SLAM system of the bundled host. Results depend on the data and the
// options only, not on the number of threads or their timing.
#ifndef CARTOGRAPHER_MAPPING_MAP_BUILDER_H_
#define CARTOGRAPHER_MAPPING_MAP_BUILDER_H_

#include <map>
#include <memory>
#include <set>
#include <string>
#include <vector>

#include "cartographer/common/thread_pool.h"
#include "cartographer/mapping/map_builder_interface.h"
#include "cartographer/mapping/pose_graph.h"
#include "cartographer/mapping/proto/map_builder_options.pb.h"
#include "cartographer/sensor/collator_interface.h"

namespace cartographer {
namespace mapping {

class PoseGraph2D;

class MapBuilder : public MapBuilderInterface {
 public:
  // The options must choose 2D.
  explicit MapBuilder(const proto::MapBuilderOptions& options);
  ~MapBuilder() override;
  MapBuilder(const MapBuilder&) = delete;
  MapBuilder& operator=(const MapBuilder&) = delete;

  int AddTrajectoryBuilder(
      const std::set<SensorId>& expected_sensor_ids,
      const proto::TrajectoryBuilderOptions& trajectory_options,
      LocalSlamResultCallback local_slam_result_callback) override;
  int AddTrajectoryForDeserialization(
      const proto::TrajectoryBuilderOptionsWithSensorIds&
          options_with_sensor_ids_proto) override;
  void FinishTrajectory(int trajectory_id) override;
  std::string SubmapToProto(const SubmapId& submap_id,
                            proto::SubmapQuery::Response* response) override;
  void SerializeState(bool include_unfinished_submaps,
                      io::ProtoStreamWriterInterface* writer) override;
  bool SerializeStateToFile(bool include_unfinished_submaps,
                            const std::string& filename) override;
  std::map<int, int> LoadState(io::ProtoStreamReaderInterface* reader,
                               bool load_frozen_state) override;
  std::map<int, int> LoadStateFromFile(const std::string& filename,
                                       const bool load_frozen_state) override;

  mapping::PoseGraphInterface* pose_graph() override;
  int num_trajectory_builders() const override {
    return trajectory_builders_.size();
  }
  mapping::TrajectoryBuilderInterface* GetTrajectoryBuilder(
      int trajectory_id) const override {
    return trajectory_builders_.at(trajectory_id).get();
  }
  const std::vector<proto::TrajectoryBuilderOptionsWithSensorIds>&
  GetAllTrajectoryBuilderOptions() const override {
    return all_trajectory_builder_options_;
  }

 private:
  // The trimmer and the initial pose that the options of a trajectory ask for.
  void AddToPoseGraph(int trajectory_id,
                      const proto::TrajectoryBuilderOptions& options);

  const proto::MapBuilderOptions options_;
  common::ThreadPool thread_pool_;
  // Ends its work in its destructor, so it must go before the threads.
  std::unique_ptr<PoseGraph2D> pose_graph_;
  std::unique_ptr<sensor::CollatorInterface> sensor_collator_;
  // Both are indexed by trajectory id.
  std::vector<std::unique_ptr<mapping::TrajectoryBuilderInterface>>
      trajectory_builders_;
  std::vector<proto::TrajectoryBuilderOptionsWithSensorIds>
      all_trajectory_builder_options_;
};

std::unique_ptr<MapBuilderInterface> CreateMapBuilder(
    const proto::MapBuilderOptions& options);

}  // namespace mapping
}  // namespace cartographer

#endif  // CARTOGRAPHER_MAPPING_MAP_BUILDER_H_
