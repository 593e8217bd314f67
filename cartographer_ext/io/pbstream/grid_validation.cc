// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
#include "cartographer_ext/io/pbstream/grid_validation.h"

#include <cmath>
#include <cstdint>
#include <utility>

#include "absl/strings/str_cat.h"
#include "absl/strings/string_view.h"

namespace cartographer_ext {
namespace io {
namespace {

namespace mapping = cartographer::mapping::proto;

constexpr int64_t kMaxCells = int64_t{1} << 28;
constexpr int kMaxCellValue = 32767;  // bit 15 marks updates in memory

class GridChecker {
 public:
  explicit GridChecker(const std::string& name) : name_(name) {}

  // False if there is no use in looking at the cells.
  bool CheckLayout(const mapping::Grid2D& grid) {
    const mapping::MapLimits& limits = grid.limits();
    Expect(std::isfinite(limits.resolution()) && limits.resolution() > 1e-6 &&
               limits.resolution() < 1e6,
           " has cells of ", limits.resolution(), " m");
    Expect(std::abs(limits.max().x()) < kMaxCoordinate &&
               std::abs(limits.max().y()) < kMaxCoordinate,
           " has no finite place");
    const int64_t width = limits.cell_limits().num_x_cells();
    const int64_t height = limits.cell_limits().num_y_cells();
    if (!Expect(width > 0 && height > 0 && width <= kMaxCells / height,
                " has the size ", width, " x ", height)) {
      return false;
    }
    Expect(grid.cells_size() == width * height, " has ", grid.cells_size(),
           " cells instead of ", width, " x ", height);
    const float min = grid.min_correspondence_cost();
    const float max = grid.max_correspondence_cost();
    // Both are zero in old files. Those of a TSDF are distances.
    const bool possible = grid.has_tsdf_2d()
                              ? std::isfinite(min) && std::isfinite(max)
                              : min > 0.f && max < 1.f;
    Expect((min == 0.f && max == 0.f) || (possible && min < max),
           " has correspondence costs between ", min, " and ", max);
    return true;
  }

  void CheckCells(const mapping::Grid2D& grid) {
    const auto& cell_limits = grid.limits().cell_limits();
    CheckCellValues(grid.cells(), "a cell");
    if (grid.has_known_cells_box()) {
      const auto& box = grid.known_cells_box();
      Expect(box.min_x() >= 0 && box.min_x() <= box.max_x() &&
                 box.max_x() < cell_limits.num_x_cells() && box.min_y() >= 0 &&
                 box.min_y() <= box.max_y() &&
                 box.max_y() < cell_limits.num_y_cells(),
             " has a box of known cells beyond its limits");
    }
    Expect(grid.grid_case() != mapping::Grid2D::GRID_NOT_SET,
           " has a grid of unknown type");
    if (grid.has_tsdf_2d()) {
      const mapping::TSDF2D& tsdf = grid.tsdf_2d();
      Expect(std::isfinite(tsdf.truncation_distance()) &&
                 tsdf.truncation_distance() > 0.f &&
                 std::isfinite(tsdf.max_weight()) && tsdf.max_weight() > 0.f,
             " has no valid truncation distance or weight");
      Expect(tsdf.weight_cells_size() == grid.cells_size(), " has ",
             tsdf.weight_cells_size(), " weights for ", grid.cells_size(),
             " cells");
      CheckCellValues(tsdf.weight_cells(), "a weight");
    }
  }

  std::vector<std::string> TakeProblems() { return std::move(problems_); }

 private:
  // Adds a problem unless `holds`; returns `holds`.
  template <typename... Parts>
  bool Expect(const bool holds, const Parts&... parts) {
    if (!holds) problems_.push_back(absl::StrCat(name_, parts...));
    return holds;
  }

  template <typename Cells>
  void CheckCellValues(const Cells& cells, absl::string_view what) {
    for (const int cell : cells) {
      if (!Expect(cell >= 0 && cell <= kMaxCellValue, " has ", what,
                  " with the value ", cell)) {
        return;
      }
    }
  }

  const std::string name_;
  std::vector<std::string> problems_;
};

}  // namespace

absl::Status CheckGridLayout(const mapping::Grid2D& grid) {
  GridChecker checker("the grid");
  checker.CheckLayout(grid);
  const std::vector<std::string> problems = checker.TakeProblems();
  return problems.empty() ? absl::OkStatus()
                          : absl::InvalidArgumentError(problems.front());
}

std::vector<std::string> FindGridProblems(const mapping::Grid2D& grid,
                                          const std::string& name) {
  GridChecker checker(name);
  if (checker.CheckLayout(grid)) checker.CheckCells(grid);
  return checker.TakeProblems();
}

}  // namespace io
}  // namespace cartographer_ext
