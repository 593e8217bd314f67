// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
#include "cartographer_ext/io/sensor_source.h"

#include <string>

#include "gmock/gmock.h"
#include "gtest/gtest.h"
#include "tests/mutation.h"
#include "tests/test_data.h"

namespace cartographer_ext {
namespace io {
namespace {

using ::testing::HasSubstr;

std::string ErrorOf(const std::string& name, const std::string& content) {
  test::TemporaryFile file(name);
  test::WriteBytes(file.path(), content);
  const auto source = OpenSensorSource(file.path(), {});
  EXPECT_FALSE(source.ok());
  EXPECT_THAT(std::string(source.status().message()), HasSubstr(file.path()));
  return std::string(source.status().message());
}

TEST(SensorSourceTest, SecondsAndNanoseconds) {
  EXPECT_EQ(FromSeconds(1.5), 1500000000);
  EXPECT_EQ(FromSeconds(-1e-9), -1);
  EXPECT_EQ(ToSeconds(2500000000), 2.5);
}

TEST(SensorSourceTest, TellsFormatsByContent) {
  // A CARMEN log under any name that does not promise something else.
  test::TemporaryFile file(".txt");
  test::WriteBytes(file.path(), "FLASER 1 2 0 0 0 0 0 0 1 h 1\n");
  auto source = OpenSensorSource(file.path(), {});
  ASSERT_TRUE(source.ok()) << source.status();
  EXPECT_EQ((*source)->info().format, "carmen");
  SensorEvent event;
  EXPECT_TRUE(*(*source)->Next(&event));
  EXPECT_TRUE(absl::holds_alternative<OdometryReading>(event));
  EXPECT_TRUE(*(*source)->Next(&event));
  EXPECT_TRUE(absl::holds_alternative<LaserScan>(event));
  EXPECT_EQ(EventTime(event), 1000000000);
  EXPECT_FALSE(*(*source)->Next(&event));
  EXPECT_FALSE(*(*source)->Next(&event));  // And stays there.
}

TEST(SensorSourceTest, SaysWhatIsWrong) {
  EXPECT_THAT(ErrorOf(".bag", "FLASER 1 2 0 0 0 0 0 0 1 h 1\n"),
              HasSubstr("not a ROS 1 bag"));
  EXPECT_THAT(ErrorOf(".mcap", "\x89MCAP0\r\n"), HasSubstr("no topic of type"));
  EXPECT_THAT(ErrorOf(".db3", "SQLite format 3"), HasSubstr("not a database"));
  EXPECT_THAT(ErrorOf(".clf", ""), HasSubstr("empty"));
  EXPECT_THAT(ErrorOf(".clf", "some text"), HasSubstr("a CARMEN log?"));
  EXPECT_EQ(OpenSensorSource("/nonexistent.clf", {}).status().code(),
            absl::StatusCode::kNotFound);
  EXPECT_FALSE(OpenSensorSource("configuration_files", {}).ok());
  EXPECT_FALSE(OpenSensorSource("/dev/null", {}).ok());
}

}  // namespace
}  // namespace io
}  // namespace cartographer_ext
