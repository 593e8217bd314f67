// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
//
// The outcome of local SLAM that ran elsewhere, passed along like sensor data.
#ifndef CARTOGRAPHER_MAPPING_INTERNAL_LOCAL_SLAM_RESULT_DATA_H_
#define CARTOGRAPHER_MAPPING_INTERNAL_LOCAL_SLAM_RESULT_DATA_H_

#include <string>

#include "cartographer/common/time.h"
#include "cartographer/mapping/pose_graph.h"
#include "cartographer/sensor/data.h"

namespace cartographer {
namespace mapping {

class LocalSlamResultData : public sensor::Data {
 public:
  LocalSlamResultData(const std::string& sensor_id, common::Time time)
      : Data(sensor_id), time_(time) {}

  common::Time GetTime() const override { return time_; }
  virtual void AddToPoseGraph(int trajectory_id,
                              PoseGraph* pose_graph) const = 0;

 private:
  common::Time time_;
};

}  // namespace mapping
}  // namespace cartographer

#endif  // CARTOGRAPHER_MAPPING_INTERNAL_LOCAL_SLAM_RESULT_DATA_H_
