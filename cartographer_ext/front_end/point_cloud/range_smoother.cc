// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
#include "cartographer_ext/front_end/point_cloud/range_smoother.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "cartographer_ext/common/order_statistics.h"
#include "cartographer_ext/common/pose2.h"
#include "cartographer_ext/common/squared.h"

namespace cartographer_ext {
namespace front_end {
namespace {

// Beams are beside each other up to this many increments: one or two may have had
// no return.
constexpr double kMostIncrements = 3.5;
// On each side of a beam.
constexpr int kLargestWindow = 16;
// Standard deviations: of chi2 above its mean, and of confidence intervals.
constexpr double kChiSquareSigmas = 3.;
constexpr double kIntervalSigmas = 2.5;

struct Return {
  Beam beam;
  size_t index = 0;
  double inverse = 0.;  // 1 / m
  double weight = 0.;   // 1 / variance of that; zero: not known
  bool is_noisy = false;
};

// u = a cos + b sin by weighted least squares, bearings from that of `center`.
class Line {
 public:
  explicit Line(const double center) : center_(center) {}

  void Add(const Return& point) {
    const double angle = point.beam.bearing - center_;
    const double c = std::cos(angle), s = std::sin(angle);
    const double w = point.weight;
    cc_ += w * c * c;
    cs_ += w * c * s;
    ss_ += w * s * s;
    cu_ += w * c * point.inverse;
    su_ += w * s * point.inverse;
    uu_ += w * point.inverse * point.inverse;
    ++count_;
  }

  // At the center; false if there are too few points.
  bool Solve(double* const inverse, double* const variance) const {
    const double determinant = cc_ * ss_ - cs_ * cs_;
    if (count_ < 3 || !(determinant > 1e-12 * cc_ * ss_)) return false;
    *inverse = (ss_ * cu_ - cs_ * su_) / determinant;
    *variance = ss_ / determinant;
    return true;
  }

  // Whether the points are on the line, up to their noise.
  bool IsStraight() const {
    const double determinant = cc_ * ss_ - cs_ * cs_;
    const double a = (ss_ * cu_ - cs_ * su_) / determinant;
    const double b = (cc_ * su_ - cs_ * cu_) / determinant;
    const double chi_square = uu_ - a * cu_ - b * su_;
    const double freedom = count_ - 2.;
    return chi_square <= freedom + kChiSquareSigmas * std::sqrt(2. * freedom);
  }

