// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
#include "cartographer_ext/loop_closure/innovation_veto.h"

namespace cartographer_ext {
namespace loop_closure {

InnovationResult TestInnovation(const InnovationOptions& options,
                                const UncertainPose& prior,
                                const UncertainPose& loop) {
  // The cycle test with certain, empty paths asks the same.
  CycleConsistencyOptions cycle;
  cycle.test = CycleTest::kChiSquare;
  cycle.chi_square_bound = options.chi_square_bound;
  const CycleResult test = TestCycle(cycle, Invert(prior), UncertainPose(),
                                     Invert(loop), UncertainPose());
  InnovationResult result;
  result.innovation = test.error;
  result.chi_square = test.chi_square;
  result.vetoed = !test.compatible;
  return result;
}

}  // namespace loop_closure
}  // namespace cartographer_ext
