// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
#include "cartographer_ext/optimization/selection/switched_loops.h"

#include <utility>

#include "absl/strings/numbers.h"
#include "absl/strings/str_cat.h"
#include "absl/strings/str_split.h"
#include "absl/strings/strip.h"

namespace cartographer_ext {
namespace optimization {
namespace {

constexpr char kHeading[] =
    "submap_trajectory,submap,node_trajectory,node,chi2,reason";
constexpr char kByOdometry[] = "odometry";
constexpr char kByConsensus[] = "consensus";

}  // namespace

void SwitchedLoopRecorder::Record(const int64_t loops,
                                  std::vector<SwitchedLoop> off,
                                  const double selection_cpu_seconds,
                                  const double solution_cpu_seconds) {
  const absl::MutexLock lock(&mutex_);
  ++loops_.optimizations;
  loops_.loops = loops;
  loops_.off = std::move(off);
  loops_.selection_cpu_seconds += selection_cpu_seconds;
  loops_.solution_cpu_seconds += solution_cpu_seconds;
}

void SwitchedLoopRecorder::Record(const LoopsPutInForce& in_force) {
  const absl::MutexLock lock(&mutex_);
  loops_.in_force = in_force;
}

void SwitchedLoopRecorder::RecordTakenBack(std::set<LoopId> loops) {
  const absl::MutexLock lock(&mutex_);
  loops_.taken_back = std::move(loops);
}

SwitchedLoops SwitchedLoopRecorder::Get() const {
  const absl::MutexLock lock(&mutex_);
  return loops_;
}

std::string SwitchedLoopsTable(const SwitchedLoops& loops) {
  std::string table = absl::StrCat(kHeading, "\n");
  for (const SwitchedLoop& loop : loops.off) {
    absl::StrAppend(&table, loop.submap_trajectory, ",", loop.submap_index, ",",
                    loop.node_trajectory, ",", loop.node_index, ",", loop.chi2,
                    ",", loop.by_odometry_check ? kByOdometry : kByConsensus,
                    "\n");
  }
  return table;
}

absl::StatusOr<std::vector<SwitchedLoop>> ParseSwitchedLoopsTable(
    const absl::string_view table) {
  std::vector<SwitchedLoop> result;
  int number = 0;
  for (absl::string_view line : absl::StrSplit(table, '\n')) {
    ++number;
    absl::ConsumeSuffix(&line, "\r");
    if (number == 1) {
      if (line == kHeading) continue;
      return absl::InvalidArgumentError(
          absl::StrCat("line 1: expected ", kHeading));
    }
    if (line.empty()) continue;
    const std::vector<absl::string_view> fields = absl::StrSplit(line, ',');
    SwitchedLoop loop;
    if (fields.size() != 6 ||
        !absl::SimpleAtoi(fields[0], &loop.submap_trajectory) ||
        !absl::SimpleAtoi(fields[1], &loop.submap_index) ||
        !absl::SimpleAtoi(fields[2], &loop.node_trajectory) ||
        !absl::SimpleAtoi(fields[3], &loop.node_index) ||
        !absl::SimpleAtod(fields[4], &loop.chi2) ||
        (fields[5] != kByOdometry && fields[5] != kByConsensus)) {
      return absl::InvalidArgumentError(
          absl::StrCat("line ", number, ": not a loop that was switched off"));
    }
    loop.by_odometry_check = fields[5] == kByOdometry;
    result.push_back(loop);
  }
  return result;
}

}  // namespace optimization
}  // namespace cartographer_ext
