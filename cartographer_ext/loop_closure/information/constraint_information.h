// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
//
// Confidence-weighted information of a loop constraint (paper C, optimised
// Cartographer 2025, section 1.4).
//
//   C eq. 8    Sigma = U^-1 diag(sigma_x, sigma_y, sigma_theta) U
//   C eq. 9    sigma_x = sigma_y = S^-alpha,  sigma_theta = S^-beta
//   C eq. 10   Omega = Sigma^-1
//   C eq. 11   Omega = U^-1 diag(S^alpha, S^alpha, S^beta) U
//
// U rotates the plane and the x and y entries are equal, so U cancels and Omega
// is exactly two scalars. The printed sigma are used as variances.
// Cartographer's weights multiply errors, that is they are square roots of
// information, so
//
//   w_t = w_t,stock (S / S_ref)^(alpha / 2)
//   w_r = w_r,stock (S / S_ref)^(beta / 2)
//
// A score of S_ref leaves the stock weights unchanged.
#ifndef CARTOGRAPHER_EXT_LOOP_CLOSURE_INFORMATION_CONSTRAINT_INFORMATION_H_
#define CARTOGRAPHER_EXT_LOOP_CLOSURE_INFORMATION_CONSTRAINT_INFORMATION_H_

#include "Eigen/Core"

namespace cartographer_ext {
namespace loop_closure {

// Parameters of eq. 8 to 11.
struct ConfidenceWeightOptions {
  bool enabled = true;           // otherwise every loop has the stock weights
  double alpha = 1.2;            // translation exponent, >= 0
  double beta = 1.5;             // rotation exponent, >= 0
  double reference_score = 0.6;  // S_ref, > 0
  double minimum_score = 1e-3;   // scores below count as this one, > 0
  // Whether loops also get the full matrix (below).
  bool full_matrix = false;
};

// The two scalar weights of a constraint.
struct ConstraintWeights {
  double translation = 0.;  // 1/metre, square root of information
  double rotation = 0.;     // 1/radian
};

// Stock weights scaled by the confidence.
ConstraintWeights ConfidenceWeights(const ConfidenceWeightOptions& options,
                                    const ConstraintWeights& stock,
                                    double final_score);

// Omega of eq. 11 for a rotation U of the plane by `angle` radians; for tests
// and for readers of the paper: the result does not depend on the angle.
Eigen::Matrix3d PaperInformation(double final_score, double alpha, double beta,
                                 double angle);

// The full matrix for weights w of a loop whose match is as uncertain as
// `match_covariance`, where the weights express one as certain as
// `certain_covariance` (diagonal; metres, radians):
//
//   Omega = W L^(1/2) C^-1 L^(1/2) W,  W = diag(w_t, w_t, w_r)
//
// with L and C the two covariances. A certain match has W^2; along a direction
// that the scan does not observe, such as a corridor, the information is
// smaller. The weights are not standard deviations in metres, so only the ratio
// of the covariances counts. Zero if C has no inverse.
Eigen::Matrix3d FullInformation(const ConstraintWeights& weights,
                                const Eigen::Matrix3d& certain_covariance,
                                const Eigen::Matrix3d& match_covariance);

// A pair of scalar weights for a full information matrix (metres, radians), for
// solvers that support two scalars only: the translation weight is the square
// root of the smaller eigenvalue of the translation block after the rotation
// has been marginalised out, the rotation weight that of the rotation entry
// after the translation has been marginalised out. A matrix that is not
// positive semi-definite gives zero weights.
ConstraintWeights ScalarWeights(const Eigen::Matrix3d& information);

}  // namespace loop_closure
}  // namespace cartographer_ext

#endif  // CARTOGRAPHER_EXT_LOOP_CLOSURE_INFORMATION_CONSTRAINT_INFORMATION_H_
