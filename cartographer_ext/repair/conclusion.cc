// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
#include "cartographer_ext/repair/conclusion.h"

#include <string>

#include "absl/strings/str_cat.h"
#include "absl/strings/str_format.h"

namespace cartographer_ext {
namespace repair {
namespace {

// Why a map stays as it is, a clause.
std::string WhyBroken(const MapRepair& repair) {
  const evaluation::SelfConsistency& after = repair.after.consistency;
  if (!after.wrong_turns.empty()) {
    const evaluation::MotionStep& step = after.wrong_turns.front();
    return absl::StrFormat(
        "local SLAM turned %.0f degrees away from the odometry before node %s, "
        "and no loop repairs that",
        RadToDeg(step.odometry_rotation), evaluation::ToString(step.node_id));
  }
  if (!after.places.empty()) {
    const evaluation::PathPiece& piece = after.places.front();
    return absl::StrFormat(
        "no step makes nodes %s to %s (near x = %.1f m, y = %.1f m) consistent "
        "with what was mapped there at another time",
        evaluation::ToString(piece.first_node),
        evaluation::ToString(piece.last_node), piece.center.x(),
        piece.center.y());
  }
  if (after.word != "broken" && !after.loose.places.empty()) {
    return absl::StrCat("no step ties its parts together: ",
                        evaluation::DescribeLooseShare(after.loose.share()));
  }
  return "no step improved it";
}

}  // namespace

void Conclude(const bool keep_frame, MapRepair* const repair) {
  const std::string& before = repair->before.quality.verdict;
  const std::string& after = repair->after.quality.verdict;
  const bool is_fine = after == "sound" || after == "unknown";
  if (!repair->changed() && after == "unknown") {
    repair->conclusion =
        absl::StrCat("not repaired, because it cannot be judged: ",
                     repair->before.consistency.reasons.front());
    repair->advice.push_back(
        "If you record again: come back to places where you have been, early "
        "and more than once, so that loops tie the parts together.");
    return;
  }
  if (!repair->changed() && is_fine) {
    repair->conclusion = absl::StrCat(
        "nothing to repair: ", repair->before.consistency.reasons.front());
    repair->advice.push_back("Use the map as it is.");
    return;
  }
  const std::string better =
      absl::StrFormat("severe share %.1f %% before, %.1f %% after",
                      100. * repair->before.quality.severe_share,
                      100. * repair->after.quality.severe_share);
  if (repair->changed() && is_fine) {
    repair->conclusion = absl::StrCat("repaired: the map was ", before,
                                      " and is ", after, " (", better, ")");
    repair->advice.push_back(
        "Compare both pictures: a self-consistent map can still be wrong where "
        "a place was seen only once.");
    repair->advice.push_back(absl::StrCat(
        "Poses defined in the old map (docks, waypoints) have moved: ",
        keep_frame ? "" : "run with -keep_frame and ",
        "look them up in the table of poses."));
    if (!repair->after.pbstream->odometry_data.empty()) {
      repair->advice.push_back(
          "Cartographer optimises the map again unless it is loaded frozen, by "
          "default with the odometry as strong as local SLAM, which can break "
          "it again: load it frozen, set odometry_translation_weight and "
          "odometry_rotation_weight to 0, or repair with -drop_odometry.");
    }
    return;
  }
  repair->conclusion =
      repair->changed()
          ? absl::StrCat("better, but still ", after, " (", better,
                         "): cannot be repaired further, because ",
                         WhyBroken(*repair))
          : absl::StrCat("cannot be repaired, because ", WhyBroken(*repair));
  repair->advice.push_back(
      "Do not navigate with this map. If the recording still exists, run "
      "cartographer_ext_slam on it: it uses all scans instead of the filtered "
      "clouds of the nodes.");
  repair->advice.push_back(
      "If you record again: drive slowly through the places named above, close "
      "loops early and more than once, and record the odometry.");
}

}  // namespace repair
}  // namespace cartographer_ext
