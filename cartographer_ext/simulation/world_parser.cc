// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
#include "cartographer_ext/simulation/world_parser.h"

#include <algorithm>
#include <cerrno>
#include <cmath>
#include <cstdint>
#include <fstream>
#include <limits>
#include <set>
#include <utility>

#include "absl/strings/ascii.h"
#include "absl/strings/str_cat.h"
#include "absl/strings/str_split.h"
#include "cartographer_ext/common/bounded_read.h"
#include "cartographer_ext/common/byte_order_mark.h"
#include "cartographer_ext/common/similar_word.h"
#include "cartographer_ext/simulation/plan_builder.h"
#include "cartographer_ext/simulation/statement.h"

namespace cartographer_ext {
namespace simulation {
namespace {

constexpr size_t kMaxFileSize = 16 << 20;
constexpr size_t kMaxDriveCommands = 20000;
constexpr size_t kMaxObstacles = 1000;
constexpr size_t kMaxMarks = 10000;
constexpr double kMaxSeconds = 4. * 3600.;

void ReadLaser(Statement* s, LaserSettings* laser) {
  laser->beams = static_cast<int>(s->Option("beams", laser->beams, 1., 7200.));
  const double fov = s->Option("fov", 360., 1e-3, 360.);
  // A field of view of 360 degrees does not repeat its first beam; any other
  // one has beams at both ends.
  const int intervals =
      fov == 360. ? laser->beams : std::max(1, laser->beams - 1);
  const double increment = s->Option("increment", fov / intervals, 1e-4, 360.);
  const double first = s->Option("first", -0.5 * fov, -360., 360.);
  laser->angle_min = DegToRad(first);
  laser->angle_increment = DegToRad(increment);
  laser->min_range = s->Option("min_range", laser->min_range, 0., 100.);
  laser->max_range = s->Option("max_range", laser->max_range, 0.1, 1000.);
  laser->noise = s->Option("noise", laser->noise, 0., 10.);
  laser->proportional_noise = s->Option("proportional_noise", 0., 0., 1.);
  laser->dropout = s->Option("dropout", 0., 0., 1.);
  laser->outlier = s->Option("outlier", 0., 0., 1.);
  laser->rate = s->Option("rate", laser->rate, 0.01, 200.);
  laser->resolution = s->Option("resolution", 0., 0., 1.);
  laser->sweep = s->Option("sweep", 0., 0., 10.);
  laser->no_return =
      s->Option("no_return", std::max(81.91, laser->max_range + 1.), 0., 1e6);
  laser->mounting.x = s->Option("x", 0., -10., 10.);
  laser->mounting.y = s->Option("y", 0., -10., 10.);
  laser->mounting.theta = DegToRad(s->Option("theta", 0., -360., 360.));
  if (laser->no_return > 0. && laser->no_return <= laser->max_range) {
    s->Fail("option no_return must be 0 or above max_range");
  }
  if (laser->min_range >= laser->max_range) {
    s->Fail("option min_range must be below max_range");
  }
  if (laser->sweep * laser->rate > 1. + 1e-9) {
    s->Fail("option sweep is longer than the time between scans");
  }
}

void ReadOdometry(Statement* s, OdometrySettings* odometry) {
  if (s->has_values()) {
    if (s->Word("'none'") != "none") s->Fail("expected options, or none");
    odometry->present = false;
  }
  odometry->rate = s->Option("rate", odometry->rate, 0.01, 1000.);
  odometry->encoder_rate =
      s->Option("encoder_rate", std::max(100., odometry->rate), 0.01, 1000.);
  odometry->phase = s->Option("phase", 0., 0., 100.);
  odometry->wheel_base =
      s->Option("wheel_base", odometry->wheel_base, 0.01, 10.);
  odometry->ticks_per_meter = s->Option("ticks_per_metre", 0., 0., 1e7);
  odometry->scale_left = s->Option("scale_left", 0., -0.5, 0.5);
  odometry->scale_right = s->Option("scale_right", 0., -0.5, 0.5);
  odometry->scale_sigma = s->Option("scale_sigma", 0., 0., 0.2);
  odometry->mismatch_sigma = s->Option("mismatch_sigma", 0., 0., 0.2);
  odometry->wheel_base_error = s->Option("wheel_base_error", 0., -0.5, 0.5);
  odometry->wheel_base_sigma = s->Option("wheel_base_sigma", 0., 0., 0.2);
  odometry->noise = s->Option("noise", 0., 0., 1.);
  odometry->lateral_noise = s->Option("lateral_noise", 0., 0., 1.);
}

void ReadImu(Statement* s, ImuSettings* imu) {
  imu->present = true;
  imu->rate = s->Option("rate", imu->rate, 0.01, 1000.);
  imu->gyro_noise = s->Option("gyro_noise", 0., 0., 10.);
  imu->gyro_bias_sigma = s->Option("gyro_bias_sigma", 0., 0., 10.);
  imu->gyro_bias_walk = s->Option("gyro_bias_walk", 0., 0., 10.);
  imu->accel_noise = s->Option("accel_noise", 0., 0., 100.);
  imu->accel_bias_sigma = s->Option("accel_bias_sigma", 0., 0., 100.);
  imu->accel_bias_walk = s->Option("accel_bias_walk", 0., 0., 100.);
  imu->gravity = s->Option("gravity", imu->gravity, 0., 100.);
}

void ReadRobot(Statement* s, RobotSettings* robot) {
  robot->radius = s->Option("radius", robot->radius, 0., 10.);
  robot->speed = s->Option("speed", robot->speed, 0.01, 10.);
  robot->acceleration =
      s->Option("acceleration", robot->acceleration, .01, 20.);
  robot->turn_rate = s->Option("turn_rate", robot->turn_rate, 0.05, 20.);
  robot->turn_acceleration =
      s->Option("turn_acceleration", robot->turn_acceleration, 0.05, 100.);
  robot->lookahead = s->Option("lookahead", robot->lookahead, 0.1, 5.);
  robot->jitter = s->Option("jitter", 0., 0., 5.);
  robot->turn_radius = s->Option("turn_radius", 0., 0., 100.);
}

void ReadObstacle(Statement* s, World* world) {
  MovingObstacle obstacle;
  obstacle.radius = s->Option("radius", obstacle.radius, 0.01, 10.);
  obstacle.speed = s->Option("speed", obstacle.speed, 0., 20.);
  obstacle.random_phase = s->WordOption("phase", "0") == "random";
  if (!obstacle.random_phase) obstacle.phase = s->Option("phase", 0., 0., 1.);
  if (s->Word("'path'") != "path") s->Fail("expected: path x y x y ...");
  obstacle.path = s->Points(2);
  world->obstacles.push_back(std::move(obstacle));
  if (world->obstacles.size() > kMaxObstacles) s->Fail("too many obstacles");
}

void ReadDrive(Statement* s, const DriveCommand::Kind kind, World* world) {
  DriveCommand command;
  command.kind = kind;
  command.where = s->where();
  switch (kind) {
    case DriveCommand::Kind::kGoto:
    case DriveCommand::Kind::kReverse:
      command.target = s->Point("target");
      command.speed = s->Option("speed", 0., 0., 10.);
      break;
    case DriveCommand::Kind::kTurn:
      command.heading = DegToRad(s->Number("heading", -360., 360.));
      break;
    case DriveCommand::Kind::kWait:
      command.seconds = s->Number("seconds", 0., kMaxSeconds);
      break;
  }
  world->drive.push_back(command);
  if (world->drive.size() > kMaxDriveCommands) s->Fail("too many waypoints");
}

void ReadFault(Statement* s, World* world) {
  using Kind = OdometryFault::Kind;
  OdometryFault fault;
  const std::string kind = s->Word("kind of fault");
  fault.start = s->Option("start", 0., 0., kMaxSeconds);
  if (kind == "stall") {
    world->stalls.push_back(
        {fault.start, s->Option("duration", 0.6, 0., kMaxSeconds)});
    if (world->stalls.size() > kMaxMarks) s->Fail("too many stalls");
    return;
  }
  if (kind == "slip") {
    fault.kind = Kind::kSlip;
    fault.in_place = s->Has("radius");
    if (fault.in_place) {
      fault.center.x() = s->Option("x", 0., -kMaxCoordinate, kMaxCoordinate);
      fault.center.y() = s->Option("y", 0., -kMaxCoordinate, kMaxCoordinate);
      fault.radius = s->Option("radius", 0., 0., kMaxCoordinate);
    }
    fault.duration =
        s->Option("duration", fault.in_place ? 0. : 1., 0., kMaxSeconds);
    fault.gain_left = s->Option("left", 0., -1., 100.);
    fault.gain_right = s->Option("right", 0., -1., 100.);
    fault.spin_left = s->Option("spin_left", 0., -10., 10.);
    fault.spin_right = s->Option("spin_right", 0., -10., 10.);
  } else if (kind == "stale") {
    fault.kind = Kind::kStale;
    fault.duration = s->Option("duration", 0.5, 0., kMaxSeconds);
  } else if (kind == "jump") {
    fault.kind = Kind::kJump;
    fault.distance = s->Option("distance", 0.7, -1000., 1000.);
    fault.angle = DegToRad(s->Option("angle", 0., -180., 180.));
  } else if (kind == "reverse") {
    fault.kind = Kind::kReverse;
    fault.duration = s->Option("duration", 0., 0., kMaxSeconds);
  } else if (kind == "offset") {
    fault.kind = Kind::kOffset;
    fault.duration = s->Option("duration", 0., 0., kMaxSeconds);
    fault.seconds = s->Option("seconds", 0.1, -10., 10.);
  } else {
    s->Fail("kinds are slip, stale, jump, reverse, offset, stall");
  }
  world->faults.push_back(fault);
  if (world->faults.size() > kMaxMarks) s->Fail("too many faults");
}

class Parser {
 public:
  absl::Status Take(Statement* statement) {
    bool taken = false;
    const absl::Status status = plan_.Take(statement, &taken);
    if (taken || !status.ok()) return status;
    TakeOther(statement);
    return statement->Finish();
  }

