// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
#include "cartographer_ext/scan_matching/bicubic_kernels.h"

#include <cmath>
#include <functional>
#include <string>
#include <vector>

#include "cartographer_ext/common/random.h"
#include "gtest/gtest.h"

namespace cartographer_ext {
namespace scan_matching {
namespace {

struct Places {
  std::vector<double> turned_x, turned_y, row, column;

  explicit Places(const int count)
      : turned_x(count), turned_y(count), row(count), column(count) {}
  PointPlaces Pointers() {
    return {turned_x.data(), turned_y.data(), row.data(), column.data()};
  }
};

struct Interpolated {
  std::vector<double> value, row_slope, column_slope;
};

class BicubicKernelsTest
    : public ::testing::TestWithParam<const BicubicKernels*> {
 protected:
  // Cell (row, column) next to point i, from -1 to 2, costs `cost(i, row,
  // column)`.
  Interpolated Interpolate(
      const BicubicKernels& kernels, const std::vector<double>& row_fraction,
      const std::vector<double>& column_fraction,
      const std::function<double(int, int, int)>& cost) const {
    const int count = static_cast<int>(row_fraction.size());
    const int stride = count + 3;
    std::vector<double> cells(16 * stride);
    for (int i = 0; i != count; ++i) {
      for (int r = 0; r != 4; ++r) {
        for (int c = 0; c != 4; ++c) {
          cells[(4 * c + r) * stride + i] = cost(i, r - 1, c - 1);
        }
      }
    }
    Interpolated result;
    result.value.resize(count);
    result.row_slope.resize(count);
    result.column_slope.resize(count);
    kernels.interpolate(cells.data(), stride, row_fraction.data(),
                        column_fraction.data(), count, result.value.data(),
                        result.row_slope.data(), result.column_slope.data());
    return result;
  }

  const BicubicKernels& kernels_ = *GetParam();
  const BicubicKernels& plain_ = *AllBicubicKernels().front();
  Random random_{7};
};

TEST_P(BicubicKernelsTest, PlacesByHand) {
  // A quarter turn and (0.5, -0.25): (1, 0) comes to (0.5, 0.75).
  const std::vector<double> point_x = {1., 0., NAN}, point_y = {0., 1., 0.};
  Places places(3);
  kernels_.find_places(GridFrame{2., 3., 4.}, 0., 1., 0.5, -0.25,
                       point_x.data(), point_y.data(), 3, places.Pointers());
  EXPECT_EQ(places.turned_x[0], 0.);
  EXPECT_EQ(places.turned_y[0], 1.);
  EXPECT_EQ(places.row[0], (2. - 0.5) * 4. - 0.5);
  EXPECT_EQ(places.column[0], (3. - 0.75) * 4. - 0.5);
  EXPECT_EQ(places.turned_x[1], -1.);
  EXPECT_EQ(places.row[1], (2. + 0.5) * 4. - 0.5);
  EXPECT_TRUE(std::isnan(places.row[2]));
}

TEST_P(BicubicKernelsTest, PlanesAreExact) {
  const std::vector<double> row = {0., 0.25, 0.5, 0.75, 0.1, 0.999};
  const std::vector<double> column = {0., 0.5, 0.125, 0.75, 0.9, 0.3};
  const Interpolated result = Interpolate(
      kernels_, row, column, [](const int i, const int r, const int c) {
        return i + 2. * r - 3. * c;
      });
  for (size_t i = 0; i != row.size(); ++i) {
    EXPECT_NEAR(result.value[i], i + 2. * row[i] - 3. * column[i], 1e-12);
    EXPECT_NEAR(result.row_slope[i], 2., 1e-12);
    EXPECT_NEAR(result.column_slope[i], -3., 1e-12);
  }
}

// A single raised cell is the kernel of Catmull and Rom: 9/16 half a cell
// away, -1/16 one and a half.
TEST_P(BicubicKernelsTest, OneRaisedCell) {
  const Interpolated result =
      Interpolate(kernels_, {0.5, 0., 0.5, 0.5}, {0., 0.5, 0.5, 0.},
                  [](const int i, const int r, const int c) {
                    return i < 3 ? r == 0 && c == 0 : r == -1 && c == 0;
                  });
  EXPECT_NEAR(result.value[0], 9. / 16., 1e-15);
  EXPECT_NEAR(result.value[1], 9. / 16., 1e-15);
  EXPECT_NEAR(result.value[2], 81. / 256., 1e-15);
  EXPECT_NEAR(result.value[3], -1. / 16., 1e-15);
  EXPECT_NEAR(result.row_slope[0], -1.375, 1e-15);
  EXPECT_NEAR(result.column_slope[0], 0., 1e-15);
}

TEST_P(BicubicKernelsTest, AllSetsGiveTheSame) {
  for (int count = 0; count != 40; ++count) {
    const auto numbers = [&](const double from, const double to) {
      std::vector<double> result(count);
      for (double& number : result) number = random_.Uniform(from, to);
      return result;
    };
    const std::vector<double> x = numbers(-9., 9.), y = numbers(-9., 9.);
    Places places(count), expected_places(count);
    const GridFrame frame{3., 5., 20.};
    const double angle = random_.Uniform(-3., 3.);
    for (const bool plain : {false, true}) {
      (plain ? plain_ : kernels_)
          .find_places(frame, std::cos(angle), std::sin(angle), 0.3, -0.7,
                       x.data(), y.data(), count,
                       (plain ? expected_places : places).Pointers());
    }
    EXPECT_EQ(places.turned_x, expected_places.turned_x);
    EXPECT_EQ(places.turned_y, expected_places.turned_y);
    EXPECT_EQ(places.row, expected_places.row);
    EXPECT_EQ(places.column, expected_places.column);

    const std::vector<double> u = numbers(0., 1.), v = numbers(0., 1.);
    const std::vector<double> noise = numbers(0.1, 0.9);
    const auto cost = [&](const int i, const int r, const int c) {
      return std::sin(noise[i] * (7 * r + 3 * c + 20));
    };
    const Interpolated found = Interpolate(kernels_, u, v, cost);
    const Interpolated expected = Interpolate(plain_, u, v, cost);
    EXPECT_EQ(found.value, expected.value);
    EXPECT_EQ(found.row_slope, expected.row_slope);
    EXPECT_EQ(found.column_slope, expected.column_slope);
  }
}

INSTANTIATE_TEST_SUITE_P(
    Sets, BicubicKernelsTest, ::testing::ValuesIn(AllBicubicKernels()),
    [](const ::testing::TestParamInfo<const BicubicKernels*>& info) {
      return std::string(info.param->name);
    });

}  // namespace
}  // namespace scan_matching
}  // namespace cartographer_ext
