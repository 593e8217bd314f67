// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
#include "cartographer_ext/repair/map_quality.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "absl/strings/str_cat.h"
#include "absl/strings/str_format.h"
#include "cartographer_ext/map/verdict/loop_statistics.h"

namespace cartographer_ext {
namespace repair {
namespace {

// Evidence of a contradicted node, in agreeing nodes (map_quality.h).
constexpr double kContradictedWeight = 3.;
// Nodes in a map of which nothing is known, neither for nor against it: as many as
// the shortest severe piece has (self_consistency.h).
constexpr double kNeutralNodes = 8.;
// Evidence that differs by less than this share of the nodes that are judged is
// alike.
constexpr double kSameEvidence = 0.01;
// Measures that differ by less are alike; what is alike is decided by the next
// one.
constexpr double kSameSevere = 0.005;
constexpr double kSameLoose = 0.01;
constexpr double kSameRays = 0.01;
constexpr double kSameCycles = 0.05;
constexpr double kSameResidual = 0.02;  // metres
constexpr double kSameEntropy = 0.02;

// Evidence of a node of this map, on average; nothing tells of a map without any.
double EvidencePerNode(const MapQuality& quality) {
  return (quality.num_agreeing() -
          kContradictedWeight * quality.num_contradicted()) /
         (static_cast<double>(quality.is_contradicted.size()) + kNeutralNodes);
}

int Rank(const std::string& verdict) {
  if (verdict == "sound") return 0;
  if (verdict == "unknown") return 1;
  return verdict == "doubtful" ? 2 : 3;
}

}  // namespace

int MapQuality::num_contradicted() const {
  return static_cast<int>(
      std::count_if(is_contradicted.begin(), is_contradicted.end(),
                    [](const std::pair<const evaluation::GraphId, bool>& node) {
                      return node.second;
                    }));
}

int MapQuality::num_agreeing() const {
  return static_cast<int>(is_contradicted.size()) - num_contradicted();
}

MapQuality QualityOf(const evaluation::MapGraph& graph,
                     const evaluation::SelfConsistency& consistency) {
  MapQuality quality;
  quality.verdict = consistency.word;
  quality.severe_share = consistency.severe_share;
  quality.loose_share = consistency.loose.share();
  quality.contradicted_rays = consistency.contradictions.ray_fraction();
  quality.open_cycles = consistency.cycles.fraction();
  quality.loop_residual =
      evaluation::ComputeLoopStatistics(graph).residual_translation.mean;
  quality.entropy = consistency.sharpness.mean_entropy;
  for (const auto& node : consistency.contradictions.nodes) {
    if (node.judged > 0) {
      quality.is_contradicted[node.node_id] = node.in_conflict;
    }
  }
  for (const auto& piece : consistency.displacements.pieces) {
    for (auto node = quality.is_contradicted.lower_bound(piece.first_node);
         node != quality.is_contradicted.upper_bound(piece.last_node); ++node) {
      node->second = true;
    }
  }
  return quality;
}

double GainOfEvidence(const MapQuality& current, const MapQuality& candidate) {
  int lost = 0;  // contradicted before, not judged now
  for (const auto& node : current.is_contradicted) {
    if (node.second && candidate.is_contradicted.count(node.first) == 0) {
      ++lost;
    }
  }
  int found = 0;  // not judged before
  for (const auto& node : candidate.is_contradicted) {
    if (current.is_contradicted.count(node.first) == 0) ++found;
  }
  const double contradicted = candidate.num_contradicted() + lost;
  return candidate.num_agreeing() - current.num_agreeing() -
         kContradictedWeight * (contradicted - current.num_contradicted()) -
         std::min(0., EvidencePerNode(current)) * found;
}

std::string WhyNotBetter(const MapQuality& current,
                         const MapQuality& candidate) {
  const double gain = GainOfEvidence(current, candidate);
  const double same = kSameEvidence * static_cast<double>(std::max(
                                          current.is_contradicted.size(),
                                          candidate.is_contradicted.size()));
  if (gain < -same) {
    return absl::StrFormat(
        "fewer places agree: %d nodes agree with scans of another time and %d "
        "contradict them, before %d and %d",
        candidate.num_agreeing(), candidate.num_contradicted(),
        current.num_agreeing(), current.num_contradicted());
  }
  const auto compared = static_cast<double>(candidate.is_contradicted.size());
  if (compared < static_cast<double>(current.is_contradicted.size()) - same &&
      candidate.loose_share > current.loose_share + kSameLoose) {
    return absl::StrFormat(
        "it rests on fewer revisits: %d nodes see a place of another time, "
        "before %d, and %s, before %.1f %%",
        candidate.is_contradicted.size(), current.is_contradicted.size(),
        evaluation::DescribeLooseShare(candidate.loose_share),
        100. * current.loose_share);
  }
  const double came_loose =
      candidate.loose_share > current.loose_share + kSameLoose
          ? (candidate.loose_share - current.loose_share) * compared
          : 0.;
  if (gain > same && gain < came_loose) {
    return absl::StrFormat(
        "more came loose than agrees: %s, before %.1f %%, and %d nodes agree "
        "with scans of another time, before %d",
        evaluation::DescribeLooseShare(candidate.loose_share),
        100. * current.loose_share, candidate.num_agreeing(),
        current.num_agreeing());
  }
  if (candidate.verdict == "unknown" && current.verdict != "unknown") {
    return absl::StrFormat(
        "it tears the map apart: hardly any place is mapped twice, only %d "
        "nodes agree with scans of another time",
        candidate.num_agreeing());
  }
  const int rank = Rank(candidate.verdict), before = Rank(current.verdict);
  if (rank != before) {
    return rank < before ? ""
                         : absl::StrFormat("the map would be %s, it is %s",
                                           candidate.verdict, current.verdict);
  }
  if (gain > same) return "";
  struct Measure {
    const char* name;
    double before, after, same;
  };
  for (const Measure& measure :
       {Measure{"severe share", current.severe_share, candidate.severe_share,
                kSameSevere},
        Measure{"share of contradicted rays", current.contradicted_rays,
                candidate.contradicted_rays, kSameRays},
        Measure{"share of open cycles", current.open_cycles,
                candidate.open_cycles, kSameCycles},
        Measure{"distance of the loops from the map", current.loop_residual,
                candidate.loop_residual, kSameResidual},
        Measure{"map entropy", current.entropy, candidate.entropy,
                kSameEntropy}}) {
    if (std::abs(measure.after - measure.before) <= measure.same) continue;
    if (measure.after < measure.before) return "";
    return absl::StrFormat("the %s would be %.3f, it is %.3f", measure.name,
                           measure.after, measure.before);
  }
  return "the map would not change in quality";
}

std::string WhyNotWritten(const MapQuality& input, const MapQuality& result) {
  if (result.verdict == "broken") {
    return absl::StrFormat("the best version is still broken (%.1f %%)",
                           100. * result.severe_share);
  }
  if (result.verdict == "unknown") {
    return "nothing tells whether the best version is right";
  }
  if (evaluation::IsLoose(result.loose_share, {})) {
    return absl::StrCat("nothing tells whether the best version is right: ",
                        evaluation::DescribeLooseShare(result.loose_share));
  }
  return WhyNotBetter(input, result);
}

std::string ToText(const MapQuality& quality) {
  return absl::StrFormat(
      "%s, %.1f %% severe, %.1f %% of rays contradicted, %.1f %% of cycles "
      "open, entropy %.3f, %d nodes agree, %d contradict, %.1f %% of the path "
      "loose",
      quality.verdict, 100. * quality.severe_share,
      100. * quality.contradicted_rays, 100. * quality.open_cycles,
      quality.entropy, quality.num_agreeing(), quality.num_contradicted(),
      100. * quality.loose_share);
}

}  // namespace repair
}  // namespace cartographer_ext
