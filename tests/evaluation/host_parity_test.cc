// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
//
// The host's local SLAM against a map that the real Cartographer has made of
// the same log with the same configuration.

#include "cartographer_ext/evaluation/host_map.h"
#include "cartographer_ext/evaluation/open_recording.h"
#include "cartographer_ext/evaluation/pbstream_inspection.h"
#include "cartographer_ext/evaluation/pbstream_map.h"
#include "cartographer_ext/evaluation/slam_runner.h"
#include "gtest/gtest.h"
#include "tests/test_data.h"

namespace cartographer_ext {
namespace evaluation {
namespace {

TEST(HostParityTest, LocalSlamOnCsail) {
  const std::string log = test::SharedData("carmen/mit-csail.clf.xz");
  const std::string reference =
      test::SharedData("pbstream/csail-made-by-cartographer.pbstream");
  CARTOGRAPHER_EXT_SKIP_WITHOUT(log);
  CARTOGRAPHER_EXT_SKIP_WITHOUT(reference);
  CARTOGRAPHER_EXT_SKIP_WITHOUT(
      test::Golden("configs/csail-made-by-cartographer.lua"));
  auto configuration =
      LoadSlamConfiguration({test::Golden("configs"), "configuration_files"},
                            "csail-made-by-cartographer.lua");
  ASSERT_TRUE(configuration.ok()) << configuration.status();
  configuration->sensors.odometry_source = "scan";
  configuration->sensors.min_range = 0.1;
  configuration->sensors.max_range = 80.;
  // Local SLAM alone.
  auto* const pose_graph =
      configuration->map_builder_options.mutable_pose_graph_options();
  pose_graph->set_optimize_every_n_nodes(0);
  pose_graph->mutable_constraint_builder_options()->set_sampling_ratio(0.);
  pose_graph->set_global_sampling_ratio(0.);
  auto source = OpenRecording(log, ToSourceOptions(configuration->sensors), 0);
  ASSERT_TRUE(source.ok()) << source.status();
  const auto run = RunSlam(*configuration, source->get(), SlamRunOptions());
  ASSERT_TRUE(run.ok()) << run.status();
  const auto pbstream = io::ReadPbstream(reference);
  ASSERT_TRUE(pbstream.ok()) << pbstream.status();

  const LocalAgreement agreement = CompareLocalSlam(
      MakeMapGraph(*pbstream), MakeMapGraph(*run->map_builder->pose_graph()));
  EXPECT_EQ(agreement.nodes_first, 1778);
  EXPECT_NEAR(agreement.nodes_second, agreement.nodes_first,
              0.02 * agreement.nodes_first);
  EXPECT_NEAR(run->submaps, 40, 0.8);
  EXPECT_GT(agreement.common_stamps, 0.98 * agreement.nodes_first);
  EXPECT_GE(agreement.fraction_alike_translation, 0.99);
  // The configuration has the online correlative matcher on, whose steps are
  // larger than 0.2 degrees and which chooses between near ties: the real
  // Cartographer built on another machine repeats 51 % of its own motions.
  EXPECT_GE(agreement.fraction_alike, 0.45);
}

}  // namespace
}  // namespace evaluation
}  // namespace cartographer_ext
