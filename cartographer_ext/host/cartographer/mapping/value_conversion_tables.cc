// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
#include "cartographer/mapping/value_conversion_tables.h"

#include "cartographer/mapping/probability_values.h"

namespace cartographer {
namespace mapping {

const std::vector<float>* ValueConversionTables::GetConversionTable(
    const float unknown_result, const float lower_bound,
    const float upper_bound) {
  // Probability grids share the one table that is never freed, so that their
  // costs stay readable when the trajectory that made them is gone.
  if (unknown_result == kMaxCorrespondenceCost &&
      lower_bound == kMinCorrespondenceCost &&
      upper_bound == kMaxCorrespondenceCost) {
    return kValueToCorrespondenceCost;
  }
  std::vector<float>& table =
      tables_[std::make_tuple(unknown_result, lower_bound, upper_bound)];
  if (table.empty()) {
    table = internal::DecodingTable(unknown_result, lower_bound, upper_bound);
  }
  return &table;
}

}  // namespace mapping
}  // namespace cartographer
