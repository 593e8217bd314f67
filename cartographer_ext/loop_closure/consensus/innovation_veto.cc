// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
#include "cartographer_ext/loop_closure/consensus/innovation_veto.h"

namespace cartographer_ext {
namespace loop_closure {

InnovationResult TestInnovation(const InnovationOptions& options,
                                const uncertainty::UncertainPose& prior,
                                const uncertainty::UncertainPose& loop) {
  // The cycle test with certain, empty paths asks the same.
  uncertainty::CycleConsistencyOptions cycle;
  cycle.test = uncertainty::CycleTest::kChiSquare;
  cycle.chi_square_bound = options.chi_square_bound;
  const uncertainty::CycleResult test =
      uncertainty::TestCycle(cycle, Invert(prior), uncertainty::UncertainPose(),
                             Invert(loop), uncertainty::UncertainPose());
  InnovationResult result;
  result.innovation = test.error;
  result.chi_square = test.chi_square;
  result.vetoed = !test.compatible;
  return result;
}

}  // namespace loop_closure
}  // namespace cartographer_ext
