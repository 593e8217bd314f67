// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
//
// The noise of the ranges of a laser, learnt from its scans.
//
// A straight surface is a line in polar coordinates, too: with u = 1 / r,
//
//   u(phi) = a cos(phi) + b sin(phi),
//
// so of three beams beside each other the one in the middle is known by those
// beside it. By how much it differs is the noise where the surface is straight. The
// noise of cheap lasers grows with the range, so it is learnt for each half octave.
//
// Rough surfaces, edges and steps of the ranges differ, too, but not as a normal
// distribution does: its quantiles at 10, 25, 50 and 75 % must tell the same standard
// deviation. They do where the noise is larger than what else there is; they do not
// where a SICK laser with steps of 1 to 5 cm looks along door frames.
#ifndef CARTOGRAPHER_EXT_FRONT_END_POINT_CLOUD_RANGE_NOISE_H_
#define CARTOGRAPHER_EXT_FRONT_END_POINT_CLOUD_RANGE_NOISE_H_

#include <array>
#include <cstdint>

namespace cartographer_ext {
namespace front_end {

// One return of a laser.
struct Beam {
  double bearing = 0.;  // radians
  double range = 0.;    // metres, > 0
};

// Learns, see above. Not thread-safe.
class RangeNoise {
 public:
  // Whether more beams at this range would tell nothing new.
  bool IsKnown(double range) const;

  // Three beams beside each other, in this order.
  void Add(const Beam& before, const Beam& beam, const Beam& after);

  // Standard deviation at a range, metres; zero before there were enough beams to
  // tell, and where it is not noise.
  double At(double range) const;

 private:
  // From 0.25 m on, half octaves.
  static constexpr int kNumRanges = 20;
  // From half a millimetre on, 5 to an octave.
  static constexpr int kNumDifferences = 60;

  // Below which there is this share of the differences, metres.
  double Difference(int range, double share) const;
  void Update(int range);

  std::array<std::array<uint32_t, kNumDifferences>, kNumRanges> counts_{};
  std::array<uint32_t, kNumRanges> totals_{};
  std::array<double, kNumRanges> sigmas_{};  // metres; zero: not known or none
};

}  // namespace front_end
}  // namespace cartographer_ext

#endif  // CARTOGRAPHER_EXT_FRONT_END_POINT_CLOUD_RANGE_NOISE_H_
