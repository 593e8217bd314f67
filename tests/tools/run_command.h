// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
//
// Runs the commands of the project as a user does, and makes small inputs for
// them.
#ifndef TESTS_TOOLS_RUN_COMMAND_H_
#define TESTS_TOOLS_RUN_COMMAND_H_

#include <dirent.h>
#include <fcntl.h>
#include <stdlib.h>
#include <sys/wait.h>
#include <unistd.h>

#include <fstream>
#include <iterator>
#include <string>
#include <vector>

#include "absl/types/variant.h"
#include "cartographer_ext/io/carmen/carmen_writer.h"
#include "gtest/gtest.h"
#include "nlohmann/json.hpp"
#include "tests/slam/room_source.h"

namespace cartographer_ext {
namespace test {

inline std::string ReadFile(const std::string& path) {
  std::ifstream stream(path, std::ios::binary);
  return std::string(std::istreambuf_iterator<char>(stream), {});
}

inline void WriteFile(const std::string& path, const std::string& content) {
  std::ofstream(path, std::ios::binary) << content;
}

// A folder that goes away with everything in it.
class TemporaryFolder {
 public:
  TemporaryFolder() {
    std::string name = testing::TempDir() + "cartographer_ext_XXXXXX";
    path_ = mkdtemp(&name[0]);
  }
  ~TemporaryFolder() {
    for (const std::string& name : Names())
      unlink((path_ + "/" + name).c_str());
    rmdir(path_.c_str());
  }

  std::string operator/(const std::string& name) const {
    return path_ + "/" + name;
  }
  const std::string& path() const { return path_; }

  std::vector<std::string> Names() const {
    std::vector<std::string> names;
    DIR* const folder = opendir(path_.c_str());
    if (folder == nullptr) return names;
    while (const dirent* const entry = readdir(folder)) {
      const std::string name = entry->d_name;
      if (name != "." && name != "..") names.push_back(name);
    }
    closedir(folder);
    return names;
  }

 private:
  std::string path_;
};

struct CommandResult {
  int exit_code = -1;  // -1 when it was ended by a signal
  std::string out;
  std::string error;
};

// `name` without the prefix cartographer_ext_. In a terminal-less environment.
inline CommandResult RunCommand(const std::string& name,
                                const std::vector<std::string>& arguments) {
  const TemporaryFolder folder;
  const std::string program =
      std::string(CARTOGRAPHER_EXT_BIN_DIR) + "/cartographer_ext_" + name;
  const pid_t child = fork();
  if (child == 0) {
    const int in = open("/dev/null", O_RDONLY);
    const int out =
        open((folder / "out").c_str(), O_WRONLY | O_CREAT | O_TRUNC, 0600);
    const int error =
        open((folder / "error").c_str(), O_WRONLY | O_CREAT | O_TRUNC, 0600);
    dup2(in, STDIN_FILENO);
    dup2(out, STDOUT_FILENO);
    dup2(error, STDERR_FILENO);
    std::vector<char*> argv = {const_cast<char*>(program.c_str())};
    for (const std::string& argument : arguments) {
      argv.push_back(const_cast<char*>(argument.c_str()));
    }
    argv.push_back(nullptr);
    execv(program.c_str(), argv.data());
    _exit(127);
  }
  int state = 0;
  waitpid(child, &state, 0);
  CommandResult result;
  if (WIFEXITED(state)) result.exit_code = WEXITSTATUS(state);
  result.out = ReadFile(folder / "out");
  result.error = ReadFile(folder / "error");
  return result;
}

inline nlohmann::json ParseJson(const std::string& text) {
  return nlohmann::json::parse(text, nullptr, false);
}

// The room of room_source.h as a CARMEN log.
inline void WriteRoomLog(const std::string& filename, int num_scans) {
  auto writer = io::CarmenWriter::Open(filename, "test");
  ASSERT_TRUE(writer.ok()) << writer.status();
  RoomSource source(num_scans);
  io::SensorEvent event;
  Pose2 odometry;
  while (*source.Next(&event)) {
    if (const auto* reading = absl::get_if<io::OdometryReading>(&event)) {
      odometry = reading->pose;
      ASSERT_TRUE((*writer)->AddOdometry(*reading).ok());
    } else if (const auto* scan = absl::get_if<io::LaserScan>(&event)) {
      ASSERT_TRUE((*writer)->AddScan(*scan, odometry).ok());
    }
  }
  ASSERT_TRUE((*writer)->Finish().ok());
}

// A map of that log and the trajectory at every scan.
inline void WriteRoomMap(const TemporaryFolder& folder, int num_scans) {
  WriteRoomLog(folder / "room.clf", num_scans);
  const CommandResult result = RunCommand(
      "slam", {"-input_filename", folder / "room.clf", "-pbstream_filename",
               folder / "room.pbstream", "-configuration_basename", "stock.lua",
               "-trajectory_filename", folder / "room.tum"});
  ASSERT_EQ(result.exit_code, 0) << result.error;
}

}  // namespace test
}  // namespace cartographer_ext

#endif  // TESTS_TOOLS_RUN_COMMAND_H_
