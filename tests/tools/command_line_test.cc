// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
#include "cartographer_ext/tools/command_line.h"

#include <sys/stat.h>

#include <cmath>
#include <filesystem>
#include <vector>

#include "cartographer_ext/tools/flag_values.h"
#include "gflags/gflags.h"
#include "glog/logging.h"
#include "gmock/gmock.h"
#include "gtest/gtest.h"
#include "tests/tools/run_command.h"

DEFINE_string(test_name, "", "A word.");
DEFINE_string(test_picture_filename, "", "A picture.");
DEFINE_int32(test_number, 3, "A number.");
DEFINE_int32(test_index, -1, "A number, -1 for all.");
DEFINE_int32(num_background_threads, 2, "Threads.");
DEFINE_double(test_length, 1., "A length.");
DEFINE_double(max_test_length, 1., "A limit.");
DEFINE_double(resolution, 0.05, "Metres per cell.");
DEFINE_bool(test_switch, true, "On or off.");

namespace cartographer_ext {
namespace tools {
namespace {

void Parse(std::vector<std::string> arguments,
           const std::string& input_flag = "") {
  arguments.insert(arguments.begin(), "/somewhere/command");
  std::vector<char*> argv;
  for (std::string& argument : arguments) argv.push_back(&argument[0]);
  CommandLine command_line("Tests.", input_flag);
  command_line.Parse(static_cast<int>(argv.size()), argv.data());
  if (command_line.has_positional_input()) std::exit(7);
}

// Starting the log is for once a process, so each case has its own.
void ParseAndCheck(const std::vector<std::string>& arguments,
                   const std::string& name, int number, bool on) {
  EXPECT_EXIT(
      {
        google::ShutdownGoogleLogging();
        Parse(arguments);
        std::exit(FLAGS_test_name == name && FLAGS_test_number == number &&
                          FLAGS_test_switch == on && ProgramName() == "command"
                      ? 0
                      : 9);
      },
      testing::ExitedWithCode(0), "");
}

void ParseAndFail(const std::vector<std::string>& arguments,
                  const std::string& message) {
  EXPECT_EXIT(
      {
        google::ShutdownGoogleLogging();
        Parse(arguments);
      },
      testing::ExitedWithCode(2), message);
}

TEST(CommandLineTest, TakesFlagsInAllForms) {
  ParseAndCheck({}, "", 3, true);
  ParseAndCheck({"-test_name", "x", "--test_number", "4"}, "x", 4, true);
  ParseAndCheck({"--test_name=a=b", "-test_number=5"}, "a=b", 5, true);
  ParseAndCheck({"-notest_switch"}, "", 3, false);
  ParseAndCheck({"--test_switch=false"}, "", 3, false);
  ParseAndCheck({"-test_switch", "-test_name", "-json"}, "-json", 3, true);
}

TEST(CommandLineTest, RefusesWhatItDoesNotKnow) {
  ParseAndFail({"-nonsense_flag"}, "unknown flag -nonsense_flag");
  ParseAndFail({"-nonsense_flag=3"}, "unknown flag -nonsense_flag");
  ParseAndFail({"word"}, "what is \"word\"");
  ParseAndFail({"-"}, "what is \"-\"");
  ParseAndFail({"-test_number", "many"}, "-test_number cannot be \"many\"");
  ParseAndFail({"-test_number"}, "-test_number needs a value");
}

TEST(CommandLineTest, RefusesNumbersThatMeanNothing) {
  ParseAndFail({"-test_length", "nan"}, "-test_length is \"nan\", must be");
  ParseAndFail({"-test_length=-0.5"}, "-test_length is \"-0.5\", must be");
  ParseAndFail({"-test_number", "-5"}, "-test_number is \"-5\", must be");
  ParseAndFail({"-max_expansion", "0"}, "-max_expansion must be at least 1");
  ParseAndFail({"-num_background_threads", "100000"},
               "-num_background_threads must be at most 4096");
  // Its default is below 0.
  ParseAndCheck({"-test_index", "-1", "-max_test_length", "inf"}, "", 3, true);
}

TEST(CommandLineTest, RefusesValuesThatAFlagCannotHave) {
  const auto status = [](const std::string& value, const bool is_list) {
    gflags::FlagSaver saver;
    FLAGS_test_name = value;
    return std::string(CheckFlagChoices({{"test_name",
                                          {"acs", "gm", "huber"},
                                          is_list ? FlagChoices::Kind::kList
                                                  : FlagChoices::Kind::kOne}})
                           .message());
  };
  EXPECT_EQ(status("gm", false), "");
  EXPECT_EQ(status("", false), "");
  EXPECT_EQ(status("huper", false),
            "-test_name=huper is none of acs, gm, huber, did you mean "
            "'huber'?");
  EXPECT_EQ(status("acs,gm", false),
            "-test_name=acs,gm is none of acs, gm, "
            "huber");
  EXPECT_EQ(status("acs, gm", true), "");
  EXPECT_EQ(status("acs,foo", true),
            "-test_name=foo is none of acs, gm, "
            "huber");
}

TEST(CommandLineTest, RefusesPicturesInOtherFormats) {
  const auto status = [](const std::string& value,
                         const std::vector<FlagChoices>& choices) {
    gflags::FlagSaver saver;
    FLAGS_test_picture_filename = value;
    return std::string(CheckFlagChoices(choices).message());
  };
  EXPECT_EQ(status("", {}), "");
  EXPECT_EQ(status("a/map.png", {}), "");
  EXPECT_EQ(status("MAP.PNG", {}), "");
  EXPECT_EQ(status("/dev/null", {}), "");
  for (const char* name : {"map.jpg", "map.pgm", "map", "png", "map.png.gz"}) {
    EXPECT_THAT(status(name, {}),
                testing::AllOf(testing::HasSubstr(name),
                               testing::HasSubstr("must end in .png")));
  }
  const std::vector<FlagChoices> both = {
      {"test_picture_filename", {".png", ".svg"}, FlagChoices::Kind::kEnding}};
  EXPECT_EQ(status("map.svg", both), "");
  EXPECT_THAT(status("map.pdf", both),
              testing::HasSubstr("must end in .png or .svg"));
}

TEST(CommandLineTest, ErrorsOfUsageHaveTheirExitCode) {
  const absl::Status error = absl::InvalidArgumentError("-x is bad");
  EXPECT_EQ(ExitCode(error), kExitBadInput);
  EXPECT_EQ(ExitCode(WrongUsage(error)), kExitUsage);
  EXPECT_EQ(WrongUsage(error).message(), "-x is bad");
  EXPECT_EQ(ExitCode(WrongUsage(absl::OkStatus())), kExitSuccess);
}

TEST(CommandLineTest, TakesTheInputWithoutItsFlag) {
  EXPECT_EXIT(
      {
        google::ShutdownGoogleLogging();
        Parse({"-test_number", "4", "run.bag"}, "test_name");
      },
      testing::ExitedWithCode(7), "");
  const auto fails = [](const std::vector<std::string>& arguments,
                        const std::string& message) {
    EXPECT_EXIT(Parse(arguments, "test_name"), testing::ExitedWithCode(2),
                message);
  };
  fails({"run.bag", "other.bag"}, "\"other.bag\" is a second input");
  fails({"-test_name", "x", "run.bag"}, "\"run.bag\" is a second input");
  fails({"-"}, "what is \"-\"");
}

TEST(CommandLineTest, BehindTwoDashesComesTheInput) {
  EXPECT_EXIT(
      {
        google::ShutdownGoogleLogging();
        Parse({"-test_number", "3", "--", "-odd.clf"}, "test_name");
      },
      testing::ExitedWithCode(7), "");
}

TEST(CommandLineTest, PrintsItsVersion) {
  EXPECT_EXIT(Parse({"--version"}), testing::ExitedWithCode(0), "");
}

TEST(CommandLineTest, FindsTheConfigurationFromTheProgram) {
  EXPECT_THAT(ConfigurationDirectories("a,b"), testing::ElementsAre("a", "b"));
  const test::TemporaryFolder folder;
  const auto make = [&](const std::string& files) {
    std::filesystem::create_directories(folder / files);
    test::WriteFile(folder / files + "/cartographer_ext.lua", "");
    return folder / files;
  };
  const std::string installed =
      make("prefix/share/cartographer/configuration_files");
  EXPECT_EQ(ConfigurationDirectoryOf(folder / "prefix/bin/command"), installed);
  // Our own package has a folder of its own.
  const std::string packaged =
      make("prefix/share/cartographer_ext/configuration_files");
  EXPECT_EQ(ConfigurationDirectoryOf(folder / "prefix/bin/command"), packaged);
  const std::string sources = make("sources/configuration_files");
  EXPECT_EQ(ConfigurationDirectoryOf(folder / "sources/build/x/bin/command"),
            sources);
  // Elsewhere those of the sources it was built from.
  EXPECT_THAT(ConfigurationDirectoryOf("/nowhere/command"),
              testing::EndsWith("configuration_files"));
  std::filesystem::remove_all(folder / "prefix");
  std::filesystem::remove_all(folder / "sources");
}

TEST(CommandLineTest, StatusBecomesExitCode) {
  EXPECT_EQ(ExitCode(absl::OkStatus()), 0);
  EXPECT_EQ(ExitCode(absl::NotFoundError("x")), 1);
  EXPECT_EQ(UsageError("x"), 2);
}

TEST(CommandLineTest, CheckWritableLeavesNothingBehind) {
  const test::TemporaryFolder folder;
  EXPECT_TRUE(CheckWritable({"", "-", folder / "new"}).ok());
  EXPECT_TRUE(folder.Names().empty());
  const absl::Status status =
      CheckWritable({folder / "fine", folder / "missing/file"});
  EXPECT_FALSE(status.ok());
  EXPECT_THAT(std::string(status.message()),
              testing::HasSubstr("missing/file"));
  // What is there already stays as it is.
  test::WriteFile(folder / "old", "content");
  EXPECT_TRUE(CheckWritable({folder / "old"}).ok());
  EXPECT_EQ(test::ReadFile(folder / "old"), "content");
}

TEST(CommandLineTest, OutputsReplaceNoInputAndNoOtherOutput) {
  const test::TemporaryFolder folder;
  const auto message = [](const absl::Status& status) {
    return std::string(status.message());
  };
  // Not there yet, and written two ways.
  EXPECT_THAT(message(CheckWritable({folder / "a", folder / "./a"})),
              testing::HasSubstr("/a: two files of the command"));
  EXPECT_TRUE(CheckWritable({folder / "a", folder / "b"}).ok());
  test::WriteFile(folder / "in", "content");
  std::filesystem::create_symlink(folder / "in", folder / "link");
  EXPECT_TRUE(CheckWritable({folder / "b"}, {folder / "in"}).ok());
  for (const char* name : {"in", "./in", "link"}) {
    EXPECT_THAT(message(CheckWritable({folder / name}, {folder / "in"})),
                testing::HasSubstr("the output is also the input"))
        << name;
  }
  EXPECT_TRUE(CheckWritable({"/dev/null", "/dev/null"}, {"/dev/null"}).ok());
  EXPECT_TRUE(CheckWritable({"-", "", ""}, {"-", ""}).ok());
  EXPECT_THAT(message(CheckWritable({"-", "-"})),
              testing::HasSubstr("two outputs are -"));
}

// Whoever opens it and goes away again ends the reader.
TEST(CommandLineTest, PipesAreNotOpenedByTheCheck) {
  const test::TemporaryFolder folder;
  ASSERT_EQ(mkfifo((folder / "pipe").c_str(), 0600), 0);
  EXPECT_TRUE(CheckWritable({folder / "pipe"}).ok());  // would wait for ever
}

TEST(CommandLineTest, ValuesMakeSense) {
  const auto good = [](const std::string& name, const std::string& value) {
    return CheckFlagValue(name, value).ok();
  };
  EXPECT_TRUE(good("test_length", "2.5"));
  EXPECT_FALSE(good("test_length", "inf"));
  EXPECT_FALSE(good("test_length", "nan"));
  EXPECT_FALSE(good("test_length", "-1"));
  EXPECT_TRUE(good("max_test_length", "inf"));
  EXPECT_TRUE(good("test_index", "-1"));
  EXPECT_FALSE(good("test_index", "-2"));
  EXPECT_TRUE(good("test_name", "-inf"));
  for (const char* const value : {"0", "1e-300", "1e308", "11"}) {
    EXPECT_THAT(std::string(CheckFlagValue("resolution", value).message()),
                testing::HasSubstr("at least 0.001 and at most 10"));
  }
  EXPECT_TRUE(good("resolution", "0.05"));
  EXPECT_TRUE(good("json", "-"));
  EXPECT_FALSE(good("pbstream_filename", "-"));
  EXPECT_FALSE(good("map_filestem", "-"));
}

TEST(CommandLineTest, NumbersAndMessagesCanBeRead) {
  EXPECT_EQ(ShortestNumber("0.050000000000000003"), "0.05");
  EXPECT_EQ(ShortestNumber("1000000000"), "1000000000");
  EXPECT_EQ(ShortestNumber("auto"), "auto");
  EXPECT_EQ(Printable("a\x1b[2Jb\x7f\r\n\tü"), "a?[2Jb??\n\tü");
}

TEST(CommandLineTest, JsonHasNoNan) {
  const test::TemporaryFolder folder;
  nlohmann::ordered_json json;
  json["b"] = std::nan("");
  json["a"] = 1;
  json["text"] = "broken \xff byte";
  ASSERT_TRUE(WriteJson(json, folder / "x.json").ok());
  const std::string text = test::ReadFile(folder / "x.json");
  EXPECT_EQ(text.back(), '\n');
  const auto parsed = test::ParseJson(text);
  EXPECT_TRUE(parsed["b"].is_null());
  EXPECT_EQ(parsed["a"], 1);
  EXPECT_LT(text.find("\"b\""), text.find("\"a\""));
}

TEST(CommandLineTest, BaseName) {
  EXPECT_EQ(BaseName("/a/b.clf"), "b.clf");
  EXPECT_EQ(BaseName("b.clf"), "b.clf");
}

}  // namespace
}  // namespace tools
}  // namespace cartographer_ext
