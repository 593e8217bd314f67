// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
#include "cartographer_ext/experiments/golden_pairs.h"

#include <fstream>

#include "gtest/gtest.h"

namespace cartographer_ext {
namespace evaluation {
namespace {

using cartographer::mapping::NodeId;
using cartographer::mapping::SubmapId;

const char kHeader[] =
    "kind,submap_trajectory,submap_index,node_trajectory,node_index,points,"
    "initial_x,initial_y,initial_theta,min_score,found,score,x,y,theta,"
    "search_us,refined_x,refined_y,refined_theta,final_cost,refine_us,"
    "build_us\n";

std::string WriteFile(const std::string& content) {
  const std::string filename = ::testing::TempDir() + "golden_pairs_test.csv";
  std::ofstream(filename) << content;
  return filename;
}

TEST(ReadGoldenPairsTest, ReadsColumnsByName) {
  const auto pairs = ReadGoldenPairs(WriteFile(
      std::string(kHeader) +
      "local,1,2,3,4,165,0.1,0.2,0.3,0.45,1,0.7,0.4,0.5,0.6,9827,0.7,0.8,0.9,"
      "25.5,449,62511\n"
      "full,1,2,3,5,165,0.1,0.2,0.3,0.45,0,0,0,0,0,9827,0,0,0,-1,0,62511\n"));
  ASSERT_TRUE(pairs.ok()) << pairs.status();
  ASSERT_EQ(pairs->size(), 2u);
  const GoldenPair& pair = pairs->front();
  EXPECT_EQ(pair.line, 2);
  EXPECT_FALSE(pair.full_submap);
  EXPECT_EQ(pair.submap_id, (SubmapId{1, 2}));
  EXPECT_EQ(pair.node_id, (NodeId{3, 4}));
  EXPECT_EQ(pair.num_points, 165);
  EXPECT_EQ(pair.initial_pose.theta, 0.3);
  EXPECT_EQ(pair.min_score, 0.45);
  EXPECT_TRUE(pair.found);
  EXPECT_EQ(pair.pose.y, 0.5);
  EXPECT_EQ(pair.refined_pose.x, 0.7);
  EXPECT_EQ(pair.final_cost, 25.5);
  EXPECT_EQ(pair.build_microseconds, 62511.);
  EXPECT_TRUE((*pairs)[1].full_submap);
  EXPECT_FALSE((*pairs)[1].found);
}

TEST(ReadGoldenPairsTest, NamesWhatIsWrong) {
  EXPECT_FALSE(ReadGoldenPairs("/nonexistent.csv").ok());
  const auto no_header = ReadGoldenPairs(WriteFile("a,b,c\n1,2,3\n"));
  EXPECT_NE(no_header.status().message().find("no column 'kind'"),
            std::string::npos)
      << no_header.status();
  // The line has as many values as there are names.
  const auto twice = ReadGoldenPairs(
      WriteFile(std::string("x,y,") + kHeader +
                "local,0,1,0,2,3,0,0,0,0.5,1,0.6,0,0,0,1,0,0,0,1,1,1\n"));
  EXPECT_NE(twice.status().message().find("two columns 'x'"), std::string::npos)
      << twice.status();
  const auto empty = ReadGoldenPairs(WriteFile(""));
  EXPECT_FALSE(empty.ok());
  const auto short_line =
      ReadGoldenPairs(WriteFile(std::string(kHeader) + "local,1\n"));
  EXPECT_NE(short_line.status().message().find(":2: 2 values"),
            std::string::npos)
      << short_line.status();
  const auto bad_number = ReadGoldenPairs(WriteFile(
      std::string(kHeader) +
      "local,1,2,3,4,165,0.1,0.2,0.3,0.45,1,nan,0.4,0.5,0.6,9827,0.7,0.8,0.9,"
      "25.5,449,62511\n"));
  EXPECT_NE(bad_number.status().message().find(":2: bad score 'nan'"),
            std::string::npos)
      << bad_number.status();
  const auto bad_kind = ReadGoldenPairs(WriteFile(
      std::string(kHeader) +
      "odd,1,2,3,4,165,0.1,0.2,0.3,0.45,1,0,0.4,0.5,0.6,9827,0.7,0.8,0.9,"
      "25.5,449,62511\n"));
  EXPECT_NE(bad_kind.status().message().find("bad kind 'odd'"),
            std::string::npos)
      << bad_kind.status();
}

}  // namespace
}  // namespace evaluation
}  // namespace cartographer_ext
