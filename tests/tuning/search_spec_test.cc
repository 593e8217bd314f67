// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
#include "cartographer_ext/tuning/search_spec.h"

#include "gmock/gmock.h"
#include "gtest/gtest.h"
#include "tests/tuning/temporary_file.h"

namespace cartographer_ext {
namespace tuning {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;

constexpr char kParameters[] =
    "parameters = { { key = 'A.b', range = { 0., 1. } } }";

TEST(SearchSpecTest, ReadsAllKeys) {
  const test::Folder folder;
  const auto spec = ReadSearchSpec(folder.Write(
      "search.lua", std::string("return { configuration = 'c.lua', ") +
                        kParameters +
                        ", objective = { ate = 2. }, aggregation = 'max',"
                        " target_recall = 0.7, no_input_worse = true, inputs = "
                        "{ 'a.clf', 'b.clf' },"
                        " holdout = {} }"));
  ASSERT_TRUE(spec.ok()) << spec.status();
  EXPECT_EQ(spec->configuration, "c.lua");
  EXPECT_EQ(spec->parameters.size(), 1u);
  EXPECT_EQ(spec->objective.weights.at("ate"), 2.);
  EXPECT_EQ(spec->objective.aggregation, Objective::Aggregation::kMax);
  EXPECT_EQ(spec->objective.target_recall, 0.7);
  EXPECT_TRUE(spec->no_input_worse);
  EXPECT_THAT(spec->inputs, ElementsAre("a.clf", "b.clf"));
  EXPECT_TRUE(spec->holdout.empty());
}

TEST(SearchSpecTest, ErrorsNameFileAndKey) {
  const test::Folder folder;
  const auto error = [&](const std::string& content) {
    const auto spec = ReadSearchSpec(folder.Write("search.lua", content));
    EXPECT_FALSE(spec.ok()) << content;
    return std::string(spec.status().message());
  };
  EXPECT_THAT(error("return {}"), HasSubstr("parameters is missing"));
  EXPECT_THAT(error("return 3"), HasSubstr("search.lua"));
  EXPECT_THAT(error("return {"), HasSubstr("search.lua:1:"));
  const auto with = [&](const std::string& more) {
    return error(std::string("return { ") + kParameters + ", " + more + " }");
  };
  EXPECT_THAT(with("paramters = 1"),
              HasSubstr("unknown key 'paramters', did you mean 'parameters'?"));
  EXPECT_THAT(error("return { map_builder = {} }"),
              HasSubstr("is a configuration, not a search file"));
  EXPECT_THAT(with("objective = 'joy'"), HasSubstr("unknown objective"));
  EXPECT_THAT(with("aggregation = 'sum'"), HasSubstr("aggregation"));
  EXPECT_THAT(with("target_recall = 0"), HasSubstr("target_recall"));
  EXPECT_THAT(with("no_input_worse = 1"), HasSubstr("no_input_worse"));
  EXPECT_THAT(with("inputs = 'a'"), HasSubstr("inputs"));
  EXPECT_THAT(with("inputs = { 1 }"), HasSubstr("inputs"));
  EXPECT_THAT(with("configuration = 1"), HasSubstr("configuration"));
  EXPECT_FALSE(ReadSearchSpec(folder.path() + "/absent.lua").ok());
}

TEST(SearchSpecTest, InputsFindTheirTruth) {
  const test::Folder folder;
  const std::string log = folder.Write("run.clf.xz", "1234");
  const auto alone = ParseInput(log);
  ASSERT_TRUE(alone.ok());
  EXPECT_EQ(alone->name, "run.clf.xz@4");
  EXPECT_EQ(alone->relations_filename, "");
  EXPECT_EQ(alone->reference_filename, "");
  const std::string relations = folder.Write("run.relations", "12");
  const std::string other = folder.Write("other.tum", "123");
  const auto beside = ParseInput(log);
  ASSERT_TRUE(beside.ok());
  EXPECT_EQ(beside->relations_filename, relations);
  EXPECT_EQ(beside->name, "run.clf.xz@4+run.relations@2");
  const auto named = ParseInput(log + "=" + other);
  ASSERT_TRUE(named.ok());
  EXPECT_EQ(named->reference_filename, other);
  EXPECT_EQ(named->relations_filename, "");
}

TEST(SearchSpecTest, WorldsHaveSeedsAndMapsAreKnown) {
  const test::Folder folder;
  const std::string world = folder.Write("room.world", "x");
  const auto input = ParseInput(world + "#12");
  ASSERT_TRUE(input.ok()) << input.status();
  EXPECT_TRUE(input->is_world);
  EXPECT_EQ(input->seed, 12u);
  EXPECT_EQ(input->recording, world);
  EXPECT_EQ(input->name, "room.world#12@1");
  const auto map = ParseInput(folder.Write("m.pbstream", ""));
  ASSERT_TRUE(map.ok());
  EXPECT_TRUE(map->is_pbstream);
}

TEST(SearchSpecTest, MissingTruthIsNoticedBeforehand) {
  TuneInput log;
  log.recording = "run.clf";
  Objective objective;
  objective.weights = {{"relations", 1.}};
  EXPECT_THAT(std::string(CheckTruth({log}, objective).message()),
              HasSubstr("run.clf: no 'relations' without"));
  log.relations_filename = "run.relations";
  EXPECT_TRUE(CheckTruth({log}, objective).ok());
  objective.weights = {{"ate", 1.}};
  EXPECT_THAT(std::string(CheckTruth({log}, objective).message()),
              HasSubstr("run.clf: no 'ate' without"));
  objective.weights = {{"self_consistency", 1.}, {"cpu_seconds", 1.}};
  EXPECT_TRUE(CheckTruth({log}, objective).ok());
  TuneInput world;
  world.is_world = true;
  objective.weights = {{"ate", 1.}, {"relations_loop", 1.}};
  EXPECT_TRUE(CheckTruth({world}, objective).ok());
}

TEST(SearchSpecTest, BadInputsAreErrors) {
  const test::Folder folder;
  const std::string log = folder.Write("run.clf", "1");
  EXPECT_THAT(
      std::string(ParseInput(folder.path() + "/no.clf").status().message()),
      HasSubstr("no.clf"));
  EXPECT_FALSE(ParseInput(log + "=" + folder.path() + "/no.tum").ok());
  EXPECT_FALSE(ParseInput(folder.path()).ok());
  folder.Write("a.world", "");
  EXPECT_THAT(
      std::string(ParseInput(folder.path() + "/a.world#x").status().message()),
      HasSubstr("not a seed"));
  EXPECT_THAT(std::string(ParseInputs({log, log}).status().message()),
              HasSubstr("twice"));
}

}  // namespace
}  // namespace tuning
}  // namespace cartographer_ext
