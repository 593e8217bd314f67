// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
//
// State that our classes share about one pose graph.
//
// Cartographer builds the classes that we replace (constraint builder,
// optimization problem, local trajectory builder) deep inside MapBuilder and
// PoseGraph2D and passes none of them a handle to their pose graph. A context
// is that handle. It is shared and owned by the objects of one pose graph and
// freed with the last of them; there is no process-wide table. It is passed by
// scope, on the thread that makes the call:
//
//   construction  A program that wants to read the context (records, statistics
//                 of the optimization) puts a scope around CreateMapBuilder()
//                 and AddTrajectoryBuilder(). Constructors keep Current().
//   optimization  PoseGraph2D optimizes within the callback that it passes to
//                 ConstraintBuilder2D::WhenDone(). Our builder puts a scope
//                 around this call, so that OptimizationProblem2D::Solve() sees
//                 the context of the builder of the same pose graph.
//
// Without a scope, as in an unedited program, each constraint builder creates
// its own context; a local trajectory builder has none and records nothing.
//
//   auto context = std::make_shared<PoseGraphContext>();
//   {
//     const ScopedPoseGraphContext scope(context);
//     map_builder = mapping::CreateMapBuilder(options);
//   }
//   ...
//   context->Get<loop_closure::DecisionRecorder>()->All();
//
// The parts are objects of the modules, one of each type, default-constructed
// on first use. Get() may be called by several threads at once; parts used by
// several threads are thread-safe themselves, and bounded.
#ifndef CARTOGRAPHER_EXT_COMMON_POSE_GRAPH_CONTEXT_H_
#define CARTOGRAPHER_EXT_COMMON_POSE_GRAPH_CONTEXT_H_

#include <map>
#include <memory>
#include <typeindex>
#include <typeinfo>

#include "absl/base/thread_annotations.h"
#include "absl/synchronization/mutex.h"

namespace cartographer_ext {

// The shared state of one pose graph, see above. Get() is thread-safe.
class PoseGraphContext {
 public:
  PoseGraphContext() = default;
  PoseGraphContext(const PoseGraphContext&) = delete;
  PoseGraphContext& operator=(const PoseGraphContext&) = delete;

  // The part of this type; it lives as long as the context.
  template <typename Part>
  Part* Get() ABSL_LOCKS_EXCLUDED(mutex_) {
    const absl::MutexLock lock(&mutex_);
    std::shared_ptr<void>& part = parts_[std::type_index(typeid(Part))];
    if (part == nullptr) part = std::make_shared<Part>();
    return static_cast<Part*>(part.get());
  }

  // The context of the innermost scope on this thread, null without one.
  static std::shared_ptr<PoseGraphContext> Current();
  // The same, with a new context instead of null.
  static std::shared_ptr<PoseGraphContext> CurrentOrNew();

 private:
  absl::Mutex mutex_;
  std::map<std::type_index, std::shared_ptr<void>> parts_
      ABSL_GUARDED_BY(mutex_);
};

// Makes a context the current one of this thread during the lifetime of the
// scope. Scopes nest and end in reverse order, on the thread that created them.
// With null the scope hides the enclosing ones.
class ScopedPoseGraphContext {
 public:
  explicit ScopedPoseGraphContext(std::shared_ptr<PoseGraphContext> context);
  ~ScopedPoseGraphContext();
  ScopedPoseGraphContext(const ScopedPoseGraphContext&) = delete;
  ScopedPoseGraphContext& operator=(const ScopedPoseGraphContext&) = delete;

 private:
  friend class PoseGraphContext;

  const std::shared_ptr<PoseGraphContext> context_;
  const ScopedPoseGraphContext* const outer_;
};

}  // namespace cartographer_ext

#endif  // CARTOGRAPHER_EXT_COMMON_POSE_GRAPH_CONTEXT_H_
