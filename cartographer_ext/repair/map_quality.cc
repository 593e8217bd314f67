// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
#include "cartographer_ext/repair/map_quality.h"

#include <cmath>

#include "absl/strings/str_format.h"

namespace cartographer_ext {
namespace repair {
namespace {

// Shares that differ by less are alike; what is alike is decided by the next
// measure.
constexpr double kSameSevere = 0.005;
constexpr double kSameRays = 0.01;
constexpr double kSameCycles = 0.05;
constexpr double kSameEntropy = 0.02;
// Share of the agreeing nodes that must remain.
constexpr double kKeptAgreement = 0.8;

int Rank(const std::string& verdict) {
  if (verdict == "sound") return 0;
  if (verdict == "unknown") return 1;
  return verdict == "doubtful" ? 2 : 3;
}

}  // namespace

MapQuality QualityOf(const evaluation::SelfConsistency& consistency) {
  MapQuality quality;
  quality.verdict = consistency.word;
  quality.severe_share = consistency.severe_share;
  quality.contradicted_rays = consistency.contradictions.ray_fraction();
  quality.open_cycles = consistency.cycles.fraction();
  quality.entropy = consistency.sharpness.mean_entropy;
  quality.agreeing_nodes =
      static_cast<double>(consistency.contradictions.judged_nodes -
                          consistency.contradictions.conflict_nodes);
  return quality;
}

std::string WhyNotBetter(const MapQuality& current,
                         const MapQuality& candidate) {
  if (candidate.agreeing_nodes < kKeptAgreement * current.agreeing_nodes) {
    return absl::StrFormat(
        "it tears the map apart: only %.0f nodes agree with scans of another "
        "time, before %.0f",
        candidate.agreeing_nodes, current.agreeing_nodes);
  }
  if (candidate.verdict == "unknown" && current.verdict != "unknown") {
    return absl::StrFormat(
        "it tears the map apart: hardly any place is mapped twice, only %.0f "
        "nodes agree with scans of another time",
        candidate.agreeing_nodes);
  }
  const int rank = Rank(candidate.verdict), before = Rank(current.verdict);
  if (rank != before) {
    return rank < before ? ""
                         : absl::StrFormat("the map would be %s, it is %s",
                                           candidate.verdict, current.verdict);
  }
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
        Measure{"map entropy", current.entropy, candidate.entropy,
                kSameEntropy}}) {
    if (std::abs(measure.after - measure.before) <= measure.same) continue;
    if (measure.after < measure.before) return "";
    return absl::StrFormat("the %s would be %.3f, it is %.3f", measure.name,
                           measure.after, measure.before);
  }
  return "the map would not change in quality";
}

std::string ToText(const MapQuality& quality) {
  return absl::StrFormat(
      "%s, %.1f %% severe, %.1f %% of rays contradicted, %.1f %% of cycles "
      "open, entropy %.3f, %.0f nodes agree",
      quality.verdict, 100. * quality.severe_share,
      100. * quality.contradicted_rays, 100. * quality.open_cycles,
      quality.entropy, quality.agreeing_nodes);
}

}  // namespace repair
}  // namespace cartographer_ext