  absl::StatusOr<World> Finish(const std::string& filename) {
    const absl::Status status = plan_.Finish();
    if (!status.ok()) return status;
    if (!started_) {
      return absl::InvalidArgumentError(
          absl::StrCat(filename, ": no start statement"));
    }
    world_.segments = plan_.segments();
    world_.discs = plan_.discs();
    return std::move(world_);
  }

  World* world() { return &world_; }

 private:
  void TakeOther(Statement* s) {
    const std::string& keyword = s->keyword();
    // The settings of a sensor or of the robot are given in one place.
    if (keyword == "world" || keyword == "laser" || keyword == "odometry" ||
        keyword == "imu" || keyword == "robot" || keyword == "start" ||
        keyword == "begin") {
      if (!once_.insert(keyword).second) s->Fail("is given a second time");
    }
    if (keyword == "world") {
      world_.name = s->Word("name");
    } else if (keyword == "begin") {
      world_.begin = s->Number("stamp", 0., 4e9);
    } else if (keyword == "laser") {
      ReadLaser(s, &world_.laser);
    } else if (keyword == "odometry") {
      ReadOdometry(s, &world_.odometry);
    } else if (keyword == "imu") {
      ReadImu(s, &world_.imu);
    } else if (keyword == "robot") {
      ReadRobot(s, &world_.robot);
    } else if (keyword == "obstacle") {
      ReadObstacle(s, &world_);
    } else if (keyword == "start") {
      const Eigen::Vector2d position = s->Point("position");
      const double heading = s->Number("heading", -360., 360.);
      world_.start =
          Pose2(position.x(), position.y(), NormalizeAngle(DegToRad(heading)));
      started_ = true;
    } else if (keyword == "goto") {
      ReadDrive(s, DriveCommand::Kind::kGoto, &world_);
    } else if (keyword == "reverse") {
      ReadDrive(s, DriveCommand::Kind::kReverse, &world_);
    } else if (keyword == "turn") {
      ReadDrive(s, DriveCommand::Kind::kTurn, &world_);
    } else if (keyword == "wait") {
      ReadDrive(s, DriveCommand::Kind::kWait, &world_);
    } else if (keyword == "fault") {
      ReadFault(s, &world_);
    } else if (keyword == "key_distance") {
      KeyDistance distance;
      distance.name = s->Word("name");
      distance.a = s->Point("first end");
      distance.b = s->Point("second end");
      if (distance.a == distance.b) s->Fail("both ends are the same point");
      world_.key_distances.push_back(distance);
      if (world_.key_distances.size() > kMaxMarks) s->Fail("too many marks");
    } else if (keyword == "revisit") {
      RevisitPlace place;
      place.name = s->Word("name");
      place.position = s->Point("position");
      place.radius = s->Option("radius", place.radius, 0.01, 100.);
      world_.places.push_back(place);
      if (world_.places.size() > kMaxMarks) s->Fail("too many marks");
    } else {
      s->Fail(
          absl::StrCat("unknown statement",
                       DidYouMean(SimilarWord(
                           absl::AsciiStrToLower(keyword),
                           {"world",     "describe", "polyline", "polygon",
                            "rectangle", "circle",   "pillar",   "wall",
                            "block",     "end",      "place",    "robot",
                            "start",     "goto",     "reverse",  "turn",
                            "wait",      "laser",    "odometry", "imu",
                            "obstacle",  "begin",    "fault",    "key_distance",
                            "revisit"}))));
    }
  }

