// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
#include "cartographer_ext/optimization/offline/starts/windings.h"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <utility>

#include "Eigen/Cholesky"
#include "Eigen/LU"
#include "Eigen/SparseCholesky"
#include "cartographer_ext/common/squared.h"
#include "cartographer_ext/common/thinned.h"
#include "cartographer_ext/optimization/offline/starts/starts.h"

namespace cartographer_ext {
namespace optimization {
namespace {

constexpr double kTurn = 2. * kPi;

// What an edge in force says of headings.
struct HeadingEdge {
  int edge = 0;  // its number
  int from = 0, to = 0;
  bool is_loop = false;
  double error = 0.;     // at given poses, up to half a turn
  double variance = 1.;  // marginal
};

double HeadingError(const WhitenedEdge& edge, const std::vector<Pose2>& poses) {
  return NormalizeSum(poses[edge.to].theta - poses[edge.from].theta -
                      edge.measurement.z());
}

std::vector<HeadingEdge> HeadingEdges(const std::vector<WhitenedEdge>& edges,
                                      const std::vector<double>& weights,
                                      const std::vector<Pose2>& poses) {
  std::vector<HeadingEdge> result;
  for (size_t i = 0; i != edges.size(); ++i) {
    if (!(weights[i] > 0.5)) continue;
    const WhitenedEdge& edge = edges[i];
    HeadingEdge heading;
    heading.edge = i;
    heading.from = edge.from;
    heading.to = edge.to;
    heading.is_loop = edge.is_loop;
    heading.error = HeadingError(edge, poses);
    heading.variance =
        (edge.whitening.transpose() * edge.whitening).inverse()(2, 2);
    result.push_back(heading);
  }
  return result;
}

// Changes of the headings, that of the first pose held, by least squares.
class HeadingSystem {
 public:
  HeadingSystem(const std::vector<HeadingEdge>& edges, const int num_poses)
      : edges_(edges), size_(num_poses - 1) {
    if (size_ == 0) return;
    std::vector<Eigen::Triplet<double>> entries;
    for (const HeadingEdge& edge : edges) {
      const double weight = 1. / edge.variance;
      const int a = edge.from - 1, b = edge.to - 1;
      if (a >= 0) entries.emplace_back(a, a, weight);
      if (b >= 0) entries.emplace_back(b, b, weight);
      if (a < 0 || b < 0) continue;
      entries.emplace_back(std::max(a, b), std::min(a, b), -weight);
    }
    Eigen::SparseMatrix<double> matrix(size_, size_);
    matrix.setFromTriplets(entries.begin(), entries.end());
    factor_.compute(matrix);
    determined_ =
        factor_.info() == Eigen::Success && factor_.vectorD().minCoeff() > 0.;
  }

  bool determined() const { return determined_; }

  // For errors with `turns` more, one per edge.
  Eigen::VectorXd Solve(const std::vector<int>& turns) const {
    Eigen::VectorXd rhs = Eigen::VectorXd::Zero(size_);
    for (size_t k = 0; k != edges_.size(); ++k) {
      const HeadingEdge& edge = edges_[k];
      Add(edge, -(edge.error + kTurn * turns[k]) / edge.variance, &rhs);
    }
    return factor_.solve(rhs);
  }

  // The covariance of the changes with the difference that an edge measures.
  Eigen::VectorXd CovarianceWith(const HeadingEdge& edge) const {
    Eigen::VectorXd column = Eigen::VectorXd::Zero(size_);
    Add(edge, 1., &column);
    return factor_.solve(column);
  }

  // The difference that an edge measures, of one value per pose but the first.
  static double Difference(const HeadingEdge& edge,
                           const Eigen::VectorXd& values) {
    return (edge.to > 0 ? values[edge.to - 1] : 0.) -
           (edge.from > 0 ? values[edge.from - 1] : 0.);
  }

 private:
  static void Add(const HeadingEdge& edge, const double value,
                  Eigen::VectorXd* const sum) {
    if (edge.to > 0) (*sum)[edge.to - 1] += value;
    if (edge.from > 0) (*sum)[edge.from - 1] -= value;
  }

