// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
// LINK: evaluation
//
// cartographer_ext_evaluate: how good is a map?
#include <iostream>
#include <string>
#include <vector>

#include "absl/status/status.h"
#include "absl/status/statusor.h"
#include "absl/strings/str_cat.h"
#include "absl/strings/str_format.h"
#include "cartographer_ext/common/atomic_file.h"
#include "cartographer_ext/evaluation/decision_table.h"
#include "cartographer_ext/evaluation/evaluation_report.h"
#include "cartographer_ext/evaluation/loop_statistics.h"
#include "cartographer_ext/evaluation/map_graph.h"
#include "cartographer_ext/evaluation/pbstream_map.h"
#include "cartographer_ext/evaluation/relations_metric.h"
#include "cartographer_ext/evaluation/trajectory_metrics.h"
#include "cartographer_ext/io/pbstream_reader.h"
#include "cartographer_ext/io/relations_file.h"
#include "cartographer_ext/io/trajectory_file.h"
#include "cartographer_ext/tools/command_line.h"
#include "gflags/gflags.h"
#include "nlohmann/json.hpp"

DEFINE_string(pbstream_filename, "",
              "Map to judge. Its poses are those of the nodes, interpolated in "
              "time between them, as Cartographer's own tool does.");
DEFINE_string(trajectory_filename, "",
              "Estimated trajectory (TUM) with a pose at every scan, as "
              "cartographer_ext_slam writes. Stamps are matched to the nearest "
              "within -stamp_tolerance, else interpolated. With both, this one "
              "is judged, and the map tells about the loops.");
DEFINE_string(relations_filename, "",
              "Reference relations: t1 t2 x y z roll pitch yaw a line.");
DEFINE_string(reference_trajectory_filename, "", "Reference trajectory (TUM).");
DEFINE_int32(trajectory_id, 0,
             "Which trajectory of the map is compared with the truth.");
DEFINE_double(stamp_tolerance, 0.001,
              "Seconds within which stamps are the same scan.");
DEFINE_double(rpe_distance, 1.,
              "Length in metres of the stretches of the relative error.");
DEFINE_double(loop_tolerance, 0.5,
              "Metres that a loop may be off the truth to count as right.");
DEFINE_string(constraints_filename, "",
              "Output: CSV of all constraints with residuals and, where there "
              "is truth, verdicts.");
DEFINE_string(relation_errors_filename, "",
              "Output: CSV of the error of every relation.");
DEFINE_string(json, "", "Output: all numbers as JSON; - is standard output.");

namespace cartographer_ext {
namespace {

constexpr char kDescription[] =
    R"(Judges a map: relations metric, trajectory error, loops right and wrong.

