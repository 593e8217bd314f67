// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
//
// The temporal score S_t of a loop candidate (paper C, optimised Cartographer
// 2025, section 1.2; the paper specifies dynamic time warping only).
//
// A look-alike place matches one scan as well as the true place does. It rarely
// matches all scans along the path that the robot took to get there. So the
// last nodes up to the candidate's node (the query) are compared with the
// prediction of the submap along the same path, placed so that its last pose is
// the candidate pose (the reference):
//
//   reference pose k:  (submap <- k) = (submap <- node) (node <- local)
//                                      (local <- k)
//   local cost:        c(i, j), how far scan i and the map disagree at
//                      reference pose j
//   score:             S_t = 1 - D / path length        (dtw.h)
//
// Two local costs: the clipped mean difference of range signatures, which
// summarise sectors of a scan (range_signature.h), and the disagreement of the
// beams themselves (beam_agreement.h), which separates places better and costs
// less.
//
// The reference is sampled `oversampling` times finer than the query, and
// warping within the band absorbs the error of the odometry's scale. In the
// textbook's symmetric warping the samples between two nodes have to be matched
// as well, so even a perfect repetition scores below one; the asymmetric
// warping selects one sample for each node and lets the first be anywhere in
// the band.
//
// Neighbouring submaps continue the reference where the path leaves the submap.
// Where none of them covers it, the query is truncated: the rest must have a
// minimum length, otherwise there is no score.
#ifndef CARTOGRAPHER_EXT_LOOP_CLOSURE_VERIFICATION_TEMPORAL_VERIFICATION_H_
#define CARTOGRAPHER_EXT_LOOP_CLOSURE_VERIFICATION_TEMPORAL_VERIFICATION_H_

#include <vector>

#include "Eigen/Core"
#include "cartographer_ext/common/pose2.h"
#include "cartographer_ext/loop_closure/verification/beam_agreement.h"
#include "cartographer_ext/loop_closure/verification/node_history.h"
#include "cartographer_ext/loop_closure/verification/range_signature.h"

namespace cartographer_ext {
namespace loop_closure {

// Steps of the warping path.
enum class WarpingStep {
  kSymmetric,   // every reference sample has to be matched, as in the textbook
  kAsymmetric,  // one reference sample for each node of the query
};

// Each has its own options.
enum class ScanComparison {
  kSectors,  // range signatures
  kBeams,
};

// Sampling, warping and comparison of scans.
struct TemporalVerificationOptions {
  ScanComparison comparison = ScanComparison::kBeams;
  RangeSignatureOptions signature;
  BeamAgreementOptions beams;
  int oversampling = 2;  // reference samples per step of the query, > 0
  WarpingStep step = WarpingStep::kAsymmetric;
  // Half width of the Sakoe-Chiba band in steps of the query; negative: no
  // band. Symmetric warping takes at least 0.5; with less there is no path.
  double band = 1.;
  // Nodes of the query, > 0; with fewer there is no score. The paper's shortest
  // window.
  int minimum_length = 4;
};

// Whether there is a score, or why not.
enum class TemporalOutcome {
  kScored,
  kShortHistory,  // too few nodes before the candidate's
  kPathUnknown,   // the maps cover too little of the path
};

// Temporal score of one candidate.
struct TemporalResult {
  TemporalOutcome outcome = TemporalOutcome::kShortHistory;
  double score = 0.;  // S_t in [0, 1], 0 unless kScored
  int num_query = 0;  // nodes compared
  int num_reference = 0;
  double travelled = 0.;  // metres from the first to the last compared node
};

// Stores the description of a scan that the comparison needs in a node of the
// history; points in the frame of the node, metres.
void DescribeScan(const TemporalVerificationOptions& options,
                  const std::vector<Eigen::Vector2f>& points,
                  HistoryNode* node);

// `query`: nodes of one trajectory, oldest first, the last is the candidate's
// node. `candidate`: (frame of the candidate <- last node). `maps`: the submap
// first, then its neighbours; each fills what the previous ones do not cover.
// If beams are compared, their views must have distances.
TemporalResult VerifySequence(const TemporalVerificationOptions& options,
                              const std::vector<const HistoryNode*>& query,
                              const Pose2& candidate,
                              const std::vector<ReferenceMap>& maps);

}  // namespace loop_closure
}  // namespace cartographer_ext

#endif  // CARTOGRAPHER_EXT_LOOP_CLOSURE_VERIFICATION_TEMPORAL_VERIFICATION_H_
