// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
//
// Compares the host's scan matchers with the results of the real Cartographer
// (golden_pairs.h).
//
// The search is exact, so found, score and pose must agree. If the optimum is
// not unique, either pose is right. Refinement always starts from the golden
// pose, so that it is compared for ties as well.
#ifndef CARTOGRAPHER_EXT_EXPERIMENTS_GOLDEN_SEARCH_H_
#define CARTOGRAPHER_EXT_EXPERIMENTS_GOLDEN_SEARCH_H_

#include <cstdint>
#include <functional>
#include <map>
#include <memory>
#include <string>
#include <vector>

#include "absl/status/statusor.h"
#include "cartographer/mapping/2d/grid_2d.h"
#include "cartographer/mapping/2d/submap_2d.h"
#include "cartographer/mapping/id.h"
#include "cartographer/mapping/value_conversion_tables.h"
#include "cartographer/sensor/point_cloud.h"
#include "cartographer_ext/experiments/golden_pairs.h"
#include "cartographer_ext/io/pbstream/pbstream_reader.h"
#include "cartographer_ext/scan_matching/correlative_search/fast_correlative_search_2d.h"

namespace cartographer_ext {
namespace evaluation {

struct GoldenTolerance {
  double score = 2e-6;
  double search_translation = 1e-5;   // metres
  double search_rotation = 1e-6;      // radians
  double refined_translation = 1e-3;  // metres
  double refined_rotation = 1e-3;     // radians
  double relative_cost = 0.01;
};

struct GoldenOutcome {
  GoldenPair golden;
  GoldenPair ours;  // results and times only
  bool tie = false;
  double translation_deviation = 0.;  // of the search, metres; ties excluded
  double refined_translation_deviation = 0.;
  double refined_rotation_deviation = 0.;
  double relative_cost_deviation = 0.;
  std::string mismatch;  // empty when within the tolerance
};

// The matcher: the host's, or FastCorrelativeSearch2D.
enum class GoldenMatcher { kStock, kOurs };

struct GoldenReport {
  GoldenMatcher matcher = GoldenMatcher::kStock;
  std::vector<GoldenOutcome> outcomes;  // in the order of the pairs
  int num_found = 0;
  int num_ties = 0;
  int num_mismatches = 0;
  double max_score_deviation = 0.;
  double max_translation_deviation = 0.;
  double max_refined_translation_deviation = 0.;
  double max_refined_rotation_deviation = 0.;
  double max_relative_cost_deviation = 0.;
  // Of the search grids, mean over the submaps built. For the stock matcher,
  // the cells of its levels; those of the real Cartographer are as many.
  double mean_matcher_bytes = 0.;
  int num_rejected_early = 0;                  // ours only
  scan_matching::SearchStatistics statistics;  // ours only, summed up
};

// Mean of a time over all pairs, or over those with a result.
struct GoldenTimes {
  double search_microseconds = 0.;
  double refine_microseconds = 0.;
  double build_microseconds = 0.;
};
GoldenTimes MeanTimes(const GoldenReport& report, bool ours);

// The submaps and clouds of a state that some pairs need.
class GoldenMap {
 public:
  // A pair that names a submap without a grid, or a node that is not there or
  // has another number of points, is an error.
  static absl::StatusOr<GoldenMap> Create(const io::Pbstream& pbstream,
                                          const std::vector<GoldenPair>& pairs);

  const cartographer::mapping::Grid2D& grid(
      const cartographer::mapping::SubmapId& id) const {
    return *submaps_.at(id)->grid();
  }
  const cartographer::sensor::PointCloud& cloud(
      const cartographer::mapping::NodeId& id) const {
    return clouds_.at(id);
  }

 private:
  GoldenMap() = default;

  // On the heap: the grids point to it.
  std::unique_ptr<cartographer::mapping::ValueConversionTables> tables_;
  std::map<cartographer::mapping::SubmapId,
           std::unique_ptr<const cartographer::mapping::Submap2D>>
      submaps_;
  std::map<cartographer::mapping::NodeId, cartographer::sensor::PointCloud>
      clouds_;
};

// Search grids are built once per run of pairs with the same submap. Times are
// CPU time of this thread, the smallest of `repeat` tries. With several
// matchers, each try is made with all of them in turn, so that their ratios are
// meaningful on a busy machine. `progress`, if any, receives the number of
// finished pairs. One report per matcher.
struct GoldenCheckOptions {
  GoldenTolerance tolerance;
  std::vector<GoldenMatcher> matchers = {GoldenMatcher::kStock};
  int repeat = 1;
  std::function<void(int)> progress;
};
std::vector<GoldenReport> CheckGoldenPairs(const std::vector<GoldenPair>& pairs,
                                           const GoldenMap& map,
                                           const GoldenCheckOptions& options);

}  // namespace evaluation
}  // namespace cartographer_ext

#endif  // CARTOGRAPHER_EXT_EXPERIMENTS_GOLDEN_SEARCH_H_