  cartographer_ext_evaluate -pbstream_filename=map.pbstream
  cartographer_ext_evaluate -pbstream_filename=map.pbstream
      -trajectory_filename=run.tum -relations_filename=aces.relations
  cartographer_ext_evaluate -trajectory_filename=run.tum
      -reference_trajectory_filename=truth.tum -json=-

Without truth the loops of the map are held against the optimised map. The
relations metric is that of Cartographer's compute_relations_metrics; relations
more than a minute apart close loops and are listed on their own, because a
folded map looks fine on the others.)";

struct Inputs {
  absl::optional<evaluation::MapGraph> graph;
  absl::optional<evaluation::Trajectory> trajectory;
  absl::optional<std::vector<evaluation::Relation>> relations;
  absl::optional<evaluation::Trajectory> reference;
};

absl::Status ReadInputs(Inputs* const inputs) {
  if (!FLAGS_pbstream_filename.empty()) {
    const auto pbstream = io::ReadPbstream(FLAGS_pbstream_filename);
    if (!pbstream.ok()) return pbstream.status();
    inputs->graph = evaluation::MakeMapGraph(*pbstream);
  }
  if (!FLAGS_trajectory_filename.empty()) {
    auto poses = io::ReadTumTrajectory(FLAGS_trajectory_filename);
    if (!poses.ok()) return poses.status();
    inputs->trajectory = evaluation::Trajectory(*std::move(poses));
  }
  if (!FLAGS_relations_filename.empty()) {
    auto relations = io::ReadRelations(FLAGS_relations_filename);
    if (!relations.ok()) return relations.status();
    inputs->relations = *std::move(relations);
  }
  if (!FLAGS_reference_trajectory_filename.empty()) {
    auto poses = io::ReadTumTrajectory(FLAGS_reference_trajectory_filename);
    if (!poses.ok()) return poses.status();
    inputs->reference = evaluation::Trajectory(*std::move(poses));
  }
  return absl::OkStatus();
}

absl::Status Annotate(const absl::Status& status, const std::string& file) {
  return absl::Status(status.code(),
                      absl::StrCat(file, ": ", status.message()));
}

absl::Status EvaluateRelations(const Inputs& inputs,
                               const evaluation::Trajectory& nodes,
                               evaluation::Evaluation* const result) {
  evaluation::RelationsMetricOptions options;
  options.stamp_tolerance = io::FromSeconds(FLAGS_stamp_tolerance);
  evaluation::RelationsMetricOptions interpolate = options;
  interpolate.stamp_tolerance = 0;
  const bool has_trajectory = inputs.trajectory.has_value();
  auto metric = has_trajectory
                    ? evaluation::ComputeRelationsMetric(
                          *inputs.trajectory, *inputs.relations, options)
                    : evaluation::ComputeRelationsMetric(
                          nodes, *inputs.relations, interpolate);
  if (!metric.ok()) {
    return Annotate(metric.status(), FLAGS_relations_filename);
  }
  result->relations = *std::move(metric);
  if (has_trajectory && !nodes.empty()) {
    auto at_nodes = evaluation::ComputeRelationsMetric(nodes, *inputs.relations,
                                                       interpolate);
    if (at_nodes.ok()) result->node_relations = *std::move(at_nodes);
  }
  return absl::OkStatus();
}

evaluation::LoopStatistics EvaluateLoops(const Inputs& inputs) {
  evaluation::LoopStatisticsOptions options;
  options.correct_translation = FLAGS_loop_tolerance;
  options.stamp_tolerance = io::FromSeconds(FLAGS_stamp_tolerance);
  if (inputs.reference.has_value()) {
    return evaluation::ComputeLoopStatistics(*inputs.graph, *inputs.reference,
                                             options);
  }
  if (inputs.relations.has_value()) {
    return evaluation::ComputeLoopStatistics(*inputs.graph, *inputs.relations,
                                             options);
  }
  return evaluation::ComputeLoopStatistics(*inputs.graph);
}

std::string RelationErrorTable(const evaluation::RelationsMetric& metric) {
  std::string table =
      "time1,time2,is_loop,translation_error,rotation_error_degrees\n";
  for (const evaluation::RelationError& error : metric.errors) {
    absl::StrAppendFormat(&table, "%.6f,%.6f,%d,%.6f,%.6f\n",
                          io::ToSeconds(error.time1),
                          io::ToSeconds(error.time2), error.is_loop ? 1 : 0,
                          error.translation, RadToDeg(error.rotation));
  }
  return table;
}

absl::Status Run() {
  const absl::Status writable = tools::CheckWritable(
      {FLAGS_constraints_filename, FLAGS_relation_errors_filename, FLAGS_json});
  if (!writable.ok()) return writable;
  Inputs inputs;
  const absl::Status read = ReadInputs(&inputs);
  if (!read.ok()) return read;

  evaluation::Evaluation result;
  evaluation::Trajectory nodes;
  if (inputs.graph.has_value()) {
    nodes = inputs.graph->GlobalTrajectory(FLAGS_trajectory_id);
    if (nodes.empty()) {
      return absl::InvalidArgumentError(
          absl::StrCat(FLAGS_pbstream_filename, ": trajectory ",
                       FLAGS_trajectory_id, " has no nodes"));
    }
  }
  const evaluation::Trajectory& estimate =
      inputs.trajectory.has_value() ? *inputs.trajectory : nodes;
  result.trajectory_metres = estimate.Length();
  if (inputs.relations.has_value()) {
    const absl::Status status = EvaluateRelations(inputs, nodes, &result);
    if (!status.ok()) return status;
  }
  if (inputs.reference.has_value()) {
    evaluation::TrajectoryMetricsOptions options;
    options.stamp_tolerance = io::FromSeconds(FLAGS_stamp_tolerance);
    options.rpe_distance = FLAGS_rpe_distance;
    auto errors = evaluation::ComputeTrajectoryErrors(
        estimate, *inputs.reference, options);
    if (!errors.ok()) {
      return Annotate(errors.status(), FLAGS_reference_trajectory_filename);
    }
    result.trajectory = *std::move(errors);
  }
  if (inputs.graph.has_value()) result.loops = EvaluateLoops(inputs);

  if (!FLAGS_constraints_filename.empty()) {
    const absl::Status status = WriteFileAtomically(
        FLAGS_constraints_filename,
        evaluation::ConstraintTable(*inputs.graph, &*result.loops));
    if (!status.ok()) return status;
  }
  if (!FLAGS_relation_errors_filename.empty()) {
    const absl::Status status = WriteFileAtomically(
        FLAGS_relation_errors_filename, RelationErrorTable(*result.relations));
    if (!status.ok()) return status;
  }
  if (FLAGS_json != "-") std::cout << evaluation::ToText(result);
  if (FLAGS_json.empty()) return absl::OkStatus();
  nlohmann::ordered_json json;
  json["pbstream"] = FLAGS_pbstream_filename;
  json["trajectory"] = FLAGS_trajectory_filename;
  json.update(evaluation::ToJson(result));
  return tools::WriteJson(json, FLAGS_json);
}

}  // namespace
}  // namespace cartographer_ext

int main(int argc, char** argv) {
  using namespace cartographer_ext;  // NOLINT
  tools::CommandLine(kDescription).Parse(argc, argv);
  if (FLAGS_pbstream_filename.empty() && FLAGS_trajectory_filename.empty()) {
    return tools::UsageError(
        "-pbstream_filename or -trajectory_filename is needed");
  }
  if (FLAGS_pbstream_filename.empty() && FLAGS_relations_filename.empty() &&
      FLAGS_reference_trajectory_filename.empty()) {
    return tools::UsageError(
        "a trajectory alone tells nothing: -relations_filename or "
        "-reference_trajectory_filename is needed");
  }
  if (!FLAGS_constraints_filename.empty() && FLAGS_pbstream_filename.empty()) {
    return tools::UsageError("-constraints_filename needs -pbstream_filename");
  }
  if (!FLAGS_relation_errors_filename.empty() &&
      FLAGS_relations_filename.empty()) {
    return tools::UsageError(
        "-relation_errors_filename needs -relations_filename");
  }
  if (!(FLAGS_stamp_tolerance >= 0.) || !(FLAGS_rpe_distance > 0.) ||
      !(FLAGS_loop_tolerance > 0.)) {
    return tools::UsageError(
        "-stamp_tolerance must not be negative, -rpe_distance and "
        "-loop_tolerance must be above 0");
  }
  return tools::ExitCode(Run());
}
