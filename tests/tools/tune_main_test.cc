// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
#include <signal.h>
#include <stdlib.h>

#include <algorithm>
#include <chrono>
#include <thread>

#include "gmock/gmock.h"
#include "gtest/gtest.h"
#include "tests/test_data.h"
#include "tests/tools/run_command.h"

namespace cartographer_ext {
namespace test {
namespace {

using testing::HasSubstr;

constexpr char kWorld[] = R"(world room
rectangle 0 0 6 5
rectangle 2.5 2 3.2 3
laser beams=60 fov=360 max_range=10 noise=0.01 rate=4
odometry rate=10 noise=0.004 mismatch_sigma=0.01
robot radius=0.2 speed=0.9
start 1 1 0
goto 5 1
goto 5 4
goto 1 4
goto 1 1
wait 1
)";

constexpr char kSearch[] = R"(return {
  parameters = {
    { key = "TRAJECTORY_BUILDER_2D.ceres_scan_matcher.translation_weight",
      range = { 1., 100. }, scale = "log" },
    { key = "TRAJECTORY_BUILDER_2D.ceres_scan_matcher.rotation_weight",
      range = { 1., 100. }, scale = "log" },
  },
})";

class TuneMainTest : public testing::Test {
 protected:
  TuneMainTest() {
    WriteFile(folder_ / "room.world", kWorld);
    WriteFile(folder_ / "search.lua", kSearch);
  }

  std::vector<std::string> Arguments(
      const std::vector<std::string>& more = {}) {
    std::vector<std::string> arguments = {
        "-search_filename",
        folder_ / "search.lua",
        "-inputs",
        folder_ / "room.world#1" + "," + folder_ / "room.world#2",
        "-method",
        "random",
        "-max_trials",
        "4"};
    arguments.insert(arguments.end(), more.begin(), more.end());
    return arguments;
  }

  // What of a result does not depend on time.
  static std::string Signature(const std::string& json_text) {
    auto json = ParseJson(json_text);
    EXPECT_TRUE(json.is_object()) << json_text;
    return json["best"].dump() + json["trial_list"].dump() +
           json["changes"].dump();
  }

  // The runs of a journal without their times, in alphabetical order.
  static std::vector<std::string> Runs(const std::string& journal) {
    std::vector<std::string> runs;
    std::istringstream stream(journal);
    std::string line;
    std::getline(stream, line);
    while (std::getline(stream, line)) {
      auto json = ParseJson(line);
      for (const char* key : {"wall_seconds", "cpu_seconds"}) {
        json.erase(key);
        json["metrics"].erase(key);
      }
      json["metrics"].erase("loop_search_cpu_seconds");
      runs.push_back(json.dump());
    }
    std::sort(runs.begin(), runs.end());
    return runs;
  }

  // Until tasks 1 to `count` of a job array have begun.
  static void WaitForTasks(const TemporaryFolder& job, const int count) {
    for (int task = 1; task <= count; ++task) {
      const std::string name = "task-" + std::to_string(task) + ".json";
      for (int i = 0; i < 3000 && ReadFile(job / name).empty(); ++i) {
        std::this_thread::sleep_for(std::chrono::milliseconds(10));
      }
    }
  }

  const TemporaryFolder folder_;
};

TEST_F(TuneMainTest, WritesEverything) {
  const CommandResult result = RunCommand(
      "tune",
      Arguments({"-holdout", folder_ / "room.world#3", "-output_filename",
                 folder_ / "tuned.lua", "-picture_filename",
                 folder_ / "tuned.svg", "-json", folder_ / "tuned.json",
                 "-journal_filename", folder_ / "journal"}));
  ASSERT_EQ(result.exit_code, 0) << result.error;
  EXPECT_THAT(result.out, HasSubstr("Objective  relations"));
  EXPECT_THAT(result.out, HasSubstr("Held out"));
  EXPECT_THAT(ReadFile(folder_ / "tuned.lua"), HasSubstr("Held out"));
  EXPECT_THAT(ReadFile(folder_ / "tuned.lua"),
              HasSubstr("-configuration_basename=tuned.lua"));
  // It is a configuration as it stands.
  const CommandResult run = RunCommand(
      "slam", {"-input_filename", folder_ / "room.world", "-pbstream_filename",
               folder_ / "tuned.pbstream", "-configuration_directory",
               folder_.path() + ",configuration_files",
               "-configuration_basename", "tuned.lua"});
  EXPECT_EQ(run.exit_code, 0) << run.error;
  EXPECT_THAT(ReadFile(folder_ / "tuned.svg"), HasSubstr("<svg"));
  const auto json = ParseJson(ReadFile(folder_ / "tuned.json"));
  EXPECT_EQ(json["trials"], 4);
  EXPECT_GT(json["baseline"]["objective"], 0.);
  EXPECT_LE(json["best"]["objective"], json["baseline"]["objective"]);
  EXPECT_GT(json["best"]["holdout"], 0.);
  EXPECT_TRUE(json["best"]["keys"].is_object());
}

