// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
//
// Injects wrong loops to test a back end: into a finished map, or into the pose
// graph of a run.
//
// A wrong loop joins a random submap with a random node that is far from it and
// claims "the same place", as the outliers of the papers do: x, y ~ N(0, 0.3
// m), theta ~ N(0, 10 deg), with the weights of the map's own loops. Their true
// distance is taken from local SLAM, which is independent of optimisations, so
// that a run injects the same loops for any back end and any number of threads.
// Portable: the same seed gives the same loops on every platform.
#ifndef CARTOGRAPHER_EXT_EXPERIMENTS_WRONG_LOOPS_H_
#define CARTOGRAPHER_EXT_EXPERIMENTS_WRONG_LOOPS_H_

#include <cstdint>
#include <functional>
#include <vector>

#include "absl/status/status.h"
#include "absl/status/statusor.h"
#include "cartographer/mapping/map_builder_interface.h"
#include "cartographer/mapping/proto/map_builder_options.pb.h"
#include "cartographer_ext/common/random.h"
#include "cartographer_ext/io/pbstream/pbstream_reader.h"
#include "cartographer_ext/map/map_graph.h"

namespace cartographer_ext {
namespace evaluation {

struct WrongLoopOptions {
  int count = 0;
  uint64_t seed = 1;
  double translation_sigma = 0.3;            // metres, each axis
  double rotation_sigma = 10. * kPi / 180.;  // radians
  double least_distance = 3.;                // metres between the two by local
                                             // SLAM
  double translation_weight = 1.1e4;
  double rotation_weight = 1e5;
};

// The options with the loop weights of this configuration.
WrongLoopOptions WithLoopWeights(
    const cartographer::mapping::proto::MapBuilderOptions& configuration,
    WrongLoopOptions options);

// One wrong loop for the current map, within one trajectory. The last two
// submaps, which may still grow, are not used. An error when no such pair turns
// up in 1000 draws: the map is too small.
absl::StatusOr<GraphConstraint> MakeWrongLoop(const MapGraph& map,
                                              const WrongLoopOptions& options,
                                              Random* random);

// `options.count` wrong loops at the end of the constraints, with the median
// weights of the map's own loops, if any. Returns their indices.
absl::StatusOr<std::vector<int>> AddWrongLoops(const WrongLoopOptions& options,
                                               io::Pbstream* pbstream);

// Spreads the loops evenly over a run.
class WrongLoopInjector {
 public:
  explicit WrongLoopInjector(const WrongLoopOptions& options)
      : options_(options), random_(options.seed) {}

  // Call after each scan. Adds those loops that are due: number k of n after
  // the share k / (n + 1) of the scans. A loop for which the map is still too
  // small is deferred.
  void AfterScan(int64_t scans, int64_t total_scans,
                 cartographer::mapping::MapBuilderInterface* map_builder);

  // AfterScan of this injector, which must outlive the callback.
  std::function<void(int64_t, int64_t,
                     cartographer::mapping::MapBuilderInterface*)>
  Callback() {
    return [this](const int64_t scans, const int64_t total_scans,
                  cartographer::mapping::MapBuilderInterface* const builder) {
      AfterScan(scans, total_scans, builder);
    };
  }

  const std::vector<GraphConstraint>& injected() const { return injected_; }

 private:
  const WrongLoopOptions options_;
  Random random_;
  std::vector<GraphConstraint> injected_;
};

}  // namespace evaluation
}  // namespace cartographer_ext

#endif  // CARTOGRAPHER_EXT_EXPERIMENTS_WRONG_LOOPS_H_
