// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
//
// Maps as small grey pictures inside a page. Sixteen shades are enough for a
// map and need a third of the bytes of a colour picture.
#ifndef CARTOGRAPHER_EXT_REPORT_PNG_IMAGE_H_
#define CARTOGRAPHER_EXT_REPORT_PNG_IMAGE_H_

#include <cstdint>
#include <string>
#include <vector>

#include "cartographer_ext/io/occupancy_map.h"

namespace cartographer_ext {
namespace report {

// A PNG with 4 bits per pixel. `shades`: 0 black to 15 white, row by row from
// the top, width * height of them.
std::string EncodePng(int width, int height,
                      const std::vector<uint8_t>& shades);

// "data:image/png;base64,...". Occupied black, free white, unknown light grey;
// the map's y axis points up.
std::string MapDataUri(const io::OccupancyMap& map);

}  // namespace report
}  // namespace cartographer_ext

#endif  // CARTOGRAPHER_EXT_REPORT_PNG_IMAGE_H_
