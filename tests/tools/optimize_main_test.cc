// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
//
// The command cartographer_ext_optimize.
#include "cartographer_ext/common/random.h"
#include "cartographer_ext/io/g2o.h"
#include "cartographer_ext/io/pbstream/pbstream_reader.h"
#include "cartographer_ext/io/pbstream/pbstream_writer.h"
#include "gmock/gmock.h"
#include "tests/map/square_map.h"
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

// One unknown cell.
void FillGrid(cartographer::mapping::proto::Submap* const submap) {
  auto* const data = submap->mutable_submap_2d();
  data->set_num_range_data(20);
  auto* const grid = data->mutable_grid();
  grid->mutable_limits()->set_resolution(0.05);
  grid->mutable_limits()->mutable_cell_limits()->set_num_x_cells(1);
  grid->mutable_limits()->mutable_cell_limits()->set_num_y_cells(1);
  grid->mutable_limits()->mutable_max();
  grid->add_cells(0);
  grid->mutable_probability_grid_2d();
  grid->set_min_correspondence_cost(0.1f);
  grid->set_max_correspondence_cost(0.9f);
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

TEST(OptimizeMainTest, ChainsOdometryWhereThereAreNoVertices) {
  const test::TemporaryFolder folder;
  io::G2oGraph graph = Square();
  graph.vertices.clear();
  ASSERT_TRUE(io::WriteG2o(graph, folder / "in.g2o").ok());
  const CommandResult result = RunCommand(
      "optimize", {"-input_filename", folder / "in.g2o", "-output_filename",
                   folder / "out.g2o", "-json", "-"});
  ASSERT_EQ(result.exit_code, 0) << result.error;
  const nlohmann::json json = test::ParseJson(result.out);
  EXPECT_EQ(json["poses"], 60);
  EXPECT_GE(json["loops"]["accepted"], 38);
  for (const char* key : {"odometry", "loops"}) {
    EXPECT_GT(json["noise_scale"][key], 0.5) << key;
    EXPECT_LT(json["noise_scale"][key], 2.) << key;
  }
  EXPECT_TRUE(json["undecidable"].is_array());
  EXPECT_TRUE(json["same_map"].is_array());
  const auto output = io::ReadG2o(folder / "out.g2o");
  ASSERT_TRUE(output.ok());
  EXPECT_NEAR(output->vertices.at(40).x, 0., 0.5);
}

TEST(OptimizeMainTest, FindsAndUndoesLoopsOfAMap) {
  const test::TemporaryFolder folder;
  test::SquareMap map;
  map.AddRightLoops();
  map.Add(1, 33, Pose2(), true);
  map.pbstream.header.set_format_version(2);
  map.pbstream.options.add_options_with_sensor_ids();
  for (auto& submap : map.pbstream.submaps) FillGrid(&submap);
  const std::string input = folder / "in.pbstream";
  ASSERT_TRUE(io::WritePbstream(map.pbstream, input).ok());
  CommandResult result =
      RunCommand("optimize", {"-input_filename", input, "-wrong_loops", "5",
                              "-nokeep_rejected", "-output_filename",
                              folder / "out.pbstream", "-verdicts_filename",
                              folder / "loops.csv", "-json", "-"});
  ASSERT_EQ(result.exit_code, 0) << result.error;
  nlohmann::json json = test::ParseJson(result.out);
  EXPECT_EQ(json["loops"]["total"], 14);
  EXPECT_EQ(json["loops"]["rejected"], 6);
  auto output = io::ReadPbstream(folder / "out.pbstream");
  ASSERT_TRUE(output.ok()) << output.status();
  EXPECT_EQ(output->pose_graph.constraint_size(),
            map.pbstream.pose_graph.constraint_size() - 1);

  result =
      RunCommand("optimize", {"-input_filename", input, "-kernel", "none",
                              "-drop_loops", "0:1:0:33", "-output_filename",
                              folder / "undone.pbstream", "-json", "-"});
  ASSERT_EQ(result.exit_code, 0) << result.error;
  json = test::ParseJson(result.out);
  EXPECT_EQ(json["loops"]["total"], 8);
  EXPECT_EQ(json["loops"]["rejected"], 0);
  output = io::ReadPbstream(folder / "undone.pbstream");
  ASSERT_TRUE(output.ok()) << output.status();
  EXPECT_EQ(output->pose_graph.constraint_size(),
            map.pbstream.pose_graph.constraint_size() - 1);

  result = RunCommand("optimize",
                      {"-input_filename", input, "-drop_loops", "0:1:0:34"});
  EXPECT_EQ(result.exit_code, 1);
  EXPECT_THAT(result.error, HasSubstr("no loop between"));

  // Marked, and left out, by the list that a run has written.
  test::WriteFile(folder / "off.csv",
                  "submap_trajectory,submap,node_trajectory,node,chi2,reason\n"
                  "0,1,0,33,812.5,consensus\n");
  result = RunCommand(
      "export",
      {"-pbstream_filename", input, "-switched_loops_filename",
       folder / "off.csv", "-constraints_filename", folder / "constraints.csv",
       "-output_pbstream_filename", folder / "without.pbstream"});
  ASSERT_EQ(result.exit_code, 0) << result.error;
  const std::string table = test::ReadFile(folder / "constraints.csv");
  EXPECT_THAT(table, HasSubstr(",residual_rotation,switched_off\n"));
  EXPECT_EQ(table.substr(table.size() - 3), ",1\n");
  output = io::ReadPbstream(folder / "without.pbstream");
  ASSERT_TRUE(output.ok()) << output.status();
  EXPECT_EQ(output->pose_graph.constraint_size(),
            map.pbstream.pose_graph.constraint_size() - 1);
  test::WriteFile(folder / "off.csv", "nonsense\n");
  result = RunCommand("export", {"-pbstream_filename", input,
                                 "-switched_loops_filename", folder / "off.csv",
                                 "-constraints_filename", folder / "c.csv"});
  EXPECT_EQ(result.exit_code, 1);
  EXPECT_THAT(result.error, HasSubstr("off.csv: line 1"));
  EXPECT_EQ(RunCommand("export", {"-pbstream_filename", input,
                                  "-output_pbstream_filename",
                                  folder / "without.pbstream"})
                .exit_code,
            2);
}

TEST(OptimizeMainTest, CorruptGraphsAreNamed) {
  const test::TemporaryFolder folder;
  const std::string file = folder / "bad.g2o";
  const std::string head =
      "VERTEX_SE2 0 0 0 0\nVERTEX_SE2 1 1 0 0\nVERTEX_SE2 2 2 0 0\n"
      "EDGE_SE2 0 1 1 0 0 1 0 0 1 0 1\n";
  const struct {
    const char* lines;
    const char* message;
  } cases[] = {
      {"EDGE_SE2 1 7 1 0 0 1 0 0 1 0 1\n", "7"},  // no such vertex
      {"EDGE_SE2 1 2 nan 0 0 1 0 0 1 0 1\n", "finite"},
      {"EDGE_SE2 1 2 1 0 0 -1 0 0 1 0 1\n", "positive definite"},
      {"EDGE_SE2 1 2 1 0 0 1 5 0 1 0 1\n", "positive definite"},
      {"EDGE_SE2 1 2 1 0 0 0 0 0 0 0 0\n", "positive definite"},
      {"", "vertex 2 cannot be reached"},
      {"VERTEX_SE2 1 4 4 0\n", "1"},  // twice
      {"EDGE_SE2 1 2 1 0\n", "bad.g2o:5"},
      {"EDGE_SE2 2 2 0 0 0 1 0 0 1 0 1\nEDGE_SE2 1 2 1 0 0 1 0 0 1 0 1\n",
       "itself"},
  };
  for (const auto& bad : cases) {
    test::WriteFile(file, head + bad.lines);
    for (const char* kernel : {"auto", "none"}) {
      const CommandResult result =
          RunCommand("optimize", {"-input_filename", file, "-kernel", kernel});
      EXPECT_EQ(result.exit_code, 1) << bad.lines;
      EXPECT_THAT(result.error, HasSubstr("bad.g2o")) << bad.lines;
      EXPECT_THAT(result.error, HasSubstr(bad.message)) << bad.lines;
    }
  }
  // Smallest graphs that are none the worse for it.
  for (const char* lines : {"VERTEX_SE2 0 0 0 0\n",
                            "VERTEX_SE2 0 0 0 0\nVERTEX_SE2 1 1 0 0\n"
                            "EDGE_SE2 0 1 1 0 0 1 0 0 1 0 1\n"}) {
    test::WriteFile(file, lines);
    for (const char* kernel : {"auto", "none", "sc", "gnc_tls", "r_isam"}) {
      EXPECT_EQ(
          RunCommand("optimize", {"-input_filename", file, "-kernel", kernel})
              .exit_code,
          0)
          << kernel << "\n"
          << lines;
    }
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
  EXPECT_EQ(result.exit_code, 2);
  EXPECT_THAT(result.error, HasSubstr("pbstream"));
}

}  // namespace
}  // namespace cartographer_ext
