// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
#ifndef CARTOGRAPHER_MAPPING_VALUE_CONVERSION_TABLES_H_
#define CARTOGRAPHER_MAPPING_VALUE_CONVERSION_TABLES_H_

#include <map>
#include <tuple>
#include <vector>

namespace cartographer {
namespace mapping {

// Tables from 16-bit cell values to floats, made when first asked for and kept
// as long as this object lives. Not thread-safe.
class ValueConversionTables {
 public:
  // 65536 entries: [1, 32767] maps linearly onto [lower_bound, upper_bound], 0
  // gives `unknown_result`, bit 15 is ignored. The pointer stays valid.
  const std::vector<float>* GetConversionTable(float unknown_result,
                                               float lower_bound,
                                               float upper_bound);

 private:
  std::map<std::tuple<float, float, float>, std::vector<float>> tables_;
};

}  // namespace mapping
}  // namespace cartographer

#endif  // CARTOGRAPHER_MAPPING_VALUE_CONVERSION_TABLES_H_
