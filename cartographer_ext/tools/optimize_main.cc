// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
// LINK: experiments
//
// cartographer_ext_optimize: solves a pose graph whose loops may be wrong.
#include <algorithm>
#include <iostream>
#include <numeric>
#include <string>
#include <vector>

#include "absl/strings/match.h"
#include "absl/strings/str_cat.h"
#include "absl/strings/str_format.h"
#include "absl/strings/str_join.h"
#include "absl/types/optional.h"
#include "cartographer_ext/common/atomic_file.h"
#include "cartographer_ext/common/order_statistics.h"
#include "cartographer_ext/experiments/wrong_loops.h"
#include "cartographer_ext/io/pbstream/pbstream_reader.h"
#include "cartographer_ext/io/pbstream/pbstream_writer.h"
#include "cartographer_ext/io/trajectory_file.h"
#include "cartographer_ext/map/pbstream_map.h"
#include "cartographer_ext/map/pbstream_optimization.h"
#include "cartographer_ext/map/pose_graph_files.h"
#include "cartographer_ext/optimization/offline/graph_metrics.h"
#include "cartographer_ext/optimization/offline/optimize.h"
#include "cartographer_ext/optimization/solvers/edges_in_force.h"
#include "cartographer_ext/tools/command_line.h"
#include "gflags/gflags.h"

DEFINE_string(input_filename, "",
              "Graph: .g2o or TORO .graph (also .gz, .xz), or .pbstream.");
DEFINE_string(
    kernel, "auto",
    "none, huber, sc, gm, dcs, acs, acs_paper, gnc_tls, auto or r_isam.");
DEFINE_double(kernel_parameter, 0.,
              "Parameter of the kernel (w, P, b or c); 0: the usual value.");
DEFINE_string(
    norm, "spectral",
    "Norm |Lambda| of acs_paper: spectral, determinant, root or information.");
DEFINE_int32(max_iterations, 200, "Limit of the iterations of one solution.");
DEFINE_bool(prune, true, "Leave disabled loops out of the linear systems.");
DEFINE_bool(adaptive_gate, true,
            "auto, r_isam: make the final decision with a gate narrowed to the "
            "noise scale of the loops that agree. Never for a pbstream, whose "
            "weights are relative.");
DEFINE_bool(lowest_cost, true,
            "auto: return the solution with the lowest truncated cost that is "
            "closest to the decision of the adapted gate.");
DEFINE_bool(
    estimate_noise, true,
    "Estimate the noise scale of odometry and of loops; if the information "
    "matrices are overconfident, decide and report chi2 with it (key "
    "noise_scale: factors of the standard deviations). Never for a pbstream.");
DEFINE_bool(dead_reckoning, false,
            "Start from chained odometry instead of the file's poses.");
DEFINE_string(output_filename, "",
              "Optimised graph: .g2o, .tum (index as stamp, or the nodes of a "
              "pbstream) or, for a pbstream, .pbstream.");
DEFINE_bool(keep_rejected, true, "Keep rejected loops in an output pbstream.");
DEFINE_string(drop_loops, "",
              "Loops of a pbstream to remove before optimising, comma "
              "separated: submap_trajectory:submap:node_trajectory:node.");
DEFINE_int32(wrong_loops, 0,
             "pbstream: add this many wrong loops before optimising, as a "
             "test; they are the last lines of the verdicts.");
DEFINE_uint64(wrong_loops_seed, 1, "Seed of the wrong loops.");
DEFINE_double(loop_sigma, 0.1,
              "pbstream: standard deviation in metres that the weights of the "
              "loops represent.");
DEFINE_string(truth_filename, "",
              "Ground truth poses: g2o, or lines x y theta; matched by id, or "
              "along the path if ids do not agree.");
DEFINE_string(verdicts_filename, "", "Output: CSV, one line per loop.");
DEFINE_string(picture_filename, "",
              "Output: PNG, before and after side by side.");
DEFINE_string(json, "", "Output: the result as JSON; - is standard output.");

namespace cartographer_ext {
namespace {

constexpr char kDescription[] =
    R"(Optimises a pose graph and separates right loops from wrong ones.

