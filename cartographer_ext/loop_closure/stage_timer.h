// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
#ifndef CARTOGRAPHER_EXT_LOOP_CLOSURE_STAGE_TIMER_H_
#define CARTOGRAPHER_EXT_LOOP_CLOSURE_STAGE_TIMER_H_

#include "cartographer_ext/common/thread_time.h"

namespace cartographer_ext {
namespace loop_closure {

// Writes the CPU seconds that the thread spends while this exists, where times
// are asked for.
class StageTimer {
 public:
  StageTimer(const bool asked_for, double* const seconds)
      : seconds_(asked_for ? seconds : nullptr),
        start_(asked_for ? ThreadCpuSeconds() : 0.) {}
  ~StageTimer() {
    if (seconds_ != nullptr) *seconds_ = ThreadCpuSeconds() - start_;
  }
  StageTimer(const StageTimer&) = delete;
  StageTimer& operator=(const StageTimer&) = delete;

 private:
  double* const seconds_;
  const double start_;
};

}  // namespace loop_closure
}  // namespace cartographer_ext

#endif  // CARTOGRAPHER_EXT_LOOP_CLOSURE_STAGE_TIMER_H_
