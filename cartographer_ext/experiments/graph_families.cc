// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
#include "cartographer_ext/experiments/graph_families.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <utility>

#include "absl/strings/str_cat.h"
#include "absl/strings/str_join.h"
#include "cartographer_ext/common/random.h"
#include "cartographer_ext/experiments/family_paths.h"
#include "cartographer_ext/optimization/solvers/edges_in_force.h"

namespace cartographer_ext {
namespace experiments {
namespace {

using optimization::PoseGraph;
using optimization::PoseGraphEdge;

// Standard deviations of one measurement.
struct Noise {
  double translation = 0.;  // metres, each axis
  double rotation = 0.;     // radians
};

// What the loops of a graph are like.
struct LoopPlan {
  double radius = 1.;       // metres between the true poses of their ends
  double probability = 1.;  // that a pose which has a partner gets a loop
  int min_gap = 10;         // poses between the ends
  int max_loops = 1 << 30;  // more are thinned at random
  int max_loops_per_pose = 1;
};

double LogUniform(Random* const random, const double low, const double high) {
  return std::exp(random->Uniform(std::log(low), std::log(high)));
}

// Makes the graph of a path.
class Builder {
 public:
  Builder(Path path, Random* const random)
      : path_(std::move(path)), random_(random) {}

  void AddOdometry(const Noise& noise) {
    for (size_t k = 1; k < path_.poses.size(); ++k) {
      if (path_.robots[k] == path_.robots[k - 1]) {
        Add(k - 1, k, noise, false);
      }
    }
  }

  void AddLoops(const LoopPlan& plan, const Noise& noise) {
    std::vector<std::pair<int, int>> pairs = Revisits(plan);
    while (static_cast<int>(pairs.size()) > plan.max_loops) {
      pairs.erase(pairs.begin() + random_->UniformInt(0, pairs.size() - 1));
    }
    for (const auto& pair : pairs) Add(pair.first, pair.second, noise, true);
  }

  FamilyGraph Finish() {
    FamilyGraph result;
    // Ids with gaps, far apart between trajectories.
    const bool has_gaps = random_->UniformInt(0, 4) == 0;
    int64_t id = 0;
    for (size_t k = 0; k != path_.poses.size(); ++k) {
      if (k > 0) {
        id += has_gaps ? random_->UniformInt(1, 3) : 1;
        if (path_.robots[k] != path_.robots[k - 1]) id += 100000;
      }
      graph_.ids.push_back(id);
    }
    graph_.poses.assign(path_.poses.size(), Pose2());
    graph_.poses = optimization::DeadReckoning(graph_);
    // One graph in ten fixes a second pose.
    if (path_.robots.back() == 0 && random_->UniformInt(0, 9) == 0) {
      const int other = path_.poses.size() / 2;
      graph_.fixed = {0, other};
      graph_.poses[other] =
          graph_.poses[0] * Between(path_.poses[0], path_.poses[other]);
    }
    result.graph = std::move(graph_);
    result.truth = std::move(path_.poses);
    return result;
  }

 private:
  void Add(const int from, const int to, const Noise& noise,
           const bool is_loop) {
    PoseGraphEdge edge;
    edge.from = from;
    edge.to = to;
    edge.is_loop = is_loop;
    edge.measurement = Between(path_.poses[from], path_.poses[to]) *
                       Pose2(random_->Normal(0., noise.translation),
                             random_->Normal(0., noise.translation),
                             random_->Normal(0., noise.rotation));
    edge.information =
        Eigen::Vector3d(1. / (noise.translation * noise.translation),
                        1. / (noise.translation * noise.translation),
                        1. / (noise.rotation * noise.rotation))
            .asDiagonal();
    graph_.edges.push_back(edge);
  }

