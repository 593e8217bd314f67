// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
#ifndef CARTOGRAPHER_MAPPING_INTERNAL_2D_TSD_VALUE_CONVERTER_H_
#define CARTOGRAPHER_MAPPING_INTERNAL_2D_TSD_VALUE_CONVERTER_H_

#include <vector>

#include "cartographer/common/port.h"
#include "cartographer/mapping/probability_values.h"
#include "cartographer/mapping/value_conversion_tables.h"

namespace cartographer {
namespace mapping {

// 16-bit encoding of truncated signed distances (metres) in
// [-max_tsd, max_tsd] and of weights in [0, max_weight]. Unknown is 0 in both;
// it decodes to the lower bound.
class TSDValueConverter {
 public:
  TSDValueConverter(float max_tsd, float max_weight,
                    ValueConversionTables* conversion_tables);

  uint16 TSDToValue(const float tsd) const {
    return internal::EncodeBounded(tsd, -max_tsd_, max_tsd_);
  }
  uint16 WeightToValue(const float weight) const {
    return internal::EncodeBounded(weight, 0.f, max_weight_);
  }
  float ValueToTSD(const uint16 value) const { return (*value_to_tsd_)[value]; }
  float ValueToWeight(const uint16 value) const {
    return (*value_to_weight_)[value];
  }

  static uint16 getUnknownTSDValue() { return 0; }
  static uint16 getUnknownWeightValue() { return 0; }
  static uint16 getUpdateMarker() { return kUpdateMarker; }
  float getMaxTSD() const { return max_tsd_; }
  float getMinTSD() const { return -max_tsd_; }
  float getMaxWeight() const { return max_weight_; }
  float getMinWeight() const { return 0.f; }

 private:
  float max_tsd_;
  float max_weight_;
  const std::vector<float>* value_to_tsd_;
  const std::vector<float>* value_to_weight_;
};

}  // namespace mapping
}  // namespace cartographer

#endif  // CARTOGRAPHER_MAPPING_INTERNAL_2D_TSD_VALUE_CONVERTER_H_
