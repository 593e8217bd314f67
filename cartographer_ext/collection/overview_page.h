// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
//
// Many maps on one page: small pictures, verdicts, reasons. One HTML file that
// needs nothing else; the script sorts and filters, and without it all is there,
// worst first.
#ifndef CARTOGRAPHER_EXT_COLLECTION_OVERVIEW_PAGE_H_
#define CARTOGRAPHER_EXT_COLLECTION_OVERVIEW_PAGE_H_

#include <map>
#include <string>
#include <vector>

#include "cartographer_ext/collection/baseline.h"
#include "cartographer_ext/collection/map_record.h"

namespace cartographer_ext {
namespace collection {

// "3 broken, 12 sound": the verdicts that occur, worst first.
std::string CountsInWords(const std::vector<MapRecord>& records);

// How many maps have each verdict.
std::map<std::string, int> CountVerdicts(const std::vector<MapRecord>& records);

// `page_filename`: where the page will be, for links to the pages of the maps.
// `changes`: empty without a baseline.
std::string MakeOverview(const std::vector<MapRecord>& records,
                         const std::vector<MapChange>& changes,
                         const std::string& page_filename);

}  // namespace collection
}  // namespace cartographer_ext

#endif  // CARTOGRAPHER_EXT_COLLECTION_OVERVIEW_PAGE_H_
