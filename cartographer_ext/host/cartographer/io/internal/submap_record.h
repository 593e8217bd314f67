// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
//
// Not part of Cartographer: the record of a submap, byte for byte as a
// SerializedData message would be serialized, without the message. That takes
// four bytes a cell, and the last submap of a run, not cropped yet, may have
// ten million cells.
#ifndef CARTOGRAPHER_IO_INTERNAL_SUBMAP_RECORD_H_
#define CARTOGRAPHER_IO_INTERNAL_SUBMAP_RECORD_H_

#include <functional>
#include <string>

#include "cartographer/mapping/2d/submap_2d.h"
#include "cartographer/mapping/id.h"

namespace cartographer {
namespace io {

// Passes the record to `write` piece by piece. The submap has a probability
// grid.
void WriteSubmapRecord(const mapping::SubmapId& id,
                       const mapping::Submap2D& submap,
                       const std::function<void(const std::string&)>& write);

}  // namespace io
}  // namespace cartographer

#endif  // CARTOGRAPHER_IO_INTERNAL_SUBMAP_RECORD_H_
