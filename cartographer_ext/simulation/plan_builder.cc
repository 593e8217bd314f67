// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
#include "cartographer_ext/simulation/plan_builder.h"

#include <algorithm>
#include <cmath>

#include "absl/strings/str_cat.h"
#include "cartographer_ext/common/pose2.h"

namespace cartographer_ext {
namespace simulation {
namespace {

constexpr size_t kMaxShapes = 300000;

double Reflectivity(Statement* statement) {
  return statement->Option("reflectivity", 1., 1e-3, 1.);
}

}  // namespace

bool PlanBuilder::Spend(const size_t shapes, Statement* statement) {
  spent_ += shapes;
  if (spent_ <= kMaxShapes) return true;
  statement->Fail(
      absl::StrCat("the plan has more than ", kMaxShapes, " shapes"));
  return false;
}

void PlanBuilder::AddSegment(const Eigen::Vector2d& a, const Eigen::Vector2d& b,
                             const double reflectivity, Statement* statement) {
  if (!Spend(1, statement)) return;
  const double degrees = statement->Option("echo_angle", 90., 0., 90.);
  current_->segments.push_back(
      {a, b, reflectivity, degrees < 90. ? DegToRad(degrees) : kAnyAngle});
}

void PlanBuilder::AddDisc(const Disc& disc, Statement* statement) {
  if (!Spend(1, statement)) return;
  current_->discs.push_back(disc);
}

void PlanBuilder::ReadLines(Statement* statement, const bool closed) {
  const double reflectivity = Reflectivity(statement);
  const std::vector<Eigen::Vector2d> points = statement->Points(closed ? 3 : 2);
  for (size_t i = 0; i + 1 < points.size(); ++i) {
    AddSegment(points[i], points[i + 1], reflectivity, statement);
  }
  if (closed && points.size() >= 3) {
    AddSegment(points.back(), points.front(), reflectivity, statement);
  }
}

void PlanBuilder::ReadRectangle(Statement* statement) {
  const double reflectivity = Reflectivity(statement);
  const Eigen::Vector2d a = statement->Point("first corner");
  const Eigen::Vector2d c = statement->Point("second corner");
  const Eigen::Vector2d b(c.x(), a.y()), d(a.x(), c.y());
  AddSegment(a, b, reflectivity, statement);
  AddSegment(b, c, reflectivity, statement);
  AddSegment(c, d, reflectivity, statement);
  AddSegment(d, a, reflectivity, statement);
}

void PlanBuilder::ReadCircle(Statement* statement) {
  Disc disc;
  disc.reflectivity = Reflectivity(statement);
  disc.center = statement->Point("centre");
  disc.radius = statement->Number("radius", 1e-3, kMaxCoordinate);
  AddDisc(disc, statement);
}

// A straight wall whose recesses (position along the wall, width, depth to the
// left; negative depth is a pilaster's or the other side) interrupt the line.
void PlanBuilder::ReadWall(Statement* statement) {
  const double reflectivity = Reflectivity(statement);
  const Eigen::Vector2d from = statement->Point("start");
  const Eigen::Vector2d to = statement->Point("end");
  std::vector<std::vector<double>> recesses =
      statement->ListOptions("recess", 3, kMaxCoordinate);
  std::sort(recesses.begin(), recesses.end());
  const double length = (to - from).norm();
  if (length == 0.) {
    statement->Fail("the wall has no length");
    return;
  }
  const Eigen::Vector2d along = (to - from) / length;
  const Eigen::Vector2d left(-along.y(), along.x());
  double position = 0.;
  Eigen::Vector2d last = from;
  for (const std::vector<double>& recess : recesses) {
    const double begin = recess[0], width = recess[1], depth = recess[2];
    if (begin < position || width <= 0. || begin + width > length) {
      statement->Fail(absl::StrCat("recess at ", begin, " of width ", width,
                                   " overlaps another or leaves the wall of ",
                                   length, " m"));
      return;
    }
    const Eigen::Vector2d corner = from + begin * along;
    if (begin > position) AddSegment(last, corner, reflectivity, statement);
    const Eigen::Vector2d inner = corner + depth * left;
    const Eigen::Vector2d inner_end = inner + width * along;
    last = corner + width * along;
    AddSegment(corner, inner, reflectivity, statement);
    AddSegment(inner, inner_end, reflectivity, statement);
    AddSegment(inner_end, last, reflectivity, statement);
    position = begin + width;
  }
  if (position < length) AddSegment(last, to, reflectivity, statement);
}

void PlanBuilder::OpenBlock(Statement* statement) {
  const std::string name = statement->Word("block name");
  if (!open_block_where_.empty()) {
    statement->Fail(absl::StrCat("block '", open_block_, "' opened at ",
                                 open_block_where_, " has no end yet"));
    return;
  }
  if (blocks_.count(name) != 0) {
    statement->Fail(absl::StrCat("block '", name, "' exists already"));
    return;
  }
  open_block_ = name;
  open_block_where_ = statement->where();
  current_ = &blocks_[name];
}

void PlanBuilder::CloseBlock(Statement* statement) {
  if (open_block_where_.empty()) {
    statement->Fail("there is no open block");
    return;
  }
  open_block_where_.clear();
  current_ = &plan_;
}

void PlanBuilder::ReadPlace(Statement* statement) {
  const std::string name = statement->Word("block name");
  const Eigen::Vector2d position = statement->Point("position");
  const double heading =
      statement->has_values()
          ? DegToRad(statement->Number("heading", -360., 360.))
          : 0.;
  const bool mirror = statement->Option("mirror", 0., 0., 1.) != 0.;
  const auto block = blocks_.find(name);
  if (block == blocks_.end() || &block->second == current_) {
    statement->Fail(absl::StrCat("there is no finished block '", name, "'"));
    return;
  }
  const Shapes& shapes = block->second;
  if (!Spend(shapes.segments.size() + shapes.discs.size(), statement)) return;
  const Pose2 pose(position.x(), position.y(), heading);
  const auto moved = [&pose, mirror](const Eigen::Vector2d& point) {
    return pose * Eigen::Vector2d(point.x(), mirror ? -point.y() : point.y());
  };
  for (const Segment& segment : shapes.segments) {
    current_->segments.push_back({moved(segment.a), moved(segment.b),
                                  segment.reflectivity, segment.echo_angle});
  }
  for (const Disc& disc : shapes.discs) {
    current_->discs.push_back(
        {moved(disc.center), disc.radius, disc.reflectivity});
  }
}

absl::Status PlanBuilder::Take(Statement* statement, bool* taken) {
  const std::string& keyword = statement->keyword();
  *taken = true;
  if (keyword == "polygon") {
    ReadLines(statement, true);
  } else if (keyword == "polyline") {
    ReadLines(statement, false);
  } else if (keyword == "rectangle") {
    ReadRectangle(statement);
  } else if (keyword == "circle" || keyword == "pillar") {
    ReadCircle(statement);
  } else if (keyword == "wall") {
    ReadWall(statement);
  } else if (keyword == "block") {
    OpenBlock(statement);
  } else if (keyword == "end") {
    CloseBlock(statement);
  } else if (keyword == "place") {
    ReadPlace(statement);
  } else {
    *taken = false;
    return absl::OkStatus();
  }
  return statement->Finish();
}

absl::Status PlanBuilder::Finish() const {
  if (open_block_where_.empty()) return absl::OkStatus();
  return absl::InvalidArgumentError(absl::StrCat(open_block_where_, ": block '",
                                                 open_block_, "' has no end"));
}

}  // namespace simulation
}  // namespace cartographer_ext
