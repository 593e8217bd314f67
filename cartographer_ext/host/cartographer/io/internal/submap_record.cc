// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
#include "cartographer/io/internal/submap_record.h"

#include <cstddef>
#include <vector>

#include "cartographer/mapping/proto/serialization.pb.h"
#include "glog/logging.h"

namespace cartographer {
namespace io {
namespace {

using mapping::CellLimits;
using mapping::Grid2D;

constexpr size_t kPieceSize = size_t{1} << 16;

void AppendVarint(uint64 value, std::string* const bytes) {
  while (value >= 0x80) {
    bytes->push_back(static_cast<char>((value & 0x7f) | 0x80));
    value >>= 7;
  }
  bytes->push_back(static_cast<char>(value));
}

size_t VarintSize(const uint16 value) {
  return value < 0x80 ? 1 : value < 0x4000 ? 2 : 3;
}

// Tag and size of a field that is a message or a packed array.
std::string Head(const int field_number, const size_t size) {
  std::string bytes;
  AppendVarint(static_cast<uint64>(field_number) << 3 | 2, &bytes);
  AppendVarint(size, &bytes);
  return bytes;
}

// Calls `visit` with the cells of each row.
template <typename Visit>
void VisitRows(const Grid2D& grid, const Visit& visit) {
  const CellLimits& size = grid.limits().cell_limits();
  std::vector<uint16> buffer(size.num_x_cells);
  for (int y = 0; y != size.num_y_cells; ++y) {
    visit(grid.CellRun(0, y, size.num_x_cells, buffer.data()));
  }
}

void AppendCells(const uint16* const cells, const int count,
                 std::string* const bytes) {
  const size_t old_size = bytes->size();
  bytes->resize(old_size + 3 * static_cast<size_t>(count));
  char* next = &(*bytes)[old_size];
  for (int i = 0; i != count; ++i) {
    uint16 value = cells[i];
    for (; value >= 0x80; value >>= 7) {
      *next++ = static_cast<char>((value & 0x7f) | 0x80);
    }
    *next++ = static_cast<char>(value);
  }
  bytes->resize(next - bytes->data());
}

}  // namespace

void WriteSubmapRecord(const mapping::SubmapId& id,
                       const mapping::Submap2D& submap,
                       const std::function<void(const std::string&)>& write) {
  const Grid2D& grid = *submap.grid();
  // Everything but the cells, as messages. Fields are in the order of their
  // numbers: the grid is the last one of its submap, the cells come after the
  // limits.
  const mapping::proto::Grid2D message = grid.HeadToProto();
  mapping::proto::Grid2D limits;
  *limits.mutable_limits() = message.limits();
  mapping::proto::Grid2D rest = message;
  rest.clear_limits();
  const std::string before_cells = limits.SerializeAsString();
  const std::string after_cells = rest.SerializeAsString();
  mapping::proto::Submap head;
  id.ToProto(head.mutable_submap_id());
  const std::string id_bytes = head.SerializeAsString();
  const std::string submap_bytes =
      submap.ToProto(false /* without grid */).submap_2d().SerializeAsString();

  size_t cells_size = 0;
  const int num_x = grid.limits().cell_limits().num_x_cells;
  VisitRows(grid, [&cells_size, num_x](const uint16* const cells) {
    for (int x = 0; x != num_x; ++x) cells_size += VarintSize(cells[x]);
  });
  const std::string cells_head =
      Head(mapping::proto::Grid2D::kCellsFieldNumber, cells_size);
  const size_t grid_size =
      before_cells.size() + cells_head.size() + cells_size + after_cells.size();
  const std::string grid_head =
      Head(mapping::proto::Submap2D::kGridFieldNumber, grid_size);
  const size_t submap_size = submap_bytes.size() + grid_head.size() + grid_size;
  const std::string submap_head =
      Head(mapping::proto::Submap::kSubmap2DFieldNumber, submap_size);
  std::string piece = Head(mapping::proto::SerializedData::kSubmapFieldNumber,
                           id_bytes.size() + submap_head.size() + submap_size);
  for (const std::string* const bytes :
       {&id_bytes, &submap_head, &submap_bytes, &grid_head, &before_cells,
        &cells_head}) {
    piece += *bytes;
  }
  VisitRows(grid, [&piece, &write, num_x](const uint16* const cells) {
    if (piece.size() >= kPieceSize) {
      write(piece);
      piece.clear();
    }
    AppendCells(cells, num_x, &piece);
  });
  piece += after_cells;
  write(piece);
}

}  // namespace io
}  // namespace cartographer