  // Pairs of poses at one place, nearest first.
  std::vector<std::pair<int, int>> Revisits(const LoopPlan& plan) {
    std::map<std::pair<int64_t, int64_t>, std::vector<int>> cells;
    const auto cell_of = [&](const Pose2& pose) {
      return std::make_pair(
          static_cast<int64_t>(std::floor(pose.x / plan.radius)),
          static_cast<int64_t>(std::floor(pose.y / plan.radius)));
    };
    std::vector<std::pair<int, int>> result;
    for (size_t k = 0; k != path_.poses.size(); ++k) {
      const Pose2& pose = path_.poses[k];
      const auto cell = cell_of(pose);
      std::vector<std::pair<double, int>> near;
      for (int64_t dx = -1; dx <= 1; ++dx) {
        for (int64_t dy = -1; dy <= 1; ++dy) {
          const auto it = cells.find({cell.first + dx, cell.second + dy});
          if (it == cells.end()) continue;
          for (const int old : it->second) {
            if (path_.floors[old] != path_.floors[k] ||
                (path_.robots[old] == path_.robots[k] &&
                 static_cast<int>(k) - old < plan.min_gap)) {
              continue;
            }
            const double distance =
                (path_.poses[old].translation() - pose.translation()).norm();
            if (distance <= plan.radius) near.push_back({distance, old});
          }
        }
      }
      cells[cell].push_back(k);
      if (near.empty() || random_->Uniform() >= plan.probability) continue;
      std::sort(near.begin(), near.end());
      const int count = std::min<int>(near.size(), plan.max_loops_per_pose);
      for (int i = 0; i != count; ++i) {
        result.push_back({near[i].second, static_cast<int>(k)});
      }
    }
    return result;
  }

