// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
//
// The part of a world file that draws the floor plan: lines, circles, walls
// with recesses, and blocks of shapes that are placed many times.
#ifndef CARTOGRAPHER_EXT_SIMULATION_PLAN_BUILDER_H_
#define CARTOGRAPHER_EXT_SIMULATION_PLAN_BUILDER_H_

#include <cstddef>
#include <map>
#include <string>
#include <vector>

#include "absl/status/status.h"
#include "cartographer_ext/simulation/ray_caster.h"
#include "cartographer_ext/simulation/statement.h"

namespace cartographer_ext {
namespace simulation {

class PlanBuilder {
 public:
  // Reads the statement if it is one of the plan's and sets `*taken`.
  absl::Status Take(Statement* statement, bool* taken);
  // At the end of the file: an error when a block is still open.
  absl::Status Finish() const;

  const std::vector<Segment>& segments() const { return plan_.segments; }
  const std::vector<Disc>& discs() const { return plan_.discs; }

 private:
  struct Shapes {
    std::vector<Segment> segments;
    std::vector<Disc> discs;
  };

  void AddSegment(const Eigen::Vector2d& a, const Eigen::Vector2d& b,
                  double reflectivity, Statement* statement);
  void AddDisc(const Disc& disc, Statement* statement);
  void ReadLines(Statement* statement, bool closed);
  void ReadRectangle(Statement* statement);
  void ReadCircle(Statement* statement);
  void ReadWall(Statement* statement);
  void ReadPlace(Statement* statement);
  void OpenBlock(Statement* statement);
  void CloseBlock(Statement* statement);
  // Nested blocks multiply; this bounds their memory.
  bool Spend(size_t shapes, Statement* statement);

  Shapes plan_;
  Shapes* current_ = &plan_;
  std::map<std::string, Shapes> blocks_;
  std::string open_block_;
  std::string open_block_where_;
  size_t spent_ = 0;
};

}  // namespace simulation
}  // namespace cartographer_ext

#endif  // CARTOGRAPHER_EXT_SIMULATION_PLAN_BUILDER_H_
