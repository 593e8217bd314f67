// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
#include "absl/strings/str_cat.h"
#include "absl/strings/str_split.h"
#include "cartographer_ext/io/g2o.h"
#include "cartographer_ext/io/occupancy_map.h"
#include "cartographer_ext/io/trajectory_file.h"
#include "gmock/gmock.h"
#include "gtest/gtest.h"
#include "tests/tools/run_command.h"

namespace cartographer_ext {
namespace test {
namespace {

using testing::HasSubstr;

TEST(ExportMainTest, WritesWhatOtherProgramsRead) {
  const TemporaryFolder folder;
  WriteRoomMap(folder, 120);
  const CommandResult result =
      RunCommand("export", {"-pbstream_filename", folder / "room.pbstream",
                            "-trajectory_filename", folder / "nodes.tum",
                            "-g2o_filename", folder / "room.g2o",
                            "-constraints_filename", folder / "room.csv",
                            "-map_filestem", folder / "room", "-resolution",
                            "0.1", "-picture_filename", folder / "room.png"});
  ASSERT_EQ(result.exit_code, 0) << result.error;

  const auto nodes = io::ReadTumTrajectory(folder / "nodes.tum");
  ASSERT_TRUE(nodes.ok()) << nodes.status();
  const auto graph = io::ReadG2o(folder / "room.g2o");
  ASSERT_TRUE(graph.ok()) << graph.status();
  // One or two submaps, and the nodes numbered from a million.
  EXPECT_GE(graph->vertices.count(0), 1u);
  EXPECT_EQ(graph->vertices.count(1000000 + nodes->size() - 1), 1u);
  EXPECT_GE(graph->edges.size(), nodes->size());
  EXPECT_EQ(graph->fixed.count(0), 1u);
  EXPECT_NEAR(graph->edges[0].information(0, 0), 500. * 500., 1e-6);
  EXPECT_NEAR(graph->edges[0].information(2, 2), 1600. * 1600., 1e-6);
  // Edges obey the poses of an undisturbed room.
  for (const io::G2oEdge& edge : graph->edges) {
    const Pose2 difference = Between(
        edge.measurement,
        Between(graph->vertices.at(edge.from), graph->vertices.at(edge.to)));
    EXPECT_LT(difference.translation().norm(), 0.05);
    EXPECT_LT(std::abs(difference.theta), 0.05);
  }
  const auto map = io::ReadOccupancyMap(folder / "room.yaml");
  ASSERT_TRUE(map.ok()) << map.status();
  EXPECT_NEAR(map->resolution, 0.1, 1e-9);
  // The room is eight by six metres.
  EXPECT_GT(map->width * map->resolution, 6.);
  EXPECT_LT(map->width * map->resolution, 12.);
  EXPECT_THAT(ReadFile(folder / "room.png").substr(1, 3), "PNG");
  EXPECT_THAT(ReadFile(folder / "room.csv"),
              HasSubstr("submap_trajectory_id,submap_index"));
}

TEST(ExportMainTest, WrongUsage) {
  EXPECT_EQ(RunCommand("export", {}).exit_code, 2);
  const CommandResult nothing =
      RunCommand("export", {"-pbstream_filename", "x.pbstream"});
  EXPECT_EQ(nothing.exit_code, 2);
  EXPECT_THAT(nothing.error, HasSubstr("nothing to write"));
}

TEST(ExportMainTest, BadInputs) {
  const TemporaryFolder folder;
  WriteFile(folder / "not.pbstream", "this is no map");
  const CommandResult wrong =
      RunCommand("export", {"-pbstream_filename", folder / "not.pbstream",
                            "-trajectory_filename", folder / "x.tum"});
  EXPECT_EQ(wrong.exit_code, 1);
  EXPECT_THAT(wrong.error, HasSubstr("not.pbstream"));
  EXPECT_EQ(folder.Names().size(), 1u);
  const CommandResult missing =
      RunCommand("export", {"-pbstream_filename", folder / "no.pbstream",
                            "-trajectory_filename", folder / "x.tum"});
  EXPECT_EQ(missing.exit_code, 1);
  EXPECT_THAT(missing.error, HasSubstr("no.pbstream"));
}

TEST(ExportMainTest, ColumnsAreDocumented) {
  const TemporaryFolder folder;
  WriteRoomMap(folder, 40);
  ASSERT_EQ(RunCommand("export", {folder / "room.pbstream",
                                  "-constraints_filename", folder / "x.csv"})
                .exit_code,
            0);
  const std::string table = ReadFile(folder / "x.csv");
  const std::string page = ReadFile("docs/side_files.md");
  for (const auto column :
       absl::StrSplit(table.substr(0, table.find('\n')), ',')) {
    EXPECT_THAT(page, HasSubstr(absl::StrCat("`", column, "`")));
  }
}

TEST(ExportMainTest, UnwritableOutputAndSenselessResolution) {
  const TemporaryFolder folder;
  WriteRoomMap(folder, 20);
  const CommandResult unwritable =
      RunCommand("export", {"-pbstream_filename", folder / "room.pbstream",
                            "-g2o_filename", "/nowhere/x.g2o"});
  EXPECT_EQ(unwritable.exit_code, 1);
  EXPECT_THAT(unwritable.error, HasSubstr("/nowhere/x.g2o"));
  const CommandResult too_fine = RunCommand(
      "export", {"-pbstream_filename", folder / "room.pbstream",
                 "-map_filestem", folder / "map", "-resolution", "0.00001"});
  EXPECT_EQ(too_fine.exit_code, 2);
  EXPECT_THAT(too_fine.error, HasSubstr("-resolution is \"0.00001\""));
}

}  // namespace
}  // namespace test
}  // namespace cartographer_ext
