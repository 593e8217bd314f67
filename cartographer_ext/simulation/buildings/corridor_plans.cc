// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
//
// Offices and hotels: rows of rooms along corridors.
//
//   +--------------------------+      y
//   |  |  |  rooms  |  |  |  | |      ^
//   |  corridor 1              |      |
//   |   +---------+ +--------+ |      +--> x
//   |   | core    | |        | |
//   |   +---------+ +--------+ |
//   |  corridor 0              |
//   |  |  |  rooms  |  |  |  | |
//   +--------------------------+
//
// or one corridor alone between two rows.
#include <algorithm>
#include <cmath>
#include <map>
#include <utility>
#include <vector>

#include "cartographer_ext/simulation/buildings/furniture.h"
#include "cartographer_ext/simulation/buildings/plans.h"

namespace cartographer_ext {
namespace simulation {
namespace {

constexpr double kHalfWall = 0.06;
constexpr double kOuterWall = 0.25;
constexpr double kDoor = 1.1;         // metres wide
constexpr double kInFront = 0.9;      // from the door to the first node inside
constexpr double kClosedDoor = 0.08;  // how far a closed door is set back

struct Style {
  double width = 30.;
  bool ring = true;
  double corridor_width = 2.2;
  double room_width = 4.;
  double room_spread = 0.;  // of the widths, relative
  double depth = 5.;
  double open_share = 0.7;   // of the rooms
  double glass_share = 0.2;  // of the open ones
  double density = 0.8;      // of the furniture
  bool alike = false;        // all rooms furnished by the same hand
  int visits = 6;            // rooms of a round
};

struct Corridor {
  double y = 0.;
  std::map<double, int> nodes;                // by x
  std::vector<std::pair<double, int>> stops;  // (x, node), in rooms
};

class CorridorBuilder {
 public:
  CorridorBuilder(const Style& style, Random* random, FloorPlan* plan)
      : style_(style), random_(random), plan_(plan) {}

  void Build() {
    const double w = style_.corridor_width;
    corridors_.resize(style_.ring ? 2 : 1);
    corridors_[0].y = style_.depth + 0.5 * w;
    double top = style_.depth + w;
    double core_top = top;
    if (style_.ring) {
      core_top = top + CoreDepth();
      corridors_[1].y = core_top + 0.5 * w;
      top = core_top + w;
    }
    height_ = top + style_.depth;
    twin_seed_ = random_->NextBits();
    AddRow(MakeBox(0., 0., style_.width, style_.depth), true, kOuterWall,
           &corridors_[0]);
    if (style_.ring) AddCore(style_.depth + w, core_top);
    AddRow(MakeBox(0., top, style_.width, height_), false, kOuterWall,
           &corridors_.back());
    const double end = 0.5 * w;
    for (Corridor& corridor : corridors_) {
      NodeAt(end, &corridor);
      NodeAt(style_.width - end, &corridor);
      ConnectCorridor(corridor);
    }
    if (style_.ring) {
      for (const double x : crossings_) {
        AddLane(corridors_[0].nodes.at(x), corridors_[1].nodes.at(x), plan_);
      }
    }
    DrawOutline();
    FurnishRooms();
    MakeRound();
  }

 private:
  struct Planned {
    Box box;
    bool alike = false;
  };

  double CoreDepth() {
    // One row of rooms, or two back to back.
    return random_->Uniform() < 0.5 ? style_.depth : 2. * style_.depth;
  }

  int NodeAt(const double x, Corridor* corridor) {
    const auto found = corridor->nodes.find(x);
    if (found != corridor->nodes.end()) return found->second;
    const int node = AddNode({x, corridor->y}, plan_);
    corridor->nodes[x] = node;
    return node;
  }

  void ConnectCorridor(const Corridor& corridor) {
    int before = -1;
    for (const auto& entry : corridor.nodes) {
      if (before >= 0) AddLane(before, entry.second, plan_);
      before = entry.second;
    }
  }

  void AddCore(const double low, const double high) {
    const double w = style_.corridor_width;
    std::vector<double> crossings = {0.5 * w, style_.width - 0.5 * w};
    if (random_->Uniform() < 0.4) {
      crossings.insert(crossings.begin() + 1,
                       style_.width * random_->Uniform(0.4, 0.6));
    }
    for (size_t i = 0; i + 1 < crossings.size(); ++i) {
      const double left = crossings[i] + 0.5 * w;
      const double right = crossings[i + 1] - 0.5 * w;
      AddLine({left, low}, {left, high}, Surface(), plan_);
      AddLine({right, low}, {right, high}, Surface(), plan_);
      if (high - low > 1.5 * style_.depth) {
        const double middle = 0.5 * (low + high);
        AddRow(MakeBox(left, low, right, middle), false, kHalfWall,
               &corridors_[0]);
        AddRow(MakeBox(left, middle, right, high), true, kHalfWall,
               &corridors_[1]);
      } else {
        AddRow(MakeBox(left, low, right, high), false, 2. * kHalfWall,
               &corridors_[0]);
        AddLine({left, high}, {right, high}, Surface(), plan_);
      }
    }
    for (const double x : crossings) {
      for (Corridor& corridor : corridors_) NodeAt(x, &corridor);
    }
    crossings_ = crossings;
  }

