// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
#include "cartographer_ext/repair/map_repair.h"

#include <utility>

#include "absl/strings/str_cat.h"
#include "absl/strings/str_format.h"
#include "absl/types/optional.h"
#include "cartographer_ext/io/pbstream/pbstream_validation.h"
#include "cartographer_ext/map/map_contents.h"
#include "cartographer_ext/map/pbstream_map.h"
#include "cartographer_ext/map/pbstream_optimization.h"
#include "cartographer_ext/map/verdict/motion_disagreement.h"
#include "cartographer_ext/optimization/offline/optimize.h"
#include "cartographer_ext/repair/conclusion.h"
#include "cartographer_ext/repair/kept_frame.h"
#include "cartographer_ext/repair/local_rerun.h"
#include "cartographer_ext/repair/store_graph.h"
#include "cartographer_ext/repair/stored_gyroscope.h"
#include "cartographer_ext/rerun/rerun.h"
#include "glog/logging.h"

namespace cartographer_ext {
namespace repair {
namespace {

using PbstreamPointer = std::shared_ptr<const io::Pbstream>;
using cartographer::mapping::proto::LocalTrajectoryBuilderOptions2D;
using cartographer::mapping::proto::PoseGraphOptions;

constexpr int64_t kMaxSearchedLoops = 400;

LocalTrajectoryBuilderOptions2D StoredLocalOptions(
    const io::Pbstream& pbstream) {
  for (const auto& options : pbstream.options.options_with_sensor_ids()) {
    if (options.trajectory_builder_options()
            .has_trajectory_builder_2d_options()) {
      return options.trajectory_builder_options()
          .trajectory_builder_2d_options();
    }
  }
  return {};
}

// The map optimised once more, without the loops that the method rejects; null
// with a reason where its graph cannot be optimised.
PbstreamPointer Optimize(const evaluation::MapGraph& graph,
                         const io::Pbstream& pbstream,
                         const std::string& method, std::string* const reason) {
  const auto map = evaluation::MakeMapPoseGraph(graph, {});
  if (!map.ok()) {
    *reason = std::string(map.status().message());
    return nullptr;
  }
  optimization::OptimizeOptions options;
  options.method = method;
  // Weights of a map are relative; their scale is a guess.
  options.adaptive_gate = false;
  options.estimate_noise = false;
  const auto solved = optimization::Optimize(map->graph, options);
  if (!solved.ok()) {
    *reason = std::string(solved.status().message());
    return nullptr;
  }
  std::vector<int> rejected;
  for (size_t i = 0; i != map->graph.edges.size(); ++i) {
    if (method != "huber" && !solved->accepted[i]) {
      rejected.push_back(map->constraint_of_edge[i]);
    }
  }
  auto result = std::make_shared<io::Pbstream>(pbstream);
  evaluation::StorePoses(*map, solved->poses, result.get());
  evaluation::DropConstraints(rejected, result.get());
  return result;
}

// The state of a repair: the best version so far, and how it came about.
class Repairer {
 public:
  Repairer(io::Pbstream pbstream, const RepairOptions& options)
      : options_(options),
        original_(std::make_shared<const io::Pbstream>(std::move(pbstream))) {
    result_.before = Assess(original_);
    best_ = result_.after = result_.before;
  }

  MapRepair Run() {
    if (!options_.dropped_loops.empty()) DropLoops();
    if (!options_.added_loops.empty()) AddLoops();
    if (!done()) JudgeLoopsAgain();
    RerunLocalSlamAlongChains();
    is_local_ = false;
    RunLoopClosure(true);
    RunLoopClosure(false);
    is_local_ = true;
    RepeatAlongBest();
    const std::string why_not =
        is_by_hand() ? ""
                     : WhyNotWritten(result_.before.quality, best_.quality);
    const bool is_better = best_.pbstream != original_;
    if (is_better && why_not.empty()) result_.after = best_;
    if (result_.changed()) Finish();
    Conclude(options_.keep_frame, &result_);
    if (is_better && !why_not.empty()) {
      absl::StrAppend(&result_.conclusion, "; ", why_not);
    }
    return std::move(result_);
  }

 private:
  // A map that cannot be judged may miss the loops that would tie it together.
  bool is_sound() const { return best_.consistency.word == "sound"; }

  // The map does not contradict itself, though little may tie it together.
  bool is_free_of_contradictions() const {
    const evaluation::SelfConsistency& consistency = best_.consistency;
    return consistency.word != "unknown" && consistency.places.empty() &&
           consistency.wrong_turns.empty();
  }

  // Who names loops by hand gets to a sound map in several runs.
  bool is_by_hand() const {
    return !options_.dropped_loops.empty() || !options_.added_loops.empty();
  }

  // New loops over bent submaps can make a map just sound; local SLAM has its
  // turn even then.
  bool done() const {
    return is_sound() &&
           (best_is_local_ || !options_.local || best_.pbstream == original_);
  }

  void Begin(const std::string& name) {
    RepairStep step;
    step.name = name;
    result_.steps.push_back(step);
    LOG(INFO) << name;
    if (options_.on_step) options_.on_step(name);
  }

