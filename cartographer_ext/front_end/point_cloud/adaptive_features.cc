// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
#include "cartographer_ext/front_end/point_cloud/adaptive_features.h"

#include <algorithm>
#include <cmath>
#include <numeric>

#include "Eigen/Eigenvalues"
#include "nanoflann.hpp"

namespace cartographer_ext {
namespace front_end {
namespace {

// The finite points in the layout that nanoflann expects.
struct Cloud {
  std::vector<Eigen::Vector2d> points;
  std::vector<int> original;

  size_t kdtree_get_point_count() const { return points.size(); }
  double kdtree_get_pt(const size_t index, const size_t dimension) const {
    return points[index](static_cast<int>(dimension));
  }
  template <class Box>
  bool kdtree_get_bbox(Box&) const {
    return false;
  }
};

using Tree = nanoflann::KDTreeSingleIndexAdaptor<
    nanoflann::L2_Simple_Adaptor<double, Cloud>, Cloud, 2, size_t>;

struct Analysis {
  std::vector<double> variation;            // per finite point
  std::vector<std::vector<int>> neighbors;  // per finite point
  Cloud cloud;
};

double Variation(const AdaptiveFeatureOptions& options, const Cloud& cloud,
                 const size_t center, const std::vector<int>& neighbors) {
  if (neighbors.size() < 2) return 0.;
  const double k = static_cast<double>(neighbors.size());
  const Eigen::Vector2d& p = cloud.points[center];
  Eigen::Vector2d mean = Eigen::Vector2d::Zero();
  double radius_squared = 0.;
  for (const int j : neighbors) {
    mean += cloud.points[j];
    radius_squared =
        std::max(radius_squared, (cloud.points[j] - p).squaredNorm());
  }
  mean /= k;
  Eigen::Matrix2d covariance = Eigen::Matrix2d::Zero();
  for (const int j : neighbors) {
    const Eigen::Vector2d d = cloud.points[j] - mean;
    double weight = 1.;
    if (options.distance_weighted && radius_squared > 0.) {
      weight = std::exp(-(cloud.points[j] - p).squaredNorm() / radius_squared);
    }
    covariance += weight * d * d.transpose();  // G eq. 1, 2
  }
  covariance /= k;
  const double trace = covariance.trace();
  if (!(trace > 0.)) return 0.;
  const Eigen::SelfAdjointEigenSolver<Eigen::Matrix2d> solver(
      covariance, Eigen::EigenvaluesOnly);
  return std::max(0., 2. * solver.eigenvalues()(0) / trace);  // G eq. 3
}

Analysis Analyze(const AdaptiveFeatureOptions& options,
                 const std::vector<Eigen::Vector2d>& points) {
  Analysis analysis;
  for (size_t i = 0; i < points.size(); ++i) {
    if (points[i].allFinite()) {
      analysis.cloud.points.push_back(points[i]);
      analysis.cloud.original.push_back(static_cast<int>(i));
    }
  }
  const size_t n = analysis.cloud.points.size();
  analysis.variation.assign(n, 0.);
  analysis.neighbors.resize(n);
  if (n == 0) return analysis;
  Tree tree(2, analysis.cloud, nanoflann::KDTreeSingleIndexAdaptorParams(10));
  tree.buildIndex();
  // One more than k, because the point finds itself.
  const size_t wanted = std::min<size_t>(options.num_neighbors + 1, n);
  std::vector<size_t> indices(wanted);
  std::vector<double> distances(wanted);
  for (size_t i = 0; i < n; ++i) {
    const size_t found = tree.knnSearch(analysis.cloud.points[i].data(), wanted,
                                        indices.data(), distances.data());
    std::vector<int>& neighbors = analysis.neighbors[i];
    for (size_t j = 0; j < found; ++j) {
      if (indices[j] != i) neighbors.push_back(static_cast<int>(indices[j]));
    }
    // With many coincident points, the list may lack the point itself.
    if (neighbors.size() > static_cast<size_t>(options.num_neighbors)) {
      neighbors.pop_back();
    }
    analysis.variation[i] = Variation(options, analysis.cloud, i, neighbors);
  }
  return analysis;
}

}  // namespace

std::vector<double> FeatureVariation(
    const AdaptiveFeatureOptions& options,
    const std::vector<Eigen::Vector2d>& points) {
  const Analysis analysis = Analyze(options, points);
  std::vector<double> variation(points.size(), 0.);
  for (size_t i = 0; i < analysis.variation.size(); ++i) {
    variation[analysis.cloud.original[i]] = analysis.variation[i];
  }
  return variation;
}

std::vector<int> SelectFeatures(const AdaptiveFeatureOptions& options,
                                const std::vector<Eigen::Vector2d>& points) {
  const Analysis analysis = Analyze(options, points);
  const int n = static_cast<int>(analysis.variation.size());
  std::vector<bool> keep(n, false);
  int kept = 0;
  for (int i = 0; i < n; ++i) {
    const std::vector<int>& neighbors = analysis.neighbors[i];
    if (neighbors.empty()) continue;
    double threshold = 0.;  // G eq. 4
    for (const int j : neighbors) threshold += analysis.variation[j];
    threshold /= static_cast<double>(neighbors.size());
    if (analysis.variation[i] > threshold) {
      keep[i] = true;
      ++kept;
    }
  }
  if (kept < options.min_points) {
    std::vector<int> order(n);
    std::iota(order.begin(), order.end(), 0);
    std::stable_sort(order.begin(), order.end(), [&](const int a, const int b) {
      return analysis.variation[a] > analysis.variation[b];
    });
    for (const int i : order) {
      if (kept >= options.min_points) break;
      if (keep[i]) continue;
      keep[i] = true;
      ++kept;
    }
  }
  std::vector<int> selected;
  for (int i = 0; i < n; ++i) {
    if (keep[i]) selected.push_back(analysis.cloud.original[i]);
  }
  return selected;
}

}  // namespace front_end
}  // namespace cartographer_ext
