// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
#include "cartographer_ext/optimization/dropin/taken_back_loops.h"

#include <vector>

#include "absl/time/clock.h"
#include "absl/time/time.h"
#include "cartographer/mapping/pose_graph.h"
#include "cartographer_ext/common/withdrawn_loops.h"
#include "glog/logging.h"

namespace cartographer_ext {
namespace optimization {

using cartographer::mapping::PoseGraph;
using cartographer::mapping::PoseGraphInterface;
using Constraint = PoseGraphInterface::Constraint;

namespace {

constexpr absl::Duration kPatience = absl::Seconds(30);

}  // namespace

void MarkTakenBack(const std::set<LoopId>& loops,
                   PoseGraphInterface* const pose_graph) {
  if (loops.empty()) return;
  std::vector<Constraint> marks;
  const std::vector<Constraint> constraints = pose_graph->constraints();
  for (const Constraint& constraint : constraints) {
    const LoopDescription loop = DescribeConstraint(constraint);
    if (loop.is_loop && loop.has_weight && loops.count(loop.id) != 0) {
      marks.push_back(WithdrawalMark(constraint));
    }
  }
  auto* const graph = dynamic_cast<PoseGraph*>(pose_graph);
  CHECK(graph != nullptr);
  graph->AddSerializedConstraints(marks);
  // Its own thread does so, soon.
  const absl::Time deadline = absl::Now() + kPatience;
  while (graph->constraints().size() < constraints.size() + marks.size()) {
    if (absl::Now() > deadline) {
      LOG(ERROR) << "loops that are taken back could not be marked";
      return;
    }
    absl::SleepFor(absl::Milliseconds(1));
  }
}

}  // namespace optimization
}  // namespace cartographer_ext
