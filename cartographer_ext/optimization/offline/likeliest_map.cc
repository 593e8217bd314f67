// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
#include "cartographer_ext/optimization/offline/likeliest_map.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <utility>
#include <vector>

#include "absl/strings/str_cat.h"
#include "cartographer_ext/optimization/offline/decision_moves.h"
#include "cartographer_ext/optimization/offline/loop_growth.h"
#include "cartographer_ext/optimization/offline/noise/loops_by_chance.h"
#include "cartographer_ext/optimization/offline/noise/map_evidence.h"
#include "cartographer_ext/optimization/solvers/edges_in_force.h"

namespace cartographer_ext {
namespace optimization {
namespace {

// Relative difference of the costs of one and the same map.
constexpr double kSameOptimum = 1e-9;
constexpr double kInfinity = std::numeric_limits<double>::infinity();
// Logarithm of the odds that another map than that of the lowest cost needs.
const double kMuchLikelier = std::log(1000.);
// Poses times loops of a graph of which each group in force may be released.
constexpr double kMaxReleaseWork = 2e6;
// Maps that are compared, those that cost least.
constexpr size_t kMaxMaps = 10;
// Maps that are improved, each of which is likelier than the last one.
constexpr int kMaxImproved = 5;

// Where most loops are wrong, one that saves hardly more than what it costs to
// refuse it is more likely wrong, too: the gate is meant for even odds, and twice
// the logarithm of the odds is what other odds change.
double GateOfOdds(const std::vector<WhitenedEdge>& edges,
                  const std::vector<Pose2>& poses) {
  double loops = 0., accepted = 0.;
  for (const WhitenedEdge& edge : edges) {
    loops += edge.is_loop;
    accepted += edge.is_loop &&
                Chi2(edge, poses[edge.from], poses[edge.to]) < kChi2Gate;
  }
  const double odds = (accepted + 1.) / (loops - accepted + 1.);
  return kChi2Gate + std::min(0., 2. * std::log(odds));
}

// Of the members that cost at most `limit` and are admitted, that with the lowest cost by
// the gate of the odds in `map`; the best where there is none.
template <typename Admit>
const Portfolio::Member& LowestByOdds(const double limit,
                                      const std::vector<Pose2>& map,
                                      const Admit& admit,
                                      const Portfolio& portfolio) {
  const double gate = GateOfOdds(portfolio.edges(), map);
  const Portfolio::Member* result = &portfolio.best();
  double lowest = kInfinity;
  for (const Portfolio::Member& member : portfolio.members()) {
    if (member.cost > limit) continue;
    const double cost = TruncatedCost(portfolio.edges(), member.poses, gate);
    if (cost >= lowest || !admit(member)) continue;
    lowest = cost;
    result = &member;
  }
  return *result;
}

// Maps by their evidence.
class LikelyMaps {
 public:
  // Another map than the preferred one has to be much likelier.
  LikelyMaps(const double limit, Portfolio::Member preferred,
             Portfolio* const portfolio)
      : limit_(limit),
        preferred_(std::move(preferred)),
        portfolio_(*portfolio),
        edges_(portfolio->edges()),
        log_area_(LogArea(portfolio->best().poses)) {}

  // The likeliest map, after improvements.
  std::vector<Pose2> Find() {
    Portfolio::Member result = Likeliest();
    for (int k = 0; k != kMaxImproved && IsOpen(); ++k) {
      Improve(result);
      Portfolio::Member next = Likeliest();
      if (IsSame(next, result)) break;
      result = std::move(next);
    }
    return result.poses;
  }

  // The likeliest member. One without most of the loops explains nothing: that all
  // groups are wrong is always likely where odometry says little.
  Portfolio::Member Likeliest() {
    std::vector<const Portfolio::Member*> order;
    for (const Portfolio::Member& member : portfolio_.members()) {
      if (member.cost <= limit_) order.push_back(&member);
    }
    std::stable_sort(order.begin(), order.end(),
                     [](const auto* const a, const auto* const b) {
                       return a->cost < b->cost;
                     });
    std::vector<const Portfolio::Member*> maps = {&preferred_};
    const Portfolio::Member* result = maps.front();
    double highest = 0.;
    for (const Portfolio::Member* const member : order) {
      if (maps.size() == kMaxMaps) break;
      const auto is_known = [&](const Portfolio::Member* const map) {
        return IsSame(*member, *map) ||
               DifferNearGateOnly(edges_, member->poses, map->poses);
      };
      if (std::any_of(maps.begin(), maps.end(), is_known) ||
          2 * LoopsInForce(*member) < LoopsInForce(preferred_)) {
        continue;
      }
      if (maps.size() == 1) {
        highest = EvidenceOf(result->poses) + kMuchLikelier;
      }
      maps.push_back(member);
      const double evidence = EvidenceOf(member->poses);
      if (evidence <= highest) continue;
      highest = evidence;
      result = member;
    }
    return *result;
  }