  Path path_;
  Random* const random_;
  PoseGraph graph_;
};

FamilyGraph MakeRing(Random* const random, const int max_loops) {
  const int rings = random->UniformInt(1, 4);
  const double step = random->Uniform(2., 6.);
  const double radius = random->Uniform(30., 60.) * step / std::sqrt(rings);
  Builder builder(Rings(rings, radius, step, random->Uniform(1.2, 2.5), random),
                  random);
  builder.AddOdometry({0.02 * step, LogUniform(random, 0.01, 0.1)});
  LoopPlan plan;
  plan.radius = 0.6 * step;
  plan.probability = random->Uniform(0.15, 0.6);
  plan.max_loops = max_loops;
  builder.AddLoops(plan, {random->Uniform(0.1, 0.4), 0.03});
  return builder.Finish();
}

FamilyGraph MakeRoad(Random* const random, const int max_loops) {
  Path path;
  const double step = random->Uniform(1., 2.);
  StreetWalker walker(random->UniformInt(2, 4), random->Uniform(60., 150.),
                      step, random, &path);
  walker.Begin(0, 0, 0, 0);
  walker.Walk(random->UniformInt(12, 24));
  Builder builder(std::move(path), random);
  builder.AddOdometry(
      {random->Uniform(0.01, 0.03) * step, LogUniform(random, 5e-4, 4e-3)});
  LoopPlan plan;
  plan.radius = 0.6 * step;
  plan.min_gap = 50;
  plan.probability = random->Uniform(0.02, 0.2);
  plan.max_loops = std::min<int>(max_loops, random->UniformInt(6, 60));
  builder.AddLoops(plan, {random->Uniform(0.05, 0.2), 0.01});
  return builder.Finish();
}

FamilyGraph MakeGrid(Random* const random, const int max_loops) {
  Path path;
  StreetWalker walker(random->UniformInt(4, 9), random->UniformInt(1, 3), 1.,
                      random, &path);
  walker.Begin(0, 0, 0, 0);
  walker.Walk(random->UniformInt(150, 300));
  Builder builder(std::move(path), random);
  builder.AddOdometry(
      {random->Uniform(0.02, 0.06), LogUniform(random, 0.01, 0.04)});
  LoopPlan plan;
  plan.radius = 1.05;
  plan.probability = random->Uniform(0.2, 1.);
  plan.max_loops_per_pose = 2;
  plan.max_loops = max_loops;
  builder.AddLoops(plan, {random->Uniform(0.03, 0.1), 0.02});
  return builder.Finish();
}

FamilyGraph MakeStar(Random* const random, const int max_loops) {
  Builder builder(
      Star(random->UniformInt(4, 9), random->Uniform(20., 50.), 1., random),
      random);
  builder.AddOdometry(
      {random->Uniform(0.02, 0.06), LogUniform(random, 0.005, 0.03)});
  LoopPlan plan;
  plan.radius = 1.05;
  plan.min_gap = 6;
  plan.probability = random->Uniform(0.2, 0.8);
  plan.max_loops = max_loops;
  builder.AddLoops(plan, {random->Uniform(0.03, 0.1), 0.02});
  return builder.Finish();
}

// Odometry and loops as they are within a building.
FamilyGraph MakeIndoorGraph(Path path, Random* const random) {
  Builder builder(std::move(path), random);
  builder.AddOdometry(
      {random->Uniform(0.02, 0.06), LogUniform(random, 0.01, 0.04)});
  LoopPlan plan;
  plan.radius = 1.05;
  plan.probability = random->Uniform(0.2, 0.8);
  builder.AddLoops(plan, {random->Uniform(0.03, 0.1), 0.02});
  return builder.Finish();
}

FamilyGraph MakeFloors(Random* const random) {
  Path path;
  StreetWalker walker(random->UniformInt(3, 5), 4., 1., random, &path);
  walker.Begin(0, 0, 0, 0);
  const int stairs = random->UniformInt(0, 1) == 0 ? 1 : 3;
  for (int visit = 0; visit <= stairs; ++visit) {
    walker.ChangeFloor(visit % 2);
    walker.Walk(random->UniformInt(30, 60));
    walker.WalkHome();
  }
  return MakeIndoorGraph(std::move(path), random);
}

FamilyGraph MakeRobots(Random* const random) {
  Path path;
  StreetWalker walker(random->UniformInt(3, 6), 4., 1., random, &path);
  const int robots = random->UniformInt(2, 4);
  for (int k = 0; k != robots; ++k) {
    walker.Begin(random->UniformInt(0, 3), random->UniformInt(0, 3), 0, k);
    walker.Walk(random->UniformInt(30, 60));
  }
  return MakeIndoorGraph(std::move(path), random);
}

FamilyGraph MakeFew(Random* const random) {
  const int max_loops = random->UniformInt(3, 30);
  FamilyGraph result;
  do {
    switch (random->UniformInt(0, 3)) {
      case 0:
        result = MakeRing(random, max_loops);
        break;
      case 1:
        result = MakeRoad(random, max_loops);
        break;
      case 2:
        result = MakeGrid(random, max_loops);
        break;
      default:
        result = MakeStar(random, max_loops);
    }
  } while (optimization::CountLoops(result.graph.edges) < 3);
  return result;
}

FamilyGraph MakeAny(Random* const random) {
  switch (random->UniformInt(0, 5)) {
    case 0:
      return MakeRing(random, 1 << 30);
    case 1:
      return MakeRoad(random, 1 << 30);
    case 2:
      return MakeStar(random, 1 << 30);
    case 3:
      return MakeFloors(random);
    case 4:
      return MakeFew(random);
    default:
      return MakeGrid(random, 1 << 30);
  }
}

// Multiplies information matrices: all, those of the loops or those of the
// odometry.
void ChangeConfidence(const double factor, Random* const random,
                      FamilyGraph* const family) {
  const int which = random->UniformInt(0, 3);
  if (which != 1) family->loop_confidence = factor;
  if (which != 2) family->odometry_confidence = factor;
  for (PoseGraphEdge& edge : family->graph.edges) {
    edge.information *=
        edge.is_loop ? family->loop_confidence : family->odometry_confidence;
  }
}

}  // namespace

const std::vector<std::string>& FamilyNames() {
  static const auto* const kNames = new std::vector<std::string>{
      "ring",   "road", "grid",          "star",          "floors",
      "robots", "few",  "overconfident", "underconfident"};
  return *kNames;
}

absl::StatusOr<FamilyGraph> GenerateFamilyGraph(const std::string& family,
                                                const uint64_t seed) {
  // Seeds of neighbouring families must not share their random numbers.
  const std::vector<std::string>& names = FamilyNames();
  const auto name = std::find(names.begin(), names.end(), family);
  if (name == names.end()) {
    return absl::InvalidArgumentError(absl::StrCat("unknown family '", family,
                                                   "', expected one of ",
                                                   absl::StrJoin(names, " ")));
  }
  Random random(1000003 * (name - names.begin() + 1) + seed);
  if (family == "ring") return MakeRing(&random, 1 << 30);
  if (family == "road") return MakeRoad(&random, 1 << 30);
  if (family == "grid") return MakeGrid(&random, 1 << 30);
  if (family == "star") return MakeStar(&random, 1 << 30);
  if (family == "floors") return MakeFloors(&random);
  if (family == "robots") return MakeRobots(&random);
  if (family == "few") return MakeFew(&random);
  FamilyGraph result = MakeAny(&random);
  // The expected chi2 of an honest loop is 3.
  const double chi2_per_loop = family == "overconfident"
                                   ? LogUniform(&random, 5., 100.)
                                   : LogUniform(&random, 0.01, 1.);
  ChangeConfidence(chi2_per_loop / 3., &random, &result);
  return result;
}

}  // namespace experiments
}  // namespace cartographer_ext
