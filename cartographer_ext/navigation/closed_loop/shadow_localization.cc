// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
#include "cartographer_ext/navigation/closed_loop/shadow_localization.h"

#include <cmath>
#include <utility>

#include "cartographer_ext/navigation/closed_loop/online_localizer.h"
#include "cartographer_ext/slam/resource_usage.h"

namespace cartographer_ext {
namespace navigation {

absl::StatusOr<ShadowLocalization> LocalizeAgain(
    const NavigationRun& run,
    const evaluation::SlamConfiguration& configuration,
    const std::string& pbstream_filename) {
  auto localizer = OnlineLocalizer::Create(configuration, pbstream_filename,
                                           run.initial_pose);
  if (!localizer.ok()) return localizer.status();
  ShadowLocalization result;
  const double begin = evaluation::ProcessCpuSeconds();
  std::vector<std::pair<io::TimeNs, Pose2>> truth;
  io::TimeNs last = 0;
  for (const io::SensorEvent& event : run.readings) {
    if (absl::holds_alternative<io::LaserScan>(event)) {
      const auto& scan = absl::get<io::LaserScan>(event);
      truth.emplace_back(scan.time, run.true_poses[truth.size()]);
      (*localizer)->Add(scan);
    } else if (absl::holds_alternative<io::OdometryReading>(event)) {
      (*localizer)->Add(absl::get<io::OdometryReading>(event));
    }
    const auto latest = (*localizer)->Latest();
    if (!latest.has_value() || latest->time <= last) continue;
    last = latest->time;
    for (auto it = truth.rbegin(); it != truth.rend(); ++it) {
      if (std::abs(it->first - last) > 100) continue;
      result.errors.push_back({it->first, latest->map_from_robot.translation() -
                                              it->second.translation()});
      break;
    }
  }
  result.jumps = CountJumps(result.errors);
  result.cpu_seconds = evaluation::ProcessCpuSeconds() - begin;
  return result;
}

}  // namespace navigation
}  // namespace cartographer_ext
