// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
#include "cartographer_ext/io/carmen/carmen_reader.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "absl/memory/memory.h"
#include "absl/strings/str_cat.h"
#include "cartographer_ext/io/carmen/carmen_line.h"
#include "cartographer_ext/io/carmen/carmen_survey.h"
#include "cartographer_ext/io/carmen/particle_filter_log.h"
#include "cartographer_ext/io/line_reader.h"

namespace cartographer_ext {
namespace io {
namespace {

// The largest range of a SICK laser.
constexpr double kDefaultRangeMax = 80.;

class CarmenSource : public SensorSource {
 public:
  CarmenSource(CarmenPlan plan, std::unique_ptr<LineReader> reader)
      : plan_(std::move(plan)),
        reader_(std::move(reader)),
        waiting_(plan_.reordering.window) {}

  const SensorSourceInfo& info() const override { return plan_.info; }

  absl::StatusOr<bool> Next(SensorEvent* event) override {
    while (!at_end_ && !waiting_.Ready()) {
      absl::string_view text;
      const auto more = reader_->Next(&text);
      const bool is_lost = plan_.is_damaged && absl::IsDataLoss(more.status());
      if (!more.ok() && !is_lost) return more.status();
      if (is_lost || !*more) {
        at_end_ = true;
        break;
      }
      ParseCarmenLine(text, &line_);
      if (ReplaceLostData()) PushEvents();
    }
    if (waiting_.empty()) return false;
    const TimeNs time = waiting_.first_key().time;
    if (time < last_time_) {
      return absl::AbortedError(
          absl::StrCat(reader_->Location(), ": file changed while reading"));
    }
    last_time_ = time;
    *event = waiting_.Pop();
    return true;
  }

 private:
  // False if the line is to be dropped.
  bool ReplaceLostData() {
    if (!IsScanKind(line_.kind) && line_.kind != CarmenKind::kOdometry) {
      return true;
    }
    if (plan_.is_filter_log && filter_log_.Repeats(line_)) {
      filter_log_.Skip(line_);
      return false;
    }
    if (plan_.remove_corrections) {
      filter_log_.RemoveCorrection(&line_);
    } else {
      filter_log_.Skip(line_);
    }
    if (plan_.line_spacing > 0) {
      line_.time = restamped_ += plan_.line_spacing;
    }
    return true;
  }

  void PushEvents() {
    CarmenEvent events[2];
    const int n =
        CarmenEventsOfLine(plan_, line_.kind, line_.time, &ordinal_, events);
    for (int i = 0; i < n; ++i) {
      const std::vector<int64_t>& dropped = plan_.reordering.dropped;
      if (next_dropped_ < dropped.size() &&
          dropped[next_dropped_] == events[i].key.ordinal) {
        ++next_dropped_;
        continue;
      }
      if (events[i].is_scan) {
        waiting_.Push(events[i].key, MakeScan());
      } else {
        OdometryReading reading;
        reading.time = line_.time;
        reading.pose = line_.robot_pose;
        reading.inside_scan = events[i].inside_scan;
        waiting_.Push(events[i].key, reading);
      }
    }
  }

  LaserScan MakeScan() {
    LaserScan scan;
    scan.time = line_.time;
    scan.angle_min = line_.angle_min;
    scan.angle_increment = line_.angle_increment;
    scan.range_max = plan_.range_max;
    if (line_.maximum_range > 0.) {
      // A reading of the maximum itself is "no return".
      const float maximum = static_cast<float>(line_.maximum_range);
      scan.range_max =
          std::min<double>(scan.range_max, std::nextafter(maximum, 0.f));
    }
    if (!std::isfinite(scan.range_max)) scan.range_max = kDefaultRangeMax;
    scan.ranges = std::move(line_.ranges);
    line_.ranges.clear();
    scan.laser_pose = plan_.laser_pose;
    return scan;
  }

  const CarmenPlan plan_;
  const std::unique_ptr<LineReader> reader_;
  ReorderBuffer<SensorEvent> waiting_;
  CarmenLine line_;
  ParticleFilterLog filter_log_;
  TimeNs restamped_ = 0;
  int64_t ordinal_ = 0;
  size_t next_dropped_ = 0;
  TimeNs last_time_ = 0;
  bool at_end_ = false;
};

}  // namespace

absl::StatusOr<std::unique_ptr<SensorSource>> OpenCarmenLog(
    const std::string& filename, const SensorSourceOptions& options) {
  auto plan = SurveyCarmenLog(filename, options.odometry_source);
  if (!plan.ok()) return plan.status();
  auto reader = LineReader::Open(filename);
  if (!reader.ok()) return reader.status();
  return std::unique_ptr<SensorSource>(
      absl::make_unique<CarmenSource>(std::move(*plan), std::move(*reader)));
}

}  // namespace io
}  // namespace cartographer_ext
