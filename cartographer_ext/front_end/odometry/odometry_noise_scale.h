// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
//
// How much better the odometry of a run is than the noise it is given credit
// for: a variance component, estimated from the innovations of the scan
// matches (Mehra 1970, innovation-based adaptive filtering).
//
// Along a direction that the scan determines, a match differs from the
// prediction by an innovation of variance
//
//   E[v^2] = s P + R,
//
// R the variance of the match, P that of odometry by the options, s the scale
// sought. With sums that forget,
//
//   s = (B_0 + sum (v^2 - R)) / (B_0 + sum P),   least <= s <= 1,
//
// where B_0 stands for `prior_samples` innovations as the options expect them.
// A laser that sees a wide room hardly notices s: R is small against P either
// way. One that sees 57 degrees of it errs by more than the wheels do from scan
// to scan, and with s = 1 every match would be taken for better than it is.
#ifndef CARTOGRAPHER_EXT_FRONT_END_ODOMETRY_ODOMETRY_NOISE_SCALE_H_
#define CARTOGRAPHER_EXT_FRONT_END_ODOMETRY_ODOMETRY_NOISE_SCALE_H_

namespace cartographer_ext {
namespace front_end {

// v^2, R and P of a match, square metres or square radians. One without P tells
// nothing.
struct SquaredInnovation {
  double squared = 0.;
  double match_variance = 0.;
  double prediction_variance = 0.;
};

// Prior and memory of the estimate.
struct OdometryNoiseScaleOptions {
  double prior_samples = 50.;
  double memory = 500.;  // innovations after which one counts 1 / e
  // Innovations show what odometry errs from scan to scan, not the errors of
  // scale and heading that add up over a submap: it is not trusted further.
  double least = 0.5;
};

// Estimates the noise scale of odometry, see above. Not thread-safe.
class OdometryNoiseScale {
 public:
  explicit OdometryNoiseScale(const OdometryNoiseScaleOptions& options)
      : options_(options) {}

  // The variance of the prediction is that without the scale.
  void Add(const SquaredInnovation& innovation);

  // Forgets all.
  void Restart();

  // s, of the variance; 1 before the first innovation.
  double scale() const { return scale_; }

 private:
  const OdometryNoiseScaleOptions options_;
  double excess_ = 0.;    // sum of v^2 - R
  double expected_ = 0.;  // sum of P
  double weight_ = 0.;    // sum of ones
  double scale_ = 1.;
};

}  // namespace front_end
}  // namespace cartographer_ext

#endif  // CARTOGRAPHER_EXT_FRONT_END_ODOMETRY_ODOMETRY_NOISE_SCALE_H_
