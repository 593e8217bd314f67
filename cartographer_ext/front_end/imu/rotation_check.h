// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
//
// Compares a gyroscope with another sensor of rotation.
//
//   rotation = factor * rotation by the gyroscope + drift * time
//
// (drift = - factor * bias) is estimated by a CalibrationFilter; the gyroscope is
// the less noisy of both. Beside a sensor that drifts itself, as wheels of unequal
// size, the bias is observable at standstill only. The gyroscope is proven once
// the factor is known and near one, and refuted once the factor is known and far
// from one, or where the two contradict each other time and again.
#ifndef CARTOGRAPHER_EXT_FRONT_END_IMU_ROTATION_CHECK_H_
#define CARTOGRAPHER_EXT_FRONT_END_IMU_ROTATION_CHECK_H_

#include "cartographer_ext/front_end/calibration_filter.h"

namespace cartographer_ext {
namespace front_end {

enum class GyroscopeState { kUnproven, kProven, kRefuted };

// See above. Not thread-safe.
class RotationCheck {
 public:
  // `length` of the noise is a time, seconds. `drifts`: the other sensor does.
  RotationCheck(const CalibrationFilter::Noise& noise, bool drifts);

  struct Stretch {
    double seconds = 0.;
    double measured = 0.;  // as received from the gyroscope, radians
    double angle = 0.;     // by the other sensor
    // Standard deviations of the latter beyond the noise: at the end, and of an
    // error that stays.
    double sigma = 0.;
    double walk = 0.;
    bool is_at_rest = false;  // where no sensor drifts
  };
  void Add(const Stretch& stretch);
  // The next stretch does not continue the last one.
  void Restart() { filter_.Restart(); }
  // The bias of the gyroscope is known, rad/s.
  void SetBias(double bias, double sigma);

  GyroscopeState state() const;
  bool factor_is_known() const;
  double factor() const { return filter_.value(0); }
  double factor_sigma() const { return filter_.sigma(0); }
  // The drift and its variance, rad/s and its square, from the filter and a prior:
  // most gyroscopes are calibrated at rest by their drivers, a few are not.
  struct Drift {
    double value;
    double variance;
  };
  Drift EstimateDrift() const;

 private:
  const bool drifts_;
  CalibrationFilter filter_;
  // Of the last stretches, forgotten slowly: how many there were, and how many
  // contradicted the filter.
  double compared_ = 0.;
  double contradicted_ = 0.;
};

}  // namespace front_end
}  // namespace cartographer_ext

#endif  // CARTOGRAPHER_EXT_FRONT_END_IMU_ROTATION_CHECK_H_
