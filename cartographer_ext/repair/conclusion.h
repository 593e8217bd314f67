// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
//
// What a repair comes to, and what the user should do.
#ifndef CARTOGRAPHER_EXT_REPAIR_CONCLUSION_H_
#define CARTOGRAPHER_EXT_REPAIR_CONCLUSION_H_

#include "cartographer_ext/repair/map_repair.h"

namespace cartographer_ext {
namespace repair {

// Fills in `conclusion` and `advice` by the other fields. `keep_frame`: the
// repaired map has the frame of the old one.
void Conclude(bool keep_frame, MapRepair* repair);

}  // namespace repair
}  // namespace cartographer_ext

#endif  // CARTOGRAPHER_EXT_REPAIR_CONCLUSION_H_
