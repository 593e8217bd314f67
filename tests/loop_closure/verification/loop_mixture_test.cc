// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
#include "cartographer_ext/loop_closure/verification/loop_mixture.h"

#include <cmath>

#include "Eigen/LU"
#include "cartographer_ext/common/random.h"
#include "gtest/gtest.h"

namespace cartographer_ext {
namespace loop_closure {
namespace {

// The temporal score of a coordinate.
double Score(const double coordinate) { return 1.02 - std::exp(-coordinate); }

// (S_g, S_t) of true and false loops, apart from each other.
Eigen::Vector2d DrawScores(Random* const random, const bool is_true) {
  return is_true ? Eigen::Vector2d(random->Normal(0.75, 0.05),
                                   Score(random->Normal(2.9, 0.4)))
                 : Eigen::Vector2d(random->Normal(0.58, 0.06),
                                   Score(random->Normal(1.4, 0.5)));
}

TEST(LoopMixtureTest, CoordinateByHand) {
  EXPECT_NEAR(TemporalCoordinate(0.52), std::log(2.), 1e-12);
  EXPECT_NEAR(TemporalCoordinate(1.), std::log(50.), 1e-12);
  EXPECT_EQ(TemporalCoordinate(1.5), TemporalCoordinate(1.));
  EXPECT_NEAR(TemporalCoordinate(Score(1.7)), 1.7, 1e-12);
}

TEST(LoopMixtureTest, DensityByHand) {
  MixtureComponent component;
  component.weight = 0.5;
  component.covariance = Eigen::Vector2d(0.04, 0.01).asDiagonal();
  // log(0.5) - log(2 pi 0.2 0.1) - (0.2^2 / 0.04 + 0.1^2 / 0.01) / 2
  EXPECT_NEAR(LogWeightedDensity(component, Eigen::Vector2d(0.2, 0.1)),
              std::log(0.5) - std::log(2. * M_PI * 0.2 * 0.1) - 1., 1e-12);
}

TEST(LoopMixtureTest, RecoversTwoPopulationsAndIsCalibrated) {
  Random random(3);
  LoopMixtureOptions options;
  options.capacity = 20000;
  // A strong prior biases the tails, where the probabilities are decided.
  options.prior_strength = 2.;
  LoopMixture mixture(options);
  for (int i = 0; i < 20000; ++i) {
    const Eigen::Vector2d s = DrawScores(&random, random.Uniform() < 0.3);
    mixture.Add(s.x(), s.y(), 1.);
  }
  EXPECT_GT(mixture.Fit(), 1);
  EXPECT_NEAR(mixture.components()[1].weight, 0.3, 0.03);
  EXPECT_NEAR(mixture.components()[1].mean.x(), 0.75, 0.01);
  EXPECT_NEAR(mixture.components()[0].mean.y(), 1.4, 0.05);
  // Reliability: of the candidates given probability p, p are true.
  double predicted = 0., actual = 0.;
  int count = 0;
  for (int i = 0; i < 100000; ++i) {
    const bool is_true = random.Uniform() < 0.3;
    const Eigen::Vector2d s = DrawScores(&random, is_true);
    const double p = mixture.ProbabilityTrue(s.x(), s.y());
    ASSERT_GE(p, 0.);
    ASSERT_LE(p, 1.);
    if (p > 0.2 && p < 0.8) {
      predicted += p;
      actual += is_true;
      ++count;
    }
  }
  ASSERT_GT(count, 200);
  EXPECT_NEAR(predicted / count, actual / count, 0.05);
}

TEST(LoopMixtureTest, OnePopulationKeepsTheOrderOfTheComponents) {
  LoopMixture mixture((LoopMixtureOptions()));
  for (int i = 0; i < 300; ++i) mixture.Add(0.6, 0.7, 1.);
  mixture.Fit();
  EXPECT_GE(mixture.components()[1].mean.x(), mixture.components()[0].mean.x());
  EXPECT_GE(mixture.components()[1].mean.y(), mixture.components()[0].mean.y());
  EXPECT_GT(mixture.components()[0].covariance.determinant(), 0.);
  EXPECT_TRUE(std::isfinite(mixture.ProbabilityTrue(1e3, -1e3)));
}

TEST(LoopMixtureTest, PriorsFollowScoresThatAreCertainByHand) {
  LoopMixture mixture((LoopMixtureOptions()));
  EXPECT_EQ(mixture.temporal_scale(), 1.);
  // As many as the prior is worth: half way from (0.72, 2.8).
  for (int i = 0; i < 20; ++i) mixture.AddCertain(0.6, Score(1.8), false);
  EXPECT_GE(mixture.Fit(), 1);
  const MixtureComponent& right = mixture.components()[1];
  EXPECT_NEAR(right.mean.x(), 0.66, 1e-9);
  EXPECT_NEAR(right.mean.y(), 2.3, 1e-9);
  // Half the variance of the prior and a quarter of the squared distance.
  EXPECT_NEAR(right.covariance(1, 1), 0.5 * 0.25 + 0.25, 1e-9);
  EXPECT_NEAR(mixture.temporal_scale(), Score(2.3) / Score(2.8), 1e-9);
  // Wrong places keep the ratio of the scores.
  const MixtureComponent& wrong = mixture.components()[0];
  EXPECT_NEAR(wrong.mean.x(), 0.66 * 0.64 / 0.72, 1e-9);
  EXPECT_NEAR(Score(wrong.mean.y()) / Score(right.mean.y()),
              Score(1.3) / Score(2.8), 1e-9);
  // What was unlikely is likely.
  EXPECT_GT(
      mixture.ProbabilityTrue(0.6, Score(1.8)),
      2. *
          LoopMixture((LoopMixtureOptions())).ProbabilityTrue(0.6, Score(1.8)));
}

TEST(LoopMixtureTest, BetterScoresThanThePriorMakeWrongOnesNoBetter) {
  LoopMixture mixture((LoopMixtureOptions()));
  for (int i = 0; i < 100; ++i) mixture.AddCertain(0.9, Score(3.5), false);
  mixture.Fit();
  // (20 * 2.8 + 100 * 3.5) / 120
  EXPECT_NEAR(mixture.components()[1].mean.y(), 406. / 120., 1e-9);
  EXPECT_NEAR(mixture.components()[0].mean.y(), 1.3, 1e-9);
  EXPECT_EQ(mixture.temporal_scale(), 1.);
}

TEST(LoopMixtureTest, OwnScansCountWhileThereAreHardlyOthers) {
  LoopMixture mixture((LoopMixtureOptions()));
  for (int i = 0; i < 100; ++i) mixture.AddCertain(0.7, Score(2.4), true);
  mixture.Fit();
  EXPECT_NEAR(mixture.components()[1].mean.y(), 2.6, 1e-9);
  for (int i = 0; i < 20; ++i) mixture.AddCertain(0.7, Score(1.8), false);
  mixture.Fit();
  EXPECT_NEAR(mixture.components()[1].mean.y(), 2.3, 1e-9);
}

TEST(LoopMixtureTest, ProbabilityOfTheGridScoreAloneByHand) {
  const LoopMixture mixture((LoopMixtureOptions()));
  // N(0.7; 0.64, 0.07) and N(0.7; 0.72, 0.09)
  const double wrong = std::exp(-0.5 * 36. / 49.) / 0.07;
  const double right = std::exp(-0.5 * 4. / 81.) / 0.09;
  EXPECT_NEAR(mixture.ProbabilityTrue(0.7), right / (right + wrong), 1e-12);
}

TEST(LoopMixtureTest, DensityOfWrongMatchesByHand) {
  const LoopMixture mixture((LoopMixtureOptions()));
  const Eigen::Vector2d scores(0.7, TemporalCoordinate(0.9));
  // Both components have the weight 0.5.
  const double log_ratio = LogWeightedDensity(mixture.components()[0], scores) -
                           LogWeightedDensity(mixture.components()[1], scores);
  EXPECT_NEAR(mixture.WrongDensity(0.7, 0.9), 0.05 * std::exp(0.4 * log_ratio),
              1e-12);
  const double wrong = std::exp(-0.5 * 36. / 49.) / 0.07;
  const double right = std::exp(-0.5 * 4. / 81.) / 0.09;
  EXPECT_NEAR(mixture.WrongDensity(0.7), 0.05 * std::pow(wrong / right, 0.4),
              1e-12);
}

// Searches of a small and a large volume, with wrong matches of a density that
// is not known: of the candidates given probability p, p are true.
TEST(LoopMixtureTest, ClutterIsLearntAndMakesCalibratedProbabilities) {
  Random random(3);
  LoopMixtureOptions options;
  options.capacity = 20000;
  options.prior_strength = 2.;
  options.likelihood_exponent = 1.;  // the scores are Gaussian
  LoopMixture mixture(options);
  constexpr double kDensity = 0.2;
  const auto is_true = [&random](const double volume) {
    return random.Uniform() < 1. / (1. + kDensity * volume);
  };
  for (int i = 0; i < 20000; ++i) {
    const double volume = i % 2 == 0 ? 1. : 60.;
    const Eigen::Vector2d s = DrawScores(&random, is_true(volume));
    mixture.Add(s.x(), s.y(), volume);
  }
  EXPECT_EQ(mixture.clutter_density(), 0.05);
  mixture.Fit();
  EXPECT_NEAR(mixture.clutter_density(), kDensity, 0.02);
  for (const double volume : {1., 60.}) {
    double predicted = 0., actual = 0.;
    int count = 0;
    for (int i = 0; i < 100000; ++i) {
      const bool truth = is_true(volume);
      const Eigen::Vector2d s = DrawScores(&random, truth);
      const double p = 1. / (1. + volume * mixture.WrongDensity(s.x(), s.y()));
      if (p > 0.2 && p < 0.8) {
        predicted += p;
        actual += truth;
        ++count;
      }
    }
    ASSERT_GT(count, 150);
    EXPECT_NEAR(predicted / count, actual / count, 0.07) << volume;
  }
}

TEST(LoopMixtureTest, MemoryIsBounded) {
  LoopMixtureOptions options;
  options.capacity = 10;
  LoopMixture mixture(options);
  EXPECT_EQ(mixture.Fit(), 0);
  for (int i = 0; i < 100; ++i) mixture.Add(0.5, 0.5, 1.);
  EXPECT_EQ(mixture.size(), 10);
}

}  // namespace
}  // namespace loop_closure
}  // namespace cartographer_ext
