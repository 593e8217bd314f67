// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
#include "cartographer_ext/io/carmen/carmen_reader.h"

#include <cmath>
#include <string>
#include <vector>

#include "absl/strings/str_cat.h"
#include "absl/strings/str_join.h"
#include "cartographer_ext/io/sensor_source.h"
#include "gmock/gmock.h"
#include "gtest/gtest.h"
#include "tests/mutation.h"
#include "tests/test_data.h"

namespace cartographer_ext {
namespace io {
namespace {

using ::testing::ElementsAre;
using ::testing::HasSubstr;

struct Log {
  SensorSourceInfo info;
  std::vector<SensorEvent> events;

  std::vector<LaserScan> Scans() const {
    std::vector<LaserScan> scans;
    for (const SensorEvent& event : events) {
      if (const auto* scan = absl::get_if<LaserScan>(&event)) {
        scans.push_back(*scan);
      }
    }
    return scans;
  }
  std::vector<OdometryReading> Odometry() const {
    std::vector<OdometryReading> readings;
    for (const SensorEvent& event : events) {
      if (const auto* reading = absl::get_if<OdometryReading>(&event)) {
        readings.push_back(*reading);
      }
    }
    return readings;
  }
  // "o1 s1.05 ...": kinds and stamps.
  std::string Order() const {
    return absl::StrJoin(
        events, " ", [](std::string* out, const SensorEvent& event) {
          const char* const kind =
              absl::holds_alternative<LaserScan>(event) ? "s" : "o";
          absl::StrAppend(out, kind, ToSeconds(EventTime(event)));
        });
  }
};

absl::StatusOr<Log> Read(const std::string& file,
                         const std::string& odometry_source = "auto") {
  SensorSourceOptions options;
  options.odometry_source = odometry_source;
  auto source = OpenSensorSource(file, options);
  if (!source.ok()) return source.status();
  Log log;
  log.info = (*source)->info();
  SensorEvent event;
  while (true) {
    const auto more = (*source)->Next(&event);
    if (!more.ok()) return more.status();
    if (!*more) return log;
    log.events.push_back(event);
  }
}

absl::StatusOr<Log> ReadText(const std::string& text,
                             const std::string& odometry_source = "auto") {
  test::TemporaryFile file(".clf");
  test::WriteBytes(file.path(), text);
  return Read(file.path(), odometry_source);
}

TEST(CarmenReaderTest, OldKind) {
  const auto log = Read(test::OwnData("flaser.clf"));
  ASSERT_TRUE(log.ok()) << log.status();
  EXPECT_EQ(log->info.format, "carmen");
  EXPECT_EQ(log->info.num_scans, 3);
  EXPECT_EQ(log->info.num_odometry, 4);
  EXPECT_EQ(log->info.begin, 1000000000);
  EXPECT_EQ(log->info.end, 4000000000);
  EXPECT_EQ(log->info.num_out_of_order, 0);  // Within the streams.
  // The second ODOM line from below stands behind its scan.
  EXPECT_EQ(log->Order(), "o1 s1.05 o2 s2.05 o3 s3.05 o4");
  const auto warnings = log->info.warnings;
  ASSERT_EQ(warnings.size(), 2u);
  EXPECT_THAT(warnings[0],
              HasSubstr("flaser.clf:10: poses and stamp do not follow"));
  EXPECT_THAT(warnings[0], HasSubstr("1 malformed line skipped"));
  EXPECT_THAT(warnings[1], HasSubstr("1 scans of other lasers"));
  const std::vector<LaserScan> scans = log->Scans();
  ASSERT_EQ(scans.size(), 3u);
  EXPECT_THAT(scans[0].ranges, ElementsAre(1.f, 2.5f, 81.91f));
  EXPECT_TRUE(std::isnan(scans[1].ranges[1]));
  EXPECT_TRUE(std::isinf(scans[2].ranges[1]));
  EXPECT_NEAR(scans[0].range_max, 81.82, 1e-9);
  // Both poses are equal, so the parameter tells where the laser is.
  EXPECT_NEAR(scans[0].laser_pose.x, 0.17, 1e-12);
  EXPECT_NEAR(log->Odometry()[3].pose.x, 0.3, 1e-12);
  EXPECT_FALSE(log->Odometry()[3].inside_scan);
}

TEST(CarmenReaderTest, OdometrySources) {
  const std::string file = test::OwnData("flaser.clf");
  EXPECT_EQ(Read(file, "odom")->Order(), "o1 s1.05 o2 s2.05 o3 s3.05 o4");
  EXPECT_EQ(Read(file, "scan")->Order(), "o1.05 s1.05 o2.05 s2.05 o3.05 s3.05");
  EXPECT_EQ(Read(file, "both")->Order(),
            "o1 o1.05 s1.05 o2 o2.05 s2.05 o3 o3.05 s3.05 o4");
  EXPECT_TRUE(Read(file, "scan")->Odometry()[0].inside_scan);
  const auto wrong = Read(file, "wheels");
  EXPECT_THAT(std::string(wrong.status().message()), HasSubstr("\"wheels\""));
}

TEST(CarmenReaderTest, TooFewOdometryLinesAreNotTaken) {
  std::string text = "ODOM 0 0 0 0 0 0 1 h 1\n";
  for (int i = 0; i < 10; ++i) {
    absl::StrAppend(&text, "FLASER 2 1 2 ", i, " 0 0 ", i, " 0 0 ", 1 + i,
                    " h 1\n");
  }
  const auto log = ReadText(text);
  ASSERT_TRUE(log.ok());
  EXPECT_EQ(log->info.num_odometry, 10);
  EXPECT_TRUE(log->Odometry()[0].inside_scan);
  ASSERT_EQ(log->info.warnings.size(), 1u);
  EXPECT_THAT(log->info.warnings[0], HasSubstr("too few ODOM lines (1)"));
}

TEST(CarmenReaderTest, DisorderedStampsCannotPairOdometryLines) {
  std::string text;
  for (int i = 0; i < 100; ++i) {
    const int time = i % 10 == 9 ? i - 5 : i;
    absl::StrAppend(&text, "ODOM ", i, " 0 0 0 0 0 ", time, " h 1\n");
    absl::StrAppend(&text, "FLASER 2 1 2 ", i, " 0 0 ", i, " 0 0 ", time,
                    " h 1\n");
  }
  const auto log = ReadText(text);
  ASSERT_TRUE(log.ok());
  EXPECT_TRUE(log->Odometry()[0].inside_scan);
  EXPECT_EQ(log->info.num_odometry, 100);
  ASSERT_EQ(log->info.warnings.size(), 2u);
  EXPECT_THAT(log->info.warnings[0], HasSubstr("too disordered"));
}

TEST(CarmenReaderTest, NewKind) {
  const auto log = Read(test::OwnData("robotlaser.clf"));
  ASSERT_TRUE(log.ok()) << log.status();
  const std::vector<LaserScan> scans = log->Scans();
  ASSERT_EQ(scans.size(), 3u);
  EXPECT_TRUE(log->info.warnings.empty()) << log->info.warnings[0];
  EXPECT_EQ(scans[0].angle_min, -1.);
  EXPECT_EQ(scans[0].angle_increment, 0.5);
  EXPECT_THAT(scans[1].ranges, ElementsAre(1.1f, 2.1f, 3.1f, 4.1f, 20.f));
  // The maximum itself is "no return".
  EXPECT_LT(scans[0].range_max, 20.);
  EXPECT_GT(scans[0].range_max, 19.999);
  // Between the two poses of each line.
  EXPECT_NEAR(scans[0].laser_pose.x, 0.3, 1e-5);
  EXPECT_NEAR(scans[0].laser_pose.y, 0.1, 1e-5);
  EXPECT_NEAR(scans[0].laser_pose.theta, 0., 1e-5);
  const std::vector<OdometryReading> odometry = log->Odometry();
  ASSERT_EQ(odometry.size(), 3u);
  EXPECT_EQ(odometry[1].time, 101500000000);
  EXPECT_NEAR(odometry[1].pose.y, 1., 1e-12);
  EXPECT_NEAR(odometry[1].pose.theta, 1.570796, 1e-9);
}

TEST(CarmenReaderTest, CorrectedLogsKeepOdometry) {
  std::string text;
  for (int i = 0; i < 10; ++i) {
    absl::StrAppend(&text, "FLASER 2 1 2 ", 1.3 * i, " ", 0.1 * i, " 0 ", i,
                    " 0 0 ", 1 + i, " h 1\n");
  }
  const auto log = ReadText(text);
  ASSERT_TRUE(log.ok());
  ASSERT_EQ(log->info.warnings.size(), 1u);
  EXPECT_THAT(log->info.warnings[0], HasSubstr("a corrected log?"));
  EXPECT_EQ(log->Scans()[9].laser_pose.x, 0.);
  EXPECT_EQ(log->Odometry()[9].pose.x, 9.);
}

// What GMapping writes: the pose jumps by the correction at every scan.
std::string ParticleFilterLogText(const int num_scans, const bool with_marks) {
  std::string text;
  double corrected = 0., stamp = 0.;
  for (int i = 0; i < num_scans; ++i) {
    for (int k = 0; k < 3; ++k) {
      corrected += 0.25;
      absl::StrAppend(&text, "ODOM ", corrected, " 0 0 0 0 0 ", stamp += 0.5,
                      " h 1\n");
    }
    corrected -= 0.5;  // the correction
    absl::StrAppend(&text, "FLASER 2 1 2 ", corrected, " 0 0 ", corrected,
                    " 0 0 ", stamp, " h 1\n");
    // The repetition, whose stamp may be no stamp.
    absl::StrAppend(&text, "ODOM ", corrected, " 0 0 0 0 0 ",
                    i % 2 == 0 ? "0 h 0\n" : "-20.1 h -20.1\n");
    if (with_marks) absl::StrAppend(&text, "NEFF 29.5\n");
  }
  return text;
}

TEST(CarmenReaderTest, CorrectedPosesOfAParticleFilterAreTaken) {
  const auto log = ReadText(ParticleFilterLogText(20, true));
  ASSERT_TRUE(log.ok()) << log.status();
  EXPECT_EQ(log->info.num_scans, 20);
  EXPECT_EQ(log->info.num_out_of_order, 0);
  ASSERT_EQ(log->info.warnings.size(), 1u);
  EXPECT_THAT(log->info.warnings[0], HasSubstr("the log of a particle filter"));
  const std::vector<OdometryReading> odometry = log->Odometry();
  ASSERT_EQ(odometry.size(), 20u);
  for (int i = 0; i < 20; ++i) {
    EXPECT_TRUE(odometry[i].inside_scan);
    EXPECT_NEAR(odometry[i].pose.x, 0.25 * (i + 1), 1e-12);
    EXPECT_NEAR(ToSeconds(odometry[i].time), 1.5 * (i + 1), 1e-9);
  }
  // Without the filter's marks it could be any log, and its ODOM lines count.
  const auto other = ReadText(ParticleFilterLogText(20, false), "odom");
  EXPECT_EQ(other->info.num_odometry, 70);
}

TEST(CarmenReaderTest, CorrectionsOfAParticleFilterAreRemovedOnRequest) {
  const auto log = ReadText(ParticleFilterLogText(20, true), "odom");
  ASSERT_TRUE(log.ok()) << log.status();
  EXPECT_EQ(log->info.num_out_of_order, 0);
  EXPECT_EQ(log->info.warnings.size(), 0u);
  const std::vector<OdometryReading> odometry = log->Odometry();
  ASSERT_EQ(odometry.size(), 60u);
  for (int i = 0; i < 60; ++i) {
    EXPECT_NEAR(odometry[i].pose.x, 0.25 * (i + 1), 1e-12);
    EXPECT_NEAR(ToSeconds(odometry[i].time), 0.5 * (i + 1), 1e-9);
    EXPECT_FALSE(odometry[i].inside_scan);
  }
  // Where stamps go backwards, the lines are in the order of the filter.
  std::string disordered = ParticleFilterLogText(20, true);
  disordered.replace(disordered.find(" 10.5 h"), 5, " 9.25");
  const auto ordered = ReadText(disordered, "odom");
  EXPECT_EQ(ordered->info.num_out_of_order, 0);
  ASSERT_EQ(ordered->Odometry().size(), 60u);
  EXPECT_NEAR(ToSeconds(ordered->Odometry()[0].time), 0.1, 1e-9);
  EXPECT_NEAR(ordered->Odometry()[20].pose.x, 5.25, 1e-12);
}

TEST(CarmenReaderTest, ScansOfAParticleFilterWithoutOdometryBetweenThem) {
  std::string text;
  for (int i = 0; i < 20; ++i) {
    absl::StrAppend(&text, "FLASER 2 1 2 ", i, " 0 0 ", i, " 0 0 ", i + 1,
                    " h 1\nODOM ", i, " 0 0 0 0 0 0 h 0\nNEFF 29\n");
    if (i == 9) absl::StrAppend(&text, "ODOM 9.5 0 0 0 0 0 10.5 h 1\n");
  }
  const auto log = ReadText(text, "both");
  ASSERT_TRUE(log.ok()) << log.status();
  ASSERT_EQ(log->Odometry().size(), 21u);
  EXPECT_NEAR(log->Odometry()[9].pose.x, 9., 1e-12);
  EXPECT_NEAR(log->Odometry()[10].pose.x, 9.5, 1e-12);
  EXPECT_NEAR(log->Odometry()[11].pose.x, 9.5, 1e-12);
  EXPECT_NEAR(log->Odometry()[20].pose.x, 18.5, 1e-12);
}

TEST(CarmenReaderTest, LostStampsAreReplaced) {
  for (const char* const stamp : {"0", "1.20012e+09"}) {
    std::string text;
    for (int i = 0; i < 20; ++i) {
      absl::StrAppend(&text, "ODOM ", i, " 0 0 0 0 0 ", stamp, " h 1\n");
      absl::StrAppend(&text, "FLASER 2 1 2 ", i, " 0 0 ", i, " 0 0 ", stamp,
                      " h 1\n");
    }
    const auto log = ReadText(text);
    ASSERT_TRUE(log.ok()) << log.status();
    ASSERT_EQ(log->info.warnings.size(), 1u);
    EXPECT_THAT(log->info.warnings[0],
                HasSubstr("that of the lines is taken, 0.1 s per line"));
    ASSERT_EQ(log->events.size(), 40u);
    for (int i = 0; i < 40; ++i) {
      EXPECT_NEAR(ToSeconds(EventTime(log->events[i])), 0.1 * (i + 1), 1e-9);
    }
    EXPECT_EQ(log->Odometry()[7].pose.x, 7.);
  }
}

TEST(CarmenReaderTest, SortsStablyAndCounts) {
  // Stamps 2 1 2 1; the order of equal ones is that of the file.
  std::string text;
  for (int i = 0; i < 4; ++i) {
    absl::StrAppend(&text, "FLASER 1 ", 1 + i, " 0 0 0 0 0 0 ", 2 - i % 2,
                    " h 1\n");
  }
  const auto log = ReadText(text);
  ASSERT_TRUE(log.ok());
  EXPECT_EQ(log->info.num_out_of_order, 2);
  // Odometry of equal stamps comes before the scans.
  EXPECT_EQ(log->Order(), "o1 o1 s1 s1 o2 o2 s2 s2");
  std::vector<float> firsts;
  for (const LaserScan& scan : log->Scans()) firsts.push_back(scan.ranges[0]);
  EXPECT_THAT(firsts, ElementsAre(2.f, 4.f, 1.f, 3.f));
  ASSERT_EQ(log->info.warnings.size(), 1u);
  EXPECT_THAT(log->info.warnings[0], HasSubstr("stamps of 2 scans"));
}

// Scans a second apart.
std::string LongLog(const int num_scans) {
  std::string text;
  for (int i = 0; i < num_scans; ++i) {
    absl::StrAppend(&text, "ODOM ", i, " 0 0 0 0 0 ", 1134864000 + i, " h 1\n");
    absl::StrAppend(&text, "FLASER 2 1 2 ", i, " 0 0 ", i, " 0 0 ",
                    1134864000 + i, ".5 h 1\n");
  }
  return text;
}

TEST(CarmenReaderTest, StampsThatDoNotBelongToTheLogAreDropped) {
  const std::string text = LongLog(200);
  const std::string odd = "FLASER 2 1 2 0 0 0 0 0 0 603 h 1\n";
  const size_t middle = text.find("ODOM 100 ");
  for (const std::string& log_text :
       {odd + text, text.substr(0, middle) + odd + text.substr(middle),
        text + odd}) {
    const auto log = ReadText(log_text);
    ASSERT_TRUE(log.ok()) << log.status();
    EXPECT_EQ(log->info.num_scans, 200);
    EXPECT_EQ(log->Scans().size(), 200u);
    EXPECT_NEAR(ToSeconds(log->info.end - log->info.begin), 199.5, 1e-6);
    ASSERT_EQ(log->info.warnings.size(), 1u);
    EXPECT_THAT(log->info.warnings[0],
                HasSubstr("the stamp 603.000000000 s is more than an hour from "
                          "those around it; 1 message dropped"));
  }
  EXPECT_THAT(ReadText(text + odd)->info.warnings[0], HasSubstr(":401: "));
  // A pause is none: both sides are logs.
  std::string paused = text;
  for (int i = 0; i < 100; ++i) {
    absl::StrAppend(&paused, "FLASER 2 1 2 0 0 0 0 0 0 ", 1134964000 + i,
                    " h 1\n");
  }
  EXPECT_EQ(ReadText(paused)->info.num_scans, 300);
}

TEST(CarmenReaderTest, OdometryMayHaveAClockOfItsOwn) {
  std::string text;
  for (int i = 0; i < 200; ++i) {
    absl::StrAppend(&text, "ODOM ", i, " 0 0 0 0 0 ", 1000 + i, " h 1\n");
    absl::StrAppend(&text, "FLASER 2 1 2 ", i, " 0 0 ", i, " 0 0 ",
                    1134864000 + i, " h 1\n");
  }
  const auto log = ReadText(text);
  ASSERT_TRUE(log.ok()) << log.status();
  EXPECT_EQ(log->info.num_scans, 200);
  EXPECT_EQ(log->info.num_odometry, 200);
  EXPECT_NEAR(ToSeconds(log->info.end - log->info.begin), 199., 1e-6);
  ASSERT_EQ(log->info.warnings.size(), 1u);
  EXPECT_THAT(log->info.warnings[0],
              HasSubstr("other times in the ODOM lines than in those of scans "
                        "(200); odometry is taken from the scan lines"));
}

TEST(CarmenReaderTest, AClockThatIsSetBackIsSaid) {
  std::string text;
  for (int i = 0; i < 200; ++i) {
    absl::StrAppend(&text, "FLASER 2 1 2 ", i, " 0 0 ", i, " 0 0 ",
                    1134864000 + (i < 100 ? i : i - 60), ".5 h 1\n");
  }
  const auto log = ReadText(text);
  ASSERT_TRUE(log.ok()) << log.status();
  EXPECT_THAT(log->info.warnings,
              testing::Contains(HasSubstr("set back by up to 59.0 s")));
}

TEST(CarmenReaderTest, ALastLineThatIsCutOffIsDropped) {
  const std::string text = LongLog(200);
  // Whole but for the line end; cut in the logger's stamp, behind the host's
  // name, and in the scan's stamp.
  EXPECT_EQ(ReadText(text.substr(0, text.size() - 1))->info.num_scans, 200);
  for (const size_t missing : {3, 5, 7, 12}) {
    const auto log = ReadText(text.substr(0, text.size() - missing));
    ASSERT_TRUE(log.ok());
    EXPECT_EQ(log->info.num_scans, 199) << missing;
    EXPECT_EQ(log->Scans().size(), 199u);
    ASSERT_EQ(log->info.warnings.size(), 1u) << missing;
    EXPECT_THAT(log->info.warnings[0],
                HasSubstr(":400: the last line is truncated"));
  }
}

TEST(CarmenReaderTest, NoReturnCodes) {
  const auto range_max = [](const std::string& reading, int count) {
    std::string text = "FLASER 1 7.0 0 0 0 0 0 0 1 h 1\n";
    for (int i = 0; i < count; ++i) {
      absl::StrAppend(&text, "FLASER 1 ", reading, " 0 0 0 0 0 0 ", 2 + i,
                      " h 1\n");
    }
    return ReadText(text)->Scans()[0].range_max;
  };
  EXPECT_EQ(range_max("9.5", 1), 80.);              // Just a far wall.
  EXPECT_NEAR(range_max("50", 20), 50., 1e-4);      // A code ...
  EXPECT_LT(range_max("50", 20), 50.);              // ... and not a range.
  EXPECT_NEAR(range_max("8.191", 1), 8.182, 1e-9);  // Reserved values.
  EXPECT_NEAR(range_max("81.83", 1), 81.82, 1e-9);
  EXPECT_NEAR(range_max("32.767", 1), 32.758, 1e-9);
}

TEST(CarmenReaderTest, OnlyRawLaser) {
  const auto log = ReadText(
      "RAWLASER1 0 -1.57 3.14 3.14 80 0.01 0 2 1 2 0 7.5 h 1\n"
      "ODOM 1 0 0 0 0 0 7.4 h 1\n");
  ASSERT_TRUE(log.ok()) << log.status();
  EXPECT_EQ(log->Order(), "o7.4 s7.5");
}

TEST(CarmenReaderTest, Errors) {
  EXPECT_EQ(Read("/nonexistent.clf").status().code(),
            absl::StatusCode::kNotFound);
  EXPECT_FALSE(Read("configuration_files").ok());
  EXPECT_FALSE(Read("/dev/null").ok());
  EXPECT_FALSE(ReadText("").ok());
  const auto no_scan = ReadText("hello\nworld\n");
  EXPECT_THAT(std::string(no_scan.status().message()),
              HasSubstr("is this a CARMEN log?"));
  const auto malformed = ReadText("\nFLASER 3 1 2\n");
  EXPECT_THAT(std::string(malformed.status().message()),
              HasSubstr(".clf:2: fewer readings"));
}

TEST(CarmenReaderTest, SurvivesMutations) {
  for (const char* name : {"flaser.clf", "robotlaser.clf"}) {
    const std::string sample = test::ReadBytes(test::OwnData(name));
    test::TemporaryFile file(".clf");
    test::ForEachMutation(sample, [&](const std::string& damaged) {
      test::WriteBytes(file.path(), damaged);
      const auto log = Read(file.path(), "both");
      if (!log.ok()) return;
      EXPECT_EQ(static_cast<int64_t>(log->events.size()),
                log->info.num_scans + log->info.num_odometry);
      TimeNs last = 0;
      for (const SensorEvent& event : log->events) {
        EXPECT_GE(EventTime(event), last);
        last = EventTime(event);
      }
    });
  }
}

}  // namespace
}  // namespace io
}  // namespace cartographer_ext
