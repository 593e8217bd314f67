// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
//
// What holds for the swapped library as a whole. Each class behind a swap has
// tests of its own.
#include <map>
#include <memory>
#include <set>
#include <string>
#include <vector>

#include "absl/memory/memory.h"
#include "cartographer/common/configuration_file_resolver.h"
#include "cartographer/common/lua_parameter_dictionary.h"
#include "cartographer/mapping/map_builder.h"
#include "cartographer/mapping/trajectory_builder_interface.h"
#include "cartographer/metrics/register.h"
#include "cartographer_ext/options/extension_field.h"
#include "cartographer_ext/swaps.h"
#include "gtest/gtest.h"

namespace cartographer_ext {
namespace overlay {
namespace {

using cartographer::common::ConfigurationFileResolver;
using cartographer::common::LuaParameterDictionary;

struct Options {
  cartographer::mapping::proto::MapBuilderOptions map_builder;
  cartographer::mapping::proto::TrajectoryBuilderOptions trajectory_builder;
};

// The stock 2D configuration with some lines behind it.
Options Load(const std::string& lines) {
  LuaParameterDictionary dictionary(
      "include 'common_2d.lua'\n" + lines +
          "\nreturn { map_builder = MAP_BUILDER,"
          " trajectory_builder = TRAJECTORY_BUILDER }",
      absl::make_unique<ConfigurationFileResolver>(
          std::vector<std::string>{"configuration_files"}));
  Options options;
  options.map_builder = cartographer::mapping::CreateMapBuilderOptions(
      dictionary.GetDictionary("map_builder").get());
  options.trajectory_builder =
      cartographer::mapping::CreateTrajectoryBuilderOptions(
          dictionary.GetDictionary("trajectory_builder").get());
  return options;
}

TEST(SwappedClassesTest, WithoutBlocksTheOptionsAreStock) {
  const Options options = Load("");
  const auto& pose_graph = options.map_builder.pose_graph_options();
  const auto& local =
      options.trajectory_builder.trajectory_builder_2d_options();
  EXPECT_FALSE(options::HasExtension(pose_graph.constraint_builder_options()));
  EXPECT_FALSE(
      options::HasExtension(pose_graph.optimization_problem_options()));
  EXPECT_FALSE(options::HasExtension(
      pose_graph.constraint_builder_options().ceres_scan_matcher_options()));
  EXPECT_FALSE(options::HasExtension(local));
  EXPECT_FALSE(options::HasExtension(local.ceres_scan_matcher_options()));
}

#ifdef CARTOGRAPHER_EXT_SWAP_CONSTRAINT_BUILDER
TEST(SwappedClassesTest, ConstraintBuilderBlockArrives) {
  const Options options =
      Load("POSE_GRAPH.constraint_builder.cartographer_ext = {}");
  EXPECT_TRUE(options::HasExtension(
      options.map_builder.pose_graph_options().constraint_builder_options()));
}

TEST(SwappedClassesDeathTest, ConstraintBuilderErrorsNameTheKey) {
  EXPECT_DEATH(
      Load("POSE_GRAPH.constraint_builder.cartographer_ext = { no_key = 1 }"),
      "POSE_GRAPH.constraint_builder.cartographer_ext.no_key: unknown key");
}
#endif

#ifdef CARTOGRAPHER_EXT_SWAP_CERES_SCAN_MATCHER
TEST(SwappedClassesTest, ScanMatcherBlocksArriveWhereTheyWereWritten) {
  const Options local =
      Load("TRAJECTORY_BUILDER_2D.ceres_scan_matcher.cartographer_ext = {}");
  EXPECT_TRUE(options::HasExtension(
      local.trajectory_builder.trajectory_builder_2d_options()
          .ceres_scan_matcher_options()));
  EXPECT_FALSE(options::HasExtension(local.map_builder.pose_graph_options()
                                         .constraint_builder_options()
                                         .ceres_scan_matcher_options()));
  const Options loop = Load(
      "POSE_GRAPH.constraint_builder.ceres_scan_matcher.cartographer_ext = {}");
  EXPECT_FALSE(options::HasExtension(
      loop.trajectory_builder.trajectory_builder_2d_options()
          .ceres_scan_matcher_options()));
  EXPECT_TRUE(options::HasExtension(loop.map_builder.pose_graph_options()
                                        .constraint_builder_options()
                                        .ceres_scan_matcher_options()));
}

TEST(SwappedClassesDeathTest, ScanMatcherErrorsTellTheTwoTablesApart) {
  EXPECT_DEATH(Load("TRAJECTORY_BUILDER_2D.ceres_scan_matcher.cartographer_ext "
                    "= { no_key = 1 }"),
               "TRAJECTORY_BUILDER_2D.ceres_scan_matcher.cartographer_ext."
               "no_key: unknown key");
#ifdef CARTOGRAPHER_EXT_SWAP_CONSTRAINT_BUILDER
  EXPECT_DEATH(
      Load("POSE_GRAPH.constraint_builder.ceres_scan_matcher.cartographer_ext "
           "= { no_key = 1 }"),
      "POSE_GRAPH.constraint_builder.ceres_scan_matcher.cartographer_ext."
      "no_key: unknown key");
#endif
}
#endif

#ifdef CARTOGRAPHER_EXT_SWAP_OPTIMIZATION_PROBLEM
TEST(SwappedClassesTest, OptimizationProblemBlockArrives) {
  const Options options =
      Load("POSE_GRAPH.optimization_problem.cartographer_ext = {}");
  EXPECT_TRUE(options::HasExtension(
      options.map_builder.pose_graph_options().optimization_problem_options()));
}

TEST(SwappedClassesDeathTest, OptimizationProblemErrorsNameTheKey) {
  EXPECT_DEATH(
      Load("POSE_GRAPH.optimization_problem.cartographer_ext = { no_key = 1 }"),
      "POSE_GRAPH.optimization_problem.cartographer_ext.no_key: unknown key");
}
#endif

#ifdef CARTOGRAPHER_EXT_SWAP_LOCAL_TRAJECTORY_BUILDER
TEST(SwappedClassesTest, LocalTrajectoryBuilderBlockArrives) {
  const Options options = Load("TRAJECTORY_BUILDER_2D.cartographer_ext = {}");
  EXPECT_TRUE(options::HasExtension(
      options.trajectory_builder.trajectory_builder_2d_options()));
}
#endif

// A metrics registry that only remembers the names.
class NameCollector : public cartographer::metrics::FamilyFactory {
 public:
  using Counter = cartographer::metrics::Counter;
  using Gauge = cartographer::metrics::Gauge;
  using Histogram = cartographer::metrics::Histogram;
  template <typename Metric>
  using Family = cartographer::metrics::Family<Metric>;