TEST_F(TuneMainTest, WritesAllOrNothing) {
  if (access("/dev/full", W_OK) != 0) GTEST_SKIP() << "no /dev/full";
  const size_t before = folder_.Names().size();
  const CommandResult result = RunCommand(
      "tune",
      Arguments({"-output_filename", folder_ / "tuned.lua", "-picture_filename",
                 folder_ / "tuned.svg", "-json", "/dev/full"}));
  EXPECT_EQ(result.exit_code, 1);
  EXPECT_EQ(folder_.Names().size(), before);
}

TEST_F(TuneMainTest, TheOutputIsNotTheConfiguration) {
  const CommandResult result = RunCommand(
      "tune", Arguments({"-output_filename", folder_ / "stock.lua"}));
  EXPECT_EQ(result.exit_code, 1);
  EXPECT_THAT(result.error, HasSubstr("must have another name"));
}

TEST_F(TuneMainTest, TheNumberOfWorkersDoesNotMatter) {
  std::string one;
  for (const std::string workers : {"1", "2"}) {
    const CommandResult result =
        RunCommand("tune", Arguments({"-workers", workers, "-json", "-"}));
    ASSERT_EQ(result.exit_code, 0) << result.error;
    if (one.empty()) one = Signature(result.out);
    EXPECT_EQ(one, Signature(result.out));
  }
}

TEST_F(TuneMainTest, MpiFindsTheSame) {
  if (std::system("command -v mpirun > /dev/null 2>&1") != 0) {
    GTEST_SKIP() << "mpirun is not installed";
  }
  const CommandResult alone = RunCommand("tune", Arguments({"-json", "-"}));
  ASSERT_EQ(alone.exit_code, 0) << alone.error;
  std::string command =
      // MPI itself leaks a little.
      "OMPI_ALLOW_RUN_AS_ROOT=1 OMPI_ALLOW_RUN_AS_ROOT_CONFIRM=1 "
      "ASAN_OPTIONS=detect_leaks=0 "
      "mpirun --oversubscribe -n 3 " +
      std::string(CARTOGRAPHER_EXT_BIN_DIR) + "/cartographer_ext_tune";
  for (const std::string& argument : Arguments()) command += " " + argument;
  const int state = std::system(
      (command + " -json " + folder_ / "mpi.json" + " > /dev/null").c_str());
  if (!Exists(folder_ / "mpi.json") && state != 0) {
    GTEST_SKIP() << "mpirun does not work here, or MPI was not built in";
  }
  EXPECT_EQ(state, 0);
  EXPECT_EQ(Signature(alone.out), Signature(ReadFile(folder_ / "mpi.json")));
}

TEST_F(TuneMainTest, AJobArrayFindsTheSame) {
  const CommandResult alone =
      RunCommand("tune", Arguments({"-workers", "1", "-json", "-"}));
  ASSERT_EQ(alone.exit_code, 0) << alone.error;
  const TemporaryFolder job;
  std::vector<std::thread> tasks;
  std::vector<CommandResult> results(3);
  for (int task = 2; task >= 0; --task) {
    if (task == 0) WaitForTasks(job, 2);
    tasks.emplace_back([&, task]() {
      results[task] = RunCommand(
          "tune",
          Arguments({"-workers", "1", "-json", folder_ / "json", "-job_folder",
                     job.path(), "-job_task", std::to_string(task)}));
    });
  }
  for (std::thread& task : tasks) task.join();
  for (const CommandResult& result : results) {
    EXPECT_EQ(result.exit_code, 0) << result.error;
  }
  EXPECT_EQ(Signature(alone.out), Signature(ReadFile(folder_ / "json")));
  // Only task 0 speaks.
  EXPECT_THAT(results[0].out, HasSubstr("Objective"));
  EXPECT_THAT(results[1].out, testing::IsEmpty());
  EXPECT_THAT(Runs(ReadFile(job / "journal.jsonl")),
              testing::Not(testing::IsEmpty()));
}

TEST_F(TuneMainTest, FlagsOfAJobArrayBelongTogether) {
  for (const std::vector<std::string>& flags :
       std::vector<std::vector<std::string>>{{"-job_folder", folder_.path()},
                                             {"-job_task", "1"}}) {
    const CommandResult result = RunCommand("tune", Arguments(flags));
    EXPECT_EQ(result.exit_code, 2);
    EXPECT_THAT(result.error, HasSubstr("belong together"));
  }
  for (const std::string task : {"0", "1"}) {
    const CommandResult result = RunCommand(
        "tune", Arguments({"-job_folder", folder_ / "no", "-job_task", task}));
    EXPECT_EQ(result.exit_code, 1);
    EXPECT_THAT(result.error, HasSubstr(folder_ / "no"));
  }
}