  // Rooms side by side; `doors_above` says on which side the corridor is.
  void AddRow(const Box& row, const bool doors_above, const double back_wall,
              Corridor* corridor) {
    double x = row.min().x();
    const double length = row.max().x() - x;
    const int count =
        std::max(1, static_cast<int>(std::lround(length / style_.room_width)));
    std::vector<double> widths(count);
    double sum = 0.;
    for (double& width : widths) {
      width = 1. + style_.room_spread * random_->Uniform(-1., 1.);
      sum += width;
    }
    for (const double share : widths) {
      const double width = share * length / sum;
      AddRoom(MakeBox(x, row.min().y(), x + width, row.max().y()), doors_above,
              back_wall, corridor);
      x += width;
    }
  }

  void AddRoom(const Box& box, const bool doors_above, const double back_wall,
               Corridor* corridor) {
    const double inwards = doors_above ? -1. : 1.;
    const double front = doors_above ? box.max().y() : box.min().y();
    const double x0 = box.min().x(), x1 = box.max().x();
    const double spare = x1 - x0 - 4. * kHalfWall - kDoor - 0.3;
    const double door = x0 + 2. * kHalfWall + 0.15 +
                        spare * (style_.alike ? 0.2 : random_->Uniform(0., 1.));
    const bool open = spare > 0.3 && random_->Uniform() < style_.open_share;
    const bool glass = open && random_->Uniform() < style_.glass_share;
    const Surface wall = glass ? Pane() : Surface();
    AddLine({x0, front}, {door, front}, wall, plan_);
    AddLine({door + kDoor, front}, {x1, front}, wall, plan_);
    if (!open) {
      const double back = front + inwards * kClosedDoor;
      AddLine({door, front}, {door, back}, Surface(), plan_);
      AddLine({door, back}, {door + kDoor, back}, Surface(), plan_);
      AddLine({door + kDoor, back}, {door + kDoor, front}, Surface(), plan_);
      return;
    }
    const double inner = front + inwards * 2. * kHalfWall;
    const double back =
        (doors_above ? box.min().y() : box.max().y()) - inwards * back_wall;
    const double left = x0 + kHalfWall, right = x1 - kHalfWall;
    AddLine({left, inner}, {left, back}, Surface(), plan_);
    AddLine({right, inner}, {right, back}, Surface(), plan_);
    if (!glass) {
      AddLine({left, inner}, {door, inner}, Surface(), plan_);
      AddLine({door + kDoor, inner}, {right, inner}, Surface(), plan_);
      AddLine({door, front}, {door, inner}, Surface(), plan_);
      AddLine({door + kDoor, front}, {door + kDoor, inner}, Surface(), plan_);
    }
    AddBackWall(left, right, back, doors_above, back_wall == kOuterWall);
    AddRoomLanes(
        MakeBox(left, std::min(inner, back), right, std::max(inner, back)),
        door + 0.5 * kDoor, doors_above, corridor);
  }

  void AddBackWall(const double left, const double right, const double y,
                   const bool below, const bool outer) {
    const double width = right - left;
    if (!outer || random_->Uniform() < 0.4) {
      AddLine({left, y}, {right, y}, Surface(), plan_);
      return;
    }
    // A window: a pane, and the open air where the outline is.
    const double begin = left + 0.3 * width, end = right - 0.3 * width;
    AddLine({left, y}, {begin, y}, Surface(), plan_);
    AddLine({begin, y}, {end, y}, Pane(), plan_);
    AddLine({end, y}, {right, y}, Surface(), plan_);
    windows_[below ? 0 : 1].push_back({begin, end});
  }

  void AddRoomLanes(const Box& room, const double door, const bool doors_above,
                    Corridor* corridor) {
    const double inwards = doors_above ? -1. : 1.;
    const double front = doors_above ? room.max().y() : room.min().y();
    const int outside = NodeAt(door, corridor);
    const int inside = AddNode({door, front + inwards * kInFront}, plan_);
    AddLane(outside, inside, plan_);
    Random twin(twin_seed_);
    Random* const random = style_.alike ? &twin : random_;
    const double margin = 0.9;
    const double across = random->Uniform(), along = random->Uniform();
    const Eigen::Vector2d size = room.max() - room.min();
    const double depth =
        kInFront + (size.y() - margin - kInFront) * (0.4 + 0.6 * along);
    const Eigen::Vector2d place(
        room.min().x() + margin + across * std::max(0., size.x() - 2. * margin),
        front + inwards * depth);
    const int stop = AddNode(place, plan_);
    AddLane(inside, stop, plan_);
    corridor->stops.push_back({door, stop});
    plan_->rooms.push_back({room, stop});
  }

  void FurnishRooms() {
    for (const Room& room : plan_->rooms) {
      Random twin(twin_seed_ + 1);
      if (style_.alike) {
        FurnishHotelRoom(room.box, &twin, plan_);
      } else {
        FurnishOffice(room.box, style_.density, random_, plan_);
      }
    }
  }

