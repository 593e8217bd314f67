// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
#include "cartographer_ext/front_end/match_record.h"

#include <cmath>
#include <fstream>
#include <iterator>
#include <string>
#include <vector>

#include "Eigen/LU"
#include "absl/strings/str_split.h"
#include "absl/strings/strip.h"
#include "gtest/gtest.h"

namespace cartographer_ext {
namespace front_end {
namespace {

using proto::MatchRecord;

MatchRecord Example() {
  scan_matching::MatchReport report;
  // 4 cm along 30 degrees, 1 cm across, 0.01 rad.
  Eigen::Matrix2d axes;
  const double c = std::cos(kPi / 6.), s = std::sin(kPi / 6.);
  axes << c, -s, s, c;
  report.covariance.setZero();
  report.covariance.topLeftCorner<2, 2>() =
      axes * Eigen::Vector2d(0.0016, 0.0001).asDiagonal() * axes.transpose();
  report.covariance(2, 2) = 1e-4;
  report.degeneracy.state = scan_matching::DegeneracyState::kTranslation;
  report.degeneracy.direction = kPi / 6.;
  report.degeneracy.ratio = 0.0625;
  report.disagreement = Eigen::Vector3d(0.01, -0.02, 0.5);
  report.mahalanobis = 3.5;
  MatchRecord record;
  record.set_builder(1);
  // 2020-09-13 12:26:40.25 UTC is 1600000000.25 s after the epoch.
  record.set_time((1600000000LL + 719162LL * 86400LL) * 10000000LL + 2500000LL);
  record.set_is_node(true);
  SetPose(Pose2(1.5, -2., kPi / 2.), &record);
  SetReport(report, &record);
  SetPrediction(PredictionSource::kOdometry, OdometryState::kSlipping, &record);
  record.set_score(0.625);
  OdometryCalibrationOptions calibration;
  calibration.translation_scale = 1.02;
  calibration.rotation_per_metre = kPi / 180.;
  SetCalibration(OdometryCalibration(calibration), &record);
  return record;
}

TEST(MatchRecordTest, EveryColumnIsDocumented) {
  std::ifstream stream("docs/side_files.md");
  const std::string page((std::istreambuf_iterator<char>(stream)), {});
  for (const absl::string_view column :
       absl::StrSplit(absl::StripSuffix(RecordCsvHead(), "\n"), ',')) {
    EXPECT_NE(page.find("`" + std::string(column) + "`"), std::string::npos)
        << column;
  }
}

TEST(MatchRecordTest, KeepsTheCovariance) {
  const MatchRecord record = Example();
  EXPECT_EQ(record.covariance_size(), 6);
  const Eigen::Matrix3d covariance = Covariance(record);
  EXPECT_DOUBLE_EQ(covariance(2, 2), 1e-4);
  EXPECT_EQ(covariance(0, 1), covariance(1, 0));
  const Eigen::Matrix2d position = covariance.topLeftCorner<2, 2>();
  EXPECT_NEAR(position.determinant(), 1.6e-7, 1e-15);
  EXPECT_TRUE(Covariance(MatchRecord()).isZero());
}

TEST(MatchRecordTest, BytesAndBack) {
  std::string bytes;
  AppendRecord(Example(), &bytes);
  AppendRecord(MatchRecord(), &bytes);
  AppendRecord(Example(), &bytes);
  const auto records = ParseRecords(bytes);
  ASSERT_TRUE(records.ok()) << records.status();
  ASSERT_EQ(records->size(), 3);
  EXPECT_EQ((*records)[0].SerializeAsString(), Example().SerializeAsString());
  EXPECT_EQ((*records)[2].SerializeAsString(), Example().SerializeAsString());
  EXPECT_TRUE(ParseRecords("")->empty());
}

TEST(MatchRecordTest, DamagedBytesAreRefused) {
  std::string bytes;
  AppendRecord(Example(), &bytes);
  const size_t one = bytes.size();
  AppendRecord(Example(), &bytes);
  for (const size_t length : {one + 1, one + 5, 2 * one - 1}) {
    const auto records =
        ParseRecords(absl::string_view(bytes).substr(0, length));
    EXPECT_EQ(records.status().code(), absl::StatusCode::kDataLoss) << length;
    EXPECT_NE(records.status().message().find(std::to_string(one)),
              absl::string_view::npos);
  }
  EXPECT_FALSE(ParseRecords("\xff\xff\xff\xff\xff\xff\xff").ok());
}

TEST(MatchRecordTest, Csv) {
  const std::vector<std::string> lines =
      absl::StrSplit(RecordCsv({Example()}), '\n');
  ASSERT_EQ(lines.size(), 3);  // head, record, nothing behind the last newline
  const std::vector<std::string> head = absl::StrSplit(lines[0], ',');
  const std::vector<std::string> cells = absl::StrSplit(lines[1], ',');
  ASSERT_EQ(cells.size(), head.size());
  const auto cell = [&](const std::string& name) {
    for (size_t i = 0; i < head.size(); ++i) {
      if (head[i] == name) return cells[i];
    }
    return std::string("no column ") + name;
  };
  EXPECT_EQ(cell("builder"), "1");
  EXPECT_EQ(cell("time"), "1600000000.2500000");
  EXPECT_EQ(cell("node"), "1");
  EXPECT_EQ(cell("x"), "1.500000");
  EXPECT_EQ(cell("theta_degrees"), "90.00000");
  EXPECT_EQ(cell("sigma_long"), "0.04");
  EXPECT_EQ(cell("sigma_short"), "0.01");
  EXPECT_EQ(cell("long_axis_degrees"), "30.00");
  EXPECT_EQ(cell("degeneracy"), "translation");
  EXPECT_EQ(cell("weak_direction_degrees"), "30.00");
  EXPECT_EQ(cell("odometry"), "slipping");
  EXPECT_EQ(cell("source"), "odometry");
  EXPECT_EQ(cell("score"), "0.6250");
  EXPECT_EQ(cell("odometry_scale"), "1.020000");
  EXPECT_EQ(cell("odometry_scale_sigma"), "0.020000");
  EXPECT_EQ(cell("rotation_scale"), "1.000000");
  EXPECT_EQ(cell("rotation_per_metre_degrees"), "1.00000");
}

TEST(MatchRecordTest, GyroscopeOnlyWhereThereIsOne) {
  Gyroscope gyroscope{GyroscopeOptions()};
  MatchRecord record;
  SetGyroscope(gyroscope, &record);
  EXPECT_EQ(record.gyroscope(), MatchRecord::NO_GYROSCOPE);
  EXPECT_EQ(record.gyroscope_factor(), 0.);
  gyroscope.Add(0., 0.1);
  SetGyroscope(gyroscope, &record);
  EXPECT_EQ(record.gyroscope(), MatchRecord::UNPROVEN);
  EXPECT_EQ(record.gyroscope_factor(), 1.);
  EXPECT_GT(record.gyroscope_factor_sigma(), 0.);
  const std::string csv = RecordCsv({record});
  EXPECT_NE(csv.find(",unproven,1.000000,"), std::string::npos) << csv;
}

TEST(MatchRecordTest, EveryStateHasItsName) {
  MatchRecord record;
  SetPrediction(PredictionSource::kImu, OdometryState::kSlipSuspected, &record);
  EXPECT_EQ(record.source(), MatchRecord::INERTIAL);
  EXPECT_EQ(record.odometry(), MatchRecord::SLIP_SUSPECTED);
  SetPrediction(PredictionSource::kConstantVelocity, OdometryState::kWrongSign,
                &record);
  EXPECT_EQ(record.source(), MatchRecord::CONSTANT_VELOCITY);
  EXPECT_EQ(record.odometry(), MatchRecord::WRONG_SIGN);
  SetPrediction(PredictionSource::kNothing, OdometryState::kStale, &record);
  EXPECT_EQ(record.source(), MatchRecord::NOTHING);
  EXPECT_EQ(record.odometry(), MatchRecord::STALE);
}

}  // namespace
}  // namespace front_end
}  // namespace cartographer_ext
