// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
#include "absl/strings/str_format.h"
#include "gmock/gmock.h"
#include "gtest/gtest.h"
#include "tests/tools/run_command.h"

namespace cartographer_ext {
namespace test {
namespace {

using testing::HasSubstr;

// Poses along x, ten a second; those before `jump` are `offset` too far left.
std::string Line(const int scans, const double offset, const int jump) {
  std::string text;
  for (int i = 0; i < scans; ++i) {
    text += absl::StrFormat("%.3f %.6f %.6f 0 0 0 0 1\n", 100. + 0.1 * i,
                            0.1 * i, i < jump ? offset : 0.);
  }
  return text;
}

TEST(EvaluateLocalizationMainTest, CountsTimeAndJumps) {
  const TemporaryFolder folder;
  WriteFile(folder / "truth.tum", Line(300, 0., 0));
  WriteFile(folder / "online.tum", Line(300, 7., 100));
  const CommandResult result =
      RunCommand("evaluate_localization",
                 {"-trajectory_filename", folder / "online.tum",
                  "-reference_trajectory_filename", folder / "truth.tum",
                  "-json", folder / "result.json"});
  ASSERT_EQ(result.exit_code, 0) << result.error;
  EXPECT_THAT(result.out, HasSubstr("in 1 of 1 segments; 0 jumps"));
  EXPECT_THAT(result.out, HasSubstr("after 10.0 s and 10.0 m"));
  const auto json = ParseJson(ReadFile(folder / "result.json"));
  ASSERT_TRUE(json.is_object());
  EXPECT_EQ(json["scans"], 300);
  EXPECT_EQ(json["localized"], 1);
  EXPECT_EQ(json["jumps"], 0);
  EXPECT_EQ(json["wrong_jumps"], 0);
  EXPECT_NEAR(json["segments"][0]["seconds_until_localized"].get<double>(), 10.,
              1e-6);
}

TEST(EvaluateLocalizationMainTest, LaysTheMapOverTheTruth) {
  const TemporaryFolder folder;
  // The map is 7 m to the left of the truth, and so is the estimate.
  WriteFile(folder / "truth.tum", Line(300, 0., 0));
  WriteFile(folder / "map.tum", Line(300, 7., 300));
  const CommandResult result =
      RunCommand("evaluate_localization",
                 {"-trajectory_filename", folder / "map.tum",
                  "-reference_trajectory_filename", folder / "truth.tum",
                  "-map_trajectory_filename", folder / "map.tum",
                  "-map_reference_trajectory_filename", folder / "truth.tum",
                  "-json", "-"});
  ASSERT_EQ(result.exit_code, 0) << result.error;
  const auto json = ParseJson(result.out);
  ASSERT_TRUE(json.is_object()) << result.out;
  EXPECT_NEAR(json["segments"][0]["translation_error"]["max"].get<double>(), 0.,
              1e-5);
}

TEST(EvaluateLocalizationMainTest, TellsWhatIsWrong) {
  EXPECT_EQ(RunCommand("evaluate_localization", {}).exit_code, 2);
  EXPECT_EQ(
      RunCommand("evaluate_localization",
                 {"-trajectory_filename=a", "-reference_trajectory_filename=b",
                  "-map_trajectory_filename=c"})
          .exit_code,
      2);
  EXPECT_EQ(RunCommand("evaluate_localization",
                       {"-trajectory_filename=a",
                        "-reference_trajectory_filename=b", "-jump_distance=0"})
                .exit_code,
            2);
  const TemporaryFolder folder;
  WriteFile(folder / "truth.tum", Line(300, 0., 0));
  const CommandResult missing =
      RunCommand("evaluate_localization",
                 {"-trajectory_filename", folder / "no.tum",
                  "-reference_trajectory_filename", folder / "truth.tum"});
  EXPECT_EQ(missing.exit_code, 1);
  EXPECT_THAT(missing.error, HasSubstr("no.tum"));
  WriteFile(folder / "one.tum", Line(1, 0., 0));
  const CommandResult one =
      RunCommand("evaluate_localization",
                 {"-trajectory_filename", folder / "one.tum",
                  "-reference_trajectory_filename", folder / "truth.tum"});
  EXPECT_EQ(one.exit_code, 1);
  EXPECT_THAT(one.error, HasSubstr("only 1 poses have a ground truth pose"));
}

}  // namespace
}  // namespace test
}  // namespace cartographer_ext
