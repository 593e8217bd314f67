// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
#include "cartographer/mapping/internal/constraints/constraint_builder_2d.h"

#include <cmath>
#include <sstream>
#include <utility>

#include "absl/memory/memory.h"
#include "absl/strings/str_format.h"
#include "cartographer/common/time.h"
#include "cartographer/metrics/counter.h"
#include "cartographer/metrics/gauge.h"
#include "cartographer/metrics/histogram.h"
#include "cartographer/transform/transform.h"
#include "glog/logging.h"

namespace cartographer {
namespace mapping {
namespace constraints {
namespace {

// Once for pairs searched in a window, once for those in the whole submap.
struct SearchMetrics {
  metrics::Counter* searched = metrics::Counter::Null();
  metrics::Counter* found = metrics::Counter::Null();
  metrics::Histogram* scores = metrics::Histogram::Null();
};

SearchMetrics local_metrics;
SearchMetrics global_metrics;
metrics::Gauge* queue_length_metric = metrics::Gauge::Null();
metrics::Gauge* num_matchers_metric = metrics::Gauge::Null();
metrics::Counter* search_cpu_metric = metrics::Counter::Null();
metrics::Counter* build_cpu_metric = metrics::Counter::Null();

// Counts the CPU seconds that the thread spends while this exists.
class CpuMeter {
 public:
  explicit CpuMeter(metrics::Counter* const counter) : counter_(counter) {}
  ~CpuMeter() {
    counter_->Increment(common::GetThreadCpuTimeSeconds() - start_);
  }
  CpuMeter(const CpuMeter&) = delete;
  CpuMeter& operator=(const CpuMeter&) = delete;