  cartographer_ext_optimize -input_filename=graph.g2o -kernel=auto \
      -output_filename=optimised.g2o -verdicts_filename=loops.csv \
      -picture_filename=before_after.png -json=-
A finished map; rejected loops are removed from the new one:
  cartographer_ext_optimize -input_filename=map.pbstream -nokeep_rejected \
      -output_filename=better.pbstream
Remove one loop (ids as in the CSV of cartographer_ext_export) and solve again:
  cartographer_ext_optimize -input_filename=map.pbstream -kernel=huber \
      -drop_loops=0:12:0:1034 -output_filename=without.pbstream)";

// What was read.
struct Input {
  optimization::PoseGraph graph;
  absl::optional<io::Pbstream> pbstream;
  evaluation::MapPoseGraph map;  // with pbstream
};

absl::StatusOr<Input> ReadInput() {
  Input input;
  if (!absl::EndsWith(FLAGS_input_filename, ".pbstream")) {
    auto graph = evaluation::ReadPoseGraph(FLAGS_input_filename);
    if (!graph.ok()) return graph.status();
    input.graph = *std::move(graph);
    return input;
  }
  auto pbstream = io::ReadPbstream(FLAGS_input_filename);
  if (!pbstream.ok()) return pbstream.status();
  input.pbstream = *std::move(pbstream);
  const auto dropped = evaluation::FindLoops(
      evaluation::MakeMapGraph(*input.pbstream), FLAGS_drop_loops);
  if (!dropped.ok()) {
    return absl::IsInvalidArgument(dropped.status())
               ? tools::WrongUsage(dropped.status())
               : dropped.status();
  }
  evaluation::DropConstraints(*dropped, &*input.pbstream);
  evaluation::WrongLoopOptions wrong_loops;
  wrong_loops.count = FLAGS_wrong_loops;
  wrong_loops.seed = FLAGS_wrong_loops_seed;
  const auto added = evaluation::AddWrongLoops(wrong_loops, &*input.pbstream);
  if (!added.ok()) return added.status();
  evaluation::MapOptimizationOptions options;
  options.loop_sigma = FLAGS_loop_sigma;
  auto map = evaluation::MakeMapPoseGraph(
      evaluation::MakeMapGraph(*input.pbstream), options);
  if (!map.ok()) {
    return absl::Status(
        map.status().code(),
        absl::StrCat(FLAGS_input_filename, ": ", map.status().message()));
  }
  input.map = *std::move(map);
  input.graph = input.map.graph;
  return input;
}

absl::Status WriteTum(const Input& input, const std::vector<Pose2>& poses) {
  std::vector<io::StampedPose> trajectory;
  if (!input.pbstream.has_value()) {
    for (size_t i = 0; i != poses.size(); ++i) {
      trajectory.push_back(io::MakeStampedPose(
          static_cast<io::TimeNs>(i) * 1000000000, poses[i]));
    }
  } else {
    io::Pbstream moved = *input.pbstream;
    evaluation::StorePoses(input.map, poses, &moved);
    trajectory = evaluation::MakeMapGraph(moved).GlobalTrajectory().poses();
  }
  return io::WriteTumTrajectory(trajectory, FLAGS_output_filename);
}

absl::Status WriteOutput(const Input& input,
                         const optimization::OptimizeResult& result) {
  if (FLAGS_output_filename.empty()) return absl::OkStatus();
  if (absl::EndsWith(FLAGS_output_filename, ".tum")) {
    return WriteTum(input, result.poses);
  }
  if (!absl::EndsWith(FLAGS_output_filename, ".pbstream")) {
    return evaluation::WritePoseGraph(input.graph, result.poses,
                                      FLAGS_output_filename);
  }
  io::Pbstream output = *input.pbstream;
  evaluation::StorePoses(input.map, result.poses, &output);
  if (!FLAGS_keep_rejected) {
    std::vector<int> rejected;
    for (size_t i = 0; i != input.graph.edges.size(); ++i) {
      if (!result.accepted[i]) {
        rejected.push_back(input.map.constraint_of_edge[i]);
      }
    }
    evaluation::DropConstraints(rejected, &output);
  }
  return io::WritePbstream(output, FLAGS_output_filename);
}

nlohmann::ordered_json NoiseReport(const optimization::OptimizeResult& result) {
  nlohmann::ordered_json json;
  json["odometry"] = result.noise.odometry.factor;
  json["loops"] = result.noise.loops.factor;
  const auto interval = [](const optimization::ScaleEstimate& scale) {
    return nlohmann::ordered_json{
        {"low", scale.low},
        {"high", scale.high},
        {"degrees_of_freedom", scale.degrees_of_freedom}};
  };
  json["odometry_interval"] = interval(result.noise.odometry);
  json["loops_interval"] = interval(result.noise.loops);
  json["applied"] = {{"odometry", result.applied_odometry_scale},
                     {"loops", result.applied_loop_scale}};
  return json;
}

// Sets of loops that explain the graph as well as those in force, with another
// map or with the same.
nlohmann::ordered_json RivalReport(const optimization::PoseGraph& graph,
                                   const optimization::OptimizeResult& result,
                                   const bool moves_map) {
  const auto ends = [&](const std::vector<int>& edges) {
    nlohmann::ordered_json json = nlohmann::ordered_json::array();
    for (const int i : edges) {
      json.push_back({{"edge", i},
                      {"from", graph.ids[graph.edges[i].from]},
                      {"to", graph.ids[graph.edges[i].to]}});
    }
    return json;
  };
  nlohmann::ordered_json json = nlohmann::ordered_json::array();
  for (const optimization::RivalSets& rival : result.rivals) {
    if (rival.moves_map != moves_map) continue;
    json.push_back({{"cost_difference", rival.cost_difference},
                    {"largest_shift", rival.largest_shift},
                    {"deviation", rival.deviation},
                    {"is_likelier", rival.is_likelier},
                    {"only_in_force", ends(rival.only_in_force)},
                    {"only_in_rival", ends(rival.only_in_rival)}});
  }
  return json;
}

// Reports the distance between the maps that the data cannot tell apart.
void PrintRivals(const std::vector<optimization::RivalSets>& rivals) {
  for (const bool moves_map : {true, false}) {
    int count = 0;
    double shift = 0., deviation = 0.;
    for (const optimization::RivalSets& rival : rivals) {
      if (rival.moves_map != moves_map) continue;
      ++count;
      shift = std::max(shift, rival.largest_shift);
      deviation = std::max(deviation, rival.deviation);
    }
    if (count == 0) continue;
    std::cout << absl::StrFormat(
        moves_map
            ? "undecidable: %d other sets of loops explain the graph equally "
              "well and move poses by up to %.3g m (%.2g standard deviations)\n"
            : "%d other sets of loops explain the graph equally well and leave "
              "each pose where it is, within its uncertainty (at most %.3g m, "
              "%.2g standard deviations)\n",
        count, shift, deviation);
  }
  for (const optimization::RivalSets& rival : rivals) {
    if (!rival.moves_map || !rival.is_likelier) continue;
    std::cout << absl::StrFormat(
        "there is more evidence for one of these, which costs %.3g more: "
        "groups "
        "of loops fit into the map that costs less which may be wrong\n",
        rival.cost_difference);
  }
}

nlohmann::ordered_json Report(const optimization::PoseGraph& graph,
                              const optimization::OptimizeResult& result) {
  const int loops = optimization::CountLoops(graph.edges);
  const int accepted =
      optimization::CountLoopsInForce(graph.edges, result.accepted);
  nlohmann::ordered_json json;
  json["kernel"] = FLAGS_kernel;
  json["cpu_seconds"] = result.cpu_seconds;
  json["iterations"] = result.iterations;
  json["converged"] = result.converged;
  json["poses"] = graph.poses.size();
  json["loops"] = {
      {"total", loops}, {"accepted", accepted}, {"rejected", loops - accepted}};
  json["chi2"] = {{"odometry", result.odometry_chi2},
                  {"accepted_loops", result.accepted_loops_chi2},
                  {"gate", result.applied_gate},
                  {"truncated", result.truncated_chi2},
                  {"truncated_as_given", result.truncated_chi2_as_given}};
  if (!result.member.empty()) {
    json["member"] = result.member;
    json["chi2"]["truncated_of_member"] = result.member_truncated_chi2;
    json["undecidable"] = RivalReport(graph, result, true);
    json["same_map"] = RivalReport(graph, result, false);
  }
  json["noise_scale"] = NoiseReport(result);
  const std::vector<double>& steps = result.step_seconds;
  if (!steps.empty()) {
    json["step_milliseconds"] = {
        {"mean",
         1e3 * std::accumulate(steps.begin(), steps.end(), 0.) / steps.size()},
        {"p99", 1e3 * NearestRankQuantile(steps, 0.99)},
        {"max", 1e3 * NearestRankQuantile(steps, 1.)}};
  }
  return json;
}

absl::Status Run() {
  const absl::Status writable =
      tools::CheckWritable({FLAGS_output_filename, FLAGS_verdicts_filename,
                            FLAGS_picture_filename, FLAGS_json});
  if (!writable.ok()) return writable;
  optimization::OptimizeOptions options;
  options.method = FLAGS_kernel;
  options.parameter = FLAGS_kernel_parameter;
  options.max_iterations = FLAGS_max_iterations;
  options.prune = FLAGS_prune;
  const auto norm = optimization::CovarianceNormFromName(FLAGS_norm);
  if (!norm.ok()) return norm.status();
  options.norm = *norm;
  auto input = ReadInput();
  if (!input.ok()) return input.status();
  // Weights of a map are relative; their scale is a guess.
  options.adaptive_gate = FLAGS_adaptive_gate && !input->pbstream.has_value();
  options.smoother.adaptive_gate = options.adaptive_gate;
  options.lowest_cost = FLAGS_lowest_cost;
  options.estimate_noise = FLAGS_estimate_noise && !input->pbstream.has_value();
  options.measure_with_estimated_noise = options.estimate_noise;
  if (FLAGS_dead_reckoning) {
    input->graph.poses = optimization::DeadReckoning(input->graph);
  }
  const auto result = optimization::Optimize(input->graph, options);
  if (!result.ok()) {
    return absl::Status(
        result.status().code(),
        absl::StrCat(FLAGS_input_filename, ": ", result.status().message()));
  }
  nlohmann::ordered_json json = Report(input->graph, *result);
  if (!FLAGS_truth_filename.empty()) {
    const auto truth = evaluation::ReadTruth(input->graph, result->poses,
                                             FLAGS_truth_filename);
    if (!truth.ok()) return truth.status();
    json["ate"] = {
        {"rmse", optimization::AbsoluteTrajectoryError(result->poses, *truth)}};
    json["rpe"] = {{"mean", optimization::RelativePoseError(
                                input->graph.edges, result->poses, *truth)}};
  }
  absl::Status status = WriteOutput(*input, *result);
  if (status.ok() && !FLAGS_verdicts_filename.empty()) {
    status =
        WriteFileAtomically(FLAGS_verdicts_filename,
                            evaluation::VerdictTable(input->graph, *result));
  }
  if (status.ok() && !FLAGS_picture_filename.empty()) {
    status = evaluation::WriteComparisonPicture(
        input->graph, *result,
        absl::StrCat(tools::BaseName(FLAGS_input_filename), ", ", FLAGS_kernel),
        FLAGS_picture_filename);
  }
  if (!status.ok()) return status;
  if (FLAGS_json != "-") {
    PrintRivals(result->rivals);
    std::cout << absl::StrFormat(
        "%s: %d poses, %d of %d loops in force, truncated chi2 %.1f, %d "
        "iterations, %.3f s\n",
        FLAGS_kernel, json["poses"].get<int>(),
        json["loops"]["accepted"].get<int>(), json["loops"]["total"].get<int>(),
        result->truncated_chi2, result->iterations, result->cpu_seconds);
    if (json.contains("ate")) {
      std::cout << absl::StrFormat("ATE %.4f m\n",
                                   json["ate"]["rmse"].get<double>());
    }
  }
  return FLAGS_json.empty() ? absl::OkStatus()
                            : tools::WriteJson(json, FLAGS_json);
}

}  // namespace
}  // namespace cartographer_ext

int main(int argc, char** argv) {
  using namespace cartographer_ext;  // NOLINT
  tools::CommandLine command_line(kDescription, "input_filename");
  command_line.TakeOneOf("kernel", optimization::MethodNames());
  command_line.TakeOneOf("norm",
                         {"spectral", "determinant", "root", "information"});
  command_line.TakeEndings("output_filename", {".g2o", ".tum", ".pbstream"});
  command_line.Parse(argc, argv);
  if (FLAGS_input_filename.empty()) {
    return tools::UsageError("-input_filename is missing");
  }
  if (!absl::EndsWith(FLAGS_input_filename, ".pbstream")) {
    if (!FLAGS_drop_loops.empty() || FLAGS_wrong_loops > 0) {
      return tools::UsageError(
          "-drop_loops and -wrong_loops need a pbstream; for a g2o file "
          "cartographer_ext_robustness adds wrong loops");
    }
    if (absl::EndsWith(FLAGS_output_filename, ".pbstream")) {
      return tools::UsageError(
          "-output_filename: a pbstream can only be written if one is read");
    }
  }
  AtomicFileSet files;
  absl::Status status = Run();
  if (status.ok()) status = files.Commit();
  return tools::ExitCode(status);
}
