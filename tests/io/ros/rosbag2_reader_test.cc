// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
#include "cartographer_ext/io/ros/rosbag2_reader.h"

#include <sqlite3.h>
#include <sys/stat.h>
#include <unistd.h>

#include <string>

#include "gmock/gmock.h"
#include "gtest/gtest.h"
#include "tests/io/ros/ros2_sample.h"
#include "tests/mutation.h"
#include "tests/test_data.h"

namespace cartographer_ext {
namespace io {
namespace {

using ::testing::HasSubstr;
using ::testing::IsEmpty;

// A folder that is removed with what the test put into it.
class Folder {
 public:
  Folder() { mkdir(path().c_str(), 0755); }
  ~Folder() {
    for (const std::string& name : names_)
      unlink((path() + "/" + name).c_str());
    rmdir(path().c_str());
  }
  const std::string& path() const { return file_.path(); }
  std::string Add(const std::string& name) {
    names_.push_back(name);
    return path() + "/" + name;
  }

 private:
  test::TemporaryFile file_{".rosbag2"};
  std::vector<std::string> names_;
};

TEST(Rosbag2ReaderTest, ReadsADatabase) {
  test::TemporaryFile file(".db3");
  test::WriteRos2Sample(file.path(), Rosbag2Storage::kDb3, "none");
  auto source = OpenSensorSource(file.path(), {});
  ASSERT_TRUE(source.ok()) << source.status();
  EXPECT_EQ((*source)->info().format, "db3");
  EXPECT_THAT((*source)->info().warnings, IsEmpty());
  test::ExpectRos2Sample(source->get());
}

TEST(Rosbag2ReaderTest, TheFilesOfAFolderAreOneRecording) {
  Folder folder;
  test::WriteRos2Sample(folder.Add("run_9.db3"), Rosbag2Storage::kDb3, "none");
  test::WriteRos2Sample(folder.Add("run_10.db3"), Rosbag2Storage::kDb3, "none");
  test::WriteBytes(folder.Add("metadata.yaml"),
                   "rosbag2_bagfile_information:\n");
  auto source = OpenSensorSource(folder.path(), {});
  ASSERT_TRUE(source.ok()) << source.status();
  // The same stamps twice: both are there, in order.
  EXPECT_EQ((*source)->info().num_scans, 20);
  EXPECT_EQ((*source)->info().num_out_of_order, 3);
}

TEST(Rosbag2ReaderTest, FoldersWithoutARecordingAreRefused) {
  Folder folder;
  EXPECT_THAT(
      std::string(OpenSensorSource(folder.path(), {}).status().message()),
      HasSubstr("a folder without .db3 and .mcap files"));
  test::WriteBytes(folder.Add("run_0.db3.zstd"), "x");
  EXPECT_THAT(
      std::string(OpenSensorSource(folder.path(), {}).status().message()),
      HasSubstr("unzstd"));
}

TEST(Rosbag2ReaderTest, AFolderOfSeveralRecordingsIsRefused) {
  Folder folder;
  test::WriteRos2Sample(folder.Add("run_9.db3"), Rosbag2Storage::kDb3, "none");
  test::WriteRos2Sample(folder.Add("run_10.db3"), Rosbag2Storage::kDb3, "none");
  test::WriteBytes(folder.Add("._run_9.db3"), "left by another system");
  const auto split = OpenSensorSource(folder.path(), {});
  ASSERT_TRUE(split.ok()) << split.status();
  EXPECT_EQ((*split)->info().num_scans, 20);
  test::WriteRos2Sample(folder.Add("walk_10.db3"), Rosbag2Storage::kDb3,
                        "none");
  EXPECT_THAT(
      std::string(OpenSensorSource(folder.path(), {}).status().message()),
      HasSubstr("several recordings (run_9.db3, walk_10.db3)"));
}

TEST(Rosbag2ReaderTest, OtherDatabasesAreRefused) {
  test::TemporaryFile file(".db3");
  sqlite3* database = nullptr;
  ASSERT_EQ(sqlite3_open(file.path().c_str(), &database), SQLITE_OK);
  sqlite3_exec(database, "CREATE TABLE people(name TEXT)", nullptr, nullptr,
               nullptr);
  sqlite3_close(database);
  const auto source = OpenSensorSource(file.path(), {});
  ASSERT_FALSE(source.ok());
  EXPECT_THAT(std::string(source.status().message()),
              HasSubstr("no such table: topics (not a database of rosbag2?)"));
  test::WriteBytes(file.path(), "SQLite format 3");
  EXPECT_FALSE(OpenSensorSource(file.path(), {}).ok());
}

TEST(Rosbag2ReaderTest, MessagesInAnotherEncodingAreNotTaken) {
  test::TemporaryFile file(".db3");
  test::WriteRos2Sample(file.path(), Rosbag2Storage::kDb3, "none");
  sqlite3* database = nullptr;
  ASSERT_EQ(sqlite3_open(file.path().c_str(), &database), SQLITE_OK);
  sqlite3_exec(database, "UPDATE topics SET serialization_format = 'protobuf'",
               nullptr, nullptr, nullptr);
  sqlite3_close(database);
  EXPECT_THAT(std::string(OpenSensorSource(file.path(), {}).status().message()),
              HasSubstr("no topic of type"));
}

// Messages without a stamp have the time at which they were recorded, which may
// be any number.
TEST(Rosbag2ReaderTest, TimesOfRecordingThatCannotBeAreLimited) {
  const TimeNs sweep = FromSeconds(SweepSeconds(test::SampleScan(0, 8)));
  ASSERT_GT(sweep, 0);
  for (const bool late : {false, true}) {
    test::TemporaryFile file(".db3");
    test::WriteRos2Sample(file.path(), Rosbag2Storage::kDb3, "none");
    sqlite3* database = nullptr;
    ASSERT_EQ(sqlite3_open(file.path().c_str(), &database), SQLITE_OK);
    const std::string time =
        late ? "9223372036854775807" : "~9223372036854775807";
    // The stamp follows the four bytes that say how messages are encoded.
    const std::string change =
        "UPDATE messages SET timestamp = " + time +
        ", data = CAST(substr(data, 1, 4) || zeroblob(8) || substr(data, 13) "
        "AS BLOB) WHERE topic_id IN (SELECT id FROM topics WHERE name <> "
        "'/tf_static')";
    EXPECT_EQ(sqlite3_exec(database, change.c_str(), nullptr, nullptr, nullptr),
              SQLITE_OK);
    sqlite3_close(database);
    auto source = OpenSensorSource(file.path(), {});
    ASSERT_TRUE(source.ok()) << source.status();
    EXPECT_EQ((*source)->info().num_scans, 10);
    const TimeNs limit = late ? kMaxRecorded : -kMaxRecorded;
    SensorEvent event;
    while ((*source)->Next(&event).value()) {
      const bool is_scan = absl::holds_alternative<LaserScan>(event);
      EXPECT_EQ(EventTime(event), limit + (is_scan ? sweep : 0));
    }
  }
}

TEST(Rosbag2ReaderTest, SurvivesDamagedDatabases) {
  test::TemporaryFile sample(".db3");
  test::WriteRos2Sample(sample.path(), Rosbag2Storage::kDb3, "none");
  test::TemporaryFile file(".db3");
  test::ForEachMutation(test::ReadBytes(sample.path()),
                        [&](const std::string& damaged) {
                          test::WriteBytes(file.path(), damaged);
                          auto source = OpenSensorSource(file.path(), {});
                          SensorEvent event;
                          for (int i = 0; source.ok() && i < 1000; ++i) {
                            const auto more = (*source)->Next(&event);
                            if (!more.ok() || !*more) break;
                          }
                        });
}

}  // namespace
}  // namespace io
}  // namespace cartographer_ext
