// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
#ifndef CARTOGRAPHER_MAPPING_GRID_INTERFACE_H_
#define CARTOGRAPHER_MAPPING_GRID_INTERFACE_H_

namespace cartographer {
namespace mapping {

// Anything range data can be inserted into.
class GridInterface {
 public:
  virtual ~GridInterface() = default;
};

}  // namespace mapping
}  // namespace cartographer

#endif  // CARTOGRAPHER_MAPPING_GRID_INTERFACE_H_
