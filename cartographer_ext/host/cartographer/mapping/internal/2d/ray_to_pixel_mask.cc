// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
#include "cartographer/mapping/internal/2d/ray_to_pixel_mask.h"

namespace cartographer {
namespace mapping {

std::vector<Eigen::Array2i> RayToPixelMask(const Eigen::Array2i& scaled_begin,
                                           const Eigen::Array2i& scaled_end,
                                           const int subpixel_scale) {
  std::vector<Eigen::Array2i> pixels;
  VisitRayPixels(
      scaled_begin, scaled_end, subpixel_scale,
      [&pixels](const int x, const int y) { pixels.emplace_back(x, y); });
  return pixels;
}

}  // namespace mapping
}  // namespace cartographer