 private:
  const double center_;
  int count_ = 0;
  double cc_ = 0., cs_ = 0., ss_ = 0., cu_ = 0., su_ = 0., uu_ = 0.;
};

std::vector<Return> ToReturns(const std::vector<Eigen::Vector2f>& points) {
  std::vector<Return> returns;
  returns.reserve(points.size());
  for (size_t i = 0; i < points.size(); ++i) {
    const double range = points[i].cast<double>().norm();
    if (!std::isfinite(range) || !(range > 0.)) continue;
    Return point;
    point.beam.bearing = std::atan2(points[i].y(), points[i].x());
    point.beam.range = range;
    point.index = i;
    point.inverse = 1. / range;
    returns.push_back(point);
  }
  return returns;
}

// Sorts by bearing, from behind the widest gap on, with bearings that grow. Returns
// the median step.
double Sort(std::vector<Return>* const returns) {
  std::vector<Return>& all = *returns;
  if (all.size() < 3) return 0.;
  std::sort(all.begin(), all.end(), [](const Return& a, const Return& b) {
    return a.beam.bearing < b.beam.bearing ||
           (a.beam.bearing == b.beam.bearing && a.index < b.index);
  });
  std::vector<double> steps;
  size_t begin = 0;
  double widest = all.front().beam.bearing + 2. * kPi - all.back().beam.bearing;
  for (size_t i = 1; i < all.size(); ++i) {
    steps.push_back(all[i].beam.bearing - all[i - 1].beam.bearing);
    if (steps.back() > widest) {
      widest = steps.back();
      begin = i;
    }
  }
  for (size_t i = 0; i < begin; ++i) all[i].beam.bearing += 2. * kPi;
  std::rotate(all.begin(), all.begin() + static_cast<int64_t>(begin),
              all.end());
  return UpperMedian(std::move(steps));
}

// 1 / m of the line around a return.
double SmoothedInverse(const std::vector<Return>& returns, const int center,
                       const double increment) {
  const int count = static_cast<int>(returns.size());
  const auto is_beside = [&](const int i) {
    if (i < 1 || i >= count) return false;
    const double step =
        (returns[i].beam.bearing - returns[i - 1].beam.bearing) / increment;
    return step > 0. && step < kMostIncrements;
  };
  double best = returns[center].inverse;
  double low = -std::numeric_limits<double>::infinity();
  double high = std::numeric_limits<double>::infinity();
  const auto agrees = [&](const double inverse, const double variance) {
    const double half = kIntervalSigmas * std::sqrt(variance);
    low = std::max(low, inverse - half);
    high = std::min(high, inverse + half);
    return low <= high;
  };
  agrees(best, 1. / returns[center].weight);
  Line line(returns[center].beam.bearing);
  line.Add(returns[center]);
  for (int k = 1; k <= kLargestWindow; ++k) {
    if (!is_beside(center - k + 1) || !is_beside(center + k)) break;
    const Return& before = returns[center - k];
    const Return& after = returns[center + k];
    if (!(before.weight > 0.) || !(after.weight > 0.)) break;
    line.Add(before);
    line.Add(after);
    double inverse = 0., variance = 0.;
    if (!line.Solve(&inverse, &variance) || !line.IsStraight() ||
        !agrees(inverse, variance)) {
      break;
    }
    best = inverse;
  }
  return best;
}

// What the noise of triples of returns tells.
void Learn(const std::vector<Return>& returns, const double increment,
           RangeNoise* const noise) {
  for (size_t i = 1; i + 1 < returns.size(); ++i) {
    const Beam& beam = returns[i].beam;
    if (noise->IsKnown(beam.range)) continue;
    const double before =
        (beam.bearing - returns[i - 1].beam.bearing) / increment;
    const double after =
        (returns[i + 1].beam.bearing - beam.bearing) / increment;
    if (before > 0. && before < kMostIncrements && after > 0. &&
        after < kMostIncrements) {
      noise->Add(returns[i - 1].beam, beam, returns[i + 1].beam);
    }
  }
}

}  // namespace

bool RangeSmoother::IsQuiet(const std::vector<Eigen::Vector2f>& points) const {
  return std::all_of(
      points.begin(), points.end(), [this](const Eigen::Vector2f& point) {
        const double range = point.cast<double>().norm();
        return !(range > 0.) ||
               (noise_.IsKnown(range) && noise_.At(range) < least_noise_);
      });
}

std::vector<float> RangeSmoother::Smooth(
    const std::vector<Eigen::Vector2f>& points) {
  std::vector<float> factors(points.size(), 1.f);
  if (IsQuiet(points)) return factors;
  std::vector<Return> returns = ToReturns(points);
  const double increment = Sort(&returns);
  if (!(increment > 0.)) return factors;
  for (Return& point : returns) {
    const double sigma = noise_.At(point.beam.range);
    if (sigma > 0.) {
      point.weight = Squared(Squared(point.beam.range) / sigma);
      point.is_noisy = sigma >= least_noise_;
    }
  }
  Learn(returns, increment, &noise_);
  for (size_t i = 0; i < returns.size(); ++i) {
    const Return& point = returns[i];
    if (!point.is_noisy) continue;
    const double inverse =
        SmoothedInverse(returns, static_cast<int>(i), increment);
    if (inverse > 0.) {
      factors[point.index] = static_cast<float>(point.inverse / inverse);
    }
  }
  return factors;
}

}  // namespace front_end
}  // namespace cartographer_ext
