// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
//
// How two stored states differ.
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

// How alike the local SLAM of two maps of the same recording is. Nodes are
// matched by their stamps, which may differ by a tenth of a millisecond
// (readers round differently); compared is the motion from one node to the
// next.
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
  // One sentence each.
  std::vector<std::string> differences;
  nlohmann::ordered_json numbers;
};

// `first` and `second` are compared by ids: what only one of them has, by how
// much poses and constraints differ, whether grids, clouds and options are the
// same.
PbstreamDifference Compare(const io::Pbstream& first,
                           const io::Pbstream& second);

}  // namespace evaluation
}  // namespace cartographer_ext

#endif  // CARTOGRAPHER_EXT_MAP_PBSTREAM_DIFFERENCE_H_
