// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
#include "cartographer_ext/io/carmen/carmen_line.h"

#include <array>
#include <cmath>

#include "absl/strings/match.h"
#include "cartographer_ext/io/tokens.h"

namespace cartographer_ext {
namespace io {
namespace {

// Farther than any robot drives; keeps sums of squares far from overflow.
constexpr double kMaxCoordinate = 1e7;

void Fail(const char* error, CarmenLine* line) {
  line->kind = CarmenKind::kMalformed;
  line->error = error;
}

bool MakePose(double x, double y, double theta, Pose2* pose) {
  if (!(std::abs(x) <= kMaxCoordinate) || !(std::abs(y) <= kMaxCoordinate) ||
      !(std::abs(theta) <= kMaxCoordinate)) {
    return false;
  }
  *pose = Pose2(x, y, NormalizeAngle(theta));
  return true;
}

bool ParsePose(Tokens* tokens, Pose2* pose) {
  double x, y, theta;
  return ParseFinite(tokens->Next(), &x) && ParseFinite(tokens->Next(), &y) &&
         ParseFinite(tokens->Next(), &theta) && MakePose(x, y, theta, pose);
}

// The numbers up to the host name or the end of the line, and the count of all
// words. At most 15 are kept: no layout has more after its readings.
struct Tail {
  std::array<absl::string_view, 15> words;
  size_t num_words = 0;
  size_t num_numbers = 0;  // words before the first that is no number
};

Tail ParseTail(Tokens* tokens) {
  Tail tail;
  bool numbers = true;
  while (tokens->More() && tail.num_words < tail.words.size()) {
    const absl::string_view word = tokens->Next();
    double unused;
    numbers = numbers && ParseDouble(word, &unused);
    if (numbers) ++tail.num_numbers;
    tail.words[tail.num_words++] = word;
  }
  return tail;
}

// True if the words are `num_values` values and "stamp [host [logger_stamp]]".
// The host may look like a number.
bool StampFollows(const Tail& tail, size_t num_values) {
  if (tail.num_words < num_values + 1 || tail.num_words > num_values + 3 ||
      tail.num_numbers <= num_values) {
    return false;
  }
  double unused;
  return tail.num_words < num_values + 3 ||
         ParseDouble(tail.words[num_values + 2], &unused);
}

bool ParseCount(absl::string_view word, int64_t* count) {
  return ParseInt(word, count) && *count >= 0;
}

bool ParseRanges(Tokens* tokens, CarmenLine* line) {
  int64_t n;
  if (!ParseCount(tokens->Next(), &n)) {
    Fail("no number of readings", line);
    return false;
  }
  if (n == 0 || n > CarmenLine::kMaxReadings) {
    Fail("number of readings out of range", line);
    return false;
  }
  line->ranges.resize(n);
  for (float& range : line->ranges) {
    double value;
    if (!ParseDouble(tokens->Next(), &value)) {
      Fail("fewer readings than declared, or a reading that is not a number",
           line);
      return false;
    }
    range = static_cast<float>(value);
  }
  return true;
}

void ParseFrontLaser(Tokens* tokens, CarmenLine* line) {
  if (!ParseRanges(tokens, line)) return;
  FrontLaserAngles(line->ranges.size(), &line->angle_min,
                   &line->angle_increment);
  const Tail tail = ParseTail(tokens);
  // Two poses, or only one in the oldest logs.
  size_t num_values = 6;
  if (!StampFollows(tail, num_values)) num_values = 3;
  if (!StampFollows(tail, num_values)) {
    return Fail("poses and stamp do not follow the readings", line);
  }
  std::array<double, 6> values;
  for (size_t i = 0; i < num_values; ++i) {
    if (!ParseFinite(tail.words[i], &values[i])) {
      return Fail("a pose that is not finite", line);
    }
  }
  const size_t robot = num_values - 3;
  if (!MakePose(values[0], values[1], values[2], &line->laser_pose) ||
      !MakePose(values[robot], values[robot + 1], values[robot + 2],
                &line->robot_pose)) {
    return Fail("a pose out of range", line);
  }
  if (!ParseTime(tail.words[num_values], &line->time)) {
    return Fail("an invalid stamp", line);
  }
  line->num_stamp_words = tail.num_words - num_values;
  line->kind = CarmenKind::kFrontLaser;
}

// ROBOTLASER1 and RAWLASER1.
void ParseNewLaser(bool has_poses, Tokens* tokens, CarmenLine* line) {
  std::array<double, 7> header;
  for (double& value : header) {
    if (!ParseFinite(tokens->Next(), &value)) {
      return Fail("a malformed laser configuration", line);
    }
  }
  line->angle_min = header[1];
  const double field_of_view = header[2];
  line->angle_increment = header[3];
  line->maximum_range = header[4] > 0. ? header[4] : 0.;
  if (!ParseRanges(tokens, line)) return;
  const int n = line->ranges.size();
  if (line->angle_increment == 0. && n > 1) {
    line->angle_increment = field_of_view / (n - 1);
  }
  // A full turn, with one or two more beams if the ends overlap.
  if (std::abs(line->angle_min) > 4. * kPi ||
      std::abs(line->angle_increment) * n > 2.1 * kPi ||
      (line->angle_increment == 0. && n > 1)) {
    return Fail("beam angles out of range", line);
  }

  // Poses (6) and velocities and safety distances (5) follow the remissions;
  // logs from before remissions lack their number.
  const size_t num_values = has_poses ? 11 : 0;
  Tokens after_ranges = *tokens;
  int64_t num_remissions;
  Tail tail;
  if (ParseCount(tokens->Next(), &num_remissions) &&
      num_remissions <= CarmenLine::kMaxReadings) {
    for (int64_t i = 0; i < num_remissions; ++i) tokens->Next();
    tail = ParseTail(tokens);
  }
  if (!StampFollows(tail, num_values)) tail = ParseTail(&after_ranges);
  if (!StampFollows(tail, num_values)) {
    return Fail("poses and stamp do not follow the readings", line);
  }
  if (has_poses) {
    std::array<double, 6> values;
    for (size_t i = 0; i < values.size(); ++i) {
      if (!ParseFinite(tail.words[i], &values[i])) {
        return Fail("a pose that is not finite", line);
      }
    }
    if (!MakePose(values[0], values[1], values[2], &line->laser_pose) ||
        !MakePose(values[3], values[4], values[5], &line->robot_pose)) {
      return Fail("a pose out of range", line);
    }
  }
  if (!ParseTime(tail.words[num_values], &line->time)) {
    return Fail("an invalid stamp", line);
  }
  line->num_stamp_words = tail.num_words - num_values;
  line->kind = has_poses ? CarmenKind::kRobotLaser : CarmenKind::kRawLaser;
}

void ParseOdometry(Tokens* tokens, CarmenLine* line) {
  if (!ParsePose(tokens, &line->robot_pose)) {
    return Fail("a malformed odometry pose", line);
  }
  const Tail tail = ParseTail(tokens);
  // tv, rv and accel, or none of them.
  for (const size_t num_values : {3, 0}) {
    if (!StampFollows(tail, num_values)) continue;
    if (!ParseTime(tail.words[num_values], &line->time)) {
      return Fail("an invalid stamp", line);
    }
    line->num_stamp_words = tail.num_words - num_values;
    line->kind = CarmenKind::kOdometry;
    return;
  }
  Fail("no stamp after the odometry pose", line);
}

}  // namespace

void FrontLaserAngles(int n, double* angle_min, double* angle_increment) {
  const bool hundred_degrees = n == 101 || n == 201 || n == 401;
  const double field_of_view = DegToRad(hundred_degrees ? 100. : 180.);
  *angle_min = -0.5 * field_of_view;
  // Lasers that report both ends have an odd number of beams.
  const int num_steps = n % 2 == 1 && n > 1 ? n - 1 : n;
  *angle_increment = field_of_view / num_steps;
}

void ParseCarmenLine(absl::string_view text, CarmenLine* line) {
  line->kind = CarmenKind::kIgnored;
  line->error = "";
  line->maximum_range = 0.;
  Tokens tokens(text);
  const absl::string_view message = tokens.Next();
  if (message.empty() || message[0] == '#') return;
  if (message == "FLASER") {
    ParseFrontLaser(&tokens, line);
  } else if (message == "ODOM") {
    ParseOdometry(&tokens, line);
  } else if (message == "ROBOTLASER1") {
    ParseNewLaser(/*has_poses=*/true, &tokens, line);
  } else if (message == "RAWLASER1") {
    ParseNewLaser(/*has_poses=*/false, &tokens, line);
  } else if (message == "PARAM") {
    line->name = std::string(tokens.Next());
    line->value = std::string(tokens.Next());
    line->kind = CarmenKind::kParameter;
  } else if (message == "RLASER" || absl::StartsWith(message, "ROBOTLASER") ||
             absl::StartsWith(message, "RAWLASER") || message == "LASER3" ||
             message == "LASER4") {
    line->kind = CarmenKind::kRearLaser;
  } else if (message == "NEFF") {
    line->kind = CarmenKind::kFilterMark;
  }
}

}  // namespace io
}  // namespace cartographer_ext