  const std::vector<HeadingEdge> edges_;
  const int size_;
  Eigen::SimplicialLDLT<Eigen::SparseMatrix<double>> factor_;
  bool determined_ = false;
};

// Parts of the path that are joined, with whole turns between their poses.
class JoinedParts {
 public:
  explicit JoinedParts(const int size) : parents_(size), turns_(size, 0) {
    std::iota(parents_.begin(), parents_.end(), 0);
  }

  bool AreJoined(const int a, const int b) { return RootOf(a) == RootOf(b); }

  // The turns of `b` are to be those of `a` and `turns` more. Whether they are,
  // which is so where these two were not joined before.
  bool Join(const int a, const int b, const int turns) {
    const int of_a = RootOf(a), of_b = RootOf(b);
    const int between = TurnsOf(a) + turns - TurnsOf(b);
    if (of_a == of_b) return between == 0;
    parents_[of_b] = of_a;
    turns_[of_b] = between;
    return true;
  }

 private:
  // Afterwards the root is the parent.
  int RootOf(const int i) {
    if (parents_[i] == i) return i;
    std::vector<int> path;
    int root = i;
    for (; parents_[root] != root; root = parents_[root]) path.push_back(root);
    // From the root on, so that the parent's turns are those from the root.
    for (auto it = path.rbegin(); it != path.rend(); ++it) {
      turns_[*it] += parents_[*it] == root ? 0 : turns_[parents_[*it]];
      parents_[*it] = root;
    }
    return root;
  }
  // After RootOf().
  int TurnsOf(const int i) const { return parents_[i] == i ? 0 : turns_[i]; }

