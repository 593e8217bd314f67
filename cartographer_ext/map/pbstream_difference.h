// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
//
// Differences between two stored states.
#ifndef CARTOGRAPHER_EXT_MAP_PBSTREAM_DIFFERENCE_H_
#define CARTOGRAPHER_EXT_MAP_PBSTREAM_DIFFERENCE_H_

#include <cstdint>
#include <string>
#include <vector>

#include "cartographer_ext/io/pbstream/pbstream_reader.h"
#include "cartographer_ext/map/map_graph.h"
#include "nlohmann/json.hpp"

namespace cartographer_ext {
namespace evaluation {

// Agreement of the local SLAM of two maps of the same recording. Nodes are
// matched by their stamps, which may differ by a tenth of a millisecond
// (readers round differently); the motion from one node to the next is
// compared.
struct LocalAgreement {
  int64_t nodes_first = 0;
  int64_t nodes_second = 0;
  int64_t common_stamps = 0;
  int64_t pairs = 0;  // of successive nodes of the first, known to the second
  double fraction_alike = 0.;  // of the pairs, to 2 cm and 0.2 degrees
  double fraction_alike_translation = 0.;  // of the pairs, to 2 cm
  double max_translation = 0.;             // metres
  double max_rotation = 0.;                // radians
};

LocalAgreement CompareLocalSlam(const MapGraph& first, const MapGraph& second);

struct PbstreamDifference {
  bool identical = true;
  // One sentence per difference.
  std::vector<std::string> differences;
  nlohmann::ordered_json numbers;
};

// Compares `first` and `second` by ids: elements of only one of them,
// differences of poses and constraints, and whether grids, clouds and options
// are equal.
PbstreamDifference Compare(const io::Pbstream& first,
                           const io::Pbstream& second);

}  // namespace evaluation
}  // namespace cartographer_ext

#endif  // CARTOGRAPHER_EXT_MAP_PBSTREAM_DIFFERENCE_H_
