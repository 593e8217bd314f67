// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
//
// Selects the trials of a search from which the importance of keys is computed.
// Objectives on parts of the recordings cannot be compared with those on the
// whole. Trials on whole recordings are used if there are enough; a search by
// halving may have few, which are its best and differ little: then the trials
// on the most frequent part of the recordings are used.
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

// Makes the baseline the result if the held-out recordings do not confirm the
// gain.
void KeepIfConfirmed(double least_gain, TuneResult* result);

}  // namespace tuning
}  // namespace cartographer_ext

#endif  // CARTOGRAPHER_EXT_TUNING_COMPARABLE_TRIALS_H_
