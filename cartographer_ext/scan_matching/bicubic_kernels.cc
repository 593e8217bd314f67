// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
#include "cartographer_ext/scan_matching/bicubic_kernels.h"

#if defined(__x86_64__) && (defined(__GNUC__) || defined(__clang__))
#define CARTOGRAPHER_EXT_X86_KERNELS 1
#endif

namespace cartographer_ext {
namespace scan_matching {
namespace {

// The compiler vectorises these loops for each instruction set for which they
// are inlined.

inline __attribute__((always_inline)) void FindPlacesInline(
    const GridFrame& frame, const double cosine, const double sine,
    const double x, const double y, const double* __restrict const point_x,
    const double* __restrict const point_y, const int count,
    const PointPlaces& places) {
  const double max_x = frame.max_x;
  const double max_y = frame.max_y;
  const double cells_per_metre = frame.cells_per_metre;
  double* __restrict const turned_x = places.turned_x;
  double* __restrict const turned_y = places.turned_y;
  double* __restrict const row = places.row;
  double* __restrict const column = places.column;
  for (int i = 0; i < count; ++i) {
    turned_x[i] = cosine * point_x[i] - sine * point_y[i];
    turned_y[i] = sine * point_x[i] + cosine * point_y[i];
    row[i] = (max_x - (turned_x[i] + x)) * cells_per_metre - 0.5;
    column[i] = (max_y - (turned_y[i] + y)) * cells_per_metre - 0.5;
  }
}

inline __attribute__((always_inline)) void InterpolateInline(
    const double* __restrict const cells, const int stride,
    const double* __restrict const row_fraction,
    const double* __restrict const column_fraction, const int count,
    double* __restrict const value, double* __restrict const row_slope,
    double* __restrict const column_slope) {
  const double* const c0 = cells;
  const double* const c1 = cells + 4 * stride;
  const double* const c2 = cells + 8 * stride;
  const double* const c3 = cells + 12 * stride;
  const int r1 = stride;
  const int r2 = 2 * stride;
  const int r3 = 3 * stride;
  for (int i = 0; i < count; ++i) {
    const double u = column_fraction[i];
    const double u2 = u * u;
    const double u3 = u2 * u;
    const double w0 = 0.5 * (-u + 2. * u2 - u3);
    const double w1 = 0.5 * (2. - 5. * u2 + 3. * u3);
    const double w2 = 0.5 * (u + 4. * u2 - 3. * u3);
    const double w3 = 0.5 * (u3 - u2);
    const double s0 = 0.5 * (-1. + 4. * u - 3. * u2);
    const double s1 = 0.5 * (-10. * u + 9. * u2);
    const double s2 = 0.5 * (1. + 8. * u - 9. * u2);
    const double s3 = 0.5 * (3. * u2 - 2. * u);
    // First along the rows.
    const double value0 = ((w0 * c0[i] + w1 * c1[i]) + w2 * c2[i]) + w3 * c3[i];
    const double slope0 = ((s0 * c0[i] + s1 * c1[i]) + s2 * c2[i]) + s3 * c3[i];
    const double value1 =
        ((w0 * c0[r1 + i] + w1 * c1[r1 + i]) + w2 * c2[r1 + i]) +
        w3 * c3[r1 + i];
    const double slope1 =
        ((s0 * c0[r1 + i] + s1 * c1[r1 + i]) + s2 * c2[r1 + i]) +
        s3 * c3[r1 + i];
    const double value2 =
        ((w0 * c0[r2 + i] + w1 * c1[r2 + i]) + w2 * c2[r2 + i]) +
        w3 * c3[r2 + i];
    const double slope2 =
        ((s0 * c0[r2 + i] + s1 * c1[r2 + i]) + s2 * c2[r2 + i]) +
        s3 * c3[r2 + i];
    const double value3 =
        ((w0 * c0[r3 + i] + w1 * c1[r3 + i]) + w2 * c2[r3 + i]) +
        w3 * c3[r3 + i];
    const double slope3 =
        ((s0 * c0[r3 + i] + s1 * c1[r3 + i]) + s2 * c2[r3 + i]) +
        s3 * c3[r3 + i];
    // Then across the rows.
    const double v = row_fraction[i];
    const double v2 = v * v;
    const double v3 = v2 * v;
    const double a0 = 0.5 * (-v + 2. * v2 - v3);
    const double a1 = 0.5 * (2. - 5. * v2 + 3. * v3);
    const double a2 = 0.5 * (v + 4. * v2 - 3. * v3);
    const double a3 = 0.5 * (v3 - v2);
    const double b0 = 0.5 * (-1. + 4. * v - 3. * v2);
    const double b1 = 0.5 * (-10. * v + 9. * v2);
    const double b2 = 0.5 * (1. + 8. * v - 9. * v2);
    const double b3 = 0.5 * (3. * v2 - 2. * v);
    value[i] = (a0 * value0 + a2 * value2) + (a1 * value1 + a3 * value3);
    row_slope[i] = (b0 * value0 + b2 * value2) + (b1 * value1 + b3 * value3);
    column_slope[i] = (a0 * slope0 + a2 * slope2) + (a1 * slope1 + a3 * slope3);
  }
}

void FindPlaces(const GridFrame& frame, const double cosine, const double sine,
                const double x, const double y, const double* const point_x,
                const double* const point_y, const int count,
                const PointPlaces& places) {
  FindPlacesInline(frame, cosine, sine, x, y, point_x, point_y, count, places);
}

void Interpolate(const double* const cells, const int stride,
                 const double* const row_fraction,
                 const double* const column_fraction, const int count,
                 double* const value, double* const row_slope,
                 double* const column_slope) {
  InterpolateInline(cells, stride, row_fraction, column_fraction, count, value,
                    row_slope, column_slope);
}

constexpr BicubicKernels kPlain = {"plain", &FindPlaces, &Interpolate};

#ifdef CARTOGRAPHER_EXT_X86_KERNELS

__attribute__((target("avx2"))) void FindPlacesAvx2(
    const GridFrame& frame, const double cosine, const double sine,
    const double x, const double y, const double* const point_x,
    const double* const point_y, const int count, const PointPlaces& places) {
  FindPlacesInline(frame, cosine, sine, x, y, point_x, point_y, count, places);
}

__attribute__((target("avx2"))) void InterpolateAvx2(
    const double* const cells, const int stride,
    const double* const row_fraction, const double* const column_fraction,
    const int count, double* const value, double* const row_slope,
    double* const column_slope) {
  InterpolateInline(cells, stride, row_fraction, column_fraction, count, value,
                    row_slope, column_slope);
}

constexpr BicubicKernels kAvx2 = {"avx2", &FindPlacesAvx2, &InterpolateAvx2};

#endif

}  // namespace

const BicubicKernels& BestBicubicKernels() {
  static const BicubicKernels* const best = AllBicubicKernels().back();
  return *best;
}

std::vector<const BicubicKernels*> AllBicubicKernels() {
  std::vector<const BicubicKernels*> all = {&kPlain};
#ifdef CARTOGRAPHER_EXT_X86_KERNELS
  if (__builtin_cpu_supports("avx2")) all.push_back(&kAvx2);
#endif
  return all;
}

}  // namespace scan_matching
}  // namespace cartographer_ext
