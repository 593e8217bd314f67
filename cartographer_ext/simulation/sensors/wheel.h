// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
#ifndef CARTOGRAPHER_EXT_SIMULATION_SENSORS_WHEEL_H_
#define CARTOGRAPHER_EXT_SIMULATION_SENSORS_WHEEL_H_

#include <cmath>

#include "cartographer_ext/common/random.h"

namespace cartographer_ext {
namespace simulation {

// One wheel with an encoder: true travel in, counted travel out.
class Wheel {
 public:
  Wheel(const double scale, const double noise, const double ticks_per_meter)
      : scale_(scale), noise_(noise), ticks_per_meter_(ticks_per_meter) {}

  // The change of the counted travel over a true change `travel` with extra
  // `slip`, all in metres.
  double Advance(const double travel, const double slip, Random* random) {
    turned_ += (1. + scale_) * travel + slip +
               noise_ * std::sqrt(std::abs(travel)) * random->Normal();
    const double counted =
        ticks_per_meter_ > 0.
            ? std::floor(turned_ * ticks_per_meter_) / ticks_per_meter_
            : turned_;
    const double change = counted - counted_;
    counted_ = counted;
    return change;
  }

 private:
  double scale_;
  double noise_;
  double ticks_per_meter_;
  double turned_ = 0.;
  double counted_ = 0.;
};

}  // namespace simulation
}  // namespace cartographer_ext

#endif  // CARTOGRAPHER_EXT_SIMULATION_SENSORS_WHEEL_H_
