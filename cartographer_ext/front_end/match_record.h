// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
//
// Records of matched scans: filled in from the parts of local SLAM, serialized
// (length-delimited messages: a varint length, then the message) and as CSV (a
// heading, one line per scan).
#ifndef CARTOGRAPHER_EXT_FRONT_END_MATCH_RECORD_H_
#define CARTOGRAPHER_EXT_FRONT_END_MATCH_RECORD_H_

#include <string>
#include <vector>

#include "Eigen/Core"
#include "absl/status/statusor.h"
#include "absl/strings/string_view.h"
#include "cartographer_ext/common/pose2.h"
#include "cartographer_ext/front_end/imu/gyroscope.h"
#include "cartographer_ext/front_end/motion_predictor.h"
#include "cartographer_ext/front_end/odometry/odometry_calibration.h"
#include "cartographer_ext/match_record.pb.h"
#include "cartographer_ext/scan_matching/match_report.h"

namespace cartographer_ext {
namespace front_end {

// Sets the pose (local <- tracking) after matching.
void SetPose(const Pose2& pose, proto::MatchRecord* record);
// Sets covariance, degeneracy and disagreement of a match.
void SetReport(const scan_matching::MatchReport& report,
               proto::MatchRecord* record);
// Sets the source of the prediction and the state of odometry.
void SetPrediction(PredictionSource source, OdometryState state,
                   proto::MatchRecord* record);

// Sets the calibration of the odometry.
void SetCalibration(const OdometryCalibration& calibration,
                    proto::MatchRecord* record);

// Sets the state of the gyroscope, if there is one.
void SetGyroscope(const Gyroscope& gyroscope, proto::MatchRecord* record);

// Of (x, y, theta); zero if the record has none.
Eigen::Matrix3d Covariance(const proto::MatchRecord& record);

// Appends one record.
void AppendRecord(const proto::MatchRecord& record, std::string* bytes);

// All records; DataLoss with the byte offset of a record that is truncated or
// cannot be decoded.
absl::StatusOr<std::vector<proto::MatchRecord>> ParseRecords(
    absl::string_view bytes);

// Times in seconds since the Unix epoch, angles in degrees: the first line of
// the table, the others, and both.
absl::string_view RecordCsvHead();
std::string RecordCsvRows(const std::vector<proto::MatchRecord>& records);
std::string RecordCsv(const std::vector<proto::MatchRecord>& records);

}  // namespace front_end
}  // namespace cartographer_ext

#endif  // CARTOGRAPHER_EXT_FRONT_END_MATCH_RECORD_H_
