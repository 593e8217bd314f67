// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
//
// From which trials of a search can be computed how much a key matters? Objectives of parts of
// the recordings cannot be held against those of the whole. Trials on whole
// recordings are taken where there are enough; a search by halving may have
// few, and these are its best, so that they differ little: then those of the
// part of the recordings that most were tried on.
#ifndef CARTOGRAPHER_EXT_TUNING_COMPARABLE_TRIALS_H_
#define CARTOGRAPHER_EXT_TUNING_COMPARABLE_TRIALS_H_

#include <string>
#include <vector>

#include "cartographer_ext/tuning/parameter_space.h"
#include "cartographer_ext/tuning/tuner.h"

namespace cartographer_ext {
namespace tuning {

struct ComparableTrials {
  double fidelity = 1.;  // share of the recordings they were run on
  std::vector<Point> points;
  std::vector<double> objectives;
};

ComparableTrials SelectComparable(const std::vector<Trial>& trials);

// "27 trials on the first 33 % of the recordings"
std::string ToText(const ComparableTrials& trials);

// The baseline becomes the result where the held-out recordings do not confirm
// what was found.
void KeepIfConfirmed(double least_gain, TuneResult* result);

}  // namespace tuning
}  // namespace cartographer_ext

#endif  // CARTOGRAPHER_EXT_TUNING_COMPARABLE_TRIALS_H_