  void Skip(const std::string& reason) { result_.steps.back().reason = reason; }

  // Keeps the version if it is better.
  MapVersion Consider(PbstreamPointer pbstream) {
    const auto problems = io::FindPbstreamProblems(*pbstream, 1);
    if (!problems.empty()) {
      Skip(absl::StrCat("its map is not valid: ", problems.front()));
      return best_;
    }
    MapVersion version = Assess(std::move(pbstream));
    RepairStep& step = result_.steps.back();
    step.has_quality = true;
    step.quality = version.quality;
    step.loops = version.graph.num_loops();
    const std::string why_not = WhyNotBetter(best_.quality, version.quality);
    step.kept = why_not.empty();
    step.reason =
        step.kept ? absl::StrCat("the map is better: ", ToText(version.quality))
                  : absl::StrCat(why_not, " (", ToText(version.quality), ")");
    LOG(INFO) << (step.kept ? "kept: " : "dropped: ") << step.reason;
    if (step.kept) {
      best_ = version;
      best_is_local_ = is_local_;
    }
    return version;
  }

  void DropLoops() {
    Begin("loops removed by hand");
    auto pbstream = std::make_shared<io::Pbstream>(*original_);
    evaluation::DropConstraints(options_.dropped_loops, pbstream.get());
    std::string reason;
    const PbstreamPointer solved = Optimize(evaluation::MakeMapGraph(*pbstream),
                                            *pbstream, "huber", &reason);
    if (solved == nullptr) {
      Skip(reason);
    } else {
      Consider(solved);
    }
  }

  void AddLoops() {
    Begin("loops added by hand");
    HandMatchOptions match;
    match.builder = options_.configuration.stock.constraint_builder_options();
    evaluation::MapGraph graph = best_.graph;
    std::string refused;
    for (const LoopByHand& loop : options_.added_loops) {
      const auto matched = MatchByHand(loop, graph, *original_, match);
      if (!matched.ok()) {
        absl::StrAppend(&refused, refused.empty() ? "" : "; ",
                        matched.status().message());
        continue;
      }
      evaluation::GraphConstraint constraint;
      constraint.submap_id = loop.submap_id;
      constraint.node_id = loop.node_id;
      constraint.relative_pose = matched->pose;
      constraint.translation_weight =
          match.builder.loop_closure_translation_weight();
      constraint.rotation_weight = match.builder.loop_closure_rotation_weight();
      constraint.is_loop = true;
      graph.constraints.push_back(constraint);
    }
    if (graph.constraints.size() == best_.graph.constraints.size()) {
      Skip(refused);
      return;
    }
    auto pbstream = std::make_shared<io::Pbstream>(*best_.pbstream);
    StoreGraph(graph, pbstream.get());
    std::string reason;
    const PbstreamPointer solved = Optimize(graph, *pbstream, "huber", &reason);
    if (solved == nullptr) {
      Skip(reason);
      return;
    }
    Consider(solved);
    if (refused.empty()) return;
    absl::StrAppend(&result_.steps.back().reason, "; not accepted: ", refused);
  }

  // Puts the map into its frame and leaves out what is not wanted.
  void Finish() {
    const Pose2 old_from_new =
        options_.keep_frame
            ? OldFromNewByNodes(result_.before.graph, result_.after.graph)
            : OldFromNewByStart(result_.before.graph, result_.after.graph);
    auto pbstream = std::make_shared<io::Pbstream>(*result_.after.pbstream);
    MoveMap(old_from_new, pbstream.get());
    result_.after = Assess(pbstream);
    // The verdict has used it.
    if (options_.drop_odometry) pbstream->odometry_data.clear();
    result_.faults = FindLocalFaults(result_.before.graph, result_.after.graph,
                                     LocalFaultOptions());
  }

  void JudgeLoopsAgain() {
    if (!options_.loops) return;
    Begin("loops re-evaluated");
    std::string reason;
    const PbstreamPointer judged = JudgeLoops(best_, &reason);
    if (judged == nullptr) {
      Skip(reason);
    } else {
      Consider(judged);
    }
  }

  // Global SLAM over `base` with our loop closure or with stock's, and its loops
  // judged again. Returns the better of the two versions, kept or not.
  absl::optional<MapVersion> CloseLoops(const std::string& prefix,
                                        const PbstreamPointer& base,
                                        const bool ours) {
    Begin(
        absl::StrCat(prefix, "loop closure re-run", ours ? "" : " with stock"));
    evaluation::RerunOptions rerun_options;
    rerun_options.num_background_threads = options_.num_background_threads;
    rerun_options.on_progress = options_.on_progress;
    const auto rerun = evaluation::RerunPoseGraph(
        *base,
        ours ? *options_.configuration.ours : options_.configuration.stock,
        rerun_options);
    if (!rerun.ok()) {
      Skip(std::string(rerun.status().message()));
      return absl::nullopt;
    }
    auto pbstream = std::make_shared<io::Pbstream>(*base);
    StoreGraph(rerun->graph, pbstream.get());
    MapVersion version = Consider(pbstream);
    Begin(absl::StrCat(result_.steps.back().name, ", its loops re-evaluated"));
    std::string reason;
    const PbstreamPointer judged = JudgeLoops(version, &reason);
    if (judged == nullptr) {
      Skip(reason);
      return version;
    }
    MapVersion after = Consider(judged);
    return WhyNotBetter(version.quality, after.quality).empty()
               ? std::move(after)
               : std::move(version);
  }

