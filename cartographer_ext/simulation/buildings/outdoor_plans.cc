// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
//
// Streets and campuses: no outer wall, and many beams that meet nothing.
#include <algorithm>
#include <cmath>
#include <vector>

#include "cartographer_ext/simulation/buildings/furniture.h"
#include "cartographer_ext/simulation/buildings/plans.h"

namespace cartographer_ext {
namespace simulation {
namespace {

constexpr double kKeep = 1.6;  // from the middle of a lane

// A row of houses: bays, doors and windows at the period of each house, and
// gaps between some.
class Facade {
 public:
  Facade(const double period, Random* random, FloorPlan* plan)
      : period_(period), random_(random), plan_(plan) {}

  // The row goes from a to b, with the street on its left.
  void Draw(const Eigen::Vector2d& a, const Eigen::Vector2d& b,
            const double gap_share) {
    const double length = (b - a).norm();
    along_ = (b - a) / length;
    inwards_ = Eigen::Vector2d(along_.y(), -along_.x());
    for (double s = 0.; s < length - 4.;) {
      const double house = std::min(length - s, random_->Uniform(8., 18.));
      if (random_->Uniform() >= gap_share) {
        House(a + s * along_, house, random_->Uniform(0., 0.6));
      }
      s += house;
      if (random_->Uniform() < gap_share) s += random_->Uniform(1.5, 4.);
    }
  }

 private:
  void House(const Eigen::Vector2d& corner, const double length,
             const double set_back) {
    const Eigen::Vector2d from = corner + set_back * inwards_;
    AddLine(from + 6. * inwards_, from, Surface(), plan_);
    double s = 0.;
    for (; s + period_ < length; s += period_) {
      const bool window = random_->Uniform() < 0.8;
      const double begin = s + 0.3 * period_, end = s + 0.7 * period_;
      const double depth = window ? 0.12 : 0.5;
      AddLine(from + s * along_, from + begin * along_, Surface(), plan_);
      AddLine(from + begin * along_, from + begin * along_ + depth * inwards_,
              Surface(), plan_);
      AddLine(from + begin * along_ + depth * inwards_,
              from + end * along_ + depth * inwards_,
              window ? Surface{0.3, kAnyAngle} : Surface(), plan_);
      AddLine(from + end * along_ + depth * inwards_, from + end * along_,
              Surface(), plan_);
      AddLine(from + end * along_, from + (s + period_) * along_, Surface(),
              plan_);
    }
    AddLine(from + s * along_, from + length * along_, Surface(), plan_);
    AddLine(from + length * along_, from + length * along_ + 6. * inwards_,
            Surface(), plan_);
  }

