// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
#include "cartographer_ext/io/carmen/carmen_survey.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <map>
#include <utility>

#include "absl/strings/str_cat.h"
#include "absl/strings/str_format.h"
#include "cartographer_ext/io/carmen/laser_offset.h"
#include "cartographer_ext/io/carmen/malformed_lines.h"
#include "cartographer_ext/io/carmen/particle_filter_log.h"
#include "cartographer_ext/io/carmen/range_histogram.h"
#include "cartographer_ext/io/carmen/scan_stamps.h"
#include "cartographer_ext/io/line_reader.h"
#include "cartographer_ext/io/tokens.h"

namespace cartographer_ext {
namespace io {
namespace {

constexpr size_t kMaxLines = 20000000;
constexpr size_t kMaxReorderWindow = 1 << 16;

// Larger steps of a clock do not come from messages that were late.
constexpr TimeNs kMaxClockStep = int64_t{10} * 1000000000;

class Survey {
 public:
  explicit Survey(const std::string& filename) : filename_(filename) {}

  absl::Status Read();
  absl::StatusOr<CarmenPlan> Plan(const std::string& odometry_source) const;

 private:
  void DropRepetitions();  // particle_filter_log.h
  void RestampIfLost();
  void WarnOfIgnored(CarmenPlan* plan) const;
  // Chooses the lines that odometry is read from; `disordered` messages have an
  // earlier stamp than the one before them.
  void ChooseOdometry(const std::string& odometry_source, int64_t disordered,
                      CarmenPlan* plan) const;
  void OrderEvents(CarmenPlan* plan) const;
  int64_t Count(CarmenKind kind) const {
    const auto it = counts_.find(kind);
    return it == counts_.end() ? 0 : it->second;
  }
  void AddParameter(const CarmenLine& line);
  CarmenKind ChooseScanKind() const;
  bool OdometryLinesCoverScans(CarmenKind scan_kind) const;
  Pose2 ChooseLaserPose(CarmenKind scan_kind,
                        std::vector<std::string>* warnings) const;
  // Whether so many stamps that go backwards are too many to pair messages.
  bool AreDisordered(int64_t backwards) const {
    return backwards > kMaxBackwardShare * static_cast<double>(lines_.size());
  }

