// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
#ifndef CARTOGRAPHER_METRICS_REGISTER_H_
#define CARTOGRAPHER_METRICS_REGISTER_H_

#include "cartographer/metrics/family_factory.h"

namespace cartographer {
namespace metrics {

// Lets every class of the library report to `registry`, which must live on.
// Call it before any of them is used.
void RegisterAllMetrics(FamilyFactory* registry);

}  // namespace metrics
}  // namespace cartographer

#endif  // CARTOGRAPHER_METRICS_REGISTER_H_
