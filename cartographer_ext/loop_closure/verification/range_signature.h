// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
//
// Range signatures: a scan as one range for each of M equal angular sectors.
// The temporal score (paper C, optimised Cartographer 2025, section 1.2; the
// paper gives no feature, this one is ours) compares the signatures of the last
// scans with those predicted by a submap.
//
// Sector m covers the angles 2 pi / M [m, m + 1) in the frame of the node, so
// the heading is part of the signature. A sector is divided into R rays; the
// range of a ray is that of the nearest point in it, the range of the sector
// the median over its rays. The division into rays makes a signature of points
// (dense on near walls) and one of cast rays (uniform in angle) comparable; the
// median is robust against a few moving people. Ranges are clipped: anything
// beyond is just "far".
#ifndef CARTOGRAPHER_EXT_LOOP_CLOSURE_VERIFICATION_RANGE_SIGNATURE_H_
#define CARTOGRAPHER_EXT_LOOP_CLOSURE_VERIFICATION_RANGE_SIGNATURE_H_

#include <vector>

#include "Eigen/Core"
#include "cartographer_ext/common/pose2.h"
#include "cartographer_ext/loop_closure/verification/occupancy_view.h"

namespace cartographer_ext {
namespace loop_closure {

// Sectors, ranges and comparison of signatures.
struct RangeSignatureOptions {
  int num_sectors = 36;       // M, > 0
  int rays_per_sector = 4;    // R, > 0
  double max_range = 10.;     // metres, > 0; longer ranges count as this
  double min_range = 0.1;     // metres, >= 0; nearer points are the robot
  double max_unknown = 0.15;  // metres of unknown space a ray may cross
  // Two sectors that differ by more count as this.
  double clip = 1.;  // metres, > 0
  // Required share of the sectors known in the first signature that are known
  // in the second as well, in (0, 1].
  double minimum_overlap = 0.5;
};

// Ranges in metres, NaN where unknown.
using RangeSignature = std::vector<float>;

// Of points in the frame of the node, metres. Points that are not finite are
// ignored.
RangeSignature SignatureFromPoints(const RangeSignatureOptions& options,
                                   const std::vector<Eigen::Vector2f>& points);

// The predicted signature of a robot at `pose` (view <- robot).
RangeSignature PredictSignature(const RangeSignatureOptions& options,
                                const OccupancyView& view, const Pose2& pose);

// Sectors that are not NaN.
int NumKnownSectors(const RangeSignature& signature);

// Fills the unknown sectors of `signature` from `other`.
void FillUnknownSectors(const RangeSignature& other, RangeSignature* signature);

// Mean over the sectors known in both of min(|difference|, clip) / clip, in
// [0, 1]. NaN when fewer than the minimum overlap of the sectors known in
// `query` are known in `reference`, or none are.
double SignatureCost(const RangeSignatureOptions& options,
                     const RangeSignature& query,
                     const RangeSignature& reference);

}  // namespace loop_closure
}  // namespace cartographer_ext

#endif  // CARTOGRAPHER_EXT_LOOP_CLOSURE_VERIFICATION_RANGE_SIGNATURE_H_
