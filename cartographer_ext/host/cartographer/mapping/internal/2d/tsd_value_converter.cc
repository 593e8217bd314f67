// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
#include "cartographer/mapping/internal/2d/tsd_value_converter.h"

namespace cartographer {
namespace mapping {

TSDValueConverter::TSDValueConverter(
    const float max_tsd, const float max_weight,
    ValueConversionTables* const conversion_tables)
    : max_tsd_(max_tsd),
      max_weight_(max_weight),
      value_to_tsd_(
          conversion_tables->GetConversionTable(-max_tsd, -max_tsd, max_tsd)),
      value_to_weight_(
          conversion_tables->GetConversionTable(0.f, 0.f, max_weight)) {}

}  // namespace mapping
}  // namespace cartographer
