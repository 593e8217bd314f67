// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
//
// Many maps on one page: thumbnails, verdicts, reasons. One self-contained HTML
// file; the script sorts and filters, without it all maps are shown, worst
// first.
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

// Number of maps by verdict.
std::map<std::string, int> CountVerdicts(const std::vector<MapRecord>& records);

// `page_filename`: where the page will be, for links to the pages of the maps.
// `changes`: empty without a baseline.
std::string MakeOverview(const std::vector<MapRecord>& records,
                         const std::vector<MapChange>& changes,
                         const std::string& page_filename);

}  // namespace collection
}  // namespace cartographer_ext

#endif  // CARTOGRAPHER_EXT_COLLECTION_OVERVIEW_PAGE_H_
