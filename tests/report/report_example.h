// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
//
// A little map for the parts of the report, put together by hand: five nodes a
// metre apart along x in one submap, a second submap, and three loops of which
// the second is off by two metres.
#ifndef TESTS_REPORT_REPORT_EXAMPLE_H_
#define TESTS_REPORT_REPORT_EXAMPLE_H_

#include <string>
#include <vector>

#include "cartographer_ext/report/report_data.h"
#include "cartographer_ext/report/sections.h"

namespace cartographer_ext {
namespace report {
namespace test {

constexpr io::TimeNs kSecond = 1000000000LL;

inline evaluation::MapGraph ExampleGraph() {
  evaluation::MapGraph graph;
  for (int i = 0; i < 5; ++i) {
    evaluation::GraphNode& node = graph.nodes[{0, i}];
    node.time = (100 + i) * kSecond;
    node.local_pose = Pose2(i, 0., 0.);
    node.global_pose = Pose2(i, 0., 0.);
  }
  for (int s = 0; s < 2; ++s) {
    evaluation::GraphSubmap& submap = graph.submaps[{0, s}];
    submap.local_pose = submap.global_pose = Pose2(2. * s, 0., 0.);
    submap.finished = true;
  }
  for (int i = 2; i < 5; ++i) {
    evaluation::GraphConstraint loop;
    loop.submap_id = {0, 0};
    loop.node_id = {0, i};
    loop.relative_pose = Pose2(i, i == 3 ? 2. : 0., 0.);
    loop.is_loop = true;
    graph.constraints.push_back(loop);
  }
  return graph;
}

inline ReportRun ExampleRun(const std::string& name, const std::string& style) {
  ReportRun run;
  run.name = name;
  run.style = style;
  run.graph = ExampleGraph();
  run.evaluation.trajectory_metres = 4.;
  run.evaluation.loops = evaluation::ComputeLoopStatistics(run.graph);
  return run;
}

// A rejected candidate and a skipped one, and the record of the first loop.
inline evaluation::Rerun ExampleRerun() {
  evaluation::Rerun rerun;
  rerun.name = "ours";
  rerun.searches = 4;
  rerun.matches = 2;
  rerun.wall_seconds = 3.25;
  rerun.cpu_seconds = 2.5;
  rerun.peak_memory_bytes = 5 << 20;
  proto::LoopDecision accepted;
  accepted.set_node_index(2);
  accepted.set_verdict(proto::LoopDecision::ACCEPTED);
  accepted.set_reason(proto::LoopDecision::CONFIRMED_BY_SUBSET);
  accepted.mutable_search()->set_grid_score(0.8);
  accepted.mutable_temporal()->set_score(0.9);
  accepted.mutable_temporal()->set_threshold(0.4);
  accepted.mutable_fusion()->set_final_score(0.95);
  accepted.mutable_subset()->set_support(3);
  rerun.decisions.push_back(accepted);
  proto::LoopDecision rejected;
  rejected.set_submap_index(1);
  rejected.set_node_index(4);
  rejected.set_verdict(proto::LoopDecision::REJECTED);
  rejected.set_reason(proto::LoopDecision::LOW_TEMPORAL_SCORE);
  rejected.mutable_search()->set_grid_score(0.6);
  rejected.mutable_search()->mutable_refined()->set_x(7.);
  rejected.mutable_temporal()->set_score(0.2);
  rejected.mutable_temporal()->set_threshold(0.4);
  rerun.decisions.push_back(rejected);
  proto::LoopDecision skipped;
  skipped.set_node_index(1);
  skipped.set_verdict(proto::LoopDecision::REJECTED);
  skipped.set_reason(proto::LoopDecision::SKIPPED_BUDGET);
  rerun.decisions.push_back(skipped);
  return rerun;
}

// Two of the five nodes contradict submap 1, and the wheels turned otherwise
// before node 3.
inline evaluation::SelfConsistency ExampleConsistency() {
  evaluation::SelfConsistency consistency;
  consistency.word = "broken";
  consistency.reasons = {"nodes contradict the map"};
  consistency.severe_share = 0.4;
  evaluation::PathPiece piece;
  piece.first_node = {0, 1};
  piece.last_node = {0, 2};
  piece.begin = 101 * kSecond;
  piece.end = 102 * kSecond;
  piece.num_nodes = 2;
  piece.center = {1.5, 0.};
  piece.metres = 1.;
  piece.submaps = {{0, 1}};
  piece.fraction = 0.75;
  consistency.places = {piece};
  for (int i = 0; i < 5; ++i) {
    evaluation::NodeContradiction node;
    node.node_id = {0, i};
    node.time = (100 + i) * kSecond;
    node.worst_fraction = i == 1 || i == 2 ? 0.75 : 0.;
    consistency.contradictions.nodes.push_back(node);
  }
  evaluation::MotionStep step;
  step.node_id = {0, 3};
  step.time = 103 * kSecond;
  step.has_odometry = true;
  step.odometry_rotation = DegToRad(40.);
  consistency.motion.steps = {step};
  consistency.motion.odometry_translation.count = 1;
  consistency.wrong_turns = {step};
  consistency.cycles.cycles = 2;
  consistency.cycles.inconsistent = 1;
  consistency.cycles.inconsistent_fraction = {0., 0.5, 0.};
  consistency.cycles.partners = {1, 2, 1};
  return consistency;
}

// The map as stored, and, with `and_ours`, a run of ours over it.
inline ReportData ExampleData(const bool and_ours) {
  static const evaluation::MapContents* const contents =
      new evaluation::MapContents;
  ReportData data;
  data.title = "example";
  data.command_line = "evaluate <map>";
  data.contents = contents;
  data.runs.push_back(ExampleRun("as stored", "s1"));
  if (!and_ours) return data;
  data.runs.push_back(ExampleRun("ours", "s3"));
  data.runs.back().graph.constraints.pop_back();
  data.runs.back().rerun = ExampleRerun();
  data.runs.back().against_stored =
      evaluation::CompareLoops(data.runs[0].graph, data.runs[1].graph, {});
  return data;
}

inline Prepared Prepare(const ReportData& data) {
  Prepared prepared;
  for (const ReportRun& run : data.runs) {
    prepared.evidence.push_back(CollectEvidence(run, *data.contents));
    prepared.image_ids.emplace_back();
  }
  prepared.bounds.Add(Eigen::Vector2d(-1., -5.));
  prepared.bounds.Add(Eigen::Vector2d(9., 5.));
  prepared.start = 100 * kSecond;
  return prepared;
}

inline size_t Count(const std::string& text, const std::string& part) {
  size_t count = 0;
  for (size_t at = text.find(part); at != std::string::npos;
       at = text.find(part, at + part.size())) {
    ++count;
  }
  return count;
}

}  // namespace test
}  // namespace report
}  // namespace cartographer_ext

#endif  // TESTS_REPORT_REPORT_EXAMPLE_H_