TEST_F(TuneMainTest, AKilledSearchGoesOn) {
  const auto arguments =
      Arguments({"-workers", "2", "-journal_filename", folder_ / "journal",
                 "-json", folder_ / "json"});
  // Kill it once there are a few runs.
  const pid_t child = fork();
  if (child == 0) {
    const std::string program =
        std::string(CARTOGRAPHER_EXT_BIN_DIR) + "/cartographer_ext_tune";
    std::vector<char*> argv = {const_cast<char*>(program.c_str())};
    for (const auto& a : arguments)
      argv.push_back(const_cast<char*>(a.c_str()));
    argv.push_back(nullptr);
    execv(program.c_str(), argv.data());
    _exit(127);
  }
  for (int i = 0; i < 6000; ++i) {
    const std::string journal = ReadFile(folder_ / "journal");
    if (std::count(journal.begin(), journal.end(), '\n') >= 4) break;
    std::this_thread::sleep_for(std::chrono::milliseconds(10));
  }
  kill(child, SIGKILL);
  waitpid(child, nullptr, 0);
  const std::string before = ReadFile(folder_ / "journal");
  EXPECT_THAT(ReadFile(folder_ / "json"), testing::IsEmpty());
  const CommandResult resumed = RunCommand("tune", arguments);
  ASSERT_EQ(resumed.exit_code, 0) << resumed.error;
  const std::string after = ReadFile(folder_ / "journal");
  EXPECT_EQ(after.substr(0, before.rfind('\n') + 1),
            before.substr(0, before.rfind('\n') + 1));
  const CommandResult whole = RunCommand(
      "tune",
      Arguments({"-journal_filename", folder_ / "whole", "-json", "-"}));
  ASSERT_EQ(whole.exit_code, 0) << whole.error;
  EXPECT_EQ(Runs(after), Runs(ReadFile(folder_ / "whole")));
  EXPECT_EQ(Signature(whole.out), Signature(ReadFile(folder_ / "json")));
}

TEST_F(TuneMainTest, BadInputIsExitCodeOne) {
  const auto error = [&](const std::vector<std::string>& arguments) {
    const CommandResult result = RunCommand("tune", arguments);
    EXPECT_EQ(result.exit_code, 1) << result.out;
    return result.error;
  };
  const auto with_search = [&](const std::string& parameter) {
    WriteFile(folder_ / "bad.lua",
              "return { parameters = { { " + parameter + " } } }");
    return error({"-search_filename", folder_ / "bad.lua", "-inputs",
                  folder_ / "room.world", "-max_trials", "1"});
  };
  EXPECT_THAT(with_search("key = 'POSE_GRAPH.nothing', range = { 0, 1 }"),
              HasSubstr("no key POSE_GRAPH.nothing"));
  EXPECT_THAT(with_search("key = 'A.b', range = { 1, 0 }"),
              HasSubstr("empty range"));
  EXPECT_THAT(
      with_search("key = 'TRAJECTORY_BUILDER_3D.min_range', range = { 1, 2 }"),
      HasSubstr("is not used"));
  EXPECT_THAT(error({"-search_filename", folder_ / "absent.lua", "-inputs",
                     folder_ / "room.world", "-max_trials", "1"}),
              HasSubstr("absent.lua"));
  EXPECT_THAT(error({"-search_filename", folder_ / "search.lua", "-inputs",
                     folder_ / "no.clf", "-max_trials", "1"}),
              HasSubstr("no.clf"));
  EXPECT_THAT(
      error({"-search_filename", folder_ / "search.lua", "-max_trials", "1"}),
      HasSubstr("no inputs: give -inputs"));
  EXPECT_THAT(error(Arguments({"-holdout", folder_ / "room.world#1"})),
              HasSubstr("both an input and held out"));
  WriteFile(folder_ / "journal", "something else\n");
  EXPECT_THAT(error(Arguments({"-journal_filename", folder_ / "journal"})),
              HasSubstr("not a tuning journal"));
  EXPECT_THAT(error(Arguments({"-output_filename", folder_ / "no/where.lua"})),
              HasSubstr("where.lua"));
  // A log without truth cannot be judged by relations.
  WriteRoomLog(folder_ / "room.clf", 40);
  EXPECT_THAT(error({"-search_filename", folder_ / "search.lua", "-inputs",
                     folder_ / "room.clf", "-max_trials", "1"}),
              HasSubstr("no 'relations'"));
}

TEST_F(TuneMainTest, WrongUsageIsExitCodeTwo) {
  const std::vector<std::vector<std::string>> wrong = {
      {},
      Arguments({"-method", "magic"}),
      Arguments({"-objective", "happiness"}),
      Arguments({"-max_trials", "-1"}),
      Arguments({"-min_fidelity", "0"}),
      Arguments({"-max_trials", "0"}),
      Arguments({"-maxtrials", "3"})};
  for (const auto& arguments : wrong) {
    const CommandResult result = RunCommand("tune", arguments);
    EXPECT_EQ(result.exit_code, 2) << result.error;
    EXPECT_THAT(result.error, HasSubstr("cartographer_ext_tune: "));
  }
}

}  // namespace
}  // namespace test
}  // namespace cartographer_ext
