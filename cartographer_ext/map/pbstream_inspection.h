// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
//
// Contents and consistency of a stored state.
#ifndef CARTOGRAPHER_EXT_MAP_PBSTREAM_INSPECTION_H_
#define CARTOGRAPHER_EXT_MAP_PBSTREAM_INSPECTION_H_

#include <string>
#include <vector>

#include "cartographer_ext/io/pbstream/pbstream_reader.h"
#include "nlohmann/json.hpp"

namespace cartographer_ext {
namespace evaluation {

// Counts by trajectory: nodes, submaps, constraints, readings, time span,
// length of the path, options.
nlohmann::ordered_json Summarise(const io::Pbstream& pbstream);

// The same as text.
std::string SummaryToText(const nlohmann::ordered_json& summary);

// The problems of io::FindPbstreamProblems, and in addition: constraints of
// inserted nodes that disagree with the local poses by more than a millimetre
// or a milliradian, loops with a node inserted into the same submap, submaps
// without nodes. (Nodes without a submap are valid: files saved without
// unfinished submaps have them at the end.)
std::vector<std::string> FindProblems(const io::Pbstream& pbstream,
                                      size_t max_problems = 100);

}  // namespace evaluation
}  // namespace cartographer_ext

#endif  // CARTOGRAPHER_EXT_MAP_PBSTREAM_INSPECTION_H_
