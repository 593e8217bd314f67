// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
#include "cartographer_ext/optimization/graph/relaxation.h"

#include <functional>

namespace cartographer_ext {
namespace optimization {
namespace {

thread_local const ScopedRelaxation* innermost_scope = nullptr;

}  // namespace

ScopedRelaxation::ScopedRelaxation(const Relaxation& relaxation,
                                   const void* const constraints_begin,
                                   const void* const constraints_end)
    : relaxation_(relaxation),
      constraints_begin_(constraints_begin),
      constraints_end_(constraints_end),
      outer_(innermost_scope) {
  innermost_scope = this;
}

ScopedRelaxation::~ScopedRelaxation() { innermost_scope = outer_; }

const ScopedRelaxation* ScopedRelaxation::Current() { return innermost_scope; }

double ScopedRelaxation::StepScale(const void* const pose,
                                   const double translation_weight,
                                   const double rotation_weight) const {
  if (translation_weight != relaxation_.step_translation_weight ||
      rotation_weight != relaxation_.step_rotation_weight) {
    return 0.;
  }
  const std::less<const void*> before{};
  const bool is_constraint =
      !before(pose, constraints_begin_) && before(pose, constraints_end_);
  return is_constraint ? 0. : factor() * relaxation_.step_huber_scale;
}

}  // namespace optimization
}  // namespace cartographer_ext
