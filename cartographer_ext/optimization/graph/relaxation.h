// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
//
// The problem of Cartographer's optimisation with other losses.
//
// In Cartographer's problem the motion by local SLAM between consecutive nodes
// (a step) is quadratic and stiff, while Huber's loss limits the pull of a loop
// to what a millimetre asks for. Where local SLAM took a single step wrongly,
// as where wheels slip in a corridor without features, the error is spread over
// the path, and any number of correct loops leaves much of it there. In the
// relaxed problem loops pull harder, and steps have Huber's loss: the few wrong
// steps give way, the others keep their motion.
//
//   minimise  1/2 sum of r^T r                (scans in submaps, odometry)
//           + sum of h(|r|, k a)              (loops; stock: k = 1)
//           + sum of h(|r|, b)                (steps; stock: b infinite)
//
//   h(r, a) = r^2 / 2 where r <= a, otherwise a r - a^2 / 2
//
// (Huber, "Robust estimation of a location parameter", 1964), a being
// Cartographer's huber_scale and r its weighted residuals. The stock code
// builds the problem with the loss of scale a for loops and none for the
// others; here all residuals are divided by k, which divides the sum by k^2,
// and those of steps bring their loss of scale b / k along. Landmarks have
// residuals of their own, which would not be divided.
//
// A step may be weighted less besides. Scans in submaps say the same about the
// motion of local SLAM as steps do, once more and far more softly: where it drifts
// everywhere, and not in a few steps, the steps hold it against any loop.
#ifndef CARTOGRAPHER_EXT_OPTIMIZATION_GRAPH_RELAXATION_H_
#define CARTOGRAPHER_EXT_OPTIMIZATION_GRAPH_RELAXATION_H_

namespace cartographer_ext {
namespace optimization {

struct Relaxation {
  double pull_of_loops = 1.;  // k, >= 1
  // Cartographer's weights of steps, 1/m and 1/rad; > 0.
  double step_translation_weight = 0.;
  double step_rotation_weight = 0.;
  double step_huber_scale = 0.;  // b, > 0
  // Factors on the weights of steps, in (0, 1].
  double step_translation_factor = 1.;
  double step_rotation_factor = 1.;
};

// Relaxes the optimisation on this thread during the lifetime of the scope.
// Cartographer creates the residual of a step as it does that of a constraint,
// from a pose with two weights. A step is what has the weights of steps and is
// not one of the constraints; odometry with the same weights is taken for a
// step, too. Scopes nest.
class ScopedRelaxation {
 public:
  // The constraints of the optimisation are stored between the two addresses.
  ScopedRelaxation(const Relaxation& relaxation, const void* constraints_begin,
                   const void* constraints_end);
  ~ScopedRelaxation();
  ScopedRelaxation(const ScopedRelaxation&) = delete;
  ScopedRelaxation& operator=(const ScopedRelaxation&) = delete;

  // The innermost scope of this thread, or null.
  static const ScopedRelaxation* Current();

  const Relaxation& relaxation() const { return relaxation_; }
  // 1 / k.
  double factor() const { return 1. / relaxation_.pull_of_loops; }
  // b / k for the pose of a step at this address, 0 for others.
  double StepScale(const void* pose, double translation_weight,
                   double rotation_weight) const;

 private:
  const Relaxation relaxation_;
  const void* const constraints_begin_;
  const void* const constraints_end_;
  const ScopedRelaxation* const outer_;
};

}  // namespace optimization
}  // namespace cartographer_ext

#endif  // CARTOGRAPHER_EXT_OPTIMIZATION_GRAPH_RELAXATION_H_