 private:
  metrics::Counter* const counter_;
  const double start_ = common::GetThreadCpuTimeSeconds();
};

}  // namespace

transform::Rigid2d ComputeSubmapPose(const Submap2D& submap) {
  return transform::Project2D(submap.local_pose());
}

ConstraintBuilder2D::ConstraintBuilder2D(
    const proto::ConstraintBuilderOptions& options,
    common::ThreadPoolInterface* const thread_pool)
    : options_(options),
      thread_pool_(thread_pool),
      ceres_scan_matcher_(options.ceres_scan_matcher_options()),
      end_of_node_task_(absl::make_unique<common::Task>()),
      callback_task_(absl::make_unique<common::Task>()) {}

ConstraintBuilder2D::~ConstraintBuilder2D() {
  absl::MutexLock lock(&mutex_);
  CHECK(callback_ == nullptr) << "a callback is due";
  CHECK(slots_.empty()) << "constraints were never collected";
  CHECK_EQ(num_started_nodes_, num_finished_nodes_);
}

void ConstraintBuilder2D::MaybeAddConstraint(
    const SubmapId& submap_id, const Submap2D* const submap,
    const NodeId& node_id, const TrajectoryNode::Data* const constant_data,
    const transform::Rigid2d& initial_relative_pose) {
  if (initial_relative_pose.translation().norm() >
      options_.max_constraint_distance()) {
    return;
  }
  absl::MutexLock lock(&mutex_);
  SubmapEntry* const entry = FindOrCreateEntry(submap_id);
  if (entry->sampler.Pulse()) {
    Schedule(
        Pair{submap_id, submap, node_id, constant_data, initial_relative_pose},
        entry);
  }
}

void ConstraintBuilder2D::MaybeAddGlobalConstraint(
    const SubmapId& submap_id, const Submap2D* const submap,
    const NodeId& node_id, const TrajectoryNode::Data* const constant_data) {
  absl::MutexLock lock(&mutex_);
  Schedule(Pair{submap_id, submap, node_id, constant_data, absl::nullopt},
           FindOrCreateEntry(submap_id));
}

void ConstraintBuilder2D::NotifyEndOfNode() {
  absl::MutexLock lock(&mutex_);
  ++num_started_nodes_;
  end_of_node_task_->SetWorkItem([this]() {
    absl::MutexLock lock(&mutex_);
    ++num_finished_nodes_;
  });
  callback_task_->AddDependency(
      thread_pool_->Schedule(std::move(end_of_node_task_)));
  end_of_node_task_ = absl::make_unique<common::Task>();
}

void ConstraintBuilder2D::WhenDone(
    const std::function<void(const Result&)>& callback) {
  absl::MutexLock lock(&mutex_);
  CHECK(callback_ == nullptr) << "WhenDone was called twice";
  callback_ = callback;
  callback_task_->SetWorkItem([this]() { CallBack(); });
  thread_pool_->Schedule(std::move(callback_task_));
  callback_task_ = absl::make_unique<common::Task>();
}

int ConstraintBuilder2D::GetNumFinishedNodes() {
  absl::MutexLock lock(&mutex_);
  return num_finished_nodes_;
}

void ConstraintBuilder2D::DeleteScanMatcher(const SubmapId& submap_id) {
  absl::MutexLock lock(&mutex_);
  LOG_IF(WARNING, callback_ != nullptr)
      << "submap " << submap_id << " is dropped while it is being searched";
  const auto it = submaps_.find(submap_id);
  if (it == submaps_.end()) {
    return;
  }
  if (it->second.has_matcher) {
    num_matchers_metric->Set(--num_matchers_);
  }
  submaps_.erase(it);
}

ConstraintBuilder2D::SubmapEntry* ConstraintBuilder2D::FindOrCreateEntry(
    const SubmapId& submap_id) {
  return &submaps_
              .emplace(std::piecewise_construct,
                       std::forward_as_tuple(submap_id),
                       std::forward_as_tuple(options_.sampling_ratio()))
              .first->second;
}

void ConstraintBuilder2D::Schedule(const Pair& pair, SubmapEntry* const entry) {
  LOG_IF(WARNING, callback_ != nullptr)
      << "node " << pair.node_id << " comes while a callback is due";
  ScheduleMatcher(pair.submap, entry);
  slots_.emplace_back();
  queue_length_metric->Set(slots_.size());
  absl::optional<Constraint>* const slot = &slots_.back();
  auto task = absl::make_unique<common::Task>();
  task->SetWorkItem(
      [this, pair, entry, slot]() { *slot = Search(pair, *entry->matcher); });
  task->AddDependency(entry->matcher_task);
  end_of_node_task_->AddDependency(thread_pool_->Schedule(std::move(task)));
}

void ConstraintBuilder2D::ScheduleMatcher(const Submap2D* const submap,
                                          SubmapEntry* const entry) {
  if (entry->has_matcher) {
    return;
  }
  entry->has_matcher = true;
  num_matchers_metric->Set(++num_matchers_);
  auto task = absl::make_unique<common::Task>();
  task->SetWorkItem([this, submap, entry]() {
    const CpuMeter meter(build_cpu_metric);
    entry->matcher =
        absl::make_unique<scan_matching::FastCorrelativeScanMatcher2D>(
            *submap->grid(), options_.fast_correlative_scan_matcher_options());
  });
  entry->matcher_task = thread_pool_->Schedule(std::move(task));
}

absl::optional<ConstraintBuilder2D::Constraint> ConstraintBuilder2D::Search(
    const Pair& pair,
    const scan_matching::FastCorrelativeScanMatcher2D& matcher) {
  const CpuMeter meter(search_cpu_metric);
  const sensor::PointCloud& cloud =
      pair.node->filtered_gravity_aligned_point_cloud;
  const transform::Rigid2d submap_pose = ComputeSubmapPose(*pair.submap);
  const bool is_local = pair.initial_relative_pose.has_value();
  const SearchMetrics& search_metrics =
      is_local ? local_metrics : global_metrics;

  // 1. The best pose on the grid.
  search_metrics.searched->Increment();
  float score = 0.f;
  auto pose_estimate = transform::Rigid2d::Identity();
  const bool found =
      is_local ? matcher.Match(submap_pose * *pair.initial_relative_pose, cloud,
                               options_.min_score(), &score, &pose_estimate)
               : matcher.MatchFullSubmap(
                     cloud, options_.global_localization_min_score(), &score,
                     &pose_estimate);
  if (!found) {
    return absl::nullopt;
  }
  search_metrics.found->Increment();
  search_metrics.scores->Observe(score);
  {
    absl::MutexLock lock(&mutex_);
    scores_.Add(score);
  }

  // 2. Between the cells.
  ceres::Solver::Summary unused_summary;
  ceres_scan_matcher_.Match(pose_estimate.translation(), pose_estimate, cloud,
                            *pair.submap->grid(), &pose_estimate,
                            &unused_summary);
  if (options_.log_matches()) {
    LogMatch(pair, score, pose_estimate);
  }
  return Constraint{pair.submap_id, pair.node_id,
                    Constraint::Pose{transform::Embed3D(submap_pose.inverse() *
                                                        pose_estimate),
                                     options_.loop_closure_translation_weight(),
                                     options_.loop_closure_rotation_weight()},
                    Constraint::INTER_SUBMAP};
}

void ConstraintBuilder2D::LogMatch(
    const Pair& pair, const float score,
    const transform::Rigid2d& pose_estimate) const {
  std::ostringstream line;
  line << "match of node " << pair.node_id << " ("
       << pair.node->filtered_gravity_aligned_point_cloud.size()
       << " points) with submap " << pair.submap_id
       << absl::StrFormat(", score %.3f", score);
  if (pair.initial_relative_pose.has_value()) {
    const transform::Rigid2d correction =
        (ComputeSubmapPose(*pair.submap) * *pair.initial_relative_pose)
            .inverse() *
        pose_estimate;
    line << absl::StrFormat(", corrected by %.2f m and %.3f rad",
                            correction.translation().norm(),
                            std::abs(correction.normalized_angle()));
  }
  LOG(INFO) << line.str();
}

void ConstraintBuilder2D::CallBack() {
  Result result;
  std::function<void(const Result&)> callback;
  {
    absl::MutexLock lock(&mutex_);
    for (const absl::optional<Constraint>& slot : slots_) {
      if (slot.has_value()) {
        result.push_back(*slot);
      }
    }
    if (options_.log_matches()) {
      LOG(INFO) << slots_.size() << " searches found " << result.size()
                << " constraints. Scores so far:\n"
                << scores_.ToString(10);
    }
    slots_.clear();
    queue_length_metric->Set(0);
    std::swap(callback, callback_);
  }
  // The builder may be destroyed once this returns.
  callback(result);
}

void ConstraintBuilder2D::RegisterMetrics(
    metrics::FamilyFactory* const family_factory) {
  auto* const constraints = family_factory->NewCounterFamily(
      "mapping_constraints_constraint_builder_2d_constraints",
      "Pairs searched, and constraints found among them");
  auto* const scores = family_factory->NewHistogramFamily(
      "mapping_constraints_constraint_builder_2d_scores",
      "Scores of the constraints found",
      metrics::Histogram::FixedWidth(0.05, 20));
  const auto add = [constraints, scores](const std::string& region) {
    SearchMetrics result;
    result.searched =
        constraints->Add({{"search_region", region}, {"matcher", "searched"}});
    result.found =
        constraints->Add({{"search_region", region}, {"matcher", "found"}});
    result.scores = scores->Add({{"search_region", region}});
    return result;
  };
  local_metrics = add("local");
  global_metrics = add("global");
  queue_length_metric =
      family_factory
          ->NewGaugeFamily(
              "mapping_constraints_constraint_builder_2d_queue_length",
              "Pairs added since the last callback")
          ->Add({});
  num_matchers_metric =
      family_factory
          ->NewGaugeFamily(
              "mapping_constraints_constraint_builder_2d_num_submap_scan_"
              "matchers",
              "Submaps with a scan matcher")
          ->Add({});
  auto* const cpu_seconds = family_factory->NewCounterFamily(
      "mapping_constraints_constraint_builder_2d_search_cpu_seconds",
      "CPU seconds spent on searching and on preparing submaps for it");
  search_cpu_metric = cpu_seconds->Add({{"stage", "search"}});
  build_cpu_metric = cpu_seconds->Add({{"stage", "build"}});
}

}  // namespace constraints
}  // namespace mapping
}  // namespace cartographer
