// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
#include "cartographer_ext/map/verdict/self_consistency.h"

#include <algorithm>
#include <iterator>
#include <limits>
#include <set>

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

bool HardlyRevisits(const Contradictions& contradictions,
                    const SelfConsistencyOptions& options) {
  return static_cast<double>(contradictions.judged_nodes) <
         std::max(1., options.judged_share *
                          static_cast<double>(contradictions.distinct_nodes));
}

std::string DescribeLoosePlaces(const MapGraph& graph,
                                const LoosePlaces& loose) {
  const auto worst =
      std::max_element(loose.places.begin(), loose.places.end(),
                       [](const LoosePlace& a, const LoosePlace& b) {
                         return a.sigma < b.sigma;
                       });
  return absl::StrFormat(
      "%s: nothing ties it closely to other parts that are within reach, so "
      "visits "
      "to one place may be drawn as two places; worst at %s (node %s, known to "
      "%.1f m, and %.1f m from node %s)",
      DescribeLooseShare(loose.share()),
      Place(graph.nodes.at(worst->node_id).global_pose.translation()),
      ToString(worst->node_id), worst->sigma, worst->distance,
      ToString(worst->other_id));
}

// The verdict in a sentence.
std::string Headline(const MapGraph& graph, const SelfConsistency& result,
                     const SelfConsistencyOptions& options) {
  const io::TimeNs start = StartTime(graph);
  if (result.word == "unknown") {
    if (result.contradictions.judged_nodes == 0) {
      return "no place was mapped twice, so consistency cannot be checked";
    }
    if (HardlyRevisits(result.contradictions, options)) {
      return "hardly any place was mapped twice, so consistency can hardly be "
             "checked";
    }
    return absl::StrFormat(
        "loops and places that were mapped twice tie no more than %.0f %% of "
        "the path together; nothing tells whether its parts are in place",
        100. * result.displacements.tied_share);
  }
  if (result.word == "doubtful" && result.places.empty() &&
      result.wrong_turns.empty()) {
    return "the map does not contradict itself, but too little ties its parts "
           "together to vouch for it";
  }
  if (result.word == "sound") {
    return result.contradictions.revisit_nodes > 0
               ? "the map is self-consistent: places that were mapped twice "
                 "coincide"
               : "the map is self-consistent: places coincide as they were "
                 "seen "
                 "from near and far on one visit; none was visited twice";
  }
  std::string sentence;
  if (!result.places.empty()) {
    const PathPiece& worst = result.places.front();
    if (!worst.is_displaced()) {
      sentence = absl::StrCat(
          result.word == "broken"
              ? "parts of the map overlap inconsistently, worst at "
              : "parts of the map overlap inconsistently at ",
          Place(worst.center));
    } else {
      sentence = absl::StrFormat(
          "parts of the map are displaced against each other, by %.1f m at %s",
          worst.displacement, Place(worst.center));
    }
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

void SortWorstFirst(std::vector<PathPiece>* const pieces) {
  std::stable_sort(pieces->begin(), pieces->end(),
                   [](const PathPiece& a, const PathPiece& b) {
                     return a.severity() > b.severity();
                   });
}

bool IsDisplaced(const SelfConsistency& result,
                 const SelfConsistencyOptions& options) {
  return !result.displacements.pieces.empty() &&
         result.displacements.displaced_share() >= options.displaced_share;
}

// Near which place, which nodes, when.
std::string Where(const PathPiece& piece, const io::TimeNs start) {
  return absl::StrFormat(
      "near %s: nodes %s to %s (%.1f s to %.1f s after the start)",
      Place(piece.center), ToString(piece.first_node),
      ToString(piece.last_node), io::ToSeconds(piece.begin - start),
      io::ToSeconds(piece.end - start));
}

// What is wrong, in order of weight.
void Explain(const MapGraph& graph, const SelfConsistencyOptions& options,
             SelfConsistency* const result) {
  const io::TimeNs start = StartTime(graph);
  result->reasons.push_back(Headline(graph, *result, options));
  const Contradictions& contradictions = result->contradictions;
  if (contradictions.revisit_nodes > 0) {
    result->reasons.push_back(absl::StrFormat(
        "%.1f %% of the %d nodes that revisit a place have most of their scan "
        "in free space or behind walls mapped there at another time",
        100. * result->severe_share, contradictions.revisit_nodes));
  }
  if (result->severe_passing_share >= options.doubtful_share) {
    result->reasons.push_back(absl::StrFormat(
        "%.1f %% of the nodes contradict what was mapped on the same visit, "
        "before the robot came back",
        100. * result->severe_passing_share));
  }
  if (IsDisplaced(*result, options)) {
    result->reasons.push_back(
        absl::StrFormat("%.1f %% of the nodes that revisit a place fit what "
                        "was mapped there at "
                        "another time better more than %.1f m away",
                        100. * result->displacements.displaced_share(),
                        options.displacement.limit));
  }
  if (!result->loose.places.empty()) {
    result->reasons.push_back(DescribeLoosePlaces(graph, result->loose));
  }
  for (size_t i = 0; i < std::min(result->places.size(), kMaxNamedPlaces);
       ++i) {
    const PathPiece& piece = result->places[i];
    const std::string where = Where(piece, start);
    const std::string submaps = Submaps(piece.submaps);
    result->reasons.push_back(
        !piece.is_displaced()
            ? absl::StrFormat("%s contradict %s by %.0f %% of their rays",
                              where, submaps, 100. * piece.fraction)
            : absl::StrFormat("%s lie %.1f m from where they fit %s", where,
                              piece.displacement, submaps));
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

std::string WordOf(const SelfConsistency& result,
                   const SelfConsistencyOptions& options) {
  const bool turned = !result.wrong_turns.empty();
  const bool contradicts =
      std::max(result.severe_share, result.severe_passing_share) >=
      options.doubtful_share;
  if (result.severe_share >= options.broken_share || (contradicts && turned)) {
    return "broken";
  }
  if (contradicts || turned) return "doubtful";
  if (HardlyRevisits(result.contradictions, options)) return "unknown";
  if (IsDisplaced(result, options)) return "doubtful";
  if (result.displacements.tied_share < options.tied_share) return "unknown";
  return IsLoose(result.loose.share(), options) ? "doubtful" : "sound";
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

// Appends the severe ones, worst first; returns the number of their nodes.
int TakeSeverePieces(std::vector<PathPiece> pieces,
                     const SelfConsistencyOptions& options,
                     std::vector<PathPiece>* const places) {
  SortWorstFirst(&pieces);
  int num_nodes = 0;
  for (const PathPiece& piece : pieces) {
    if (piece.fraction < options.severe_fraction ||
        piece.num_nodes < options.min_severe_nodes) {
      continue;
    }
    num_nodes += piece.num_nodes;
    places->push_back(piece);
  }
  return num_nodes;
}

double ShareOf(const int num_nodes, const double of) {
  return of > 0. ? num_nodes / of : 0.;
}

SelfConsistency Assess(const MapGraph& graph, const MapContents& contents,
                       const std::map<int, Trajectory>& odometry,
                       const SelfConsistencyOptions& options) {
  SelfConsistency result;
  result.contradictions =
      FindContradictions(graph, contents, options.contradiction);
  result.displacements = FindDisplacements(
      graph, contents, result.contradictions, options.displacement);
  result.loose =
      FindLoosePlaces(graph, result.displacements.ties, options.loose);
  result.sharpness = ComputeSharpness(graph, contents, options.sharpness);
  result.motion = CompareMotions(graph, odometry);
  result.cycles = ComputeLoopCycles(graph, options.cycles);
  const Contradictions& found = result.contradictions;
  result.severe_share =
      ShareOf(TakeSeverePieces(found.pieces, options, &result.places),
              std::max(static_cast<double>(found.revisit_nodes),
                       options.judged_share *
                           static_cast<double>(found.distinct_nodes)));
  result.severe_passing_share =
      ShareOf(TakeSeverePieces(found.passing_pieces, options, &result.places),
              static_cast<double>(found.judged_nodes));
  if (IsDisplaced(result, options)) {
    std::vector<PathPiece> displaced = result.displacements.pieces;
    SortWorstFirst(&displaced);
    result.places.insert(result.places.end(), displaced.begin(),
                         displaced.end());
  }
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
  result.word = WordOf(result, options);
  Explain(graph, options, &result);
  return result;
}

}  // namespace

bool IsLoose(const double loose_share, const SelfConsistencyOptions& options) {
  return loose_share >= options.loose_share;
}

SelfConsistency AssessSelfConsistency(const MapGraph& graph,
                                      const MapContents& contents,
                                      const std::map<int, Trajectory>& odometry,
                                      const SelfConsistencyOptions& options) {
  const std::set<int> tied = graph.TiedTrajectories();
  std::map<int, int> untied_nodes;  // by trajectory
  for (const auto& node : graph.nodes) {
    const int trajectory_id = node.first.trajectory_id;
    if (tied.count(trajectory_id) == 0) ++untied_nodes[trajectory_id];
  }
  if (tied.empty() || untied_nodes.empty()) {
    return Assess(graph, contents, odometry, options);
  }
  MapGraph judged = graph;
  for (auto it = judged.nodes.begin(); it != judged.nodes.end();) {
    it = tied.count(it->first.trajectory_id) > 0 ? std::next(it)
                                                 : judged.nodes.erase(it);
  }
  SelfConsistency result = Assess(judged, contents, odometry, options);
  for (const auto& entry : untied_nodes) {
    result.reasons.push_back(
        absl::StrFormat("trajectory %d (%d nodes) is not judged: nothing ties "
                        "its nodes to a submap",
                        entry.first, entry.second));
  }
  return result;
}

ordered_json ToJson(const SelfConsistency& consistency) {
  const Contradictions& contradictions = consistency.contradictions;
  ordered_json json;
  json["verdict"] = consistency.word;
  json["reasons"] = consistency.reasons;
  json["severe_share"] = consistency.severe_share;
  json["severe_passing_share"] = consistency.severe_passing_share;
  json["judged_nodes"] = contradictions.judged_nodes;
  json["conflict_nodes"] = contradictions.conflict_nodes;
  json["contradicted_rays"] = contradictions.ray_fraction();
  json["displaced_share"] = consistency.displacements.displaced_share();
  json["tied_share"] = consistency.displacements.tied_share;
  json["loose_share"] = consistency.loose.share();
  json["places"] = ordered_json::array();
  for (const PathPiece& piece : consistency.places) {
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
                              {"displacement", piece.displacement},
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
      100. * consistency.severe_share, consistency.contradictions.revisit_nodes,
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
