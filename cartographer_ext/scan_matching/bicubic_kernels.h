// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
//
// The inner loops of OccupiedSpaceCost, for several instruction sets. All sets
// give the same results, bit for bit: the same operations in the same order,
// without fused multiply-add.
#ifndef CARTOGRAPHER_EXT_SCAN_MATCHING_BICUBIC_KERNELS_H_
#define CARTOGRAPHER_EXT_SCAN_MATCHING_BICUBIC_KERNELS_H_

#include <vector>

namespace cartographer_ext {
namespace scan_matching {

// Positions of the points of a scan in a grid; arrays with one element per
// point.
struct PointPlaces {
  // In the frame of the grid, but without the translation of the pose, metres.
  double* turned_x;
  double* turned_y;
  // Cell index, whole at the centre of a cell.
  double* row;
  double* column;
};

// Position and resolution of a grid.
struct GridFrame {
  double max_x;
  double max_y;
  double cells_per_metre;
};

// Function pointers of one instruction set.
struct BicubicKernels {
  const char* name;

  // Rotates points by (cosine, sine), translates them by (x, y) and finds their
  // cells:
  //   row = (max_x - x) cells_per_metre - 1/2, column likewise with y.
  void (*find_places)(const GridFrame& frame, double cosine, double sine,
                      double x, double y, const double* point_x,
                      const double* point_y, int count,
                      const PointPlaces& places);

  // Interpolates between the 4 x 4 cells around each point, at the fractional
  // parts of its indices. The cell in row r and column c of those around point
  // i is cells[(4 c + r) stride + i]. Slopes are per cell.
  void (*interpolate)(const double* cells, int stride,
                      const double* row_fraction, const double* column_fraction,
                      int count, double* value, double* row_slope,
                      double* column_slope);
};

// The fastest set that this machine supports.
const BicubicKernels& BestBicubicKernels();

// All sets that this machine supports, the plain C++ one first. For tests.
std::vector<const BicubicKernels*> AllBicubicKernels();

}  // namespace scan_matching
}  // namespace cartographer_ext

#endif  // CARTOGRAPHER_EXT_SCAN_MATCHING_BICUBIC_KERNELS_H_
