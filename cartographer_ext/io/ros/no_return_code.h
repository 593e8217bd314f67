// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
//
// Lasers whose driver reports "no return" as a range that looks like a reading:
// 5.599 m although range_max is 5.6 m, 65.533 m in a driver that counts
// millimetres in 16 bits. Mapped, it is a wall around the robot wherever it
// goes.
//
// Walls do not look like this: the same value, bit for bit, is the largest of a
// scan and that of at least a twentieth of its beams, with hardly a reading in
// the 5 cm below it, in many scans, and no other scan reads farther. Readings of
// a flat wall that are rounded to a centimetre are equal only within
// sqrt(2 cm / range) radians or so of its perpendicular (3 of 360 beams at 5 m),
// with others just above and below, and the ends of the wall are farther away.
#ifndef CARTOGRAPHER_EXT_IO_ROS_NO_RETURN_CODE_H_
#define CARTOGRAPHER_EXT_IO_ROS_NO_RETURN_CODE_H_

#include <cstdint>
#include <map>
#include <string>
#include <utility>
#include <vector>

#include "cartographer_ext/io/sensor_source.h"

namespace cartographer_ext {
namespace io {

// Collects the scans of each sensor, then judges.
class NoReturnCodes {
 public:
  void Add(const std::string& topic, const std::string& frame,
           const LaserScan& scan);
  void Judge();

  // Just below the code, or infinity where the sensor has none.
  double RangeMax(const std::string& topic, const std::string& frame) const;

  // One for each sensor with a code; they do not name the file.
  std::vector<std::string> Warnings() const;

 private:
  struct Candidate {
    int64_t num_scans = 0;      // that look as above
    int64_t num_beams = 0;      // of those scans, with the value
    int64_t num_all_beams = 0;  // of those scans
  };
  struct Sensor {
    std::map<float, Candidate> candidates;  // by value, metres
    std::vector<float> largest;             // of every scan, metres
    float code = 0.f;                       // 0: none
  };
  std::map<std::pair<std::string, std::string>, Sensor> sensors_;
};

}  // namespace io
}  // namespace cartographer_ext

#endif  // CARTOGRAPHER_EXT_IO_ROS_NO_RETURN_CODE_H_
