// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
#include "cartographer_ext/tuning/workers/shared_folder_pool.h"

#include <signal.h>
#include <sys/stat.h>
#include <sys/wait.h>
#include <unistd.h>

#include <chrono>
#include <fstream>
#include <set>
#include <string>
#include <thread>
#include <vector>

#include "cartographer_ext/tuning/workers/shared_folder_server.h"
#include "gmock/gmock.h"
#include "gtest/gtest.h"
#include "tests/tuning/temporary_file.h"

namespace cartographer_ext {
namespace tuning {
namespace {

using testing::HasSubstr;

nlohmann::json Act(const nlohmann::json& request) {
  if (request.value("sleeps", false)) sleep(30);
  return {{"ok", true},
          {"metrics", {{"twice", 2. * double(request["x"])}}},
          {"process", getppid()}};
}

nlohmann::json Request(const double x, const bool sleeps = false) {
  return {{"x", x}, {"sleeps", sleeps}};
}

class SharedFolderPoolTest : public testing::Test {
 protected:
  ~SharedFolderPoolTest() override {
    for (const pid_t child : children_) {
      kill(child, SIGKILL);
      waitpid(child, nullptr, 0);
    }
  }

  SharedFolderOptions Options(const int task) const {
    SharedFolderOptions options;
    options.folder = folder_.path();
    options.task = task;
    options.poll_seconds = 0.02;
    options.silent_seconds = 2.;
    options.wait_seconds = 20.;
    return options;
  }

  // A task in a process of its own; its exit code is 0 if it served until the
  // end, 1 after an error.
  pid_t StartTask(const SharedFolderOptions& options) {
    const pid_t child = fork();
    if (child == 0) {
      _exit(ServeSharedFolder(options, &Act).ok() ? 0 : 1);
    }
    children_.push_back(child);
    return child;
  }

  int ExitCodeOf(const pid_t child) {
    int state = 0;
    waitpid(child, &state, 0);
    for (pid_t& known : children_) {
      if (known == child) {
        known = children_.back();
        children_.pop_back();
        break;
      }
    }
    return WIFEXITED(state) ? WEXITSTATUS(state) : -1;
  }

  // Leaves its exit code to ExitCodeOf.
  static bool HasEnded(const pid_t child) {
    siginfo_t info = {};
    return waitid(P_PID, static_cast<id_t>(child), &info,
                  WEXITED | WNOHANG | WNOWAIT) == 0 &&
           info.si_pid == child;
  }

  void Kill(const pid_t child) {
    kill(child, SIGKILL);
    ExitCodeOf(child);
  }

  void WaitForFile(const std::string& name) const {
    for (int i = 0; i < 3000 && folder_.Read(name).empty(); ++i) {
      std::this_thread::sleep_for(std::chrono::milliseconds(10));
    }
  }

  static bool WaitForTasks(SharedFolderPool* const pool, const int count) {
    for (int i = 0; i < 1000 && pool->num_tasks() != count; ++i) {
      EXPECT_FALSE(pool->Wait(0.02).has_value());
    }
    return pool->num_tasks() == count;
  }

  std::unique_ptr<SharedFolderPool> MakePool() const {
    auto pool = SharedFolderPool::Create(Options(0), &Act);
    EXPECT_TRUE(pool.ok()) << pool.status();
    return pool.ok() ? *std::move(pool) : nullptr;
  }

  const test::Folder folder_;

