// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
//
// The printed tables of the ACS and R-iSAM papers, for comparison with our figures.
#ifndef CARTOGRAPHER_EXT_EXPERIMENTS_PAPER_TABLES_H_
#define CARTOGRAPHER_EXT_EXPERIMENTS_PAPER_TABLES_H_

#include <string>
#include <vector>

namespace cartographer_ext {
namespace experiments {

struct PrintedRow {
  std::string dataset;  // our name of the set
  std::string type;     // R L RG LG
  int count = 0;
  double baseline = 0.;  // seconds of SC; negative where the paper has none
  double method = 0.;    // ACS: seconds. R-iSAM: milliseconds a step
};

// ACS paper, table 2: SC and ACS, seconds.
std::vector<PrintedRow> AcsTable2();
// R-iSAM paper, table 2: SC in seconds, R-iSAM in milliseconds a step.
std::vector<PrintedRow> RIsamTable2();

}  // namespace experiments
}  // namespace cartographer_ext

#endif  // CARTOGRAPHER_EXT_EXPERIMENTS_PAPER_TABLES_H_