  Family<Counter>* NewCounterFamily(const std::string& name,
                                    const std::string&) override {
    Remember(name);
    return &counters_;
  }
  Family<Gauge>* NewGaugeFamily(const std::string& name,
                                const std::string&) override {
    Remember(name);
    return &gauges_;
  }
  Family<Histogram>* NewHistogramFamily(
      const std::string& name, const std::string&,
      const Histogram::BucketBoundaries&) override {
    Remember(name);
    return &histograms_;
  }

  std::set<std::string> names;
  std::vector<std::string> repeated;

 private:
  template <typename Metric>
  class NullFamily : public Family<Metric> {
    Metric* Add(const std::map<std::string, std::string>&) override {
      return Metric::Null();
    }
  };
  void Remember(const std::string& name) {
    if (!names.insert(name).second) repeated.push_back(name);
  }
  NullFamily<Counter> counters_;
  NullFamily<Gauge> gauges_;
  NullFamily<Histogram> histograms_;
};

TEST(SwappedClassesTest, MetricFamiliesAreRegisteredOnce) {
  NameCollector collector;
  cartographer::metrics::RegisterAllMetrics(&collector);
  EXPECT_TRUE(collector.repeated.empty()) << collector.repeated.front();
  EXPECT_EQ(collector.names.count(
                "mapping_constraints_constraint_builder_2d_constraints"),
            1u);
  EXPECT_EQ(
      collector.names.count("mapping_2d_local_trajectory_builder_latency"), 1u);
}

}  // namespace
}  // namespace overlay
}  // namespace cartographer_ext
