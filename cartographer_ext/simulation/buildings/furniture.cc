// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
#include "cartographer_ext/simulation/buildings/furniture.h"

#include <algorithm>

namespace cartographer_ext {
namespace simulation {
namespace {

constexpr int kAttempts = 8;

void Outline(const std::vector<Eigen::Vector2d>& corners, Piece* piece) {
  for (size_t i = 0; i != corners.size(); ++i) {
    Segment segment;
    segment.a = corners[i];
    segment.b = corners[(i + 1) % corners.size()];
    piece->segments.push_back(segment);
  }
}

void Round(const double x, const double y, const double radius, Piece* piece) {
  Disc disc;
  disc.center = {x, y};
  disc.radius = radius;
  piece->discs.push_back(disc);
}

// The size of a piece whose back is turned to that side.
Eigen::Vector2d TurnedSize(const Piece& piece, const Side back) {
  return back == kBelow || back == kAbove
             ? piece.size
             : Eigen::Vector2d(piece.size.y(), piece.size.x());
}

Eigen::Vector2d Turned(const Piece& piece, const Side back,
                       const Eigen::Vector2d& point) {
  const double x = point.x(), y = point.y();
  const double width = piece.size.x(), depth = piece.size.y();
  switch (back) {
    case kBelow:
      return {x, y};
    case kRight:
      return {depth - y, x};
    case kAbove:
      return {width - x, depth - y};
    case kLeft:
      return {y, width - x};
  }
  return point;
}

}  // namespace

Piece Desk() {
  Piece piece;
  piece.size = {1.6, 1.25};
  for (const double x : {0.05, 1.55}) {
    for (const double y : {0.05, 0.75}) Round(x, y, 0.03, &piece);
  }
  Round(0.8, 1.0, 0.22, &piece);
  return piece;
}

Piece Cupboard(const double width, const double depth) {
  Piece piece;
  piece.size = {width, depth};
  Outline({{0., 0.}, {width, 0.}, {width, depth}, {0., depth}}, &piece);
  return piece;
}

Piece Table(const int chairs) {
  Piece piece;
  const int row = std::max(1, chairs / 2);
  const double width = 0.75 * row + 0.3;
  piece.size = {width, 2.};
  Outline({{0.3, 0.9}, {width - 0.3, 0.9}, {width - 0.3, 1.1}, {0.3, 1.1}},
          &piece);
  for (int i = 0; i != row; ++i) {
    const double x = 0.15 + 0.375 + 0.75 * i;
    Round(x, 0.25, 0.2, &piece);
    Round(x, 1.75, 0.2, &piece);
  }
  return piece;
}

Piece Bed() {
  Piece piece;
  piece.size = {2.2, 2.05};
  Outline({{0.3, 0.}, {1.9, 0.}, {1.9, 2.05}, {0.3, 2.05}}, &piece);
  Outline({{0., 0.}, {0.25, 0.}, {0.25, 0.35}, {0., 0.35}}, &piece);
  Outline({{1.95, 0.}, {2.2, 0.}, {2.2, 0.35}, {1.95, 0.35}}, &piece);
  return piece;
}

Piece RoundThing(const double radius) {
  Piece piece;
  piece.size = {2. * radius, 2. * radius};
  Round(radius, radius, radius, &piece);
  return piece;
}

Piece ParkedCar() {
  Piece piece;
  piece.size = {4.4, 1.8};
  Outline({{0.35, 0.},
           {3.9, 0.},
           {4.4, 0.45},
           {4.4, 1.35},
           {3.9, 1.8},
           {0.35, 1.8},
           {0., 1.4},
           {0., 0.4}},
          &piece);
  return piece;
}

Piece Rack(const int bays, const double depth, const double filled,
           Random* random) {
  constexpr double kBay = 2.7;
  Piece piece;
  piece.size = {kBay * bays + 0.1, depth};
  for (int bay = 0; bay <= bays; ++bay) {
    const double x = 0.05 + kBay * bay;
    Round(x, 0.05, 0.05, &piece);
    Round(x, depth - 0.05, 0.05, &piece);
    if (bay == bays) break;
    for (const double offset : {0.1, 1.38}) {
      if (random->Uniform() > filled) continue;
      const double left = x + offset + random->Uniform(0., 0.05);
      const double low = random->Uniform(0.02, 0.1);
      const double high = depth - random->Uniform(0.02, 0.1);
      Outline(
          {{left, low}, {left + 1.2, low}, {left + 1.2, high}, {left, high}},
          &piece);
    }
  }
  return piece;
}

bool Place(const Piece& piece, const Placement& placement, FloorPlan* plan) {
  const Eigen::Vector2d size = TurnedSize(piece, placement.back);
  const Box box(placement.corner, placement.corner + size);
  if (!IsFree(box, placement.keep, placement.gap, *plan)) return false;
  const auto moved = [&](const Eigen::Vector2d& point) -> Eigen::Vector2d {
    return placement.corner + Turned(piece, placement.back, point);
  };
  for (Segment segment : piece.segments) {
    segment.a = moved(segment.a);
    segment.b = moved(segment.b);
    plan->segments.push_back(segment);
  }
  for (Disc disc : piece.discs) {
    disc.center = moved(disc.center);
    plan->discs.push_back(disc);
  }
  plan->occupied.push_back(box);
  return true;
}

bool PlaceAtWall(const Piece& piece, const Box& room, Random* random,
                 FloorPlan* plan) {
  constexpr double kFromWall = 0.03;
  for (int attempt = 0; attempt != kAttempts; ++attempt) {
    Placement placement;
    placement.back = static_cast<Side>(random->UniformInt(0, 3));
    const double along = random->Uniform();
    const Eigen::Vector2d size = TurnedSize(piece, placement.back);
    const Eigen::Vector2d low =
        room.min() + Eigen::Vector2d::Constant(kFromWall);
    const Eigen::Vector2d high =
        room.max() - Eigen::Vector2d::Constant(kFromWall) - size;
    if (high.x() < low.x() || high.y() < low.y()) continue;
    placement.corner = low + along * (high - low);
    if (placement.back == kBelow) placement.corner.y() = low.y();
    if (placement.back == kAbove) placement.corner.y() = high.y();
    if (placement.back == kLeft) placement.corner.x() = low.x();
    if (placement.back == kRight) placement.corner.x() = high.x();
    if (Place(piece, placement, plan)) return true;
  }
  return false;
}

bool PlaceInside(const Piece& piece, const Box& room, Random* random,
                 FloorPlan* plan) {
  for (int attempt = 0; attempt != kAttempts; ++attempt) {
    Placement placement;
    placement.back = static_cast<Side>(random->UniformInt(0, 3));
    placement.gap = 0.4;
    const double x = random->Uniform(), y = random->Uniform();
    const Eigen::Vector2d size = TurnedSize(piece, placement.back);
    const Eigen::Vector2d room_left = room.max() - room.min() - size;
    if (room_left.minCoeff() < 0.2) continue;
    placement.corner =
        room.min() + Eigen::Vector2d(0.1, 0.1) +
        Eigen::Vector2d(x * (room_left.x() - 0.2), y * (room_left.y() - 0.2));
    if (Place(piece, placement, plan)) return true;
  }
  return false;
}

void FurnishOffice(const Box& room, const double density, Random* random,
                   FloorPlan* plan) {
  const double area = room.volume();
  const int pieces =
      static_cast<int>(density * area / 4. * random->Uniform(0.6, 1.2)) + 1;
  for (int i = 0; i != pieces; ++i) {
    const double kind = random->Uniform();
    if (kind < 0.35) {
      PlaceAtWall(Desk(), room, random, plan);
    } else if (kind < 0.6) {
      PlaceAtWall(Cupboard(random->Uniform(0.8, 2.), 0.45), room, random, plan);
    } else if (kind < 0.75) {
      PlaceAtWall(Cupboard(1.8, 0.8), room, random, plan);
    } else if (kind < 0.85) {
      PlaceInside(Table(4 + 2 * static_cast<int>(random->UniformInt(0, 2))),
                  room, random, plan);
    } else {
      PlaceAtWall(RoundThing(random->Uniform(0.12, 0.25)), room, random, plan);
    }
  }
}

void FurnishHotelRoom(const Box& room, Random* random, FloorPlan* plan) {
  PlaceAtWall(Bed(), room, random, plan);
  PlaceAtWall(Cupboard(1.2, 0.6), room, random, plan);
  PlaceAtWall(Desk(), room, random, plan);
  PlaceAtWall(RoundThing(0.15), room, random, plan);
}

}  // namespace simulation
}  // namespace cartographer_ext
