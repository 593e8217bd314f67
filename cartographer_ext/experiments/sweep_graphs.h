// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
//
// The graphs of a sweep: data sets and generated families, with wrong loops
// added.
#ifndef CARTOGRAPHER_EXT_EXPERIMENTS_SWEEP_GRAPHS_H_
#define CARTOGRAPHER_EXT_EXPERIMENTS_SWEEP_GRAPHS_H_

#include <map>
#include <string>
#include <vector>

#include "absl/status/status.h"
#include "absl/status/statusor.h"
#include "cartographer_ext/optimization/graph/pose_graph.h"
#include "cartographer_ext/optimization/offline/optimize.h"

namespace cartographer_ext {
namespace experiments {

struct SweepOptions {
  std::string data_directory;         // where names of data sets are looked up
  std::vector<std::string> datasets;  // names ("intel") or files
  // Families of generated graphs (graph_families.h); one graph per seed.
  std::vector<std::string> families;
  std::vector<std::string> kernels;  // optimization::MethodNames()
  std::vector<std::string> types;    // R L RG LG, or none
  std::vector<std::string> counts;   // "1000", or "90%" of all loops
  int first_seed = 1;
  int seeds = 1;  // first_seed, first_seed + 1, ...
  int group_size = 10;
  double ate_limit = 0.05;  // metres; success
  double ate_limit_local = 0.4;
  std::map<std::string, double> ate_limits;   // by data set, for all types
  std::map<std::string, std::string> truths;  // by data set; else the optimum
  std::string journal_filename;               // empty: none
  optimization::OptimizeOptions optimize;     // all but the method
};

struct SweepGraph {
  std::string name;
  optimization::PoseGraph graph;
  std::vector<Pose2> optimum;  // without outliers
  // What the optimum solves: odometry, right loops and fixed poses, for a family
  // with the noise as it is. None where right loops are not known.
  std::vector<optimization::WhitenedEdge> right_edges;
  int num_loops = 0;
  bool is_family = false;
  double inherent_ate = -1.;  // metres, of the optimum; families only
};

// An error for an unknown kernel, type or family.
absl::Status CheckSweepOptions(const SweepOptions& options);

// The options that a run depends on besides its data set, kernel, type, count
// and seed: the fingerprint of a journal.
std::string JournalFingerprint(const SweepOptions& options);

// The data set's short name: the file's without folder and .g2o, .gz, .xz.
std::string DatasetName(const std::string& dataset);

absl::StatusOr<SweepGraph> LoadSweepGraph(const SweepOptions& options,
                                          const std::string& dataset);
absl::StatusOr<SweepGraph> MakeFamilyGraph(const std::string& family, int seed);

// By how much `poses` differ from the optimum, in standard deviations that odometry and
// right loops leave: the root of the excess of chi2 over its variance factor
// (chi2 of the optimum over its redundancy, at most one). To first order no
// coordinate of any pose, nor any combination of them, is off by more of its own
// standard deviation. Infinite where right loops are not known.
double DeviationFromOptimum(const SweepGraph& dataset,
                            const std::vector<Pose2>& poses);

// Number of outliers that `text` ("1000", or "90%" of all loops) asks for.
absl::StatusOr<int> OutlierCount(const std::string& text, int num_loops);

// The graph with `count` outliers of the type behind its edges; as it is for
// the type "none".
absl::StatusOr<optimization::PoseGraph> WithOutliers(
    const SweepOptions& options, const SweepGraph& dataset,
    const std::string& type, int count, int seed);

}  // namespace experiments
}  // namespace cartographer_ext

#endif  // CARTOGRAPHER_EXT_EXPERIMENTS_SWEEP_GRAPHS_H_