  const std::string filename_;
  std::map<CarmenKind, int64_t> counts_;
  CarmenKind scan_kind_ = CarmenKind::kFrontLaser;
  bool is_filter_log_ = false;
  bool stamps_lost_ = false;
  std::vector<LineKey> lines_;
  std::map<CarmenKind, std::vector<Pose2>> offsets_;  // (robot <- laser)
  std::map<CarmenKind, RangeHistogram> ranges_;
  Pose2 parameter_offset_;
  MalformedLines malformed_;
  MalformedLines malformed_behind_scans_;
  std::map<CarmenKind, size_t> stamp_words_;  // of the last line so far
  bool is_cut_ = false;                       // the last line, behind its stamp
  std::string damage_;                        // of compressed data; empty: none
  ImplausibleLines implausible_;
};

void Survey::AddParameter(const CarmenLine& line) {
  double value;
  if (!ParseFinite(line.value, &value)) return;
  if (std::abs(value) > kMaxLaserOffset) return;
  if (line.name == "robot_frontlaser_offset") {
    parameter_offset_.x = value;
  } else if (line.name == "robot_frontlaser_side_offset") {
    parameter_offset_.y = value;
  } else if (line.name == "robot_frontlaser_angular_offset") {
    parameter_offset_.theta = NormalizeAngle(value);
  }
}

absl::Status Survey::Read() {
  auto reader = LineReader::Open(filename_);
  if (!reader.ok()) return reader.status();
  CarmenLine line;
  ParticleFilterLog repetitions;
  absl::string_view text;
  while (true) {
    const auto more = (*reader)->Next(&text);
    if (absl::IsDataLoss(more.status()) && Count(ChooseScanKind()) > 0) {
      damage_ = absl::StrCat(more.status().message(), "; read up to line ",
                             (*reader)->line_number());
      break;
    }
    if (!more.ok()) return more.status();
    if (!*more) break;
    ParseCarmenLine(text, &line);
    switch (line.kind) {
      case CarmenKind::kIgnored:
        continue;
      case CarmenKind::kMalformed:
        (repetitions.last_was_scan() ? malformed_behind_scans_ : malformed_)
            .Add((*reader)->Location(), line.error);
        continue;
      case CarmenKind::kParameter:
        AddParameter(line);
        continue;
      case CarmenKind::kRearLaser:
      case CarmenKind::kFilterMark:
        ++counts_[line.kind];
        continue;
      case CarmenKind::kFrontLaser:
      case CarmenKind::kRobotLaser:
        offsets_[line.kind].push_back(
            Between(line.robot_pose, line.laser_pose));
        ABSL_FALLTHROUGH_INTENDED;
      case CarmenKind::kRawLaser:
        ranges_[line.kind].Add(line.ranges);
        ABSL_FALLTHROUGH_INTENDED;
      case CarmenKind::kOdometry:
        ++counts_[line.kind];
        lines_.push_back(LineKey{line.time, (*reader)->line_number(), line.kind,
                                 true, repetitions.Repeats(line)});
        repetitions.Skip(line);
        if ((*reader)->unterminated() &&
            line.num_stamp_words < stamp_words_[line.kind]) {
          lines_.back().plausible = false;
          is_cut_ = true;
        }
        stamp_words_[line.kind] = line.num_stamp_words;
    }
    if (lines_.size() > kMaxLines) {
      return absl::OutOfRangeError(absl::StrCat((*reader)->Location(),
                                                ": more than ", kMaxLines,
                                                " messages; split the log"));
    }
  }
  scan_kind_ = ChooseScanKind();
  DropRepetitions();
  RestampIfLost();
  implausible_ = MarkImplausible(&lines_);
  return absl::OkStatus();
}

void Survey::DropRepetitions() {
  is_filter_log_ = Count(scan_kind_) > 0 &&
                   2 * Count(CarmenKind::kFilterMark) > Count(scan_kind_);
  if (!is_filter_log_) {
    malformed_.Add(malformed_behind_scans_);
    return;
  }
  const auto repetition =
      std::remove_if(lines_.begin(), lines_.end(),
                     [](const LineKey& line) { return line.repeats; });
  counts_[CarmenKind::kOdometry] -= lines_.end() - repetition;
  lines_.erase(repetition, lines_.end());
}

void Survey::RestampIfLost() {
  // A particle filter has read the lines in their order.
  stamps_lost_ = AreStampsLost(lines_, scan_kind_) ||
                 (is_filter_log_ &&
                  AreDisordered(CountBackwards(lines_, CarmenKind::kOdometry)));
  if (!stamps_lost_) return;
  TimeNs time = 0;
  for (LineKey& line : lines_) line.time = time += kLineSpacing;
}

CarmenKind Survey::ChooseScanKind() const {
  const int64_t front = Count(CarmenKind::kFrontLaser);
  const int64_t robot = Count(CarmenKind::kRobotLaser);
  if (front == 0 && robot == 0) return CarmenKind::kRawLaser;
  return front > robot ? CarmenKind::kFrontLaser : CarmenKind::kRobotLaser;
}

bool Survey::OdometryLinesCoverScans(CarmenKind scan_kind) const {
  constexpr TimeNs kMax = std::numeric_limits<TimeNs>::max();
  TimeNs scans[2] = {kMax, -kMax}, odometry[2] = {kMax, -kMax};
  for (const LineKey& line : lines_) {
    TimeNs* const bounds = line.kind == scan_kind               ? scans
                           : line.kind == CarmenKind::kOdometry ? odometry
                                                                : nullptr;
    if (bounds == nullptr || !line.plausible) continue;
    bounds[0] = std::min(bounds[0], line.time);
    bounds[1] = std::max(bounds[1], line.time);
  }
  if (5 * Count(CarmenKind::kOdometry) < Count(scan_kind)) return false;
  if (Count(CarmenKind::kOdometry) == 0) return false;
  const TimeNs slack = std::max<TimeNs>(2000000000, (scans[1] - scans[0]) / 50);
  return odometry[0] <= scans[0] + slack && odometry[1] >= scans[1] - slack;
}

Pose2 Survey::ChooseLaserPose(CarmenKind scan_kind,
                              std::vector<std::string>* warnings) const {
  const auto offsets = offsets_.find(scan_kind);
  if (offsets == offsets_.end()) return parameter_offset_;
  Pose2 offset;
  if (!FindConstantOffset(offsets->second, &offset)) {
    warnings->push_back(
        absl::StrCat(filename_,
                     ": the two poses of the scan lines differ by a varying "
                     "amount (a corrected log?); only the odometry pose is "
                     "used"));
    return parameter_offset_;
  }
  // Equal poses are no evidence: many loggers did not know where the laser is
  // mounted.
  const bool equal =
      std::hypot(offset.x, offset.y) < 1e-4 && std::abs(offset.theta) < 1e-4;
  return equal ? parameter_offset_ : offset;
}

void Survey::WarnOfIgnored(CarmenPlan* const plan) const {
  SensorSourceInfo& info = plan->info;
  if (!damage_.empty()) {
    info.warnings.push_back(absl::StrCat(
        damage_,
        lines_.empty() ? ""
                       : absl::StrCat(", to the stamp ",
                                      FormatTime(lines_.back().time), " s"),
        "; what is behind it is lost, and the last lines may be damaged"));
  }
  if (stamps_lost_) {
    info.warnings.push_back(absl::StrCat(
        filename_,
        ": the stamps do not put scans and odometry into an order; that of the "
        "lines is taken, ",
        ToSeconds(kLineSpacing), " s per line"));
  }
  if (malformed_.count > 0) {
    info.warnings.push_back(
        absl::StrCat(malformed_.first, "; ", malformed_.count,
                     malformed_.count == 1 ? " malformed line skipped"
                                           : " malformed lines skipped"));
  }
  if (is_cut_) {
    info.warnings.push_back(absl::StrCat(
        filename_, ":", lines_.back().number,
        ": the last line is truncated in or after its stamp; dropped"));
  }
  if (implausible_.count > 0) {
    const LineKey& first = lines_[implausible_.first];
    info.warnings.push_back(absl::StrFormat(
        "%s:%d: the stamp %s s is more than an hour from those around it; %d "
        "%s "
        "dropped",
        filename_, first.number, FormatTime(first.time), implausible_.count,
        implausible_.count == 1 ? "message" : "messages"));
  }
  int64_t num_other_lasers = Count(CarmenKind::kRearLaser);
  for (const CarmenKind kind :
       {CarmenKind::kFrontLaser, CarmenKind::kRobotLaser,
        CarmenKind::kRawLaser}) {
    if (kind != plan->scan_kind) num_other_lasers += Count(kind);
  }
  if (num_other_lasers > 0) {
    info.warnings.push_back(absl::StrCat(
        filename_, ": ", num_other_lasers,
        " scans of other lasers or in another format ignored (RLASER, ...)"));
  }
}

void Survey::ChooseOdometry(const std::string& odometry_source,
                            const int64_t disordered,
                            CarmenPlan* const plan) const {
  SensorSourceInfo& info = plan->info;
  const bool has_poses = plan->scan_kind != CarmenKind::kRawLaser;
  if (is_filter_log_ && odometry_source == "auto" && has_poses) {
    plan->use_scan_poses = true;
    info.warnings.push_back(absl::StrCat(
        filename_,
        ": the log of a particle filter; its corrected poses are taken for "
        "odometry (odometry source odom: without the corrections)"));
  } else if (odometry_source == "both") {
    plan->use_odometry_lines = true;
    plan->use_scan_poses = has_poses;
  } else if (odometry_source == "odom") {
    plan->use_odometry_lines = true;
  } else if (odometry_source == "scan") {
    plan->use_scan_poses = has_poses;
  } else {
    const bool cover = OdometryLinesCoverScans(plan->scan_kind);
    plan->use_odometry_lines =
        !has_poses || (cover && !AreDisordered(disordered));
    plan->use_scan_poses = !plan->use_odometry_lines;
    if (plan->use_scan_poses && cover) {
      info.warnings.push_back(absl::StrCat(
          filename_,
          ": stamps are too disordered to pair ODOM lines with scans; odometry "
          "is taken from the scan lines"));
    } else if (plan->use_scan_poses && Count(CarmenKind::kOdometry) > 0) {
      info.warnings.push_back(absl::StrCat(
          filename_,
          5 * Count(CarmenKind::kOdometry) < Count(plan->scan_kind)
              ? ": too few ODOM lines ("
              : ": other times in the ODOM lines than in those of scans (",
          Count(CarmenKind::kOdometry),
          "); odometry is taken from the scan lines"));
    }
  }
}

void Survey::OrderEvents(CarmenPlan* const plan) const {
  SensorSourceInfo& info = plan->info;
  std::vector<EventKey> keys;
  std::vector<int64_t> implausible;
  int64_t ordinal = 0;
  CarmenEvent events[2];
  for (const LineKey& line : lines_) {
    const int n =
        CarmenEventsOfLine(*plan, line.kind, line.time, &ordinal, events);
    for (int i = 0; i < n; ++i) {
      if (line.plausible) {
        keys.push_back(events[i].key);
      } else {
        implausible.push_back(events[i].key.ordinal);
      }
    }
  }
  plan->reordering = PlanReordering(keys, kMaxReorderWindow);
  if (!plan->reordering.dropped.empty()) {
    info.warnings.push_back(absl::StrCat(
        filename_, ": ", plan->reordering.dropped.size(),
        " messages more than ", kMaxReorderWindow, " messages late dropped"));
  }
  info.begin = std::numeric_limits<TimeNs>::max();
  info.end = 0;
  size_t next_dropped = 0;
  for (const EventKey& key : keys) {
    if (next_dropped < plan->reordering.dropped.size() &&
        plan->reordering.dropped[next_dropped] == key.ordinal) {
      ++next_dropped;
      continue;
    }
    ++(key.rank == 1 ? info.num_scans : info.num_odometry);
    info.begin = std::min(info.begin, key.time);
    info.end = std::max(info.end, key.time);
  }
  std::vector<int64_t>& dropped = plan->reordering.dropped;
  dropped.insert(dropped.end(), implausible.begin(), implausible.end());
  std::sort(dropped.begin(), dropped.end());
}

absl::StatusOr<CarmenPlan> Survey::Plan(
    const std::string& odometry_source) const {
  CarmenPlan plan;
  plan.scan_kind = scan_kind_;
  plan.is_filter_log = is_filter_log_;
  plan.is_damaged = !damage_.empty();
  plan.line_spacing = stamps_lost_ ? kLineSpacing : 0;
  SensorSourceInfo& info = plan.info;
  info.format = "carmen";
  if (Count(plan.scan_kind) == 0) {
    return absl::InvalidArgumentError(absl::StrCat(
        filename_, ": no laser scan (FLASER, ROBOTLASER1 or RAWLASER1) found",
        malformed_.count == 0
            ? "; is this a CARMEN log?"
            : absl::StrCat(", ", malformed_.count, " malformed lines, first ",
                           malformed_.first)));
  }
  WarnOfIgnored(&plan);
  const int64_t backward_scans = CountBackwards(lines_, plan.scan_kind);
  int64_t backward_odometry = CountBackwards(lines_, CarmenKind::kOdometry);
  ChooseOdometry(odometry_source, backward_scans + backward_odometry, &plan);
  plan.remove_corrections = is_filter_log_ && plan.use_odometry_lines;
  plan.laser_pose = ChooseLaserPose(plan.scan_kind, &info.warnings);
  plan.range_max = ranges_.at(plan.scan_kind).RangeMax();
  if (!plan.use_odometry_lines) backward_odometry = 0;
  info.num_out_of_order = backward_scans + backward_odometry;
  if (info.num_out_of_order > 0) {
    info.warnings.push_back(
        absl::StrFormat("%s: stamps of %d scans and %d odometry messages go "
                        "backwards; sorted",
                        filename_, backward_scans, backward_odometry));
  }
  // Sorting would mix what was driven before and after.
  const TimeNs step = LargestStepBack(lines_, plan.scan_kind);
  if (step > kMaxClockStep) {
    info.warnings.push_back(absl::StrFormat(
        "%s: the clock of the scans was set back by up to %.1f s: where the "
        "times overlap, scans of different places are mixed; split the log",
        filename_, ToSeconds(step)));
  }
  OrderEvents(&plan);
  return plan;
}

}  // namespace

int CarmenEventsOfLine(const CarmenPlan& plan, CarmenKind kind, TimeNs time,
                       int64_t* ordinal, CarmenEvent events[2]) {
  int n = 0;
  const auto add = [&](bool is_scan, bool inside_scan) {
    events[n].key = EventKey{time, is_scan ? 1 : 0, (*ordinal)++};
    events[n].is_scan = is_scan;
    events[n].inside_scan = inside_scan;
    ++n;
  };
  if (kind == CarmenKind::kOdometry) {
    if (plan.use_odometry_lines) add(false, false);
  } else if (kind == plan.scan_kind) {
    if (plan.use_scan_poses) add(false, true);
    add(true, false);
  }
  return n;
}

absl::StatusOr<CarmenPlan> SurveyCarmenLog(const std::string& filename,
                                           const std::string& odometry_source) {
  if (odometry_source != "auto" && odometry_source != "odom" &&
      odometry_source != "scan" && odometry_source != "both") {
    return absl::InvalidArgumentError(
        absl::StrCat("odometry source must be auto, odom, scan or both, not \"",
                     odometry_source, "\""));
  }
  Survey survey(filename);
  const absl::Status status = survey.Read();
  if (!status.ok()) return status;
  return survey.Plan(odometry_source);
}

}  // namespace io
}  // namespace cartographer_ext