 private:
  // Whether another map than that of the lowest cost may be reported.
  bool IsOpen() const {
    return limit_ > portfolio_.best().cost * (1. + kSameOptimum) + kChi2Gate &&
           portfolio_.Size() <= kMaxReleaseWork;
  }

  double EvidenceOf(const std::vector<Pose2>& poses,
                    const std::vector<double>& decisions) {
    return LogPosteriorOfMap({poses, decisions}, portfolio_.support(), edges_,
                             log_area_, portfolio_.solver());
  }

  double EvidenceOf(const std::vector<Pose2>& poses) {
    return EvidenceOf(poses, DecideLoops(edges_, poses, kChi2Gate));
  }

  int LoopsInForce(const Portfolio::Member& member) const {
    return CountLoopsInForce(edges_,
                             DecideLoops(edges_, member.poses, kChi2Gate));
  }

  bool IsSame(const Portfolio::Member& a, const Portfolio::Member& b) const {
    return std::abs(a.cost - b.cost) <= kSameOptimum * b.cost;
  }

  void Improve(const Portfolio::Member& map) {
    std::vector<Pose2> poses = map.poses;
    if (!IsSame(map, portfolio_.best()) &&
        FlipLoops(FlipOptions(), portfolio_.solver(), &poses) > 0) {
      portfolio_.Add(absl::StrCat(map.name, ", moved"), poses);
    }
    ReleaseUnlikely(map.name, std::move(poses));
  }

  // Releases those parts of groups without which there is more evidence, the one
  // with most first, and again each as long as that is so.
  void ReleaseUnlikely(const std::string& name, std::vector<Pose2> poses) {
    std::vector<double> decisions = DecideLoops(edges_, poses, kChi2Gate);
    std::map<Part, std::vector<int>> parts;
    for (size_t i = 0; i != edges_.size(); ++i) {
      if (!edges_[i].is_loop || decisions[i] <= 0.5) continue;
      parts[PartOf(edges_[i], portfolio_.support().group[i])].push_back(i);
    }
    const double all = EvidenceOf(poses, decisions);
    std::vector<std::pair<double, Part>> order;
    for (const auto& part : parts) {
      std::vector<Pose2> without = poses;
      const std::vector<double> released = Without(part.second, decisions);
      Solve(released, &without);
      const double gain = EvidenceOf(without, released) - all;
      if (gain > 0.) order.push_back({-gain, part.first});
    }
    std::sort(order.begin(), order.end());
    double highest = all;
    for (const auto& entry : order) {
      std::vector<Pose2> without = poses;
      const std::vector<double> released =
          Without(parts[entry.second], decisions);
      Solve(released, &without);
      const double evidence = EvidenceOf(without, released);
      if (evidence <= highest) continue;
      highest = evidence;
      poses = std::move(without);
      decisions = released;
      portfolio_.Add(absl::StrCat(name, ", released"), poses);
    }
  }

  static std::vector<double> Without(const std::vector<int>& loops,
                                     std::vector<double> decisions) {
    for (const int i : loops) decisions[i] = 0.;
    return decisions;
  }

  void Solve(const std::vector<double>& weights,
             std::vector<Pose2>* const poses) {
    SolverOptions options;
    options.edge_weights = weights;
    options.initial_lambda = 1e-8;
    options.max_iterations = 10;
    options.cost_tolerance = 1e-5;
    portfolio_.solver()->Solve(options, poses);
  }

  const double limit_;
  const Portfolio::Member preferred_;
  Portfolio& portfolio_;
  const std::vector<WhitenedEdge>& edges_;
  const double log_area_;
};

}  // namespace

const Portfolio::Member& LikeliestMember(const double limit,
                                         Portfolio* const portfolio) {
  const auto any = [](const Portfolio::Member&) { return true; };
  const Portfolio::Member preferred =
      LowestByOdds(limit, portfolio->best().poses, any, *portfolio);
  const std::vector<Pose2> map = LikelyMaps(limit, preferred, portfolio).Find();
  return LowestByOdds(
      limit, map,
      [&](const Portfolio::Member& member) {
        return DifferNearGateOnly(portfolio->edges(), member.poses, map);
      },
      *portfolio);
}

std::vector<Pose2> FindLikelierMap(const std::vector<Pose2>& map,
                                   Portfolio* const portfolio) {
  if (portfolio->Size() > kMaxReleaseWork) return {};
  const Portfolio::Member ours = {"", map,
                                  TruncatedCost(portfolio->edges(), map)};
  std::vector<Pose2> likeliest =
      LikelyMaps(kInfinity, ours, portfolio).Likeliest().poses;
  if (DifferNearGateOnly(portfolio->edges(), map, likeliest)) return {};
  return likeliest;
}

}  // namespace optimization
}  // namespace cartographer_ext
