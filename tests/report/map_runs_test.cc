// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
//
// The runs themselves are tested with the report they are made for
// (report_test.cc).
#include "cartographer_ext/report/map_runs.h"

#include <fstream>
#include <map>
#include <string>
#include <vector>

#include "cartographer_ext/front_end/match_record.h"
#include "cartographer_ext/map/host_types.h"
#include "gmock/gmock.h"
#include "gtest/gtest.h"
#include "tests/report/report_example.h"

namespace cartographer_ext {
namespace report {
namespace {

using testing::HasSubstr;

TEST(MapRunsTest, TheStoredMapIsTheFirstRun) {
  const evaluation::MapGraph graph = test::ExampleGraph();
  RunInputs inputs;
  inputs.graph = &graph;
  evaluation::Evaluation evaluation;
  evaluation.trajectory_metres = 12.;
  const ReportRun run = StoredRun(inputs, evaluation);
  EXPECT_EQ(run.name, "as stored");
  EXPECT_EQ(run.style, "s1");
  EXPECT_EQ(run.graph.nodes.size(), 5u);
  EXPECT_EQ(run.evaluation.trajectory_metres, 12.);
  EXPECT_FALSE(run.rerun.has_value());
  EXPECT_FALSE(run.against_stored.has_value());
}

TEST(MapRunsTest, AMapThatCannotBeReplayedIsAnError) {
  // Nodes and constraints are not in the file.
  const evaluation::MapGraph graph = test::ExampleGraph();
  const io::Pbstream pbstream;
  const std::map<int, evaluation::Trajectory> odometry;
  const evaluation::GroundTruth truth;
  RunInputs inputs;
  inputs.graph = &graph;
  inputs.pbstream = &pbstream;
  inputs.odometry = &odometry;
  inputs.truth = &truth;
  ReportData data;
  EXPECT_FALSE(AddReruns(inputs, evaluation::RerunConfiguration(), &data).ok());
  EXPECT_TRUE(data.runs.empty());
}

TEST(MapRunsTest, DegeneracyIsThatOfNodes) {
  const std::string filename = testing::TempDir() + "map_runs_test.nodes.pb";
  std::vector<proto::MatchRecord> records(3);
  for (int i = 0; i < 3; ++i) {
    records[i].set_time(cartographer::common::ToUniversal(
        evaluation::ToHostTime((100 + i) * test::kSecond)));
    records[i].set_is_node(i != 1);
    records[i].set_information_ratio(0.25 * i);
    records[i].set_weak_direction(0.5);
  }
  records[2].set_degeneracy(proto::MatchRecord::TRANSLATION);
  std::string bytes;
  for (const proto::MatchRecord& record : records) {
    front_end::AppendRecord(record, &bytes);
  }
  std::ofstream(filename, std::ios::binary) << bytes;
  const auto samples = ReadDegeneracy(filename);
  ASSERT_TRUE(samples.ok()) << samples.status();
  ASSERT_EQ(samples->size(), 2u);
  EXPECT_EQ((*samples)[0].time, 100 * test::kSecond);
  EXPECT_EQ((*samples)[0].ratio, 0.);
  EXPECT_FALSE((*samples)[0].degenerate);
  EXPECT_EQ((*samples)[1].ratio, 0.5);
  EXPECT_EQ((*samples)[1].direction, 0.5);
  EXPECT_TRUE((*samples)[1].degenerate);

  std::ofstream(filename, std::ios::binary) << "\xff\xff\xff\xff";
  const auto broken = ReadDegeneracy(filename);
  ASSERT_FALSE(broken.ok());
  EXPECT_THAT(std::string(broken.status().message()), HasSubstr(filename));
  EXPECT_TRUE(absl::IsNotFound(ReadDegeneracy(filename + ".missing").status()));
}

TEST(MapRunsTest, VersionsNameWhatDecidesResults) {
  std::vector<std::string> names;
  for (const auto& version : Versions()) {
    names.push_back(version.first);
    EXPECT_FALSE(version.second.empty()) << version.first;
  }
  EXPECT_THAT(names, testing::IsSupersetOf({"cartographer_ext", "Cartographer",
                                            "Ceres Solver", "Eigen"}));
}

}  // namespace
}  // namespace report
}  // namespace cartographer_ext
