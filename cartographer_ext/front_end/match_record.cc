// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
#include "cartographer_ext/front_end/match_record.h"

#include <algorithm>
#include <cmath>
#include <cstdint>

#include "absl/strings/ascii.h"
#include "absl/strings/str_cat.h"
#include "absl/strings/str_format.h"
#include "cartographer_ext/common/delimited_messages.h"
#include "cartographer_ext/common/host_ticks.h"

namespace cartographer_ext {
namespace front_end {
namespace {

using proto::MatchRecord;
using scan_matching::DegeneracyState;

constexpr char kHead[] =
    "builder,time,node,x,y,theta_degrees,sigma_long,sigma_short,"
    "long_axis_degrees,sigma_theta_degrees,degeneracy,weak_direction_degrees,"
    "information_ratio,disagreement_x,disagreement_y,"
    "disagreement_theta_degrees,chi_square,odometry,source,searched,score,"
    "time_offset,interval,odometry_scale,odometry_scale_sigma,rotation_scale,"
    "rotation_scale_sigma,rotation_per_metre_degrees,rotation_per_metre_sigma_"
    "degrees,gyroscope,gyroscope_factor,gyroscope_factor_sigma\n";

MatchRecord::Degeneracy ToProto(const DegeneracyState state) {
  switch (state) {
    case DegeneracyState::kNone:
      return MatchRecord::NONE;
    case DegeneracyState::kTranslation:
      return MatchRecord::TRANSLATION;
    case DegeneracyState::kPosition:
      return MatchRecord::POSITION;
    case DegeneracyState::kRotation:
      return MatchRecord::ROTATION;
    case DegeneracyState::kTranslationAndRotation:
      return MatchRecord::TRANSLATION_AND_ROTATION;
    case DegeneracyState::kEverything:
      return MatchRecord::EVERYTHING;
  }
  return MatchRecord::NONE;
}

MatchRecord::OdometryState ToProto(const OdometryState state) {
  switch (state) {
    case OdometryState::kOk:
      return MatchRecord::OK;
    case OdometryState::kAbsent:
      return MatchRecord::ABSENT;
    case OdometryState::kStale:
      return MatchRecord::STALE;
    case OdometryState::kJumping:
      return MatchRecord::JUMPING;
    case OdometryState::kWrongSign:
      return MatchRecord::WRONG_SIGN;
    case OdometryState::kSlipping:
      return MatchRecord::SLIPPING;
    case OdometryState::kSlipSuspected:
      return MatchRecord::SLIP_SUSPECTED;
  }
  return MatchRecord::OK;
}

MatchRecord::Source ToProto(const PredictionSource source) {
  switch (source) {
    case PredictionSource::kNothing:
      return MatchRecord::NOTHING;
    case PredictionSource::kConstantVelocity:
      return MatchRecord::CONSTANT_VELOCITY;
    case PredictionSource::kOdometry:
      return MatchRecord::ODOMETRY;
    case PredictionSource::kImu:
      return MatchRecord::INERTIAL;
  }
  return MatchRecord::NOTHING;
}

MatchRecord::Gyroscope ToProto(const GyroscopeState state) {
  switch (state) {
    case GyroscopeState::kUnproven:
      return MatchRecord::UNPROVEN;
    case GyroscopeState::kProven:
      return MatchRecord::PROVEN;
    case GyroscopeState::kRefuted:
      return MatchRecord::REFUTED;
  }
  return MatchRecord::NO_GYROSCOPE;
}

// The ellipse of one standard deviation.
struct Ellipse {
  double long_axis;
  double short_axis;
  double direction;  // of the long axis, [0, pi)
};

Ellipse PositionEllipse(const Eigen::Matrix3d& covariance) {
  const double a = covariance(0, 0), b = covariance(0, 1), c = covariance(1, 1);
  const double mean = 0.5 * (a + c);
  const double radius = std::hypot(0.5 * (a - c), b);
  Ellipse ellipse;
  ellipse.long_axis = std::sqrt(std::max(0., mean + radius));
  ellipse.short_axis = std::sqrt(std::max(0., mean - radius));
  ellipse.direction = 0.5 * std::atan2(2. * b, a - c);
  if (ellipse.direction < 0.) ellipse.direction += kPi;
  return ellipse;
}

}  // namespace

void SetPose(const Pose2& pose, MatchRecord* const record) {
  record->set_x(pose.x);
  record->set_y(pose.y);
  record->set_theta(pose.theta);
}

void SetReport(const scan_matching::MatchReport& report,
               MatchRecord* const record) {
  record->clear_covariance();
  for (int i = 0; i < 3; ++i) {
    for (int j = i; j < 3; ++j) {
      record->add_covariance(report.covariance(i, j));
    }
  }
  record->set_degeneracy(ToProto(report.degeneracy.state));
  record->set_weak_direction(report.degeneracy.direction);
  record->set_information_ratio(report.degeneracy.ratio);
  record->set_disagreement_x(report.disagreement.x());
  record->set_disagreement_y(report.disagreement.y());
  record->set_disagreement_theta(report.disagreement.z());
  record->set_chi_square(report.mahalanobis);
}

void SetPrediction(const PredictionSource source, const OdometryState state,
                   MatchRecord* const record) {
  record->set_source(ToProto(source));
  record->set_odometry(ToProto(state));
}

void SetCalibration(const OdometryCalibration& calibration,
                    MatchRecord* const record) {
  record->set_odometry_scale(calibration.translation_scale());
  record->set_odometry_scale_sigma(calibration.translation_scale_sigma());
  record->set_rotation_scale(calibration.rotation_scale());
  record->set_rotation_scale_sigma(calibration.rotation_scale_sigma());
  record->set_rotation_per_metre(calibration.rotation_per_metre());
  record->set_rotation_per_metre_sigma(calibration.rotation_per_metre_sigma());
}

void SetGyroscope(const Gyroscope& gyroscope, MatchRecord* const record) {
  if (!gyroscope.has_readings()) return;
  record->set_gyroscope(ToProto(gyroscope.state()));
  record->set_gyroscope_factor(gyroscope.factor());
  record->set_gyroscope_factor_sigma(gyroscope.factor_sigma());
}

Eigen::Matrix3d Covariance(const MatchRecord& record) {
  Eigen::Matrix3d covariance = Eigen::Matrix3d::Zero();
  if (record.covariance_size() != 6) return covariance;
  int k = 0;
  for (int i = 0; i < 3; ++i) {
    for (int j = i; j < 3; ++j) {
      covariance(i, j) = covariance(j, i) = record.covariance(k++);
    }
  }
  return covariance;
}

void AppendRecord(const MatchRecord& record, std::string* const bytes) {
  AppendDelimited(record, bytes);
}

absl::StatusOr<std::vector<MatchRecord>> ParseRecords(
    const absl::string_view bytes) {
  return ParseDelimited<MatchRecord>(bytes, "match record");
}

absl::string_view RecordCsvHead() { return kHead; }

std::string RecordCsvRows(const std::vector<MatchRecord>& records) {
  std::string rows;
  for (const MatchRecord& record : records) {
    const Eigen::Matrix3d covariance = Covariance(record);
    const Ellipse ellipse = PositionEllipse(covariance);
    absl::StrAppendFormat(
        &rows, "%d,%s,%d,%.6f,%.6f,%.5f,%.5g,%.5g,%.2f,%.5g,%s,%.2f,",
        record.builder(), UnixSecondsOfTicks(record.time()),
        record.is_node() ? 1 : 0, record.x(), record.y(),
        RadToDeg(record.theta()), ellipse.long_axis, ellipse.short_axis,
        RadToDeg(ellipse.direction),
        RadToDeg(std::sqrt(std::max(0., covariance(2, 2)))),
        absl::AsciiStrToLower(
            MatchRecord::Degeneracy_Name(record.degeneracy())),
        RadToDeg(record.weak_direction()));
    absl::StrAppendFormat(
        &rows, "%.4g,%.5f,%.5f,%.4f,%.4g,%s,%s,%d,%.4f,%.4f,%.4f,",
        record.information_ratio(), record.disagreement_x(),
        record.disagreement_y(), RadToDeg(record.disagreement_theta()),
        record.chi_square(),
        absl::AsciiStrToLower(
            MatchRecord::OdometryState_Name(record.odometry())),
        absl::AsciiStrToLower(MatchRecord::Source_Name(record.source())),
        record.searched() ? 1 : 0, record.score(), record.time_offset(),
        record.interval());
    absl::StrAppendFormat(
        &rows, "%.6f,%.6f,%.6f,%.6f,%.5f,%.5f,", record.odometry_scale(),
        record.odometry_scale_sigma(), record.rotation_scale(),
        record.rotation_scale_sigma(), RadToDeg(record.rotation_per_metre()),
        RadToDeg(record.rotation_per_metre_sigma()));
    absl::StrAppendFormat(
        &rows, "%s,%.6f,%.6f\n",
        absl::AsciiStrToLower(MatchRecord::Gyroscope_Name(record.gyroscope())),
        record.gyroscope_factor(), record.gyroscope_factor_sigma());
  }
  return rows;
}

std::string RecordCsv(const std::vector<MatchRecord>& records) {
  return absl::StrCat(RecordCsvHead(), RecordCsvRows(records));
}

}  // namespace front_end
}  // namespace cartographer_ext
