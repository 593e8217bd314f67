// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
#include "cartographer_ext/experiments/outliers/outlier_generator.h"

#include <algorithm>
#include <cmath>

#include "absl/strings/str_cat.h"
#include "cartographer_ext/common/random.h"

namespace cartographer_ext {
namespace optimization {

absl::StatusOr<OutlierType> OutlierTypeFromName(const absl::string_view name) {
  if (name == "R") return OutlierType::kRandom;
  if (name == "L") return OutlierType::kLocal;
  if (name == "RG") return OutlierType::kRandomGrouped;
  if (name == "LG") return OutlierType::kLocalGrouped;
  return absl::InvalidArgumentError(absl::StrCat("unknown outlier type '", name,
                                                 "', expected R, L, RG or LG"));
}

std::string OutlierTypeName(const OutlierType type) {
  switch (type) {
    case OutlierType::kRandom:
      return "R";
    case OutlierType::kLocal:
      return "L";
    case OutlierType::kRandomGrouped:
      return "RG";
    case OutlierType::kLocalGrouped:
      return "LG";
  }
  return "";
}

absl::StatusOr<std::vector<PoseGraphEdge>> GenerateOutliers(
    const PoseGraph& graph, const OutlierOptions& options) {
  const bool grouped = options.type == OutlierType::kRandomGrouped ||
                       options.type == OutlierType::kLocalGrouped;
  const bool local = options.type == OutlierType::kLocal ||
                     options.type == OutlierType::kLocalGrouped;
  if (options.count < 0 || options.group_size < 1 || options.local_span < 2) {
    return absl::InvalidArgumentError(
        "outliers need count >= 0, group size >= 1 and local span >= 2");
  }
  const int group = grouped ? options.group_size : 1;
  const int64_t last = static_cast<int64_t>(graph.poses.size()) - 1 - group;
  if (options.count > 0 && last < 2) {
    return absl::InvalidArgumentError(
        absl::StrCat("outliers in groups of ", group, " need more than ",
                     graph.poses.size(), " poses"));
  }
  Eigen::Matrix3d information = 44.72135955 * Eigen::Matrix3d::Identity();
  for (const PoseGraphEdge& edge : graph.edges) {
    if (edge.is_loop) {
      information = edge.information;
      break;
    }
  }
  Random random(options.seed);
  std::vector<PoseGraphEdge> result;
  result.reserve(options.count);
  while (static_cast<int>(result.size()) < options.count) {
    int64_t a, b;
    do {
      a = random.UniformInt(0, last);
      b = local ? random.UniformInt(a, std::min(last, a + options.local_span))
                : random.UniformInt(0, last);
      if (a > b) std::swap(a, b);
      // An edge between neighbours would count as odometry.
      if (b == a + 1) b = a + 2;
    } while (a == b);
    PoseGraphEdge edge;
    edge.measurement.x = random.Normal(0., options.translation_sigma);
    edge.measurement.y = random.Normal(0., options.translation_sigma);
    edge.measurement.theta =
        NormalizeAngle(random.Normal(0., options.rotation_sigma));
    edge.information = information;
    edge.is_loop = true;
    for (int j = 0;
         j != group && static_cast<int>(result.size()) < options.count; ++j) {
      edge.from = a + j;
      edge.to = b + j;
      result.push_back(edge);
    }
  }
  return result;
}

}  // namespace optimization
}  // namespace cartographer_ext
