// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
//
// The command cartographer_ext_optimize.
#include "cartographer_ext/common/random.h"
#include "cartographer_ext/io/g2o.h"
#include "gmock/gmock.h"
#include "tests/tools/run_command.h"

namespace cartographer_ext {
namespace {

using test::CommandResult;
using test::RunCommand;
using ::testing::HasSubstr;

// A square walked three times, with true loops and two wrong ones (the last).
io::G2oGraph Square() {
  io::G2oGraph graph;
  Random random(4);
  std::vector<Pose2> truth = {Pose2()};
  graph.vertices[0] = Pose2();
  const auto add = [&](const int from, const int to, const Pose2& measurement) {
    io::G2oEdge edge;
    edge.from = from;
    edge.to = to;
    edge.measurement = measurement;
    edge.information = Eigen::Vector3d(2500., 2500., 10000.).asDiagonal();
    graph.edges.push_back(edge);
  };
  const auto noisy = [&](const Pose2& pose) {
    return pose * Pose2(random.Normal(0., 0.02), random.Normal(0., 0.02),
                        random.Normal(0., 0.01));
  };
  for (int i = 1; i != 60; ++i) {
    truth.push_back(truth.back() * Pose2(1., 0., i % 5 == 0 ? kPi / 2. : 0.));
    const Pose2 step = noisy(Between(truth[i - 1], truth[i]));
    graph.vertices[i] = graph.vertices[i - 1] * step;
    add(i - 1, i, step);
    if (i >= 20) add(i - 20, i, noisy(Between(truth[i - 20], truth[i])));
  }
  add(3, 12, Pose2());
  add(27, 50, Pose2(0.1, 0.2, 0.));
  return graph;
}

TEST(OptimizeMainTest, SwitchesOffTheWrongLoops) {
  const test::TemporaryFolder folder;
  ASSERT_TRUE(io::WriteG2o(Square(), folder / "in.g2o").ok());
  for (const char* kernel : {"auto", "r_isam", "dcs", "gm", "acs"}) {
    const CommandResult result = RunCommand(
        "optimize",
        {"-input_filename", folder / "in.g2o", "-kernel", kernel,
         "-output_filename", folder / "out.g2o", "-verdicts_filename",
         folder / "loops.csv", "-picture_filename", folder / "out.png",
         "-truth_filename", folder / "in.g2o", "-json", "-"});
    ASSERT_EQ(result.exit_code, 0) << result.error;
    const nlohmann::json json = test::ParseJson(result.out);
    EXPECT_EQ(json["kernel"], kernel);
    EXPECT_EQ(json["poses"], 60);
    EXPECT_EQ(json["loops"]["total"], 42);
    EXPECT_GE(json["loops"]["rejected"], 2) << kernel;
    if (std::string(kernel) == "auto" || std::string(kernel) == "r_isam") {
      EXPECT_LE(json["loops"]["rejected"], 4) << kernel;
    }
    for (const char* key : {"odometry", "accepted_loops", "truncated"}) {
      EXPECT_TRUE(json["chi2"][key].is_number()) << key;
    }
    EXPECT_TRUE(json["ate"]["rmse"].is_number());
    EXPECT_TRUE(json["rpe"]["mean"].is_number());
    EXPECT_EQ(json.contains("step_milliseconds"),
              std::string(kernel) == "r_isam");
    const std::string table = test::ReadFile(folder / "loops.csv");
    EXPECT_THAT(table, HasSubstr("edge,from,to,chi2,weight,accepted\n"));
    EXPECT_THAT(table, HasSubstr(",3,12,"));
    EXPECT_EQ(table[table.size() - 2], '0');  // the last loop is off
    EXPECT_THAT(test::ReadFile(folder / "out.png"), HasSubstr("PNG"));
    const auto output = io::ReadG2o(folder / "out.g2o");
    ASSERT_TRUE(output.ok());
    EXPECT_EQ(output->vertices.size(), 60u);
    EXPECT_EQ(output->edges.size(), Square().edges.size());
    EXPECT_NEAR(output->vertices.at(40).x, 0., 0.5);
  }
}

TEST(OptimizeMainTest, BadInputAndUsage) {
  const test::TemporaryFolder folder;
  EXPECT_EQ(RunCommand("optimize", {}).exit_code, 2);
  EXPECT_EQ(
      RunCommand("optimize", {"-input_filename", "a.g2o", "-kernel", "magic"})
          .exit_code,
      2);
  CommandResult result =
      RunCommand("optimize", {"-input_filename", folder / "missing.g2o"});
  EXPECT_EQ(result.exit_code, 1);
  EXPECT_THAT(result.error, HasSubstr("missing.g2o"));
  // In two pieces.
  io::G2oGraph broken = Square();
  broken.vertices[1000] = Pose2();
  ASSERT_TRUE(io::WriteG2o(broken, folder / "broken.g2o").ok());
  result = RunCommand("optimize", {"-input_filename", folder / "broken.g2o"});
  EXPECT_EQ(result.exit_code, 1);
  EXPECT_THAT(result.error, HasSubstr("vertex 1000 cannot be reached"));
  ASSERT_TRUE(io::WriteG2o(Square(), folder / "in.g2o").ok());
  result = RunCommand("optimize", {"-input_filename", folder / "in.g2o",
                                   "-drop_loops", "0:0:0:1"});
  EXPECT_EQ(result.exit_code, 1);
  EXPECT_THAT(result.error, HasSubstr("pbstream"));
}

}  // namespace
}  // namespace cartographer_ext
