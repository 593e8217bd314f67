// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
#include "cartographer_ext/map/verdict/evaluation_inputs.h"

#include <cstdio>

#include "absl/strings/str_cat.h"
#include "cartographer_ext/io/pbstream/pbstream_writer.h"
#include "cartographer_ext/io/relations_file.h"
#include "cartographer_ext/io/trajectory_file.h"
#include "gmock/gmock.h"
#include "gtest/gtest.h"
#include "tests/io/pbstream/pbstream_example.h"

namespace cartographer_ext {
namespace evaluation {
namespace {

class EvaluationInputsTest : public testing::Test {
 protected:
  EvaluationInputsTest() {
    files_.pbstream = Name("pbstream");
    CHECK(io::WritePbstream(io::ExamplePbstream(), files_.pbstream).ok());
  }
  ~EvaluationInputsTest() override {
    for (const std::string& name : names_) std::remove(name.c_str());
  }

  std::string Name(const std::string& ending) {
    names_.push_back(
        absl::StrCat(testing::TempDir(), "/evaluation_inputs.", ending));
    return names_.back();
  }

  EvaluationFiles files_;

 private:
  std::vector<std::string> names_;
};

TEST_F(EvaluationInputsTest, MakesOfAMapWhatIsUsed) {
  for (const bool contents : {false, true}) {
    for (const bool stored_grids : {false, true}) {
      SCOPED_TRACE(absl::StrCat(contents, " ", stored_grids));
      EvaluationUses uses;
      uses.contents = contents;
      uses.stored_grids = stored_grids;
      const auto inputs = ReadEvaluationInputs(files_, uses);
      ASSERT_TRUE(inputs.ok()) << inputs.status();
      EXPECT_EQ(inputs->contents.submaps.size(), contents ? 2u : 0u);
      EXPECT_EQ(inputs->contents.scans.size(), contents ? 3u : 0u);
      ASSERT_TRUE(inputs->pbstream.has_value());
      for (const auto& submap : inputs->pbstream->submaps) {
        EXPECT_EQ(submap.submap_2d().grid().cells_size() > 0, stored_grids);
      }
      EXPECT_EQ(inputs->graph.nodes.size(), 3u);
      EXPECT_EQ(inputs->graph.constraints.size(), 3u);
      EXPECT_EQ(inputs->odometry.size(), 1u);
    }
  }
}

// Also those of which no cell is used.
TEST_F(EvaluationInputsTest, InvalidGridsAreRefused) {
  io::Pbstream invalid = io::ExamplePbstream();
  invalid.submaps[1].mutable_submap_2d()->mutable_grid()->add_cells(1);
  ASSERT_TRUE(io::WritePbstream(invalid, files_.pbstream).ok());
  EvaluationUses uses;
  uses.contents = uses.stored_grids = false;
  EXPECT_TRUE(
      absl::IsInvalidArgument(ReadEvaluationInputs(files_, uses).status()));
}

TEST_F(EvaluationInputsTest, ReadsATrajectoryAndTheTruth) {
  files_.pbstream.clear();
  files_.trajectory = Name("tum");
  files_.reference_trajectory = Name("truth.tum");
  files_.relations = Name("relations");
  const std::vector<io::StampedPose> poses = {io::MakeStampedPose(1, Pose2()),
                                              io::MakeStampedPose(2, Pose2())};
  ASSERT_TRUE(io::WriteTumTrajectory(poses, files_.trajectory).ok());
  ASSERT_TRUE(io::WriteTumTrajectory(poses, files_.reference_trajectory).ok());
  ASSERT_TRUE(
      io::WriteRelations({io::StampedRelation()}, files_.relations).ok());
  const auto inputs = ReadEvaluationInputs(files_, {});
  ASSERT_TRUE(inputs.ok()) << inputs.status();
  EXPECT_FALSE(inputs->pbstream.has_value());
  EXPECT_TRUE(inputs->graph.nodes.empty());
  EXPECT_TRUE(inputs->trajectory.has_value());
  EXPECT_TRUE(inputs->truth.reference.has_value());
  EXPECT_EQ(inputs->truth.reference_name, files_.reference_trajectory);
  ASSERT_TRUE(inputs->truth.relations.has_value());
  EXPECT_EQ(inputs->truth.relations->size(), 1u);
  EXPECT_EQ(inputs->truth.relations_name, files_.relations);
}

TEST_F(EvaluationInputsTest, MissingFilesAreNamed) {
  for (std::string* const name :
       {&files_.pbstream, &files_.trajectory, &files_.relations,
        &files_.reference_trajectory}) {
    const std::string before = *name;
    *name = "no such file";
    EXPECT_THAT(
        std::string(ReadEvaluationInputs(files_, {}).status().message()),
        testing::HasSubstr("no such file"));
    *name = before;
  }
}

}  // namespace
}  // namespace evaluation
}  // namespace cartographer_ext
