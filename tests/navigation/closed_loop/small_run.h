// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
//
// A run made up for the tests of what is written about it.
#ifndef CARTOGRAPHER_EXT_TESTS_NAVIGATION_CLOSED_LOOP_SMALL_RUN_H_
#define CARTOGRAPHER_EXT_TESTS_NAVIGATION_CLOSED_LOOP_SMALL_RUN_H_

#include <fstream>
#include <iterator>
#include <string>

#include "cartographer_ext/navigation/closed_loop/navigation_run.h"
#include "tests/navigation/test_maps.h"

namespace cartographer_ext {
namespace navigation {

inline NavigationRun SmallRun() {
  NavigationRun run;
  run.map = RoomMap(4., 3.);
  run.robot_radius = 0.25;
  run.frame_seconds = 0.2;
  run.goals = {{{1., 1.}, true, "", 10.},
               {{9., 1.}, false, "why </script>", 12.}};
  run.goal_errors = {0.02, 5.};
  run.seconds = 20.;
  run.travelled = 11.;
  run.shortest = 10.;
  run.path_ratio = 1.1;
  run.planning_cpu_seconds = 0.2;
  run.localization_cpu_seconds = 0.8;
  for (int i = 1; i <= 100; ++i) run.cycle_seconds.push_back(1e-3 * i);
  run.localization = {{0, {0.01, 0.}}, {1, {0.03, 0.}}, {2, {0.02, 0.}}};
  run.true_path = {Pose2(), Pose2(1., 1., 0.)};
  Disturbance obstacle;
  obstacle.present = true;
  obstacle.discs.push_back({{2., 2.}, 0.2});
  run.disturbances = {obstacle};
  NavigationFrame frame;
  frame.message = "why </script>";
  frame.path = {{0., 0.}, {1., 1.}};
  run.frames = {frame, frame};
  return run;
}

inline std::string Read(const std::string& filename) {
  std::ifstream stream(filename, std::ios::binary);
  return std::string(std::istreambuf_iterator<char>(stream), {});
}

}  // namespace navigation
}  // namespace cartographer_ext

#endif  // CARTOGRAPHER_EXT_TESTS_NAVIGATION_CLOSED_LOOP_SMALL_RUN_H_
