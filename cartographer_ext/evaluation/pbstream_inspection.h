// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
//
// What is in a stored state, whether it makes sense, and how two of them
// differ.
#ifndef CARTOGRAPHER_EXT_EVALUATION_PBSTREAM_INSPECTION_H_
#define CARTOGRAPHER_EXT_EVALUATION_PBSTREAM_INSPECTION_H_

#include <string>
#include <vector>

#include "cartographer_ext/evaluation/map_graph.h"
#include "cartographer_ext/io/pbstream_reader.h"
#include "nlohmann/json.hpp"

namespace cartographer_ext {
namespace evaluation {

// Numbers of everything, by trajectory: nodes, submaps, constraints, readings,
// time span, length of the path, options.
nlohmann::ordered_json Summarise(const io::Pbstream& pbstream);

// The same for people.
std::string SummaryToText(const nlohmann::ordered_json& summary);

// What io::FindPbstreamProblems finds, and beyond: constraints of inserted
// nodes that contradict the local poses by more than a millimetre or a
// milliradian, loops that name a node inserted in the same submap, submaps
// without nodes. (Nodes in no submap are fine: files saved without unfinished
// submaps have them at the end.)
std::vector<std::string> FindProblems(const io::Pbstream& pbstream,
                                      size_t max_problems = 100);

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

#endif  // CARTOGRAPHER_EXT_EVALUATION_PBSTREAM_INSPECTION_H_
