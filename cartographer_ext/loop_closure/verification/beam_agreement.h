// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
//
// Agreement of a scan with a map at a given pose, beam by beam. Look-alike
// places differ in details: a door shifted by ten centimetres, a wall at the
// far end of a corridor. Averages over sectors blur these, so the temporal
// score (temporal_verification.h) compares each beam at its own angle:
//
//   ends at a wall or in free space   The disagreement is the distance from its
//                                     end to the nearest occupied cell, which
//                                     tolerates beams that graze a wall.
//   ends in unknown space             The disagreement is the difference between
//                                     its range and the range that the map
//                                     predicts along it: a beam does not pass
//                                     through walls. Without a prediction the
//                                     beam is not compared.
//
// A tolerance is subtracted, and disagreements are clipped because of moving
// people. A beam longer than the maximum range has no end; space along it is
// free up to that range.
#ifndef CARTOGRAPHER_EXT_LOOP_CLOSURE_VERIFICATION_BEAM_AGREEMENT_H_
#define CARTOGRAPHER_EXT_LOOP_CLOSURE_VERIFICATION_BEAM_AGREEMENT_H_

#include <vector>

#include "Eigen/Core"
#include "cartographer_ext/common/pose2.h"
#include "cartographer_ext/loop_closure/verification/occupancy_view.h"

namespace cartographer_ext {
namespace loop_closure {

// A map used as reference, with its pose.
struct ReferenceMap {
  const OccupancyView* view = nullptr;
  Pose2 view_from_submap;  // (frame of the view <- frame of the candidate)
};

// Range limits and tolerances of the comparison.
struct BeamAgreementOptions {
  double max_range = 25.;     // metres, > 0
  double min_range = 0.1;     // metres, >= 0; nearer points are the robot
  double max_unknown = 0.15;  // metres of unknown space a beam may cross
  double tolerance = 1.;      // cells of the map, >= 0
  double clip = 0.2;          // metres, > 0
  // Required share of beams for which the maps have data, in (0, 1].
  double minimum_overlap = 0.7;
  // Scans are subsampled to this number of beams.
  int max_beams = 120;  // > 0
};

// A beam from the origin of the node to what it hit, metres.
struct Beam {
  Eigen::Vector2f end;
  float range;
};

// Of points in the frame of the node, in their order. Points that are not
// finite or nearer than the smallest range are ignored.
std::vector<Beam> BeamsFromPoints(const BeamAgreementOptions& options,
                                  const std::vector<Eigen::Vector2f>& points);

// The reach, in cells, up to which the views must have distances.
int DistanceReach(const BeamAgreementOptions& options, double resolution);

// Maps seen from one pose.
class PlacedMaps {
 public:
  // `pose`: (frame of the candidate <- node). The views must have distances and
  // outlive this object.
  PlacedMaps(const std::vector<ReferenceMap>& maps, const Pose2& pose);

  // Mean disagreement of the beams as a share of the clip, in [0, 1]. For each
  // beam the first map with data is used. NaN if the overlap is below the
  // minimum.
  double Disagreement(const BeamAgreementOptions& options,
                      const std::vector<Beam>& beams) const;
  // A lower bound of the disagreement (unless that is NaN), at a fraction of
  // the cost: no ranges are predicted.
  double LeastDisagreement(const BeamAgreementOptions& options,
                           const std::vector<Beam>& beams) const;

 private:
  // Position of the node in one map.
  struct Place {
    const OccupancyView* view;
    Eigen::Vector2d start;  // frame of the view, metres
    double cos, sin;
    Eigen::Vector2d cell;  // of the start
    double cos_cells, sin_cells;
  };
  struct Sums {
    double disagreement = 0.;  // metres
    int num_known = 0;
    int num_open = 0;  // neither known nor unknown yet
  };

  // NaN if no map has data at the end of the beam.
  double EndDisagreement(const Beam& beam, double tolerance) const;
  Sums Sum(const BeamAgreementOptions& options, const std::vector<Beam>& beams,
           bool predict) const;

  std::vector<Place> places_;
};

}  // namespace loop_closure
}  // namespace cartographer_ext

#endif  // CARTOGRAPHER_EXT_LOOP_CLOSURE_VERIFICATION_BEAM_AGREEMENT_H_
