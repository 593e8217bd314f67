// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
//
// The pixels a line segment passes through, exactly, in integers.
//
// Ends are given as subpixels, `subpixel_scale` to a pixel and axis; the
// segment connects the centres of the two subpixels. A pixel belongs to it when
// the segment passes through its inside. Where it passes exactly through a
// corner, only the two pixels it really enters belong to it.
#ifndef CARTOGRAPHER_MAPPING_INTERNAL_2D_RAY_TO_PIXEL_MASK_H_
#define CARTOGRAPHER_MAPPING_INTERNAL_2D_RAY_TO_PIXEL_MASK_H_

#include <utility>
#include <vector>

#include "Eigen/Core"
#include "cartographer/common/port.h"
#include "glog/logging.h"

namespace cartographer {
namespace mapping {

// Calls visit(x, y) once for every pixel, with x ascending. Coordinates must
// not be negative.
template <typename Visitor>
void VisitRayPixels(Eigen::Array2i begin, Eigen::Array2i end,
                    const int subpixel_scale, const Visitor& visit) {
  if (begin.x() > end.x()) std::swap(begin, end);
  DCHECK_GE(begin.x(), 0);
  DCHECK_GE(begin.y(), 0);
  DCHECK_GE(end.y(), 0);
  const int last_x = end.x() / subpixel_scale;
  int x = begin.x() / subpixel_scale;
  int y = begin.y() / subpixel_scale;
  int last_y = end.y() / subpixel_scale;
  if (x == last_x) {
    if (y > last_y) std::swap(y, last_y);
    for (; y <= last_y; ++y) visit(x, y);
    return;
  }

  // Half a subpixel is the unit of length, so that centres are whole numbers.
  // `climb` / width is how far the segment is above the lower edge of pixel
  // row y (below the upper edge, when it descends) at the column's border.
  const int64 pixel = 2 * static_cast<int64>(subpixel_scale);
  const int64 width = end.x() - begin.x();
  const int64 height = end.y() - begin.y();
  const int step = height < 0 ? -1 : 1;
  const int64 rise = height < 0 ? -height : height;
  const int64 full_pixel = pixel * width;
  int64 begin_in_pixel = 2 * (begin.y() % subpixel_scale) + 1;
  if (height < 0) begin_in_pixel = pixel - begin_in_pixel;
  const int64 to_first_border = pixel - 2 * (begin.x() % subpixel_scale) - 1;
  const int64 rise_per_column = rise * pixel;

  int64 climb = begin_in_pixel * width + rise * to_first_border;
  for (; x != last_x; ++x) {
    visit(x, y);
    while (climb > full_pixel) {
      climb -= full_pixel;
      y += step;
      visit(x, y);
    }
    if (climb == full_pixel) {
      climb = 0;
      y += step;
    }
    climb += rise_per_column;
  }
  visit(x, y);
  while (y != last_y) {
    y += step;
    visit(x, y);
  }
}

// The same as a list.
std::vector<Eigen::Array2i> RayToPixelMask(const Eigen::Array2i& scaled_begin,
                                           const Eigen::Array2i& scaled_end,
                                           int subpixel_scale);

}  // namespace mapping
}  // namespace cartographer

#endif  // CARTOGRAPHER_MAPPING_INTERNAL_2D_RAY_TO_PIXEL_MASK_H_
