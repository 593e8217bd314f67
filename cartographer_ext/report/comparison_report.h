// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
//
// The comparison of two maps as one HTML file, and as a part of a larger page.
#ifndef CARTOGRAPHER_EXT_REPORT_COMPARISON_REPORT_H_
#define CARTOGRAPHER_EXT_REPORT_COMPARISON_REPORT_H_

#include <string>
#include <utility>
#include <vector>

#include "cartographer_ext/io/occupancy_map.h"
#include "cartographer_ext/map/comparison/map_comparison.h"
#include "cartographer_ext/map/verdict/self_consistency.h"
#include "cartographer_ext/report/markup.h"

namespace cartographer_ext {
namespace report {

// One of the two; only the map is required.
struct ComparedMap {
  std::string name;
  const io::OccupancyMap* map = nullptr;
  const evaluation::MapGraph* graph = nullptr;
  const evaluation::SelfConsistency* consistency = nullptr;
};

// Opens the page with its style and title, and closes it.
void OpenPage(const std::string& title, Markup* page);
void ClosePage(Markup* page);

// A box with the verdict and its reasons.
void AddVerdictBox(const std::string& name,
                   const evaluation::SelfConsistency& consistency,
                   Markup* page);

// The picture of walls and paths, and the tables. `names`: of the two maps.
void AddComparisonFigures(const ComparedMap& first, const ComparedMap& second,
                          const evaluation::MapComparison& comparison,
                          Markup* page);

std::string MakeComparisonReport(const ComparedMap& first,
                                 const ComparedMap& second,
                                 const evaluation::MapComparison& comparison,
                                 const std::string& command_line);

}  // namespace report
}  // namespace cartographer_ext

#endif  // CARTOGRAPHER_EXT_REPORT_COMPARISON_REPORT_H_