  void DrawOutline() {
    const double width = style_.width;
    plan_->outline = {{0., 0.}, {width, 0.}, {width, height_}, {0., height_}};
    for (const int side : {0, 1}) {
      const double y = side == 0 ? 0. : height_;
      double x = 0.;
      std::sort(windows_[side].begin(), windows_[side].end());
      for (const auto& window : windows_[side]) {
        AddLine({x, y}, {window.first, y}, Surface(), plan_);
        AddLine({window.first, y}, {window.second, y}, OpenAir(), plan_);
        x = window.second;
      }
      AddLine({x, y}, {width, y}, Surface(), plan_);
    }
    // A glass door at one end of a corridor.
    for (const double x : {0., width}) {
      double y = 0.;
      for (const Corridor& corridor : corridors_) {
        if (random_->Uniform() < 0.6) continue;
        AddLine({x, y}, {x, corridor.y - 0.8}, Surface(), plan_);
        AddLine({x, corridor.y - 0.8}, {x, corridor.y + 0.8}, {0.05, kAnyAngle},
                plan_);
        y = corridor.y + 0.8;
      }
      AddLine({x, y}, {x, height_}, Surface(), plan_);
    }
  }

  // Every k-th room along the route: east on the first corridor, back on the
  // other or, where there is one only, on the same.
  void MakeRound() {
    std::vector<std::pair<double, int>> east = corridors_.front().stops;
    std::vector<std::pair<double, int>> west;
    if (style_.ring) {
      west = corridors_.back().stops;
    } else {
      Shuffle(&east);
      const size_t half = east.size() / 2;
      west.assign(east.begin() + half, east.end());
      east.resize(half);
    }
    Choose((style_.visits + 1) / 2, &east);
    Choose(style_.visits / 2, &west);
    std::sort(east.begin(), east.end());
    std::sort(west.rbegin(), west.rend());
    const int start = corridors_.front().nodes.begin()->second;
    plan_->round = {start};
    for (const auto& stop : east) plan_->round.push_back(stop.second);
    plan_->round.push_back(corridors_.front().nodes.rbegin()->second);
    if (style_.ring) {
      plan_->round.push_back(corridors_.back().nodes.rbegin()->second);
    }
    for (const auto& stop : west) plan_->round.push_back(stop.second);
    if (style_.ring) {
      plan_->round.push_back(corridors_.back().nodes.begin()->second);
    }
    plan_->round.push_back(start);
  }

  void Shuffle(std::vector<std::pair<double, int>>* stops) {
    for (size_t i = 1; i < stops->size(); ++i) {
      std::swap((*stops)[i], (*stops)[random_->UniformInt(0, i)]);
    }
  }

  void Choose(const size_t count, std::vector<std::pair<double, int>>* stops) {
    Shuffle(stops);
    if (stops->size() > count) stops->resize(count);
  }

  const Style style_;
  Random* const random_;
  FloorPlan* const plan_;
  std::vector<Corridor> corridors_;
  std::vector<double> crossings_;
  std::vector<std::pair<double, double>> windows_[2];
  double height_ = 0.;
  uint64_t twin_seed_ = 0;
};

void SetWalks(const double corridor_width, FloorPlan* plan) {
  plan->walk_offset_min = 0.5 * corridor_width - 0.4;
  plan->walk_offset_max = 0.5 * corridor_width - 0.28;
  plan->lateral_slack = 0.12;
}

}  // namespace

void PlanOffice(Random* random, FloorPlan* plan) {
  Style style;
  style.ring = random->Uniform() < 0.6;
  style.width =
      style.ring ? random->Uniform(24., 42.) : random->Uniform(24., 50.);
  style.corridor_width = random->Uniform(1.8, 2.8);
  style.room_width = random->Uniform(3.6, 5.5);
  style.room_spread = random->Uniform(0.1, 0.45);
  style.depth = random->Uniform(4.2, 6.5);
  style.open_share = random->Uniform(0.5, 0.9);
  style.glass_share = random->Uniform(0., 0.5);
  style.density = random->Uniform(0.5, 1.1);
  style.visits = static_cast<int>(random->UniformInt(4, 8));
  CorridorBuilder(style, random, plan).Build();
  SetWalks(style.corridor_width, plan);
  plan->people = static_cast<int>(random->UniformInt(1, 4));
}

void PlanHotel(Random* random, FloorPlan* plan) {
  Style style;
  style.ring = random->Uniform() < 0.7;
  style.width = random->Uniform(36., 60.);
  style.corridor_width = random->Uniform(1.7, 2.2);
  style.room_width = random->Uniform(3.4, 4.2);
  style.depth = random->Uniform(5.5, 7.);
  style.open_share = random->Uniform(0.1, 0.3);
  style.glass_share = 0.;
  style.alike = true;
  style.visits = static_cast<int>(random->UniformInt(1, 4));
  CorridorBuilder(style, random, plan).Build();
  SetWalks(style.corridor_width, plan);
  plan->people = static_cast<int>(random->UniformInt(0, 3));
}

}  // namespace simulation
}  // namespace cartographer_ext
