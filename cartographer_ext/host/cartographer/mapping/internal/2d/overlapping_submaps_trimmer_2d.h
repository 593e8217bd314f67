// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
//
// Removes submaps whose area newer submaps cover, so that the map of a robot
// that stays in one place does not grow forever.
#ifndef CARTOGRAPHER_MAPPING_INTERNAL_2D_OVERLAPPING_SUBMAPS_TRIMMER_2D_H_
#define CARTOGRAPHER_MAPPING_INTERNAL_2D_OVERLAPPING_SUBMAPS_TRIMMER_2D_H_

#include "cartographer/common/port.h"
#include "cartographer/mapping/pose_graph_trimmer.h"

namespace cartographer {
namespace mapping {

class OverlappingSubmapsTrimmer2D : public PoseGraphTrimmer {
 public:
  // Every place belongs to the `fresh_submaps_count` newest submaps that know
  // it. A submap to which less than `min_covered_area` square metres belong is
  // removed. Works only when more than `min_added_submaps_count` submaps have
  // come since it worked last.
  OverlappingSubmapsTrimmer2D(uint16 fresh_submaps_count,
                              double min_covered_area,
                              uint16 min_added_submaps_count)
      : fresh_submaps_count_(fresh_submaps_count),
        min_covered_area_(min_covered_area),
        min_added_submaps_count_(min_added_submaps_count) {}
  ~OverlappingSubmapsTrimmer2D() override = default;

  void Trim(Trimmable* pose_graph) override;
  bool IsFinished() override { return false; }

 private:
  const uint16 fresh_submaps_count_;
  const double min_covered_area_;
  const uint16 min_added_submaps_count_;
  size_t num_submaps_after_last_trim_ = 0;
};

}  // namespace mapping
}  // namespace cartographer

#endif  // CARTOGRAPHER_MAPPING_INTERNAL_2D_OVERLAPPING_SUBMAPS_TRIMMER_2D_H_
