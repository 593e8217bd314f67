// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
#include "cartographer_ext/optimization/solvers/kernels.h"

#include <cmath>

#include "gtest/gtest.h"

namespace cartographer_ext {
namespace optimization {
namespace {

const KernelType kAll[] = {KernelType::kNone,         KernelType::kHuber,
                           KernelType::kGemanMcClure, KernelType::kDcs,
                           KernelType::kAcs,          KernelType::kAcsPaper};

TEST(KernelsTest, WeightIsTheDerivativeOfRho) {
  for (const KernelType type : kAll) {
    for (const double parameter : {0.5, 1., 4., kChi2Gate}) {
      KernelOptions kernel;
      kernel.type = type;
      kernel.parameter = parameter;
      for (const double shape : {0.01, 1., 30.}) {
        const double k = type == KernelType::kAcs ? AcsShape(kernel) : shape;
        for (const double chi2 :
             {1e-3, 0.1, 0.49, 0.51, 0.9, 1.1, 3., 15., 17., 130., 1e4}) {
          const double step = 1e-5 * chi2;
          const double numeric = (EvaluateKernel(kernel, chi2 + step, k).rho -
                                  EvaluateKernel(kernel, chi2 - step, k).rho) /
                                 (2. * step);
          const double weight = EvaluateKernel(kernel, chi2, k).weight;
          EXPECT_NEAR(weight, numeric, 1e-6 + 1e-4 * weight)
              << KernelName(type) << " chi2 " << chi2 << " parameter "
              << parameter << " shape " << k;
          EXPECT_GE(weight, 0.);
          EXPECT_LE(weight, 1.);
        }
        EXPECT_DOUBLE_EQ(EvaluateKernel(kernel, 0., k).rho, 0.);
        EXPECT_DOUBLE_EQ(EvaluateKernel(kernel, 0., k).weight, 1.);
      }
    }
  }
}

TEST(KernelsTest, RhoIsContinuousAtTheBranches) {
  for (const KernelType type :
       {KernelType::kHuber, KernelType::kDcs, KernelType::kTruncated}) {
    KernelOptions kernel;
    kernel.type = type;
    kernel.parameter = 2.;
    const double branch = type == KernelType::kHuber ? 4. : 2.;
    EXPECT_NEAR(EvaluateKernel(kernel, branch - 1e-9, 0.).rho,
                EvaluateKernel(kernel, branch + 1e-9, 0.).rho, 1e-8);
  }
}

TEST(KernelsTest, GemanMcClureIsTheMinimumOverTheSwitch) {
  // min over s of s^2 chi2 + w (1 - s)^2, by brute force.
  for (const double w : {0.3, 1., 11.}) {
    for (const double chi2 : {0.1, 1., 7., 200.}) {
      double best = 1e300, best_s = 0.;
      for (int i = 0; i <= 100000; ++i) {
        const double s = i * 1e-5;
        const double cost = s * s * chi2 + w * (1. - s) * (1. - s);
        if (cost < best) {
          best = cost;
          best_s = s;
        }
      }
      KernelOptions kernel;
      kernel.type = KernelType::kGemanMcClure;
      kernel.parameter = w;
      const KernelValue value = EvaluateKernel(kernel, chi2, 0.);
      EXPECT_NEAR(value.rho, best, 1e-6);
      EXPECT_NEAR(std::sqrt(value.weight), best_s, 2e-5);  // ACS eq. (8)
    }
  }
}

TEST(KernelsTest, HandComputedValues) {
  // DCS, P = 1, chi2 = 3: s = 2/4, weight 1/4, rho = (9 - 1)/4.
  KernelValue value = EvaluateKernel(DefaultKernel(KernelType::kDcs), 3., 0.);
  EXPECT_DOUBLE_EQ(value.weight, 0.25);
  EXPECT_DOUBLE_EQ(value.rho, 2.);
  // ACS at the gate: s = 1/2; rho = c/4 + c pi/8.
  const KernelOptions acs = DefaultKernel(KernelType::kAcs);
  value = EvaluateKernel(acs, kChi2Gate, AcsShape(acs));
  EXPECT_DOUBLE_EQ(value.weight, 0.25);
  EXPECT_NEAR(value.rho, kChi2Gate * (0.25 + std::acos(-1.) / 8.), 1e-12);
  // Huber with b = 2 at chi2 = 9: 2*2*3 - 4, weight 2/3.
  KernelOptions huber = DefaultKernel(KernelType::kHuber);
  huber.parameter = 2.;
  value = EvaluateKernel(huber, 9., 0.);
  EXPECT_DOUBLE_EQ(value.rho, 8.);
  EXPECT_DOUBLE_EQ(value.weight, 2. / 3.);
}

TEST(KernelsTest, PaperSwitchIsEquation13) {
  // s = 1/(chi2 chi' |L| + 1) with chi2 = 5, chi' = 0.4, |L| = 0.25.
  KernelOptions kernel;
  kernel.type = KernelType::kAcsPaper;
  const double shape = AcsPaperShape(5., 0.4, 0.25);
  EXPECT_NEAR(std::sqrt(EvaluateKernel(kernel, 5., shape).weight),
              1. / (5. * 0.4 * 0.25 + 1.), 1e-12);
}

TEST(KernelsTest, NormsOfACovariance) {
  Eigen::Matrix3d information = Eigen::Matrix3d::Zero();
  information.diagonal() << 4., 2., 10.;
  EXPECT_NEAR(NormOfCovariance(information, CovarianceNorm::kSpectral), 0.5,
              1e-12);
  EXPECT_NEAR(NormOfCovariance(information, CovarianceNorm::kDeterminant),
              1. / 80., 1e-12);
  EXPECT_NEAR(NormOfCovariance(information, CovarianceNorm::kRoot),
              std::cbrt(1. / 80.), 1e-12);
  EXPECT_NEAR(NormOfCovariance(information, CovarianceNorm::kInformation), 80.,
              1e-9);
}

// The switch of one and the same error in metres and in millimetres.
void SwitchInTwoUnits(const KernelType type, const CovarianceNorm norm,
                      double* const metres, double* const millimetres) {
  const double error[3] = {0.4, -0.1, 0.05};
  const double sigma[3] = {0.1, 0.1, 0.02};
  double result[2];
  for (int i = 0; i != 2; ++i) {
    const double unit = i == 0 ? 1. : 1000.;
    double chi2 = 0., plain = 0.;
    Eigen::Matrix3d information = Eigen::Matrix3d::Zero();
    for (int k = 0; k != 3; ++k) {
      const double scale = k == 2 ? 1. : unit;
      const double e = error[k] * scale, s = sigma[k] * scale;
      chi2 += e * e / (s * s);
      plain += e * e;
      information(k, k) = 1. / (s * s);
    }
    KernelOptions kernel = DefaultKernel(type);
    kernel.norm = norm;
    const double shape =
        type == KernelType::kAcs
            ? AcsShape(kernel)
            : AcsPaperShape(chi2, plain, NormOfCovariance(information, norm));
    result[i] = std::sqrt(EvaluateKernel(kernel, chi2, shape).weight);
  }
  *metres = result[0];
  *millimetres = result[1];
}

TEST(KernelsTest, DimensionlessAcsDoesNotDependOnTheUnit) {
  double metres, millimetres;
  SwitchInTwoUnits(KernelType::kAcs, CovarianceNorm::kSpectral, &metres,
                   &millimetres);
  EXPECT_NEAR(metres, millimetres, 1e-12);
}

TEST(KernelsTest, PaperAcsDependsOnTheUnitWhateverTheNorm) {
  // This is the flaw that made a dimensionless default necessary.
  for (const CovarianceNorm norm :
       {CovarianceNorm::kSpectral, CovarianceNorm::kDeterminant,
        CovarianceNorm::kRoot, CovarianceNorm::kInformation}) {
    double metres, millimetres;
    SwitchInTwoUnits(KernelType::kAcsPaper, norm, &metres, &millimetres);
    EXPECT_GT(std::abs(metres - millimetres), 0.1 * metres);
  }
}

TEST(KernelsTest, GncWeights) {
  // mu -> infinity: truncation at c; in between sqrt(c mu (mu+1)/chi2) - mu.
  EXPECT_DOUBLE_EQ(GncTlsWeight(9.9, 10., 1e6), 1.);
  EXPECT_DOUBLE_EQ(GncTlsWeight(10.1, 10., 1e6), 0.);
  EXPECT_DOUBLE_EQ(GncTlsWeight(4., 10., 1.), 1.);
  EXPECT_NEAR(GncTlsWeight(10., 10., 1.), std::sqrt(2.) - 1., 1e-12);
  EXPECT_DOUBLE_EQ(GncTlsWeight(21., 10., 1.), 0.);
}

TEST(KernelsTest, Names) {
  for (const KernelType type : kAll) {
    EXPECT_EQ(*KernelTypeFromName(KernelName(type)), type);
  }
  EXPECT_FALSE(KernelTypeFromName("cauchy").ok());
  EXPECT_EQ(*CovarianceNormFromName("root"), CovarianceNorm::kRoot);
  EXPECT_FALSE(CovarianceNormFromName("trace").ok());
}

}  // namespace
}  // namespace optimization
}  // namespace cartographer_ext
