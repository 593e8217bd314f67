// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
#include "cartographer_ext/common/atomic_file.h"

#include <dirent.h>
#include <signal.h>
#include <sys/stat.h>
#include <sys/wait.h>
#include <unistd.h>

#include <cstdio>
#include <fstream>
#include <sstream>
#include <string>
#include <vector>

#include "gmock/gmock.h"
#include "gtest/gtest.h"

namespace cartographer_ext {
namespace {

using ::testing::HasSubstr;

class AtomicFileTest : public ::testing::Test {
 protected:
  AtomicFileTest() {
    std::string name = ::testing::TempDir() + "/atomic_file_XXXXXX";
    folder_ = ::mkdtemp(&name[0]);
  }
  ~AtomicFileTest() override {
    for (const std::string& name : List()) {
      std::remove((folder_ + "/" + name).c_str());
    }
    ::rmdir(folder_.c_str());
  }
  std::vector<std::string> List() const {
    std::vector<std::string> names;
    DIR* const folder = ::opendir(folder_.c_str());
    while (const dirent* entry = ::readdir(folder)) {
      const std::string name = entry->d_name;
      if (name != "." && name != "..") names.push_back(name);
    }
    ::closedir(folder);
    return names;
  }
  static std::string Read(const std::string& path) {
    std::ifstream file(path, std::ios::binary);
    std::ostringstream content;
    content << file.rdbuf();
    return content.str();
  }
  std::string folder_;
};

TEST_F(AtomicFileTest, AppearsOnlyWithCommit) {
  const std::string path = folder_ + "/out.txt";
  {
    AtomicFile file(path);
    ASSERT_TRUE(file.status().ok());
    file.stream() << "half";
    EXPECT_NE(::access(path.c_str(), F_OK), 0);
    file.stream() << " and half";
    ASSERT_TRUE(file.Commit().ok());
    EXPECT_TRUE(file.Commit().ok());  // Twice is harmless.
  }
  EXPECT_EQ(Read(path), "half and half");
  EXPECT_THAT(List(), ::testing::ElementsAre("out.txt"));
}

TEST_F(AtomicFileTest, WithoutCommitTheOldContentStays) {
  const std::string path = folder_ + "/out.txt";
  ASSERT_TRUE(WriteFileAtomically(path, "old").ok());
  {
    AtomicFile file(path);
    file.stream() << "new";
  }
  EXPECT_EQ(Read(path), "old");
  EXPECT_THAT(List(), ::testing::ElementsAre("out.txt"));
}

TEST_F(AtomicFileTest, WritersMayOpenThePathThemselves) {
  const std::string path = folder_ + "/out.txt";
  AtomicFile file(path);
  std::ofstream(file.temporary_path()) << "by path";
  ASSERT_TRUE(file.Commit().ok());
  EXPECT_EQ(Read(path), "by path");
}

TEST_F(AtomicFileTest, KeepsModeAndLink) {
  const std::string path = folder_ + "/real.txt";
  const std::string link = folder_ + "/link.txt";
  ASSERT_TRUE(WriteFileAtomically(path, "old").ok());
  ASSERT_EQ(::chmod(path.c_str(), 0600), 0);
  ASSERT_EQ(::symlink("real.txt", link.c_str()), 0);
  ASSERT_TRUE(WriteFileAtomically(link, "new").ok());
  EXPECT_EQ(Read(path), "new");
  struct stat info;
  ASSERT_EQ(::lstat(link.c_str(), &info), 0);
  EXPECT_TRUE(S_ISLNK(info.st_mode));
  ASSERT_EQ(::stat(path.c_str(), &info), 0);
  EXPECT_EQ(info.st_mode & 0777, 0600);
}

TEST_F(AtomicFileTest, MissingFolderNamesThePath) {
  const std::string path = folder_ + "/missing/out.txt";
  const absl::Status status = WriteFileAtomically(path, "x");
  EXPECT_EQ(status.code(), absl::StatusCode::kNotFound);
  EXPECT_THAT(std::string(status.message()), HasSubstr(path));
  AtomicFile file(path);
  file.stream() << "swallowed";
  EXPECT_FALSE(file.Commit().ok());
}

TEST_F(AtomicFileTest, FolderIsNoFile) {
  const absl::Status status = WriteFileAtomically(folder_, "x");
  EXPECT_FALSE(status.ok());
  EXPECT_THAT(std::string(status.message()), HasSubstr(folder_));
  EXPECT_TRUE(List().empty());
}

TEST_F(AtomicFileTest, FullDiskIsAnErrorAndTheDeviceStays) {
  if (::access("/dev/full", W_OK) != 0) GTEST_SKIP() << "no /dev/full";
  for (const size_t size : {1, 1 << 20}) {
    const absl::Status status =
        WriteFileAtomically("/dev/full", std::string(size, 'x'));
    EXPECT_EQ(status.code(), absl::StatusCode::kResourceExhausted) << status;
    EXPECT_THAT(std::string(status.message()), HasSubstr("/dev/full"));
  }
  struct stat info;
  ASSERT_EQ(::stat("/dev/full", &info), 0);
  EXPECT_TRUE(S_ISCHR(info.st_mode));
}

TEST_F(AtomicFileTest, DashIsStandardOutput) {
  ::testing::internal::CaptureStdout();
  const absl::Status status = WriteFileAtomically("-", "to stdout\n");
  EXPECT_EQ(::testing::internal::GetCapturedStdout(), "to stdout\n");
  EXPECT_TRUE(status.ok());
}

TEST_F(AtomicFileTest, ASetIsWrittenAsAWholeOrNotAtAll) {
  const std::string first = folder_ + "/first", second = folder_ + "/second";
  {
    AtomicFileSet files;
    ASSERT_TRUE(WriteFileAtomically(first, "1").ok());
    ASSERT_TRUE(WriteFileAtomically(second, "2").ok());
    EXPECT_NE(::access(first.c_str(), F_OK), 0);
  }
  EXPECT_TRUE(List().empty());
  {
    AtomicFileSet files;
    ASSERT_TRUE(WriteFileAtomically(first, "1").ok());
    ASSERT_TRUE(WriteFileAtomically(second, "2").ok());
    EXPECT_TRUE(files.Commit().ok());
  }
  EXPECT_EQ(Read(first), "1");
  EXPECT_EQ(Read(second), "2");
  EXPECT_EQ(List().size(), 2u);
  // Behind the set files are written at once again.
  ASSERT_TRUE(WriteFileAtomically(first, "3").ok());
  EXPECT_EQ(Read(first), "3");
}

TEST_F(AtomicFileTest, WhatWaitsCanBeReadAndReplaced) {
  const std::string first = folder_ + "/first", second = folder_ + "/second";
  ASSERT_TRUE(WriteFileAtomically(first, "old").ok());
  ASSERT_TRUE(WriteFileAtomically(second, "old").ok());
  for (const bool commit : {false, true}) {
    AtomicFileSet files;
    EXPECT_EQ(Read(AtomicFileSet::NameToRead(first)), "old");
    ASSERT_TRUE(WriteFileAtomically(first, "1").ok());
    EXPECT_EQ(Read(AtomicFileSet::NameToRead(first)), "1");
    ASSERT_TRUE(WriteFileAtomically(first, "2").ok());
    EXPECT_EQ(Read(AtomicFileSet::NameToRead(first)), "2");
    RemoveWithSet(second);
    EXPECT_EQ(AtomicFileSet::NameToRead(second), "");
    EXPECT_EQ(Read(first) + Read(second), "oldold");
    if (!commit) continue;
    EXPECT_TRUE(files.Commit().ok());
  }
  EXPECT_EQ(AtomicFileSet::NameToRead(first), first);
  EXPECT_EQ(Read(first), "2");
  EXPECT_THAT(List(), ::testing::ElementsAre("first"));
}

TEST_F(AtomicFileTest, WhatAKilledProcessLeftIsRemoved) {
  const std::string path = folder_ + "/out";
  const pid_t child = ::fork();
  if (child == 0) {
    AtomicFile file(path);
    ::_exit(0);  // without the destructor
  }
  int state;
  ASSERT_EQ(::waitpid(child, &state, 0), child);
  ASSERT_EQ(List().size(), 1u);
  {
    // Of this process, which lives, and of a file with a similar name.
    AtomicFile alive(folder_ + "/out.2");
    ASSERT_TRUE(WriteFileAtomically(path, "whole").ok());
    EXPECT_EQ(List().size(), 2u);
  }
  EXPECT_EQ(List(), std::vector<std::string>{"out"});
}

TEST_F(AtomicFileTest, ALinkLeadsToAFileThatIsNotThereYet) {
  ASSERT_EQ(::symlink("target.txt", (folder_ + "/link").c_str()), 0);
  ASSERT_TRUE(WriteFileAtomically(folder_ + "/link", "new").ok());
  EXPECT_EQ(Read(folder_ + "/target.txt"), "new");
  struct stat info;
  ASSERT_EQ(::lstat((folder_ + "/link").c_str(), &info), 0);
  EXPECT_TRUE(S_ISLNK(info.st_mode));
}

TEST_F(AtomicFileTest, NoFileIsCalledDash) {
  EXPECT_FALSE(AtomicFile("-").status().ok());
  EXPECT_NE(::access("-", F_OK), 0);
}

TEST_F(AtomicFileTest, LinksInACircleEnd) {
  ASSERT_EQ(::symlink("b", (folder_ + "/a").c_str()), 0);
  ASSERT_EQ(::symlink("a", (folder_ + "/b").c_str()), 0);
  // Whatever becomes of it.
  WriteFileAtomically(folder_ + "/a", "new").IgnoreError();
}

TEST_F(AtomicFileTest, SignalsLeaveNoTemporaryFiles) {
  for (const int number : {SIGHUP, SIGINT, SIGTERM}) {
    const pid_t child = ::fork();
    if (child == 0) {
      RemoveTemporaryFilesOnSignals();
      AtomicFileSet set;
      AtomicFile waiting(folder_ + "/waiting.txt");
      if (!waiting.Commit().ok()) ::_exit(1);
      AtomicFile open(folder_ + "/open.txt");
      if (List().size() != 2) ::_exit(1);
      // A child of its own does not remove what is not its.
      const pid_t worker = ::fork();
      if (worker == 0) ::raise(number);
      ::waitpid(worker, nullptr, 0);
      if (List().size() != 2) ::_exit(1);
      ::raise(number);
      ::_exit(1);
    }
    int state = 0;
    ::waitpid(child, &state, 0);
    ASSERT_TRUE(WIFSIGNALED(state));
    EXPECT_EQ(WTERMSIG(state), number);
    EXPECT_THAT(List(), ::testing::IsEmpty());
  }
}

}  // namespace
}  // namespace cartographer_ext
