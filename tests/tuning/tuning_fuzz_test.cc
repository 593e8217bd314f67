// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
//
// Damaged journals and search files: opening them must return.
#include <string>

#include "cartographer_ext/tuning/journal.h"
#include "cartographer_ext/tuning/search_spec.h"
#include "gtest/gtest.h"
#include "tests/mutation.h"

namespace cartographer_ext {
namespace tuning {
namespace {

TEST(TuningFuzzTest, DamagedJournalsReturn) {
  const test::TemporaryFile file(".jsonl");
  {
    const auto journal = Journal::Open(file.path(), "f");
    ASSERT_TRUE(journal.ok());
    for (int i = 0; i < 5; ++i) {
      RunRecord record;
      record.assignment = {{"A.b", i}, {"A.c", "text"}};
      record.input = "log.clf@12";
      record.ok = i % 2 == 0;
      record.message = record.ok ? "" : "it crashed";
      record.metrics = {{"relations", 0.5 * i}, {"cpu_seconds", 2.}};
      record.wall_seconds = 3.;
      ASSERT_TRUE((*journal)->Append(record).ok());
    }
  }
  const std::string sample = test::ReadBytes(file.path());
  test::ForEachMutation(sample, [&file](const std::string& damaged) {
    test::WriteBytes(file.path(), damaged);
    const auto journal = Journal::Open(file.path(), "f");
    if (!journal.ok()) return;
    for (const RunRecord& record : (*journal)->runs()) RunKey(record);
  });
}

TEST(TuningFuzzTest, DamagedSearchFilesReturn) {
  const std::string sample = R"(return {
  configuration = "stock.lua",
  objective = { relations = 1., cpu_seconds = 0.001 },
  aggregation = "mean",
  parameters = {
    { key = "POSE_GRAPH.constraint_builder.min_score", range = { 0.4, 0.8 } },
    { key = "A.huber_scale", range = { 0.1, 1e3 }, scale = "log", steps = 4 },
    { key = "A.num", range = { 30, 180 }, integer = true },
    { key = "A.use", choices = { false, true } },
    { include = "front_end", choices = { "", "front_end_default.lua" } },
  },
})";
  const test::TemporaryFile file(".lua");
  test::WriteBytes(file.path(), sample);
  ASSERT_TRUE(ReadSearchSpec(file.path()).ok());
  test::ForEachMutation(sample, [&file](const std::string& damaged) {
    test::WriteBytes(file.path(), damaged);
    ReadSearchSpec(file.path()).status().IgnoreError();
  });
}

}  // namespace
}  // namespace tuning
}  // namespace cartographer_ext
