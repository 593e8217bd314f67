// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
#include "cartographer/mapping/pose_graph_trimmer.h"

#include <cstddef>

#include "glog/logging.h"

namespace cartographer {
namespace mapping {

PureLocalizationTrimmer::PureLocalizationTrimmer(const int trajectory_id,
                                                 const int num_submaps_to_keep)
    : trajectory_id_(trajectory_id), num_submaps_to_keep_(num_submaps_to_keep) {
  CHECK_GE(num_submaps_to_keep, 2)
      << "local SLAM itself needs the two newest submaps";
}

void PureLocalizationTrimmer::Trim(Trimmable* const pose_graph) {
  const bool trajectory_ended = pose_graph->IsFinished(trajectory_id_);
  if (trajectory_ended) {
    num_submaps_to_keep_ = 0;
  }
  const std::vector<SubmapId> submap_ids =
      pose_graph->GetSubmapIds(trajectory_id_);
  const size_t num_kept = num_submaps_to_keep_;
  if (submap_ids.size() > num_kept) {
    for (size_t i = 0; i < submap_ids.size() - num_kept; ++i) {
      pose_graph->TrimSubmap(submap_ids[i]);
    }
  }
  if (trajectory_ended) {
    pose_graph->SetTrajectoryState(
        trajectory_id_, PoseGraphInterface::TrajectoryState::DELETED);
    finished_ = true;
  }
}

bool PureLocalizationTrimmer::IsFinished() { return finished_; }

}  // namespace mapping
}  // namespace cartographer
