// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
//
// Noise scale of a graph relative to its information matrices. Two variance
// components, one factor for odometry and one for loops, after Helmert: with C
// the chi2 of a kind of edges at the optimum and
//
//   r = sum over these edges of trace(I - J H^-1 J')
//
// their redundancy, C / r estimates the variance factor. The redundancies of
// both kinds add up to three for each loop in force; if odometry is weak it
// takes all of it, and the factor of the loops is undetermined. So each factor
// has its degrees of freedom and an interval, and a prior with a few degrees of
// freedom keeps it at one without data.
//
// Whether loops in force follow their noise model shows in their leave-one-out
// innovations d2 = r' (I - J H^-1 J')^-1 r, which are chi2 with three degrees
// of freedom whatever the redundancy.
#ifndef CARTOGRAPHER_EXT_OPTIMIZATION_OFFLINE_NOISE_SCALE_H_
#define CARTOGRAPHER_EXT_OPTIMIZATION_OFFLINE_NOISE_SCALE_H_

#include <vector>

#include "cartographer_ext/optimization/graph/pose_graph.h"
#include "cartographer_ext/optimization/solvers/robust_solver.h"

namespace cartographer_ext {
namespace optimization {

// A factor of standard deviations.
struct ScaleEstimate {
  double factor = 1.;
  // 95 % interval.
  double low = 0.;
  double high = 1e9;
  double degrees_of_freedom = 0.;
};

// Noise scales of both kinds of edges.
struct NoiseScale {
  ScaleEstimate odometry;
  ScaleEstimate loops;
};

// The ratio of two factors, as a deviate of the normal distribution with regard to
// one: that of F with the degrees of freedom of both, the prior's included, by the
// cube-root approximation (Annals of Mathematical Statistics 13(2), 1942).
double DeviateOfRatio(const ScaleEstimate& a, const ScaleEstimate& b);

// At a solution of the edges with these weights, 1 for the edges in force and 0
// for rejected loops. All edges of one kind share a factor.
NoiseScale EstimateNoiseScale(const std::vector<Pose2>& poses,
                              const std::vector<double>& weights,
                              RobustSolver* solver);

// Leave-one-out innovations d2 of the loops in force, at most `limit` of them
// evenly chosen. Loops without redundancy have none and are skipped.
std::vector<double> LeaveOneOutInnovations(const std::vector<Pose2>& poses,
                                           const std::vector<double>& weights,
                                           size_t limit, RobustSolver* solver);

// Whether values may be a sample of chi2 with three degrees of freedom,
// truncated at the gate, by their 5 % and 50 % quantiles. False for fewer than
// ten.
bool IsLikeChi2(const std::vector<double>& values);

// Whether values are less than chi2 with three degrees of freedom, by chance once in a
// thousand times. A loop and the one that predicts it say the same, so that two values
// count as one.
bool IsBelowChi2(const std::vector<double>& values);

// Whether many values lie just inside the gate, as where a gate cuts through
// the right loops.
bool IsCutByGate(const std::vector<double>& values, double gate);

// The factor of the standard deviations by the median of leave-one-out
// innovations, which a few wrong loops among them hardly move; 1 for fewer than
// ten.
double TypicalNoise(std::vector<double> innovations);

// Whether the median of leave-one-out innovations is that of half the claimed
// noise or less. chi2 of the loops themselves is that small also where odometry
// gives way to them, as in a sparse graph, and then says nothing about their
// noise. False for fewer than ten.
bool ClaimTooMuchNoise(std::vector<double> innovations);

// The graph with the standard deviations of odometry and loops multiplied.
PoseGraph WithNoiseScale(const PoseGraph& graph, double odometry, double loops);
// The same for whitened edges.
std::vector<WhitenedEdge> WithNoiseScale(std::vector<WhitenedEdge> edges,
                                         double odometry, double loops);

}  // namespace optimization
}  // namespace cartographer_ext

#endif  // CARTOGRAPHER_EXT_OPTIMIZATION_OFFLINE_NOISE_SCALE_H_
