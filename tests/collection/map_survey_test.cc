// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
#include "cartographer_ext/collection/map_survey.h"

#include <signal.h>
#include <stdlib.h>
#include <unistd.h>

#include <filesystem>
#include <fstream>
#include <thread>

#include "gmock/gmock.h"
#include "gtest/gtest.h"

namespace cartographer_ext {
namespace collection {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;

// Judges by the file's content: "crash" dies, anything else is the verdict.
// Leaves a mark beside the file for each time it was asked.
nlohmann::json FakeAnswer(const nlohmann::json& request) {
  const std::string filename = request["filename"];
  std::ofstream(filename + ".asked", std::ios::app) << "x";
  std::string content;
  std::ifstream(filename) >> content;
  if (content == "crash") abort();
  if (content.empty()) return tuning::Failure(filename + ": is empty");
  // Later files first, so that the order of answers is another one.
  std::this_thread::sleep_for(std::chrono::milliseconds(
      filename.find("a.map") != std::string::npos ? 60 : 1));
  MapRecord record;
  record.filename = filename;
  record.verdict = content;
  return {{"ok", true}, {"metrics", ToJson(record)}};
}

class MapSurveyTest : public testing::Test {
 protected:
  MapSurveyTest() {
    std::string name = testing::TempDir() + "map_survey_XXXXXX";
    root_ = mkdtemp(&name[0]);
  }
  ~MapSurveyTest() override { std::filesystem::remove_all(root_); }

  std::string Write(const std::string& name, const std::string& content) {
    const std::string filename = root_ + "/" + name;
    std::ofstream(filename) << content;
    return filename;
  }

  std::vector<std::string> Verdicts(const std::vector<std::string>& files,
                                    const int workers) {
    tuning::LocalWorkerPool pool(workers, 0., &FakeAnswer);
    SurveyOptions options;
    options.journal_filename = journal_;
    const auto records = SurveyMaps(files, options, &pool);
    EXPECT_TRUE(records.ok()) << records.status();
    std::vector<std::string> verdicts;
    if (!records.ok()) return verdicts;
    for (size_t i = 0; i < files.size(); ++i) {
      EXPECT_EQ((*records)[i].filename, files[i]);
      verdicts.push_back((*records)[i].verdict);
    }
    return verdicts;
  }

  int64_t TimesAsked(const std::string& filename) {
    std::error_code error;
    const auto size = std::filesystem::file_size(filename + ".asked", error);
    return error ? 0 : static_cast<int64_t>(size);
  }

  std::string root_;
  std::string journal_;
};

TEST_F(MapSurveyTest, ACrashStopsNoOther) {
  const std::vector<std::string> files = {
      Write("a.map", "sound"), Write("b.map", "crash"), Write("c.map", ""),
      Write("d.map", "broken")};
  for (const int workers : {1, 2, 3}) {
    EXPECT_THAT(Verdicts(files, workers),
                ElementsAre("sound", "failed", "failed", "broken"));
  }
}

TEST_F(MapSurveyTest, GoesOnWhereItWasAndLooksAgainAtWhatHasChanged) {
  journal_ = root_ + "/journal";
  const std::vector<std::string> files = {Write("a.map", "sound"),
                                          Write("b.map", "broken")};
  EXPECT_THAT(Verdicts(files, 1), ElementsAre("sound", "broken"));
  // As after kill -9 in the middle of a line.
  std::ofstream(journal_, std::ios::app) << "{\"state\": \"1";
  EXPECT_THAT(Verdicts(files, 1), ElementsAre("sound", "broken"));
  EXPECT_EQ(TimesAsked(files[0]), 1);
  EXPECT_EQ(TimesAsked(files[1]), 1);
  Write("b.map", "doubtful");
  EXPECT_THAT(Verdicts(files, 1), ElementsAre("sound", "doubtful"));
  EXPECT_EQ(TimesAsked(files[0]), 1);
  EXPECT_EQ(TimesAsked(files[1]), 2);
}

TEST_F(MapSurveyTest, AJournalThatIsNoneIsLeftAlone) {
  journal_ = Write("a.map", "sound");
  tuning::LocalWorkerPool pool(1, 0., &FakeAnswer);
  SurveyOptions options;
  options.journal_filename = journal_;
  const auto records = SurveyMaps({journal_}, options, &pool);
  EXPECT_THAT(std::string(records.status().message()),
              HasSubstr("a.map: line 1: not a journal of maps"));
  std::string content;
  std::ifstream(journal_) >> content;
  EXPECT_EQ(content, "sound");
}

TEST_F(MapSurveyTest, PagesHaveNamesOfTheirOwn) {
  EXPECT_THAT(ReportFilenames(
                  {"x/a.pbstream", "x_a.pbstream", "../b c.pbstream"}, "out"),
              ElementsAre("out/x_a.html", "out/x_a-2.html", "out/b_c.html"));
  EXPECT_THAT(ReportFilenames({"a"}, ""), ElementsAre(""));
}

}  // namespace
}  // namespace collection
}  // namespace cartographer_ext
