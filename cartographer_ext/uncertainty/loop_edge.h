// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
#ifndef CARTOGRAPHER_EXT_UNCERTAINTY_LOOP_EDGE_H_
#define CARTOGRAPHER_EXT_UNCERTAINTY_LOOP_EDGE_H_

#include "cartographer_ext/uncertainty/ids.h"
#include "cartographer_ext/uncertainty/uncertain_pose.h"

namespace cartographer_ext {
namespace uncertainty {

// A loop between two vertices, (a <- b).
struct LoopEdge {
  VertexId a;
  VertexId b;
  UncertainPose pose;
};

}  // namespace uncertainty
}  // namespace cartographer_ext

#endif  // CARTOGRAPHER_EXT_UNCERTAINTY_LOOP_EDGE_H_
