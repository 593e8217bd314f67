// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0

#ifndef CARTOGRAPHER_EXT_IO_ROS_SCAN_TIMING_H_
#define CARTOGRAPHER_EXT_IO_ROS_SCAN_TIMING_H_

#include <cstddef>
#include <map>
#include <string>
#include <utility>
#include <vector>

#include "cartographer_ext/io/sensor_source.h"

namespace cartographer_ext {
namespace io {

// Checks the plausibility of the beam times of a scan against the scan rate. A
// driver may omit them, or use a wrong unit.
class ScanTiming {
 public:
  // A scan on `topic` from the sensor `frame`: time of its first beam, seconds
  // to the last one, and the angle between them in radians.
  void Add(const std::string& topic, const std::string& frame, TimeNs begin,
           double sweep, double field_of_view);

  // Decides for every sensor; before, all are plausible.
  void Judge();
  // Whether sweeps of this sensor take longer than the time between its scans.
  bool IsImpossible(const std::string& topic, const std::string& frame) const;
  bool AnyImpossible() const;
  // Warnings about sensors with implausible beam times, and about sensors
  // without beam times that rotate so slowly that the motion of the robot
  // distorts their scans.
  std::vector<std::string> Warnings() const;

 private:
  struct Sensor {
    TimeNs last = 0;
    bool any = false;
    std::vector<double> periods, sweeps;  // seconds, of the first scans
    double field_of_view = 0.;            // largest
    double period = 0., sweep = 0.;       // medians; 0: not judged
    bool impossible = false;
  };
  std::map<std::pair<std::string, std::string>, Sensor> sensors_;
};

}  // namespace io
}  // namespace cartographer_ext

#endif  // CARTOGRAPHER_EXT_IO_ROS_SCAN_TIMING_H_
