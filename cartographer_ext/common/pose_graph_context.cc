// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
#include "cartographer_ext/common/pose_graph_context.h"

#include <utility>

namespace cartographer_ext {
namespace {

thread_local const ScopedPoseGraphContext* innermost_scope = nullptr;

}  // namespace

std::shared_ptr<PoseGraphContext> PoseGraphContext::Current() {
  return innermost_scope == nullptr ? nullptr : innermost_scope->context_;
}

std::shared_ptr<PoseGraphContext> PoseGraphContext::CurrentOrNew() {
  std::shared_ptr<PoseGraphContext> current = Current();
  return current != nullptr ? current : std::make_shared<PoseGraphContext>();
}

ScopedPoseGraphContext::ScopedPoseGraphContext(
    std::shared_ptr<PoseGraphContext> context)
    : context_(std::move(context)), outer_(innermost_scope) {
  innermost_scope = this;
}

ScopedPoseGraphContext::~ScopedPoseGraphContext() { innermost_scope = outer_; }

}  // namespace cartographer_ext
