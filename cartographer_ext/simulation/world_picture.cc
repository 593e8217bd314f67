// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
#include "cartographer_ext/simulation/world_picture.h"

#include <algorithm>
#include <set>
#include <vector>

#include "absl/strings/str_cat.h"
#include "absl/strings/str_format.h"
#include "cartographer_ext/io/picture.h"

namespace cartographer_ext {
namespace simulation {
namespace {

namespace palette = io::palette;

constexpr double kPathStep = 0.2;  // seconds between points of the path

std::vector<Eigen::Vector2d> DrivenPath(const Drive& drive) {
  std::vector<Eigen::Vector2d> path;
  for (double time = 0.; time < drive.duration(); time += kPathStep) {
    path.push_back(drive.PoseAt(time).translation());
  }
  path.push_back(drive.PoseAt(drive.duration()).translation());
  return path;
}

void DrawPlan(const Simulation& simulation, io::Picture* picture) {
  const auto style = [](const double reflectivity) {
    const double gray = 0.6 * (1. - reflectivity);
    io::LineStyle line;
    line.color = {gray, gray, gray};
    return line;
  };
  for (const Segment& segment : simulation.plan().segments()) {
    picture->DrawLine(segment.a, segment.b, style(segment.reflectivity));
  }
  for (const Disc& disc : simulation.plan().discs()) {
    picture->DrawCircle(disc.center, disc.radius, style(disc.reflectivity));
  }
  picture->AddLegend("walls", palette::kBlack);
}

void DrawDrive(const Simulation& simulation, io::Picture* picture) {
  const std::vector<Eigen::Vector2d> path = DrivenPath(simulation.drive());
  io::LineStyle style;
  style.color = palette::kBlue;
  style.width = 1.2;
  picture->DrawPolyline(path, style);
  picture->DrawDot(path.front(), 5., palette::kGreen);
  picture->DrawDot(path.back(), 5., palette::kVermilion);
  picture->AddLegend(
      absl::StrFormat("drive, %.0f m in %.0f s, green start to red end",
                      simulation.drive().length(),
                      simulation.drive().duration()),
      palette::kBlue);
}

void DrawObstacles(const Simulation& simulation, io::Picture* picture) {
  if (simulation.world().obstacles.empty()) return;
  io::LineStyle loop;
  loop.color = palette::kOrange;
  loop.width = 0.8;
  for (const MovingObstacle& obstacle : simulation.world().obstacles) {
    std::vector<Eigen::Vector2d> path = obstacle.path;
    path.push_back(path.front());
    picture->DrawPolyline(path, loop);
  }
  io::LineStyle body = loop;
  body.width = 2.5;
  for (const Disc& disc : simulation.obstacles().At(0.)) {
    picture->DrawCircle(disc.center, disc.radius, body);
  }
  picture->AddLegend(
      absl::StrCat(simulation.obstacles().size(), " moving obstacles"),
      palette::kOrange);
}

void DrawFaults(const Simulation& simulation, io::Picture* picture) {
  std::set<std::string> kinds;
  for (const FaultLabel& label : simulation.odometry().labels) {
    if (label.kind == OdometryFault::Kind::kOffset) continue;
    const double start = label.start - simulation.world().begin;
    picture->DrawDot(simulation.drive().PoseAt(start).translation(), 4.,
                     palette::kPurple);
    kinds.insert(FaultName(label.kind));
  }
  std::string names;
  for (const std::string& kind : kinds) absl::StrAppend(&names, " ", kind);
  if (!names.empty()) {
    picture->AddLegend("odometry faults:" + names, palette::kPurple);
  }
}

void DrawMarks(const Simulation& simulation, io::Picture* picture) {
  constexpr double kTextSize = 13.;
  io::LineStyle place_style;
  place_style.color = palette::kGreen;
  for (const RevisitPlace& place : simulation.world().places) {
    picture->DrawCircle(place.position, place.radius, place_style);
    picture->DrawText(place.position + Eigen::Vector2d(0.6, 0.6) * place.radius,
                      place.name, kTextSize, palette::kGreen);
  }
  io::LineStyle distance_style;
  distance_style.color = palette::kVermilion;
  distance_style.dashed = true;
  for (const KeyDistance& distance : simulation.world().key_distances) {
    picture->DrawLine(distance.a, distance.b, distance_style);
    picture->DrawDot(distance.a, 3., palette::kVermilion);
    picture->DrawDot(distance.b, 3., palette::kVermilion);
    picture->DrawText(0.5 * (distance.a + distance.b),
                      absl::StrFormat("%s %.2f m", distance.name,
                                      (distance.b - distance.a).norm()),
                      kTextSize, palette::kVermilion);
  }
}

}  // namespace

absl::Status WriteWorldPicture(const Simulation& simulation, const int pixels,
                               const std::string& filename) {
  if (pixels < 100 || pixels > 8000) {
    return absl::InvalidArgumentError(
        absl::StrCat("a picture of ", pixels, " pixels: outside [100, 8000]"));
  }
  io::PictureBounds bounds;
  bounds.Add(simulation.plan().min());
  bounds.Add(simulation.plan().max());
  for (const Eigen::Vector2d& point : DrivenPath(simulation.drive())) {
    bounds.Add(point);
  }
  // Room for the title and the legend above the plan.
  const double extent =
      std::max(bounds.max_x - bounds.min_x, bounds.max_y - bounds.min_y);
  bounds.Add(Eigen::Vector2d(bounds.min_x, bounds.max_y + 0.1 * extent));
  io::Picture picture(bounds, pixels);
  DrawPlan(simulation, &picture);
  DrawObstacles(simulation, &picture);
  DrawDrive(simulation, &picture);
  DrawMarks(simulation, &picture);
  DrawFaults(simulation, &picture);
  picture.SetTitle(absl::StrCat(simulation.world().name, ", seed ",
                                simulation.options().seed));
  return picture.Write(filename);
}

}  // namespace simulation
}  // namespace cartographer_ext
