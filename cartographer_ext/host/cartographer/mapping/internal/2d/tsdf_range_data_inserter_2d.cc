// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
#include "cartographer/mapping/internal/2d/tsdf_range_data_inserter_2d.h"

#include "cartographer/mapping/internal/2d/normal_estimation_2d.h"

namespace cartographer {
namespace mapping {

proto::TSDFRangeDataInserterOptions2D CreateTSDFRangeDataInserterOptions2D(
    common::LuaParameterDictionary* const parameter_dictionary) {
  common::LuaParameterDictionary& lua = *parameter_dictionary;
  proto::TSDFRangeDataInserterOptions2D options;
  options.set_truncation_distance(lua.GetDouble("truncation_distance"));
  options.set_maximum_weight(lua.GetDouble("maximum_weight"));
  options.set_update_free_space(lua.GetBool("update_free_space"));
  const auto normals_dictionary =
      lua.GetDictionary("normal_estimation_options");
  *options.mutable_normal_estimation_options() =
      CreateNormalEstimationOptions2D(normals_dictionary.get());
  options.set_project_sdf_distance_to_scan_normal(
      lua.GetBool("project_sdf_distance_to_scan_normal"));
  options.set_update_weight_range_exponent(
      lua.GetInt("update_weight_range_exponent"));
  options.set_update_weight_angle_scan_normal_to_ray_kernel_bandwidth(
      lua.GetDouble("update_weight_angle_scan_normal_to_ray_kernel_bandwidth"));
  options.set_update_weight_distance_cell_to_hit_kernel_bandwidth(
      lua.GetDouble("update_weight_distance_cell_to_hit_kernel_bandwidth"));
  return options;
}

}  // namespace mapping
}  // namespace cartographer
