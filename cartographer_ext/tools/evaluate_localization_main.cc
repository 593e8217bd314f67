// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
// LINK: verdict
//
// cartographer_ext_evaluate_localization: did the robot know where it was?
#include <iostream>
#include <string>
#include <utility>
#include <vector>

#include "absl/status/status.h"
#include "absl/status/statusor.h"
#include "absl/strings/str_cat.h"
#include "absl/strings/str_format.h"
#include "cartographer_ext/io/trajectory_file.h"
#include "cartographer_ext/map/verdict/evaluation_report.h"
#include "cartographer_ext/metrics/localization_metrics.h"
#include "cartographer_ext/metrics/trajectory.h"
#include "cartographer_ext/metrics/trajectory_metrics.h"
#include "cartographer_ext/tools/command_line.h"
#include "gflags/gflags.h"
#include "nlohmann/json.hpp"

DEFINE_string(trajectory_filename, "",
              "Poses as published online (TUM), from "
              "-online_trajectory_filename of cartographer_ext_slam.");
DEFINE_string(reference_trajectory_filename, "",
              "Ground truth trajectory (TUM).");
DEFINE_string(
    map_trajectory_filename, "",
    "Trajectory of the run that made the map (TUM), to align the map with the "
    "ground truth. Without it both must be in the same frame.");
DEFINE_string(map_reference_trajectory_filename, "",
              "Ground truth trajectory of that run (TUM).");
DEFINE_double(translation_tolerance, 0.3,
              "Metres within which a pose counts as right.");
DEFINE_double(rotation_tolerance, 5.,
              "Degrees within which a pose counts as right.");
DEFINE_double(
    hold_seconds, 10.,
    "Seconds of right poses after which the robot counts as localised.");
DEFINE_double(jump_distance, 0.5,
              "Change of the error of the published pose from one scan to the "
              "next, in metres, that counts as a jump.");
DEFINE_double(carried_distance, 1.,
              "Motion between two scans, in metres, beyond which the robot "
              "counts as kidnapped.");
DEFINE_double(stamp_tolerance, 0.001,
              "Seconds within which two stamps belong to the same scan.");
DEFINE_string(json, "", "Output: all numbers as JSON; - is standard output.");

namespace cartographer_ext {
namespace {

constexpr char kDescription[] =
    R"(Evaluates localisation in a finished map: time to localise, jumps of the
published pose, wrong places.