  const double period_;
  Random* const random_;
  FloorPlan* const plan_;
  Eigen::Vector2d along_ = Eigen::Vector2d::UnitX();
  Eigen::Vector2d inwards_ = Eigen::Vector2d::UnitY();
};

// Trees, lamp posts and cars beside a lane from a to b, axis-aligned.
void LineTheStreet(const Eigen::Vector2d& a, const Eigen::Vector2d& b,
                   const double kerb, Random* random, FloorPlan* plan) {
  const bool horizontal = a.y() == b.y();
  const double length = (b - a).norm();
  const Eigen::Vector2d along = (b - a) / length;
  const Eigen::Vector2d left(-along.y(), along.x());
  const double parked = random->Uniform(0.1, 0.6);
  for (const double side : {-1., 1.}) {
    for (double s = kerb + 2.; s < length - kerb - 7.; s += 5.6) {
      const Eigen::Vector2d foot = a + s * along + side * kerb * left;
      Placement placement;
      placement.keep = kKeep;
      placement.back = horizontal ? kBelow : kRight;
      if (random->Uniform() < parked) {
        const double wide = 0.9 + 0.1 * random->Uniform(-1., 1.);
        placement.corner = horizontal
                               ? Eigen::Vector2d(foot.x(), foot.y() - wide)
                               : Eigen::Vector2d(foot.x() - wide, foot.y());
        if (b.sum() < a.sum()) {
          placement.corner -= 4.4 * Eigen::Vector2d(horizontal, !horizontal);
        }
        Place(ParkedCar(), placement, plan);
      } else if (random->Uniform() < 0.4) {
        const double radius = random->Uniform(0.08, 0.3);
        placement.corner =
            foot + side * 1.4 * left - Eigen::Vector2d::Constant(radius);
        Place(RoundThing(radius), placement, plan);
      }
    }
  }
}

void AddHouseBlock(const Box& block, const double gap_share, Random* random,
                   FloorPlan* plan) {
  const double period = random->Uniform(2., 4.5);
  Facade facade(period, random, plan);
  const Eigen::Vector2d a = block.min(), c = block.max();
  const Eigen::Vector2d b(c.x(), a.y()), d(a.x(), c.y());
  // The street is outside: left of a clockwise walk.
  facade.Draw(a, d, gap_share);
  facade.Draw(d, c, gap_share);
  facade.Draw(c, b, gap_share);
  facade.Draw(b, a, gap_share);
}

}  // namespace

void PlanStreet(Random* random, FloorPlan* plan) {
  const int blocks = static_cast<int>(random->UniformInt(1, 2));
  const double block_x = random->Uniform(34., 60.);
  const double block_y = random->Uniform(28., 45.);
  const double road = random->Uniform(10., 16.);
  const double gaps = random->Uniform(0., 0.35);
  std::vector<double> xs, ys = {0., block_y + road};
  for (int i = 0; i <= blocks; ++i) xs.push_back(i * (block_x + road));
  const auto grid = AddLaneGrid(xs, ys, plan);
  const double half = 0.5 * road;
  for (int i = 0; i != blocks; ++i) {
    AddHouseBlock(MakeBox(xs[i] + half, half, xs[i + 1] - half, ys[1] - half),
                  gaps, random, plan);
  }
  // The far side of the streets round the blocks, open at the corners.
  const double period = random->Uniform(2., 4.5);
  Facade facade(period, random, plan);
  const double right = xs.back();
  facade.Draw({0., -half}, {right, -half}, gaps);
  facade.Draw({right + half, 0.}, {right + half, ys[1]}, gaps);
  facade.Draw({right, ys[1] + half}, {0., ys[1] + half}, gaps);
  facade.Draw({-half, ys[1]}, {-half, 0.}, gaps);
  const double kerb = half - random->Uniform(2.6, 3.);
  for (const double y : ys) {
    for (int i = 0; i != blocks; ++i) {
      LineTheStreet({xs[i], y}, {xs[i + 1], y}, kerb, random, plan);
    }
  }
  for (const double x : xs) {
    LineTheStreet({x, ys[0]}, {x, ys[1]}, kerb, random, plan);
  }
  plan->round = {grid[0][0], grid[blocks][0], grid[blocks][1], grid[0][1],
                 grid[0][0]};
  if (blocks == 2 && random->Uniform() < 0.6) {
    plan->round.insert(plan->round.end() - 2, {grid[1][1], grid[1][0]});
  }
  plan->lateral_slack = 0.5;
  plan->walk_offset_min = 1.3;
  plan->walk_offset_max = half - 1.;
  plan->people = static_cast<int>(random->UniformInt(2, 8));
  plan->overlap = 60.;
}

void PlanCampus(Random* random, FloorPlan* plan) {
  const int columns = static_cast<int>(random->UniformInt(2, 3));
  const int rows = 2;
  const double cell_x = random->Uniform(28., 42.);
  const double cell_y = random->Uniform(26., 38.);
  std::vector<double> xs, ys;
  for (int i = 0; i <= columns; ++i) xs.push_back(i * cell_x);
  for (int j = 0; j <= rows; ++j) ys.push_back(j * cell_y);
  const auto grid = AddLaneGrid(xs, ys, plan);
  for (int i = 0; i != columns; ++i) {
    for (int j = 0; j != rows; ++j) {
      const double left = xs[i] + random->Uniform(4., 10.);
      const double low = ys[j] + random->Uniform(4., 10.);
      const double right = xs[i + 1] - random->Uniform(4., 10.);
      const double high = ys[j + 1] - random->Uniform(4., 10.);
      if (random->Uniform() < 0.85) {
        const Box house = MakeBox(left, low, right, high);
        AddHouseBlock(house, 0., random, plan);
        plan->occupied.push_back(house);
      }
    }
  }
  const Box green = MakeBox(-12., -12., xs.back() + 12., ys.back() + 12.);
  const int trees = static_cast<int>(random->UniformInt(40, 160));
  for (int i = 0; i != trees; ++i) {
    const double kind = random->Uniform();
    Placement placement;
    placement.keep = kKeep;
    placement.gap = 0.8;
    placement.corner = {random->Uniform(green.min().x(), green.max().x()),
                        random->Uniform(green.min().y(), green.max().y())};
    if (kind < 0.75) {
      Place(RoundThing(random->Uniform(0.1, 0.35)), placement, plan);
    } else if (kind < 0.9) {
      placement.back = random->Uniform() < 0.5 ? kBelow : kLeft;
      Place(Cupboard(random->Uniform(2., 8.), 0.7), placement, plan);
    } else {
      placement.back = random->Uniform() < 0.5 ? kBelow : kLeft;
      Place(ParkedCar(), placement, plan);
    }
  }
  plan->round = {grid[0][0], grid[columns][0], grid[columns][rows],
                 grid[0][rows]};
  const double way = random->Uniform();
  if (way < 0.4) {
    plan->round.insert(plan->round.end(),
                       {grid[0][1], grid[columns][1], grid[columns][0]});
  } else if (way < 0.7) {
    plan->round.insert(plan->round.begin() + 1,
                       {grid[1][0], grid[1][rows], grid[0][rows], grid[0][0]});
  }
  plan->round.push_back(grid[0][0]);
  plan->lateral_slack = 0.6;
  plan->walk_offset_min = 1.2;
  plan->walk_offset_max = 3.;
  plan->people = static_cast<int>(random->UniformInt(2, 10));
  plan->overlap = 60.;
}

}  // namespace simulation
}  // namespace cartographer_ext