  std::vector<int> parents_;
  std::vector<int> turns_;  // from the parent
};

// Odometry and the loops that join what it does not, whose turns change nothing, and
// the other loops.
void Split(const std::vector<HeadingEdge>& edges, const int num_poses,
           std::vector<HeadingEdge>* const joining,
           std::vector<HeadingEdge>* const closing) {
  JoinedParts parts(num_poses);
  for (const HeadingEdge& edge : edges) {
    if (edge.is_loop) continue;
    parts.Join(edge.from, edge.to, 0);
    joining->push_back(edge);
  }
  for (const HeadingEdge& edge : edges) {
    if (!edge.is_loop) continue;
    const bool closes = parts.AreJoined(edge.from, edge.to);
    parts.Join(edge.from, edge.to, 0);
    (closes ? closing : joining)->push_back(edge);
  }
}

// Turns of the first loops, with their errors whitened so far.
struct Choice {
  std::vector<int> turns;
  std::vector<double> whitened;
  double chi2 = 0.;
};

// All turns that may be added to the errors within `max_chi2`, the cheapest first.
std::vector<Choice> ChooseTurns(const Eigen::VectorXd& errors,
                                const Eigen::MatrixXd& root,
                                const WindingOptions& options) {
  std::vector<Choice> result(1);
  for (int i = 0; i != errors.size(); ++i) {
    std::vector<Choice> longer;
    for (const Choice& choice : result) {
      double error = errors[i];
      for (int j = 0; j != i; ++j) error -= root(i, j) * choice.whitened[j];
      const double reach =
          root(i, i) * std::sqrt(std::max(0., options.max_chi2 - choice.chi2));
      const int first = std::ceil((-reach - error) / kTurn);
      const int last = std::floor((reach - error) / kTurn);
      for (int turns = first; turns <= last; ++turns) {
        Choice next = choice;
        next.turns.push_back(turns);
        next.whitened.push_back((error + kTurn * turns) / root(i, i));
        next.chi2 += Squared(next.whitened.back());
        longer.push_back(std::move(next));
      }
    }
    std::stable_sort(
        longer.begin(), longer.end(),
        [](const Choice& a, const Choice& b) { return a.chi2 < b.chi2; });
    if (longer.size() > static_cast<size_t>(options.max_choices)) {
      longer.resize(options.max_choices);
    }
    result = std::move(longer);
  }
  return result;
}

}  // namespace

std::vector<Winding> FindWindings(const std::vector<WhitenedEdge>& edges,
                                  const std::vector<double>& weights,
                                  const std::vector<Pose2>& poses,
                                  const WindingOptions& options) {
  std::vector<HeadingEdge> joining, closing;
  const std::vector<HeadingEdge> all = HeadingEdges(edges, weights, poses);
  Split(all, poses.size(), &joining, &closing);
  const std::vector<HeadingEdge> chosen = Thinned(closing, options.max_loops);
  if (chosen.empty()) return {};
  const HeadingSystem chain(joining, poses.size());
  if (!chain.determined()) return {};
  const int size = chosen.size();
  const Eigen::VectorXd change =
      chain.Solve(std::vector<int>(joining.size(), 0));
  Eigen::VectorXd errors(size);
  Eigen::MatrixXd covariance(size, size);
  for (int i = 0; i != size; ++i) {
    errors[i] = chosen[i].error + HeadingSystem::Difference(chosen[i], change);
    const Eigen::VectorXd column = chain.CovarianceWith(chosen[i]);
    for (int j = 0; j != size; ++j) {
      covariance(j, i) = HeadingSystem::Difference(chosen[j], column);
    }
    covariance(i, i) += chosen[i].variance;
  }
  const Eigen::LLT<Eigen::MatrixXd> root(covariance);
  if (root.info() != Eigen::Success) return {};
  std::vector<HeadingEdge> decided = joining;
  decided.insert(decided.end(), chosen.begin(), chosen.end());
  const HeadingSystem system(decided, poses.size());
  std::vector<Winding> result;
  for (const Choice& choice : ChooseTurns(errors, root.matrixL(), options)) {
    if (result.size() == static_cast<size_t>(options.max_windings)) break;
    if (std::count(choice.turns.begin(), choice.turns.end(), 0) == size) {
      continue;
    }
    std::vector<int> turns(joining.size(), 0);
    turns.insert(turns.end(), choice.turns.begin(), choice.turns.end());
    const Eigen::VectorXd headings = system.Solve(turns);
    Winding winding;
    winding.chi2 = choice.chi2;
    winding.turns.assign(edges.size(), 0);
    for (const HeadingEdge& edge : closing) {
      winding.turns[edge.edge] = -std::lround(
          (edge.error + HeadingSystem::Difference(edge, headings)) / kTurn);
    }
    for (int i = 0; i != size; ++i) {
      winding.turns[chosen[i].edge] = choice.turns[i];
    }
    result.push_back(std::move(winding));
  }
  return result;
}

bool HaveSameWinding(const std::vector<WhitenedEdge>& edges,
                     const std::vector<double>& weights,
                     const std::vector<Pose2>& a, const std::vector<Pose2>& b) {
  JoinedParts parts(a.size());
  const auto change = [&](const int pose) {
    return NormalizeAngle(b[pose].theta - a[pose].theta);
  };
  for (size_t i = 0; i != edges.size(); ++i) {
    if (!(weights[i] > 0.5)) continue;
    const WhitenedEdge& edge = edges[i];
    const int turns =
        std::lround((HeadingError(edge, b) - HeadingError(edge, a) -
                     change(edge.to) + change(edge.from)) /
                    kTurn);
    if (!parts.Join(edge.from, edge.to, turns)) return false;
  }
  return true;
}

bool Rewind(const std::vector<WhitenedEdge>& edges,
            const std::vector<double>& weights, const std::vector<int>& turns,
            std::vector<Pose2>* const poses) {
  const std::vector<HeadingEdge> headings =
      HeadingEdges(edges, weights, *poses);
  std::vector<int> in_force;
  for (const HeadingEdge& edge : headings) in_force.push_back(turns[edge.edge]);
  const HeadingSystem system(headings, poses->size());
  if (!system.determined()) return false;
  const Eigen::VectorXd change = system.Solve(in_force);
  std::vector<Pose2> result = *poses;
  for (size_t i = 1; i != result.size(); ++i) {
    result[i].theta = NormalizeAngle(result[i].theta + change[i - 1]);
  }
  if (!PositionsOfHeadings(edges, weights, &result)) return false;
  *poses = std::move(result);
  return true;
}

}  // namespace optimization
}  // namespace cartographer_ext