  cartographer_ext_slam -input_filename=later.clf -load_state_filename=map.pbstream \
      -configuration_basename=localization.lua -online_trajectory_filename=later.tum
  cartographer_ext_evaluate_localization -trajectory_filename=later.tum \
      -reference_trajectory_filename=truth.tum \
      -map_trajectory_filename=map.tum -map_reference_trajectory_filename=map_truth.tum

A kidnapped robot (its true pose moves by more than -carried_distance between two
scans) starts a new segment, in which it has to localise again.)";

absl::StatusOr<evaluation::Trajectory> Read(const std::string& filename) {
  auto poses = io::ReadTumTrajectory(filename);
  if (!poses.ok()) return poses.status();
  return evaluation::Trajectory(*std::move(poses));
}

absl::StatusOr<std::vector<evaluation::PosePair>> ReadPairs(
    const std::string& estimate_filename, const std::string& truth_filename) {
  const auto estimate = Read(estimate_filename);
  if (!estimate.ok()) return estimate.status();
  const auto truth = Read(truth_filename);
  if (!truth.ok()) return truth.status();
  return evaluation::Associate(*estimate, *truth,
                               io::FromSeconds(FLAGS_stamp_tolerance));
}

nlohmann::ordered_json ToJson(const evaluation::LocalizationSegment& segment) {
  nlohmann::ordered_json json;
  json["begin"] = io::ToSeconds(segment.begin);
  json["end"] = io::ToSeconds(segment.end);
  json["localized"] = segment.localized;
  if (segment.localized) {
    json["seconds_until_localized"] = segment.seconds;
    json["metres_until_localized"] = segment.metres;
  }
  json["jumps"] = segment.jumps;
  json["wrong_jumps"] = segment.wrong_jumps;
  json["translation_error"] = evaluation::ToJson(segment.translation_error);
  json["rotation_error_degrees"] =
      evaluation::ToJson(segment.rotation_error_degrees);
  json["fraction_within"] = segment.fraction_within;
  return json;
}

std::string ToText(const evaluation::LocalizationMetrics& metrics) {
  std::string text = absl::StrFormat(
      "Localised  in %d of %d segments; %d jumps after that, %d wrong places\n",
      metrics.num_localized(), metrics.segments.size(), metrics.num_jumps(),
      metrics.num_wrong_jumps());
  for (const evaluation::LocalizationSegment& segment : metrics.segments) {
    absl::StrAppendFormat(&text,
                          "  %.1f s to %.1f s: ", io::ToSeconds(segment.begin),
                          io::ToSeconds(segment.end));
    if (!segment.localized) {
      absl::StrAppend(&text, "never localised");
    } else {
      absl::StrAppendFormat(
          &text,
          "after %.1f s and %.1f m; then %.3f m off (largest %.3f m), %.1f %% "
          "of the scans within %g m and %g deg",
          segment.seconds, segment.metres, segment.translation_error.rmse,
          segment.translation_error.max, 100. * segment.fraction_within,
          FLAGS_translation_tolerance, FLAGS_rotation_tolerance);
    }
    absl::StrAppendFormat(&text, "; %d jumps, %d wrong places\n", segment.jumps,
                          segment.wrong_jumps);
  }
  return text;
}

absl::Status Run() {
  const absl::Status writable = tools::CheckWritable({FLAGS_json});
  if (!writable.ok()) return writable;
  auto pairs =
      ReadPairs(FLAGS_trajectory_filename, FLAGS_reference_trajectory_filename);
  if (!pairs.ok()) return pairs.status();
  if (!FLAGS_map_trajectory_filename.empty()) {
    const auto map_pairs = ReadPairs(FLAGS_map_trajectory_filename,
                                     FLAGS_map_reference_trajectory_filename);
    if (!map_pairs.ok()) return map_pairs.status();
    if (map_pairs->size() < 2) {
      return absl::InvalidArgumentError(
          absl::StrCat(FLAGS_map_trajectory_filename, ": only ",
                       map_pairs->size(), " poses have a ground truth pose"));
    }
    // The reference trajectory in the frame of the map.
    const Pose2 map_from_truth = evaluation::AlignInPlane(*map_pairs).Inverse();
    for (evaluation::PosePair& pair : *pairs) {
      pair.reference = map_from_truth * pair.reference;
    }
  }
  evaluation::LocalizationOptions options;
  options.translation_tolerance = FLAGS_translation_tolerance;
  options.rotation_tolerance = DegToRad(FLAGS_rotation_tolerance);
  options.hold_seconds = FLAGS_hold_seconds;
  options.jump_distance = FLAGS_jump_distance;
  options.carried_distance = FLAGS_carried_distance;
  const auto metrics = evaluation::ComputeLocalizationMetrics(*pairs, options);
  if (!metrics.ok()) {
    return absl::Status(metrics.status().code(),
                        absl::StrCat(FLAGS_trajectory_filename, ": ",
                                     metrics.status().message()));
  }
  if (FLAGS_json != "-") std::cout << ToText(*metrics);
  if (FLAGS_json.empty()) return absl::OkStatus();
  nlohmann::ordered_json json;
  json["scans"] = metrics->num_scans;
  json["localized"] = metrics->num_localized();
  json["jumps"] = metrics->num_jumps();
  json["wrong_jumps"] = metrics->num_wrong_jumps();
  json["segments"] = nlohmann::ordered_json::array();
  for (const evaluation::LocalizationSegment& segment : metrics->segments) {
    json["segments"].push_back(ToJson(segment));
  }
  return tools::WriteJson(json, FLAGS_json);
}

}  // namespace
}  // namespace cartographer_ext

int main(int argc, char** argv) {
  using namespace cartographer_ext;  // NOLINT
  tools::CommandLine(kDescription).Parse(argc, argv);
  if (FLAGS_trajectory_filename.empty() ||
      FLAGS_reference_trajectory_filename.empty()) {
    return tools::UsageError(
        "-trajectory_filename and -reference_trajectory_filename are needed");
  }
  if (FLAGS_map_trajectory_filename.empty() !=
      FLAGS_map_reference_trajectory_filename.empty()) {
    return tools::UsageError(
        "-map_trajectory_filename and -map_reference_trajectory_filename go "
        "together");
  }
  if (!(FLAGS_translation_tolerance > 0.) || !(FLAGS_rotation_tolerance > 0.) ||
      !(FLAGS_hold_seconds >= 0.) || !(FLAGS_jump_distance > 0.) ||
      !(FLAGS_carried_distance > 0.) || !(FLAGS_stamp_tolerance >= 0.)) {
    return tools::UsageError(
        "tolerances and distances must be above 0, -hold_seconds and "
        "-stamp_tolerance not negative");
  }
  return tools::ExitCode(Run());
}
