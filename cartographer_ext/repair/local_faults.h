// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
//
// Errors of the local SLAM of a map, found by comparison with the repaired map:
// from one node to the next the stored local poses and the repaired map differ
// by more than any optimisation would.
#ifndef CARTOGRAPHER_EXT_REPAIR_LOCAL_FAULTS_H_
#define CARTOGRAPHER_EXT_REPAIR_LOCAL_FAULTS_H_

#include <string>
#include <vector>

#include "cartographer_ext/common/pose2.h"
#include "cartographer_ext/map/map_graph.h"

namespace cartographer_ext {
namespace repair {

struct LocalFault {
  evaluation::GraphId node_id;  // the step before this node
  double seconds = 0.;          // after the start of the map
  double metres = 0.;           // too far, or too short
  double radians = 0.;          // excess rotation of local SLAM, signed
};

struct LocalFaultOptions {
  double window_seconds = 3.;  // steps that are merged into one event
  double metres = 0.5;
  double radians = DegToRad(10.);
  size_t max_listed = 10;
};

// The largest first; events do not overlap.
std::vector<LocalFault> FindLocalFaults(const evaluation::MapGraph& stored,
                                        const evaluation::MapGraph& repaired,
                                        const LocalFaultOptions& options);

// "local SLAM turned 92 degrees too far at 338.0 s (node (0, 512))".
std::string ToText(const LocalFault& fault);

}  // namespace repair
}  // namespace cartographer_ext

#endif  // CARTOGRAPHER_EXT_REPAIR_LOCAL_FAULTS_H_
