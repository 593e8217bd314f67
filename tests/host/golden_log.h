// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
//
// The simulated log that golden_run.h runs through Cartographer's classes. Like
// that file it is compiled against the unmodified Cartographer, too, and uses
// nothing else.
#ifndef TESTS_HOST_GOLDEN_LOG_H_
#define TESTS_HOST_GOLDEN_LOG_H_

#include <cmath>
#include <fstream>
#include <sstream>
#include <string>
#include <vector>

#include "cartographer/common/time.h"
#include "cartographer/sensor/point_cloud.h"
#include "cartographer/transform/transform.h"
#include "glog/logging.h"

namespace golden_run {

namespace common = cartographer::common;
namespace sensor = cartographer::sensor;
namespace transform = cartographer::transform;

struct Message {
  common::Time time;
  transform::Rigid3d odometry;
  sensor::TimedPointCloud points;  // empty where only odometry comes
};

// Understands the two kinds of lines that the simulator writes.
inline std::vector<Message> ReadLog(const std::string& filename) {
  std::ifstream file(filename);
  CHECK(file.good()) << "cannot read " << filename;
  const auto planar = [](const double x, const double y, const double yaw) {
    return transform::Embed3D(transform::Rigid2d({x, y}, yaw));
  };
  std::vector<Message> log;
  for (std::string line; std::getline(file, line);) {
    std::istringstream words(line);
    std::string kind;
    words >> kind;
    Message message;
    double x = 0.;
    double y = 0.;
    double yaw = 0.;
    double skipped = 0.;
    double seconds = 0.;
    if (kind == "ODOM") {
      words >> x >> y >> yaw >> skipped >> skipped >> skipped >> seconds;
    } else if (kind == "ROBOTLASER1") {
      double start = 0.;
      double increment = 0.;
      double maximum = 0.;
      int num_readings = 0;
      words >> skipped >> start >> skipped >> increment >> maximum >> skipped >>
          skipped >> num_readings;
      for (int i = 0; i < num_readings; ++i) {
        double range = 0.;
        words >> range;
        if (range >= maximum) continue;
        const double angle = start + i * increment;
        message.points.push_back(
            {Eigen::Vector3f(static_cast<float>(range * std::cos(angle)),
                             static_cast<float>(range * std::sin(angle)), 0.f),
             0.f});
      }
      int num_remissions = 0;
      words >> num_remissions;
      for (int i = 0; i < num_remissions + 3; ++i) words >> skipped;
      words >> x >> y >> yaw;
      for (int i = 0; i < 5; ++i) words >> skipped;
      words >> seconds;
    } else {
      continue;
    }
    CHECK(!words.fail()) << filename << ": " << line.substr(0, 60);
    message.time = common::FromUniversal(10000000) +
                   common::FromSeconds(std::round(seconds * 1e4) / 1e4);
    message.odometry = planar(x, y, yaw);
    log.push_back(message);
  }
  return log;
}

}  // namespace golden_run

#endif  // TESTS_HOST_GOLDEN_LOG_H_
