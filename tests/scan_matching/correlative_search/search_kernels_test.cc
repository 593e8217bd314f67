// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
#include "cartographer_ext/scan_matching/correlative_search/search_kernels.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <string>
#include <vector>

#include "cartographer_ext/common/random.h"
#include "gtest/gtest.h"

namespace cartographer_ext {
namespace scan_matching {
namespace {

std::vector<uint8_t> RandomBytes(const int count, Random* const random) {
  std::vector<uint8_t> bytes(count);
  for (uint8_t& byte : bytes) {
    byte = static_cast<uint8_t>(random->Uniform(0., 256.));
  }
  return bytes;
}

class SearchKernelsTest
    : public ::testing::TestWithParam<const SearchKernels*> {
 protected:
  const SearchKernels& kernels_ = *GetParam();
  const SearchKernels& plain_ = *AllSearchKernels().front();
  Random random_{7};
};

TEST_P(SearchKernelsTest, CellsByHand) {
  CellFrame frame;
  frame.max_x = 2.;
  frame.max_y = 3.;
  frame.resolution = 0.5;
  frame.translation_x = 0.3f;
  frame.translation_y = 0.1f;
  // A quarter turn: (x, y) becomes (-y, x).
  frame.w = frame.z = std::sqrt(0.5f);
  const float nan = std::numeric_limits<float>::quiet_NaN();
  const float infinity = std::numeric_limits<float>::infinity();
  const std::vector<float> point_x = {0.f, 1.f, 0.f, nan, infinity, 1e30f};
  const std::vector<float> point_y = {0.f, 0.f, 1.f, 0.f, 0.f, 0.f};
  std::vector<int32_t> x(6), y(6);
  kernels_.find_cells(frame, point_x.data(), point_y.data(), 6, x.data(),
                      y.data());
  // World (0.3, 0.1): (3 - 0.1) / 0.5 - 0.5 = 5.3, (2 - 0.3) / 0.5 - 0.5 = 2.9.
  EXPECT_EQ(x[0], 5);
  EXPECT_EQ(y[0], 3);
  // World (0.3, 1.1) and (-0.7, 0.1).
  EXPECT_EQ(x[1], 3);
  EXPECT_EQ(y[1], 3);
  EXPECT_EQ(x[2], 5);
  EXPECT_EQ(y[2], 5);
  // Far outside, but defined.
  for (int i = 3; i != 6; ++i) EXPECT_EQ(std::abs(x[i]), 100000000) << i;
}

TEST_P(SearchKernelsTest, HalvesAreRoundedAwayFromZero) {
  CellFrame frame;  // cells of 1 m; index -world - 0.5
  const std::vector<float> zeros(8, 0.f);
  const std::vector<float> world = {0.f, 1.f, -1.f, -2.f, 2.f, 5.f, -5.f, 0.5f};
  std::vector<int32_t> x(8), y(8);
  kernels_.find_cells(frame, zeros.data(), world.data(), 8, x.data(), y.data());
  EXPECT_EQ(x, (std::vector<int32_t>{-1, -2, 1, 2, -3, -6, 5, -1}));
  EXPECT_EQ(y, std::vector<int32_t>(8, -1));
}

TEST_P(SearchKernelsTest, CellsAreTheSame) {
  for (int i = 0; i != 200; ++i) {
    const int count = static_cast<int>(random_.Uniform(0., 40.));
    CellFrame frame;
    const double angle = random_.Uniform(-4., 4.);
    frame.w = static_cast<float>(std::cos(angle / 2.));
    frame.z = static_cast<float>(std::sin(angle / 2.));
    frame.translation_x = static_cast<float>(random_.Uniform(-100., 100.));
    frame.translation_y = static_cast<float>(random_.Uniform(-100., 100.));
    frame.max_x = random_.Uniform(-100., 100.);
    frame.max_y = random_.Uniform(-100., 100.);
    frame.resolution = random_.Uniform(0.01, 0.5);
    std::vector<float> point_x(count), point_y(count);
    for (int k = 0; k != count; ++k) {
      point_x[k] = static_cast<float>(random_.Uniform(-50., 50.));
      // Halves come up often among these.
      point_y[k] = static_cast<float>(std::round(random_.Uniform(-9., 9.)) / 4);
    }
    std::vector<int32_t> x(count), y(count), expected_x(count),
        expected_y(count);
    kernels_.find_cells(frame, point_x.data(), point_y.data(), count, x.data(),
                        y.data());
    plain_.find_cells(frame, point_x.data(), point_y.data(), count,
                      expected_x.data(), expected_y.data());
    EXPECT_EQ(x, expected_x);
    EXPECT_EQ(y, expected_y);
  }
}

TEST_P(SearchKernelsTest, AddsRowsAndLeavesTheRest) {
  for (int i = 0; i != 300; ++i) {
    const int num_columns = static_cast<int>(random_.Uniform(0., 100.));
    const int num_rows = static_cast<int>(random_.Uniform(0., 5.));
    const int row_stride =
        num_columns + static_cast<int>(random_.Uniform(0, 9));
    const int sums_stride =
        num_columns + static_cast<int>(random_.Uniform(0., 9.));
    const std::vector<uint8_t> rows =
        RandomBytes(num_rows * row_stride + 32, &random_);
    std::vector<uint8_t> sums =
        RandomBytes(num_rows * sums_stride + 32, &random_);
    std::vector<uint8_t> expected = sums;
    for (int y = 0; y != num_rows; ++y) {
      for (int x = 0; x != num_columns; ++x) {
        uint8_t& sum = expected[y * sums_stride + x];
        sum = static_cast<uint8_t>(sum + rows[y * row_stride + x]);
      }
    }
    kernels_.add_rows(rows.data(), row_stride, num_columns, num_rows,
                      sums.data(), sums_stride);
    ASSERT_EQ(sums, expected) << num_columns << " columns";
  }
}

TEST_P(SearchKernelsTest, MovesSums) {
  std::vector<uint8_t> sums = RandomBytes(48, &random_);
  const std::vector<uint8_t> before = sums;
  std::vector<uint16_t> totals(48);
  for (int i = 0; i != 48; ++i) totals[i] = static_cast<uint16_t>(1365 * i);
  kernels_.move_sums(48, sums.data(), totals.data());
  for (int i = 0; i != 48; ++i) {
    EXPECT_EQ(sums[i], 0);
    EXPECT_EQ(totals[i], 1365 * i + before[i]);
  }
}

TEST_P(SearchKernelsTest, SumsValuesInsideOnly) {
  constexpr int kNumX = 13;
  constexpr int kNumY = 9;
  const std::vector<uint8_t> values = RandomBytes(kNumX * kNumY + 3, &random_);
  for (int i = 0; i != 200; ++i) {
    const int count = static_cast<int>(random_.Uniform(0., 50.));
    std::vector<int32_t> x(count), y(count);
    for (int k = 0; k != count; ++k) {
      x[k] = static_cast<int32_t>(random_.Uniform(-30., 30.));
      y[k] = static_cast<int32_t>(random_.Uniform(-30., 30.));
      if (k % 7 == 0) x[k] = k % 2 == 0 ? 100000000 : -100000000;
    }
    const int shift_x = static_cast<int>(random_.Uniform(-20., 20.));
    const int shift_y = static_cast<int>(random_.Uniform(-20., 20.));
    int expected = 0;
    std::vector<int32_t> expected_places;
    for (int k = 0; k != count; ++k) {
      const int column = x[k] + shift_x;
      const int row = y[k] + shift_y;
      if (column < 0 || column >= kNumX || row < 0 || row >= kNumY) continue;
      expected += values[row * kNumX + column];
      expected_places.push_back(100 * row + column);
    }
    EXPECT_EQ(kernels_.sum_values(values.data(), kNumX, kNumY, x.data(),
                                  y.data(), shift_x, shift_y, count),
              expected);
    std::vector<int32_t> places(count + 8);
    places.resize(kernels_.find_places(kNumX, kNumY, 100, x.data(), y.data(),
                                       shift_x, shift_y, count, places.data()));
    EXPECT_EQ(places, expected_places);
  }
}

TEST_P(SearchKernelsTest, SplitsColumns) {
  for (const int count : {0, 1, 7, 8, 127, 128, 129, 300}) {
    const size_t plane = 50;
    const std::vector<uint8_t> source = RandomBytes(count, &random_);
    std::vector<uint8_t> target(8 * plane, 1);
    std::vector<uint8_t> expected(8 * plane, 1);
    for (int i = 0; i != count; ++i) {
      expected[plane * (i % 8) + i / 8] = source[i];
    }
    kernels_.split_columns(source.data(), count, plane, target.data());
    EXPECT_EQ(target, expected) << count;
  }
}

TEST_P(SearchKernelsTest, AddsSquares) {
  constexpr int kStride = 29;
  const std::vector<uint8_t> cells = RandomBytes(kStride * 40, &random_);
  for (const int count : {0, 1, 2, 100, 257}) {
    std::vector<int32_t> offsets(count);
    for (int32_t& offset : offsets) {
      offset = static_cast<int32_t>(random_.Uniform(0., kStride * 32. - 8.));
    }
    std::vector<uint16_t> sums(64, 0);
    std::vector<uint16_t> expected(64, 0);
    for (const int32_t offset : offsets) {
      for (int y = 0; y != 8; ++y) {
        for (int x = 0; x != 8; ++x) {
          expected[8 * y + x] = static_cast<uint16_t>(
              expected[8 * y + x] + cells[offset + kStride * y + x]);
        }
      }
    }
    EXPECT_EQ(kernels_.add_squares(cells.data(), kStride, offsets.data(), count,
                                   sums.data()),
              *std::max_element(expected.begin(), expected.end()));
    EXPECT_EQ(sums, expected);
  }
}

// The largest sum there may be.
TEST_P(SearchKernelsTest, SquaresUseAllSixteenBits) {
  const std::vector<uint8_t> cells(64, 255);
  const std::vector<int32_t> offsets(257, 0);
  std::vector<uint16_t> sums(64, 0);
  EXPECT_EQ(
      kernels_.add_squares(cells.data(), 8, offsets.data(), 257, sums.data()),
      65535);
}

TEST_P(SearchKernelsTest, RoundsUpToBytes) {
  const float nan = std::numeric_limits<float>::quiet_NaN();
  std::vector<float> values = {0.9f, 0.1f,  0.5f,   0.8f,
                               nan,  1e30f, -1e30f, 0.89999f};
  std::vector<uint8_t> bytes(8);
  kernels_.round_up(values.data(), 0.9f, 10.f, 8, bytes.data());
  // 0, 8, 4 and 1 steps; bounds.
  EXPECT_EQ(bytes, (std::vector<uint8_t>{0, 8, 4, 1, 0, 0, 255, 0}));
  for (int count = 0; count != 50; ++count) {
    values.resize(count);
    for (float& value : values) {
      value = static_cast<float>(random_.Uniform(0., 1.));
    }
    if (count > 20) values[7] = nan;
    bytes.assign(count + 1, 77);
    std::vector<uint8_t> expected = bytes;
    kernels_.round_up(values.data(), 0.9f, 318.75f, count, bytes.data());
    plain_.round_up(values.data(), 0.9f, 318.75f, count, expected.data());
    ASSERT_EQ(bytes, expected);
  }
}

INSTANTIATE_TEST_SUITE_P(
    Sets, SearchKernelsTest, ::testing::ValuesIn(AllSearchKernels()),
    [](const ::testing::TestParamInfo<const SearchKernels*>& info) {
      return std::string(info.param->name);
    });

}  // namespace
}  // namespace scan_matching
}  // namespace cartographer_ext
