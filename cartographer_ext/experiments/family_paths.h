// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
//
// The paths that the graph families (graph_families.h) are made of.
#ifndef CARTOGRAPHER_EXT_EXPERIMENTS_FAMILY_PATHS_H_
#define CARTOGRAPHER_EXT_EXPERIMENTS_FAMILY_PATHS_H_

#include <vector>

#include "cartographer_ext/common/pose2.h"
#include "cartographer_ext/common/random.h"

namespace cartographer_ext {
namespace experiments {

// True poses, the part of the world (floor) and the trajectory of each.
struct Path {
  std::vector<Pose2> poses;
  std::vector<int> floors;
  std::vector<int> robots;

  void Add(const Pose2& pose, const int floor, const int robot) {
    poses.push_back(pose);
    floors.push_back(floor);
    robots.push_back(robot);
  }
};

// Walks `length` metres along a circular arc (curvature 0: straight on), a pose
// about every `step` metres.
void Drive(double length, double curvature, double step, int floor, int robot,
           Path* path);

// Laps over `rings` circles in a row, out along one half of each and back along
// the other.
Path Rings(int rings, double radius, double step, double laps, Random* random);

// Out and back along `arms` slightly bent arms of about `length` metres, with a
// turn on the spot at both ends.
Path Star(int arms, double length, double step, Random* random);

// Moves along the streets of a grid with blocks of `block` metres, within
// `size` blocks; turns on the spot take one pose.
class StreetWalker {
 public:
  StreetWalker(const int size, const double block, const double step,
               Random* const random, Path* const path)
      : size_(size), block_(block), step_(step), random_(random), path_(path) {}

  void Begin(const int x, const int y, const int floor, const int robot) {
    x_ = x;
    y_ = y;
    direction_ = 0;
    floor_ = floor;
    robot_ = robot;
    path_->Add(Pose2(block_ * x, block_ * y, 0.), floor, robot);
  }

  void Walk(const int blocks) {
    for (int i = 0; i != blocks; ++i) {
      int direction = direction_;
      const double choice = random_->Uniform();
      if (choice < 0.25) direction = (direction_ + 1) % 4;
      if (choice >= 0.75) direction = (direction_ + 3) % 4;
      while (!IsFree(direction)) direction = (direction + 1) % 4;
      Go(direction);
    }
  }

  void WalkHome() {
    while (x_ != 0) Go(x_ > 0 ? 2 : 0);
    while (y_ != 0) Go(y_ > 0 ? 3 : 1);
  }

  void ChangeFloor(const int floor) { floor_ = floor; }

 private:
  bool IsFree(const int direction) const {
    const int x = x_ + kDx[direction], y = y_ + kDy[direction];
    return x >= 0 && y >= 0 && x <= size_ && y <= size_;
  }

  void Go(const int direction) {
    const double turn = NormalizeAngle((direction - direction_) * kPi / 2.);
    if (direction != direction_) {
      path_->Add(path_->poses.back() * Pose2(0., 0., turn), floor_, robot_);
    }
    direction_ = direction;
    Drive(block_, 0., step_, floor_, robot_, path_);
    x_ += kDx[direction];
    y_ += kDy[direction];
  }

  static constexpr int kDx[4] = {1, 0, -1, 0};
  static constexpr int kDy[4] = {0, 1, 0, -1};
  const int size_;
  const double block_;
  const double step_;
  Random* const random_;
  Path* const path_;
  int x_ = 0, y_ = 0, direction_ = 0, floor_ = 0, robot_ = 0;
};

}  // namespace experiments
}  // namespace cartographer_ext

#endif  // CARTOGRAPHER_EXT_EXPERIMENTS_FAMILY_PATHS_H_