  // Local SLAM along `chain` and loops over it. The best outcome of any chain is
  // remembered, kept or not: stock's loop closure, which takes long, is run over
  // that one only.
  void RerunAlong(const std::string& name, const MotionChain& chain,
                  const NodeMatching matching, const bool use_gyroscope) {
    if (done() || chain.empty()) return;
    const auto rerun = RerunLocalSlam(
        *original_, chain, matching, use_gyroscope,
        OptionsForClouds(options_.local_slam, StoredLocalOptions(*original_)));
    if (!rerun.ok()) {
      Begin(name);
      Skip(std::string(rerun.status().message()));
      return;
    }
    const auto base = std::make_shared<const io::Pbstream>(*rerun);
    const bool has_ours = options_.configuration.ours.has_value();
    const auto version = CloseLoops(absl::StrCat(name, ", "), base, has_ours);
    if (!has_ours || !version.has_value()) return;
    if (!best_local_.has_value() ||
        WhyNotBetter(best_local_->quality, version->quality).empty()) {
      best_local_ = version;
      best_base_ = base;
      best_name_ = name;
    }
  }

  void RunLoopClosure(const bool ours) {
    if (is_sound() || !options_.loops ||
        (!ours && is_free_of_contradictions()) ||
        (ours && !options_.configuration.ours.has_value())) {
      return;
    }
    CloseLoops("", original_, ours);
  }

  void RerunLocalSlamAlongChains() {
    if (done() || !options_.local) return;
    is_local_ = true;
    const MotionChain stored = LocalChain(*original_);
    const MotionChain mixed = MixedChain(*original_);
    const MotionChain wheels = OdometryChain(*original_);
    const bool has_gyroscope = !StoredGyroscopeReadings(*original_).empty();
    if (has_gyroscope) {
      RerunAlong("local SLAM re-run with gyroscope and the recorded odometry",
                 wheels, NodeMatching::kRecordedOdometry, true);
    }
    RerunAlong("local SLAM re-run with the recorded odometry", wheels,
               NodeMatching::kRecordedOdometry, false);
    const std::string name = has_gyroscope ? "local SLAM re-run with gyroscope"
                                           : "local SLAM re-run";
    RerunAlong(absl::StrCat(name, ", with odometry where the two differ"),
               mixed, NodeMatching::kFrontEnd, has_gyroscope);
    RerunAlong(name, stored, NodeMatching::kFrontEnd, has_gyroscope);
    if (is_free_of_contradictions() || best_base_ == nullptr) return;
    CloseLoops(absl::StrCat(best_name_, ", "), best_base_, false);
  }

  // Corrected loops help local SLAM to follow, and vice versa.
  void RepeatAlongBest() {
    if (!options_.local) return;
    for (int i = 0; i < options_.max_rounds && !done(); ++i) {
      const PbstreamPointer before = best_.pbstream;
      const MotionChain best = GlobalChain(*original_, best_.graph);
      RerunAlong("submaps rebuilt along the best map so far", best,
                 NodeMatching::kNone, false);
      if (before == best_.pbstream) break;
    }
  }

  const RepairOptions options_;
  const PbstreamPointer original_;
  MapRepair result_;
  MapVersion best_;        // so far
  bool is_local_ = false;  // the steps that run now
  bool best_is_local_ = false;
  // Of local SLAM run again with our loop closure.
  absl::optional<MapVersion> best_local_;
  PbstreamPointer best_base_;
  std::string best_name_;
};

}  // namespace

MapVersion Assess(PbstreamPointer pbstream) {
  MapVersion version;
  version.graph = evaluation::MakeMapGraph(*pbstream);
  version.consistency = evaluation::AssessSelfConsistency(
      version.graph, evaluation::ReadMapContents(*pbstream, {}),
      evaluation::ReadOdometry(*pbstream), {});
  version.quality = QualityOf(version.graph, version.consistency);
  version.pbstream = std::move(pbstream);
  return version;
}

PbstreamPointer JudgeLoops(const MapVersion& version,
                           std::string* const reason) {
  if (version.graph.num_loops() == 0) {
    *reason = "the map has no loops";
    return nullptr;
  }
  // The search over many solvers takes minutes on thousands of loops, which
  // outvote wrong ones anyway.
  return Optimize(
      version.graph, *version.pbstream,
      version.graph.num_loops() <= kMaxSearchedLoops ? "auto" : "gnc_tls",
      reason);
}

absl::StatusOr<MapRepair> RepairMap(io::Pbstream pbstream,
                                    const RepairOptions& options) {
  if (pbstream.nodes.empty() || pbstream.submaps.empty()) {
    return absl::InvalidArgumentError(
        "a map without nodes or submaps cannot be repaired");
  }
  return Repairer(std::move(pbstream), options).Run();
}

}  // namespace repair
}  // namespace cartographer_ext