 private:
  std::vector<pid_t> children_;
};

TEST_F(SharedFolderPoolTest, AllTasksWork) {
  SharedFolderOptions two = Options(1);
  two.num_workers = 2;
  const std::vector<pid_t> tasks = {StartTask(two), StartTask(Options(2))};
  auto pool = MakePool();
  ASSERT_TRUE(WaitForTasks(pool.get(), 3));
  EXPECT_EQ(pool->num_workers(), 4);
  std::set<int> ids;
  std::set<int> processes;
  int next = 0;
  while (ids.size() < 40) {
    while (next < 40 && pool->num_running() < pool->num_workers()) {
      pool->Start(next, Request(next));
      ++next;
    }
    const auto result = pool->Wait(60.);
    ASSERT_TRUE(result.has_value());
    EXPECT_EQ(result->answer["metrics"]["twice"], 2. * result->id);
    EXPECT_GE(result->answer["wall_seconds"].get<double>(), 0.);
    processes.insert(result->answer["process"].get<int>());
    EXPECT_TRUE(ids.insert(result->id).second);
  }
  EXPECT_EQ(processes,
            (std::set<int>{static_cast<int>(getpid()), tasks[0], tasks[1]}));
  pool.reset();
  EXPECT_EQ(ExitCodeOf(tasks[0]), 0);
  EXPECT_EQ(ExitCodeOf(tasks[1]), 0);
}

TEST_F(SharedFolderPoolTest, WorksAlone) {
  const auto pool = MakePool();
  EXPECT_EQ(pool->num_workers(), 1);
  pool->Start(3, Request(5.));
  const auto result = pool->Wait(60.);
  ASSERT_TRUE(result.has_value());
  EXPECT_EQ(result->id, 3);
  EXPECT_EQ(result->answer["metrics"]["twice"], 10.);
}

TEST_F(SharedFolderPoolTest, ARunOfATaskThatDiesWasKilled) {
  const pid_t task = StartTask(Options(1));
  const auto pool = MakePool();
  ASSERT_TRUE(WaitForTasks(pool.get(), 2));
  pool->Start(7, Request(1., true));
  EXPECT_FALSE(pool->Wait(0.2).has_value());
  Kill(task);
  const auto result = pool->Wait(60.);
  ASSERT_TRUE(result.has_value());
  EXPECT_EQ(result->id, 7);
  EXPECT_EQ(result->answer["ok"], false);
  EXPECT_EQ(result->answer["killed"], true);
  EXPECT_THAT(result->answer["message"].get<std::string>(),
              HasSubstr("task-1-0"));
  EXPECT_EQ(pool->num_workers(), 1);
}

TEST_F(SharedFolderPoolTest, ATaskThatCannotAnswerTakesItsFileAway) {
  // A file cannot take the place of a folder.
  const std::string in_the_way = folder_.path() + "/task-1-0.answer.json";
  ASSERT_EQ(mkdir(in_the_way.c_str(), 0755), 0);
  const pid_t task = StartTask(Options(1));
  SharedFolderOptions patient = Options(0);
  patient.silent_seconds = 120.;
  const auto pool = SharedFolderPool::Create(patient, &Act);
  ASSERT_TRUE(pool.ok()) << pool.status();
  ASSERT_TRUE(WaitForTasks(pool->get(), 2));
  (*pool)->Start(5, Request(1.));
  EXPECT_EQ(ExitCodeOf(task), 1);
  EXPECT_EQ(folder_.Read("task-1.json"), "");
  // Long before its silence would be noticed.
  const auto result = (*pool)->Wait(30.);
  ASSERT_TRUE(result.has_value());
  EXPECT_EQ(result->id, 5);
  EXPECT_EQ(result->answer["killed"], true);
  EXPECT_EQ((*pool)->num_tasks(), 1);
  rmdir(in_the_way.c_str());
}

TEST_F(SharedFolderPoolTest, ATaskStartedAgainTakesNewRuns) {
  const pid_t task = StartTask(Options(1));
  const auto pool = MakePool();
  ASSERT_TRUE(WaitForTasks(pool.get(), 2));
  pool->Start(0, Request(1., true));
  EXPECT_FALSE(pool->Wait(0.2).has_value());
  Kill(task);
  // Before its silence is noticed: the token tells.
  StartTask(Options(1));
  const auto lost = pool->Wait(60.);
  ASSERT_TRUE(lost.has_value());
  EXPECT_EQ(lost->answer["killed"], true);
  ASSERT_TRUE(WaitForTasks(pool.get(), 2));
  pool->Start(0, Request(4.));
  const auto result = pool->Wait(60.);
  ASSERT_TRUE(result.has_value());
  EXPECT_EQ(result->answer["metrics"]["twice"], 8.);
  EXPECT_NE(result->answer["process"], static_cast<int>(getpid()));
}

TEST_F(SharedFolderPoolTest, StopsRemoteRuns) {
  StartTask(Options(1));
  const auto pool = MakePool();
  ASSERT_TRUE(WaitForTasks(pool.get(), 2));
  pool->Start(0, Request(1., true));
  EXPECT_FALSE(pool->Wait(0.2).has_value());
  pool->StopAll();
  EXPECT_EQ(pool->num_running(), 0);
  // The same slot: at once, long before the sleeper would have ended.
  pool->Start(1, Request(2.));
  const auto result = pool->Wait(20.);
  ASSERT_TRUE(result.has_value());
  EXPECT_EQ(result->id, 1);
  EXPECT_EQ(result->answer["metrics"]["twice"], 4.);
  EXPECT_NE(result->answer["process"], static_cast<int>(getpid()));
}

TEST_F(SharedFolderPoolTest, TasksServeACoordinatorThatIsStartedAgain) {
  const pid_t first = fork();
  if (first == 0) {
    auto pool = SharedFolderPool::Create(Options(0), &Act);
    if (!pool.ok()) _exit(1);
    while (true) (*pool)->Wait(1.);
  }
  const pid_t task = StartTask(Options(1));
  WaitForFile("coordinator.json");
  WaitForFile("task-1.json");
  const auto second = SharedFolderPool::Create(Options(0), &Act);
  EXPECT_THAT(std::string(second.status().message()),
              HasSubstr("another process is task 0"));
  kill(first, SIGKILL);
  waitpid(first, nullptr, 0);
  auto pool = MakePool();
  ASSERT_TRUE(WaitForTasks(pool.get(), 2));
  pool->Start(0, Request(3.));
  const auto result = pool->Wait(60.);
  ASSERT_TRUE(result.has_value());
  EXPECT_EQ(result->answer["process"], static_cast<int>(task));
  pool.reset();
  EXPECT_EQ(ExitCodeOf(task), 0);
}

TEST_F(SharedFolderPoolTest, WithoutTaskZeroTheOthersEnd) {
  SharedFolderOptions options = Options(1);
  options.wait_seconds = 0.2;
  EXPECT_THAT(std::string(ServeSharedFolder(options, &Act).message()),
              HasSubstr("no sign of task 0"));
  // It had its time, and has ended.
  MakePool().reset();
  options.wait_seconds = 20.;
  options.wait_after_end_seconds = 0.2;
  EXPECT_TRUE(ServeSharedFolder(options, &Act).ok());
}

TEST_F(SharedFolderPoolTest, ASearchThatBeginsAndEndsUnseenEndsTheTask) {
  SharedFolderOptions options = Options(1);
  options.poll_seconds = 0.3;
  const pid_t task = StartTask(options);
  WaitForFile("task-1.json");
  MakePool().reset();
  EXPECT_EQ(ExitCodeOf(task), 0);
}

TEST_F(SharedFolderPoolTest, TwoTasksOfOneNumberAreAnError) {
  const pid_t first = StartTask(Options(1));
  const auto pool = MakePool();
  ASSERT_TRUE(WaitForTasks(pool.get(), 2));
  const pid_t second = StartTask(Options(1));
  // Nearly always the later one stays. There are no locks: if the earlier one
  // replaces the file without having seen the other's, that one ends.
  for (int i = 0; i < 1000 && !HasEnded(first) && !HasEnded(second); ++i) {
    EXPECT_FALSE(pool->Wait(0.02).has_value());
  }
  ASSERT_NE(HasEnded(first), HasEnded(second));
  const pid_t ended = HasEnded(first) ? first : second;
  EXPECT_EQ(ExitCodeOf(ended), 1);
  EXPECT_FALSE(pool->Wait(0.5).has_value());
  ASSERT_TRUE(WaitForTasks(pool.get(), 2));
  pool->Start(0, Request(3.));
  const auto result = pool->Wait(60.);
  ASSERT_TRUE(result.has_value());
  EXPECT_EQ(result->answer["process"],
            static_cast<int>(ended == first ? second : first));
}

TEST_F(SharedFolderPoolTest, DamagedFilesAreIgnored) {
  auto pool = MakePool();
  const std::vector<std::string> contents = {
      "",
      "{",
      "[]",
      "{\"token\":1,\"beat\":\"x\",\"slots\":-1}",
      "{\"token\":\"t\",\"beat\":1,\"slots\":1e300}",
      std::string(100000, '[')};
  for (const char* const name :
       {"task-1.json", "task-x.json", "task-01.json", "task-.json"}) {
    for (const std::string& content : contents) {
      std::ofstream(folder_.path() + "/" + name) << content;
      std::this_thread::sleep_for(std::chrono::milliseconds(25));
      EXPECT_FALSE(pool->Wait(0.).has_value());
      EXPECT_EQ(pool->num_tasks(), 1) << name << " " << content.substr(0, 40);
    }
  }
}

TEST_F(SharedFolderPoolTest, AFolderThatDoesNotExistIsNamed) {
  SharedFolderOptions options = Options(0);
  options.folder += "/no";
  EXPECT_THAT(
      std::string(SharedFolderPool::Create(options, &Act).status().message()),
      HasSubstr("/no: is not a folder"));
  options.task = 1;
  EXPECT_THAT(std::string(ServeSharedFolder(options, &Act).message()),
              HasSubstr("/no: is not a folder"));
}

}  // namespace
}  // namespace tuning
}  // namespace cartographer_ext
