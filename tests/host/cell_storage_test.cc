// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
#include "cartographer/mapping/2d/cell_storage.h"

#include <algorithm>
#include <string>
#include <utility>
#include <vector>

#include "cartographer/mapping/2d/probability_grid.h"
#include "cartographer_ext/common/random.h"
#include "gtest/gtest.h"
#include "tests/host/mapping_test_helpers.h"

namespace cartographer {
namespace mapping {
namespace {

TEST(CellStorageTest, FlatCellsAreZero) {
  for (const size_t size : {0, 1, 1000, 10000000}) {
    FlatCells cells(size);
    EXPECT_EQ(std::count(cells.begin(), cells.end(), 0),
              static_cast<ptrdiff_t>(size));
    if (size == 0) continue;
    cells.back() = 7;
    FlatCells moved = std::move(cells);
    EXPECT_EQ(moved.back(), 7);
    const FlatCells copy = moved;
    EXPECT_EQ(copy, moved);
  }
}

TEST(CellStorageTest, CompactCellsHaveTheSameValues) {
  cartographer_ext::Random random(3);
  for (const auto& size : {CellLimits(1, 1), CellLimits(16, 32),
                           CellLimits(37, 70), CellLimits(200, 15)}) {
    FlatCells cells(size.num_x_cells * size.num_y_cells);
    for (size_t i = 0; i < cells.size(); ++i) {
      // Unknown, of one value, or mixed.
      const size_t part = 3 * i / cells.size();
      cells[i] = part == 0   ? 0
                 : part == 1 ? 123
                             : static_cast<uint16>(32767 * random.Uniform());
    }
    const CompactCells compact(cells, size);
    EXPECT_FALSE(compact.empty());
    for (int y = 0; y < size.num_y_cells; ++y) {
      for (int x = 0; x < size.num_x_cells; ++x) {
        ASSERT_EQ(compact.At(x, y), cells[size.num_x_cells * y + x])
            << x << " " << y;
      }
    }
  }
  EXPECT_TRUE(CompactCells().empty());
}

TEST(CellStorageTest, TilesOfOneValueShareTheirMemory) {
  const CellLimits size(1600, 1600);
  FlatCells cells(size.num_x_cells * size.num_y_cells);
  const CompactCells unknown(cells, size);
  EXPECT_LT(unknown.MemoryBytes(), 45000u);
  cells[1600 * 800 + 800] = 5;
  EXPECT_EQ(CompactCells(cells, size).MemoryBytes(),
            unknown.MemoryBytes() + 2 * 16 * 16);
}

// All that is said about a grid stays the same.
TEST(CellStorageTest, CompactGridsAreTheSame) {
  ValueConversionTables tables;
  const auto flat = test::RoomGrid(&tables, 0.05, 5);
  const auto compact = test::RoomGrid(&tables, 0.05, 5);
  compact->MakeCompact();
  compact->MakeCompact();
  EXPECT_FALSE(flat->is_compact());
  EXPECT_TRUE(compact->is_compact());
  EXPECT_EQ(compact->ToProto().SerializeAsString(),
            flat->ToProto().SerializeAsString());
  const CellLimits& size = flat->limits().cell_limits();
  for (int y = -1; y <= size.num_y_cells; ++y) {
    for (int x = -1; x <= size.num_x_cells; ++x) {
      const Eigen::Array2i cell(x, y);
      ASSERT_EQ(compact->GetCorrespondenceCost(cell),
                flat->GetCorrespondenceCost(cell));
      ASSERT_EQ(compact->IsKnown(cell), flat->IsKnown(cell));
    }
  }
  proto::SubmapQuery::Response::SubmapTexture of_flat, of_compact;
  flat->DrawToSubmapTexture(&of_flat, transform::Rigid3d::Identity());
  compact->DrawToSubmapTexture(&of_compact, transform::Rigid3d::Identity());
  EXPECT_EQ(of_compact.SerializeAsString(), of_flat.SerializeAsString());
}

// Runs begin and end anywhere in tiles and, for costs, outside the grid.
TEST(CellStorageTest, RunsAreTheSameAsSingleCells) {
  ValueConversionTables tables;
  const auto flat = test::RoomGrid(&tables, 0.05, 5);
  const auto compact = test::RoomGrid(&tables, 0.05, 5);
  compact->MakeCompact();
  const CellLimits& size = flat->limits().cell_limits();
  for (const Grid2D* const grid : {flat.get(), compact.get()}) {
    for (int y = -1; y <= size.num_y_cells; y += 3) {
      for (const int count : {1, 4, 16, 40, size.num_x_cells + 9}) {
        for (int x = -50; x <= size.num_x_cells + 3; x += 7) {
          const std::string where = std::to_string(x) + " " +
                                    std::to_string(y) + " " +
                                    std::to_string(count);
          std::vector<float> costs(count + 1, -1.f);
          grid->CopyCorrespondenceCosts(x, y, count, costs.data());
          for (int i = 0; i != count; ++i) {
            ASSERT_EQ(costs[i], flat->GetCorrespondenceCost({x + i, y}))
                << where;
          }
          ASSERT_EQ(costs[count], -1.f) << where;
          if (!flat->limits().Contains({x, y}) ||
              !flat->limits().Contains({x + count - 1, y})) {
            continue;
          }
          std::vector<uint16> buffer(count);
          const uint16* const cells = grid->CellRun(x, y, count, buffer.data());
          for (int i = 0; i != count; ++i) {
            ASSERT_EQ(cells[i], flat->CellValue({x + i, y})) << where;
          }
        }
      }
    }
  }
}

}  // namespace
}  // namespace mapping
}  // namespace cartographer