  World world_;
  PlanBuilder plan_;
  std::set<std::string> once_;
  bool started_ = false;
};

std::string FileStem(const std::string& filename) {
  const size_t slash = filename.find_last_of('/');
  const std::string base =
      slash == std::string::npos ? filename : filename.substr(slash + 1);
  return base.substr(0, base.find_last_of('.'));
}

}  // namespace

absl::StatusOr<World> ParseWorld(absl::string_view text,
                                 const std::string& filename) {
  if (text.size() > kMaxFileSize) {
    return absl::InvalidArgumentError(absl::StrCat(
        filename, ": a world file of more than ", kMaxFileSize, " bytes"));
  }
  Parser parser;
  parser.world()->name = FileStem(filename);
  int64_t line_number = 0;
  for (const absl::string_view line :
       absl::StrSplit(WithoutByteOrderMark(text), '\n')) {
    ++line_number;
    Statement statement(line, absl::StrCat(filename, ":", line_number));
    if (statement.keyword().empty()) continue;
    if (statement.keyword() == "describe") {
      absl::string_view words = absl::StripAsciiWhitespace(line);
      words.remove_prefix(std::string("describe").size());
      absl::StrAppend(&parser.world()->description,
                      parser.world()->description.empty() ? "" : " ",
                      absl::StripAsciiWhitespace(words));
      continue;
    }
    const absl::Status status = parser.Take(&statement);
    if (!status.ok()) return status;
  }
  return parser.Finish(filename);
}

absl::StatusOr<World> LoadWorld(const std::string& filename) {
  std::ifstream file(filename, std::ios::binary);
  if (!file) {
    return absl::ErrnoToStatus(errno, absl::StrCat("cannot open ", filename));
  }
  std::string text;
  // ParseWorld reports a file that is too large.
  if (!ReadUpTo(kMaxFileSize, &file, &text) || text.empty()) {
    return absl::InvalidArgumentError(
        absl::StrCat(filename, ": is empty or cannot be read"));
  }
  return ParseWorld(text, filename);
}

}  // namespace simulation
}  // namespace cartographer_ext
