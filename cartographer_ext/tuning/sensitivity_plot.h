// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
//
// A picture of a search: one small plot for each key, a dot for each trial that
// can be compared (see comparable_trials.h), objective over value.
#ifndef CARTOGRAPHER_EXT_TUNING_SENSITIVITY_PLOT_H_
#define CARTOGRAPHER_EXT_TUNING_SENSITIVITY_PLOT_H_

#include <string>

#include "absl/status/status.h"
#include "cartographer_ext/tuning/result_writer.h"
#include "cartographer_ext/tuning/tuner.h"

namespace cartographer_ext {
namespace tuning {

// Keys with the largest effect first. The best trial is ringed (a line
// where the dots are trials on parts of the recordings), the value before is a
// dashed line, the median of each quarter of the range a bar. The
// objective's axis is logarithmic where all are above zero. Written atomically,
// as SVG when the name ends in .svg, else as PNG.
absl::Status WriteSensitivityPlot(const TuneResult& result,
                                  const ResultContext& context,
                                  const std::string& filename);

}  // namespace tuning
}  // namespace cartographer_ext

#endif  // CARTOGRAPHER_EXT_TUNING_SENSITIVITY_PLOT_H_
