// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
//
// What a stored state contains and whether it is consistent.
#ifndef CARTOGRAPHER_EXT_MAP_PBSTREAM_INSPECTION_H_
#define CARTOGRAPHER_EXT_MAP_PBSTREAM_INSPECTION_H_

#include <string>
#include <vector>

#include "cartographer_ext/io/pbstream/pbstream_reader.h"
#include "nlohmann/json.hpp"

namespace cartographer_ext {
namespace evaluation {

// Numbers of everything, by trajectory: nodes, submaps, constraints, readings,
// time span, length of the path, options.
nlohmann::ordered_json Summarise(const io::Pbstream& pbstream);

// The same for people.
std::string SummaryToText(const nlohmann::ordered_json& summary);

// What io::FindPbstreamProblems finds, and beyond: constraints of inserted
// nodes that disagree with the local poses by more than a millimetre or a
// milliradian, loops that name a node inserted in the same submap, submaps
// without nodes. (Nodes in no submap are fine: files saved without unfinished
// submaps have them at the end.)
std::vector<std::string> FindProblems(const io::Pbstream& pbstream,
                                      size_t max_problems = 100);

}  // namespace evaluation
}  // namespace cartographer_ext

#endif  // CARTOGRAPHER_EXT_MAP_PBSTREAM_INSPECTION_H_
