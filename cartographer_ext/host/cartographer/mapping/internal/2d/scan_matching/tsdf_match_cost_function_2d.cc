// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
#include "cartographer/mapping/internal/2d/scan_matching/tsdf_match_cost_function_2d.h"

#include "cartographer/mapping/internal/2d/scan_matching/interpolated_tsdf_2d.h"

namespace cartographer {
namespace mapping {
namespace scan_matching {
namespace {

class TSDFMatchFunctor {
 public:
  TSDFMatchFunctor(const double scaling_factor,
                   const sensor::PointCloud& point_cloud, const TSDF2D& grid)
      : scaling_factor_(scaling_factor),
        point_cloud_(point_cloud),
        tsdf_(grid) {}

  template <typename T>
  bool operator()(const T* const pose, T* const residuals) const {
    using std::cos;
    using std::sin;
    const T cosine = cos(pose[2]);
    const T sine = sin(pose[2]);
    T total_weight(0.);
    for (size_t i = 0; i != point_cloud_.size(); ++i) {
      const Eigen::Vector2d point =
          point_cloud_[i].position.head<2>().cast<double>();
      const T x = cosine * point.x() - sine * point.y() + pose[0];
      const T y = sine * point.x() + cosine * point.y() + pose[1];
      const T weight = tsdf_.GetWeight(x, y);
      total_weight += weight;
      residuals[i] = weight * tsdf_.GetCorrespondenceCost(x, y);
    }
    if (total_weight == T(0.)) return false;
    const T scale = scaling_factor_ * static_cast<double>(point_cloud_.size()) /
                    total_weight;
    for (size_t i = 0; i != point_cloud_.size(); ++i) residuals[i] *= scale;
    return true;
  }

 private:
  const double scaling_factor_;
  const sensor::PointCloud& point_cloud_;
  const InterpolatedTSDF2D tsdf_;
};

}  // namespace

ceres::CostFunction* CreateTSDFMatchCostFunction2D(
    const double scaling_factor, const sensor::PointCloud& point_cloud,
    const TSDF2D& grid) {
  using CostFunction =
      ceres::AutoDiffCostFunction<TSDFMatchFunctor, ceres::DYNAMIC, 3>;
  return new CostFunction(
      new TSDFMatchFunctor(scaling_factor, point_cloud, grid),
      static_cast<int>(point_cloud.size()));
}

}  // namespace scan_matching
}  // namespace mapping
}  // namespace cartographer
