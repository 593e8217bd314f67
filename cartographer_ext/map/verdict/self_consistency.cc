// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
#include "cartographer_ext/map/verdict/self_consistency.h"

#include <algorithm>
#include <limits>

#include "absl/strings/str_cat.h"
#include "absl/strings/str_format.h"
#include "absl/strings/str_join.h"
#include "cartographer_ext/map/verdict/evaluation_report.h"

namespace cartographer_ext {
namespace evaluation {
namespace {

using nlohmann::ordered_json;

constexpr size_t kMaxNamedPlaces = 5;
constexpr size_t kMaxNamedTurns = 3;

// Share of the nodes that must revisit a place before a map without
// contradictions is called sound. A map torn apart has hardly any overlap, and
// so no contradictions.
constexpr double kMinJudgedShare = 0.15;

io::TimeNs StartTime(const MapGraph& graph) {
  io::TimeNs start = std::numeric_limits<io::TimeNs>::max();
  for (const auto& node : graph.nodes) {
    start = std::min(start, node.second.time);
  }
  return graph.nodes.empty() ? 0 : start;
}

std::string Submaps(const std::vector<GraphId>& ids) {
  constexpr size_t kMaxNamed = 4;
  std::vector<std::string> names;
  for (size_t i = 0; i < std::min(ids.size(), kMaxNamed); ++i) {
    names.push_back(ToString(ids[i]));
  }
  return absl::StrCat(
      ids.size() == 1 ? "submap " : "submaps ", absl::StrJoin(names, ", "),
      ids.size() > kMaxNamed
          ? absl::StrCat(" and ", ids.size() - kMaxNamed, " more")
          : "");
}

std::string Place(const Eigen::Vector2d& place) {
  return absl::StrFormat("x = %.1f m, y = %.1f m", place.x(), place.y());
}

// The verdict in a sentence.
std::string Headline(const MapGraph& graph, const SelfConsistency& result) {
  const io::TimeNs start = StartTime(graph);
  if (result.word == "unknown") {
    return result.contradictions.judged_nodes == 0
               ? "no place was mapped twice, so consistency cannot be checked"
               : "hardly any place was mapped twice, so consistency can hardly "
                 "be checked";
  }
  if (result.word == "sound") {
    return "the map is self-consistent: places that were mapped twice coincide";
  }
  std::string sentence;
  if (!result.severe.empty()) {
    sentence =
        absl::StrCat(result.word == "broken"
                         ? "parts of the map overlap inconsistently, worst at "
                         : "parts of the map overlap inconsistently at ",
                     Place(result.severe.front().center));
  }
  if (!result.wrong_turns.empty()) {
    const MotionStep& step = result.wrong_turns.front();
    absl::StrAppendFormat(
        &sentence, "%slocal SLAM %s %.1f s after the start (stamp %.1f), at %s",
        sentence.empty() ? "" : "; ",
        sentence.empty() ? "may have lost track" : "probably lost track",
        io::ToSeconds(step.time - start), io::ToSeconds(step.time),
        Place(graph.nodes.at(step.node_id).global_pose.translation()));
  }
  return sentence;
}

// What is wrong, in order of weight.
void Explain(const MapGraph& graph, SelfConsistency* const result) {
  const io::TimeNs start = StartTime(graph);
  result->reasons.push_back(Headline(graph, *result));
  const Contradictions& contradictions = result->contradictions;
  if (contradictions.judged_nodes > 0) {
    result->reasons.push_back(absl::StrFormat(
        "%.1f %% of the %d nodes that revisit a place have most of their scan "
        "in free space or behind walls mapped there at another time",
        100. * result->severe_share, contradictions.judged_nodes));
  }
  for (size_t i = 0; i < std::min(result->severe.size(), kMaxNamedPlaces);
       ++i) {
    const ConflictPiece& piece = result->severe[i];
    result->reasons.push_back(absl::StrFormat(
        "near x = %.1f m, y = %.1f m: nodes %s to %s (%.1f s to %.1f s after "
        "the start) contradict %s by %.0f %% of their rays",
        piece.center.x(), piece.center.y(), ToString(piece.first_node),
        ToString(piece.last_node), io::ToSeconds(piece.begin - start),
        io::ToSeconds(piece.end - start), Submaps(piece.submaps),
        100. * piece.fraction));
  }
  for (size_t i = 0; i < std::min(result->wrong_turns.size(), kMaxNamedTurns);
       ++i) {
    const MotionStep& step = result->wrong_turns[i];
    const GraphNode& node = graph.nodes.at(step.node_id);
    result->reasons.push_back(absl::StrFormat(
        "local SLAM and odometry differ by %.0f degrees in the %.2f s before "
        "node %s (%.1f s after the start, stamp %.1f), near x = %.1f m, "
        "y = %.1f m",
        RadToDeg(step.odometry_rotation), step.seconds, ToString(step.node_id),
        io::ToSeconds(step.time - start), io::ToSeconds(step.time),
        node.global_pose.x, node.global_pose.y));
  }
  if (result->sharpness.single_visit_thickness.count > 0) {
    result->reasons.push_back(absl::StrFormat(
        "walls seen in several visits are %.0f %% thicker than those of one "
        "visit (%.1f cm against %.1f cm)",
        100. *
            (result->sharpness.revisited_thickness.mean /
                 std::max(1e-6, result->sharpness.single_visit_thickness.mean) -
             1.),
        100. * result->sharpness.revisited_thickness.mean,
        100. * result->sharpness.single_visit_thickness.mean));
  }
  if (result->cycles.cycles > 0) {
    result->reasons.push_back(absl::StrFormat(
        "%.1f %% of %d short cycles of two loops are open",
        100. * result->cycles.fraction(), result->cycles.cycles));
  }
}

// Of steps within this time of each other, in order of time, the largest one.
void KeepWorstOfEach(const io::TimeNs span, std::vector<MotionStep>* steps) {
  std::vector<MotionStep> kept;
  io::TimeNs last = std::numeric_limits<io::TimeNs>::min();
  for (const MotionStep& step : *steps) {
    const bool same =
        !kept.empty() &&
        kept.back().node_id.trajectory_id == step.node_id.trajectory_id &&
        step.time - last <= span;
    last = step.time;
    if (!same) {
      kept.push_back(step);
    } else if (step.odometry_rotation > kept.back().odometry_rotation) {
      kept.back() = step;
    }
  }
  steps->swap(kept);
}

}  // namespace

SelfConsistency AssessSelfConsistency(const MapGraph& graph,
                                      const MapContents& contents,
                                      const std::map<int, Trajectory>& odometry,
                                      const SelfConsistencyOptions& options) {
  SelfConsistency result;
  result.contradictions =
      FindContradictions(graph, contents, options.contradiction);
  result.sharpness = ComputeSharpness(graph, contents, options.sharpness);
  result.motion = CompareMotions(graph, odometry);
  result.cycles = ComputeLoopCycles(graph, options.cycles);
  int64_t severe_nodes = 0;
  for (const ConflictPiece& piece : result.contradictions.pieces) {
    if (piece.fraction < options.severe_fraction ||
        piece.num_nodes < options.min_severe_nodes) {
      continue;
    }
    severe_nodes += piece.num_nodes;
    result.severe.push_back(piece);
  }
  std::stable_sort(result.severe.begin(), result.severe.end(),
                   [](const ConflictPiece& a, const ConflictPiece& b) {
                     return a.num_nodes * a.fraction > b.num_nodes * b.fraction;
                   });
  for (const MotionStep& step : result.motion.steps) {
    if (step.has_odometry && step.odometry_rotation > options.wrong_turn &&
        step.lasting_rotation > 0.5 * step.odometry_rotation) {
      result.wrong_turns.push_back(step);
    }
  }
  KeepWorstOfEach(options.same_turn, &result.wrong_turns);
  std::stable_sort(result.wrong_turns.begin(), result.wrong_turns.end(),
                   [](const MotionStep& a, const MotionStep& b) {
                     return a.odometry_rotation > b.odometry_rotation;
                   });
  const int64_t judged = result.contradictions.judged_nodes;
  if (judged > 0) {
    result.severe_share =
        static_cast<double>(severe_nodes) / static_cast<double>(judged);
  }
  const bool turned = !result.wrong_turns.empty();
  if (result.severe_share >= options.broken_share ||
      (result.severe_share >= options.doubtful_share && turned)) {
    result.word = "broken";
  } else if (result.severe_share >= options.doubtful_share || turned) {
    result.word = "doubtful";
  } else {
    const auto nodes = static_cast<double>(result.contradictions.nodes.size());
    const bool is_checked =
        static_cast<double>(judged) >= std::max(1., kMinJudgedShare * nodes);
    result.word = is_checked ? "sound" : "unknown";
  }
  Explain(graph, &result);
  return result;
}

ordered_json ToJson(const SelfConsistency& consistency) {
  const Contradictions& contradictions = consistency.contradictions;
  ordered_json json;
  json["verdict"] = consistency.word;
  json["reasons"] = consistency.reasons;
  json["severe_share"] = consistency.severe_share;
  json["judged_nodes"] = contradictions.judged_nodes;
  json["conflict_nodes"] = contradictions.conflict_nodes;
  json["contradicted_rays"] = contradictions.ray_fraction();
  json["places"] = ordered_json::array();
  for (const ConflictPiece& piece : consistency.severe) {
    ordered_json submaps = ordered_json::array();
    for (const GraphId& id : piece.submaps) submaps.push_back(ToString(id));
    json["places"].push_back({{"x", piece.center.x()},
                              {"y", piece.center.y()},
                              {"begin_seconds", io::ToSeconds(piece.begin)},
                              {"end_seconds", io::ToSeconds(piece.end)},
                              {"first_node", ToString(piece.first_node)},
                              {"last_node", ToString(piece.last_node)},
                              {"nodes", piece.num_nodes},
                              {"metres", piece.metres},
                              {"fraction", piece.fraction},
                              {"submaps", submaps}});
  }
  json["wrong_turns"] = ordered_json::array();
  for (const MotionStep& step : consistency.wrong_turns) {
    json["wrong_turns"].push_back(
        {{"node", ToString(step.node_id)},
         {"time", io::ToSeconds(step.time)},
         {"seconds", step.seconds},
         {"degrees", RadToDeg(step.odometry_rotation)},
         {"metres", step.odometry_translation}});
  }
  const Sharpness& sharpness = consistency.sharpness;
  json["mean_map_entropy"] = sharpness.mean_entropy;
  json["wall_thickness"] = ToJson(sharpness.wall_thickness);
  json["wall_thickness_single_visit"] =
      ToJson(sharpness.single_visit_thickness);
  json["wall_thickness_revisited"] = ToJson(sharpness.revisited_thickness);
  json["wall_doubling"] = sharpness.doubling;
  json["loop_cycles"] = {
      {"count", consistency.cycles.cycles},
      {"inconsistent", consistency.cycles.inconsistent},
      {"translation", ToJson(consistency.cycles.translation)},
      {"rotation_degrees", ToJson(consistency.cycles.rotation_degrees)}};
  const MotionDisagreement& motion = consistency.motion;
  json["bend"] = {{"translation", ToJson(motion.bend_translation)},
                  {"rotation_degrees", ToJson(motion.bend_rotation_degrees)}};
  json["odometry_disagreement"] = {
      {"translation", ToJson(motion.odometry_translation)},
      {"rotation_degrees", ToJson(motion.odometry_rotation_degrees)}};
  return json;
}

std::string ToText(const SelfConsistency& consistency) {
  const Sharpness& sharpness = consistency.sharpness;
  std::string text = absl::StrFormat(
      "Self-consistency   rays contradicted %.2f %%, severe %.2f %% of %d "
      "nodes, entropy %.3f,\n"
      "        walls %.1f cm (one visit %.1f cm, all %.1f cm), open cycles "
      "%.1f %% of %d,\n",
      100. * consistency.contradictions.ray_fraction(),
      100. * consistency.severe_share, consistency.contradictions.judged_nodes,
      sharpness.mean_entropy, 100. * sharpness.wall_thickness.mean,
      100. * sharpness.single_visit_thickness.mean,
      100. * sharpness.revisited_thickness.mean,
      100. * consistency.cycles.fraction(), consistency.cycles.cycles);
  const MotionDisagreement& motion = consistency.motion;
  if (motion.odometry_translation.count == 0) {
    absl::StrAppend(&text, "        no odometry\n");
  } else {
    absl::StrAppendFormat(&text, "        odometry %.3f m %.3f deg per node\n",
                          motion.odometry_translation.mean,
                          motion.odometry_rotation_degrees.mean);
  }
  return text;
}

}  // namespace evaluation
}  // namespace cartographer_ext
