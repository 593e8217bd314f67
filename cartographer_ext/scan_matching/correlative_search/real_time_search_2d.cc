// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
#include "cartographer_ext/scan_matching/correlative_search/real_time_search_2d.h"

#include <algorithm>
#include <cmath>
#include <queue>
#include <tuple>
#include <vector>

#include "cartographer_ext/scan_matching/correlative_search/search_maxima.h"

namespace cartographer_ext {
namespace scan_matching {
namespace {

// Rotations in a group move no point by more cells than this.
constexpr int kReach = 4;
constexpr int kLargestHalfGroup = 31;
constexpr int kMargin = kBlockSize - 1;
constexpr int kPointsPerSquareSum = 257;

// Memory of a thread that is used again for the next scan: getting it anew from
// the system would take longer than the search. As large as the part of the
// grid that a scan touches, a few bytes per cell.
struct Scratch {
  std::vector<uint8_t> padded;
  RectangleMaxima maxima[3];
};

Scratch* ThreadScratch() {
  static thread_local Scratch scratch;
  return &scratch;
}

class RealTimeRun {
 public:
  RealTimeRun(const RealTimeSearchOptions& options, const ProbabilityView& grid,
              const Pose2& initial, const PlanarCloud& cloud)
      : options_(options),
        grid_(grid),
        kernels_(options.kernels == nullptr ? BestSearchKernels()
                                            : *options.kernels),
        scans_(cloud, initial, options.window.linear, options.window.angular,
               grid.Geometry(), kernels_, RotatedScans::RangeOf::kTurnedCloud),
        scratch_(ThreadScratch()),
        padded_(scratch_->padded) {}

  bool valid() const { return scans_.valid(); }
  RealTimeSearchResult Run();

 private:
  // A group of rotations or, when `rotation` is not negative, one of them;
  // offsets from (x, y) on, up to a block of them.
  struct Node {
    double bound;
    int group;
    int rotation;
    int x;
    int y;

    bool operator<(const Node& other) const {
      if (bound != other.bound) return bound < other.bound;
      return std::tie(group, rotation, x, y) >
             std::tie(other.group, other.rotation, other.x, other.y);
    }
  };

  void ChooseGroups();
  void CopyCells();
  int WidenTo(int width, int from, int keep);
  int First(const int group) const { return group * (2 * half_group_ + 1); }
  int Last(const int group) const {
    return std::min(First(group) + 2 * half_group_, scans_.num_rotations() - 1);
  }
  double Factor(int rotation, int x, int y) const;
  // The largest factor of rotations `first` to `last`.
  double LargestFactor(int first, int last) const;
  // From a sum of 8-bit values to a mean probability, rounding included.
  double UpperMean(int64_t sum) const;
  void OpenGroup(const Node& node);
  void OpenRotation(const Node& node);
  void Score(int rotation, int x, int y);

  const RealTimeSearchOptions& options_;
  const ProbabilityView& grid_;
  const SearchKernels& kernels_;
  RotatedScans scans_;
  int half_group_ = 0;
  std::vector<std::vector<int32_t>> group_x_;  // in the middle rotations
  std::vector<std::vector<int32_t>> group_y_;
  // Cells of the grid from (min_x_, min_y_) on.
  int min_x_ = 0;
  int min_y_ = 0;
  Scratch* const scratch_;
  const RectangleMaxima* blocks_ = nullptr;
  const RectangleMaxima* coarse_ = nullptr;
  std::vector<uint8_t>& padded_;
  int padded_stride_ = 0;
  std::priority_queue<Node> nodes_;
  int32_t places_[kPointsPerSquareSum + 8];

  float best_score_ = -1.f;
  int best_rotation_ = 0;
  int best_x_ = 0;
  int best_y_ = 0;
  int64_t poses_scored_ = 0;
};

void RealTimeRun::ChooseGroups() {
  double longest = 0.;
  for (int i = 0; i != scans_.num_points(); ++i) {
    longest = std::max(longest, scans_.CellsPerStep(i));
  }
  while (half_group_ < kLargestHalfGroup &&
         (half_group_ + 1) * longest + scans_.RoundingCells() <= kReach) {
    ++half_group_;
  }
  for (int group = 0; First(group) < scans_.num_rotations(); ++group) {
    group_x_.emplace_back(scans_.num_points());
    group_y_.emplace_back(scans_.num_points());
    scans_.FindCells((First(group) + Last(group)) / 2, group_x_.back().data(),
                     group_y_.back().data());
  }
}

// Those known ones that the scan may touch, as cells, blocks and coarse blocks.
void RealTimeRun::CopyCells() {
  OffsetBounds bounds = grid_.Known();
  const int margin = kReach + scans_.linear_cells() + kBlockSize;
  OffsetBounds touched =
      scans_.CellBounds(group_x_.front().data(), group_y_.front().data());
  for (size_t group = 1; group < group_x_.size(); ++group) {
    const OffsetBounds cells =
        scans_.CellBounds(group_x_[group].data(), group_y_[group].data());
    touched.min_x = std::min(touched.min_x, cells.min_x);
    touched.max_x = std::max(touched.max_x, cells.max_x);
    touched.min_y = std::min(touched.min_y, cells.min_y);
    touched.max_y = std::max(touched.max_y, cells.max_y);
  }
  bounds.min_x = std::max(bounds.min_x, touched.min_x - margin);
  bounds.max_x = std::min(bounds.max_x, touched.max_x + margin);
  bounds.min_y = std::max(bounds.min_y, touched.min_y - margin);
  bounds.max_y = std::min(bounds.max_y, touched.max_y + margin);
  const bool empty = bounds.max_x < bounds.min_x || bounds.max_y < bounds.min_y;
  const int num_x = empty ? 1 : bounds.max_x - bounds.min_x + 1;
  const int num_y = empty ? 1 : bounds.max_y - bounds.min_y + 1;
  min_x_ = bounds.min_x;
  min_y_ = bounds.min_y;
  RectangleMaxima& cells = scratch_->maxima[0];
  cells.width = cells.height = 1;
  cells.num_x = num_x;
  cells.num_y = num_y;
  cells.values.resize(static_cast<size_t>(num_x) * num_y);
  if (empty) cells.values[0] = 0;
  padded_stride_ = num_x + 2 * kMargin;
  padded_.assign(static_cast<size_t>(padded_stride_) * (num_y + 2 * kMargin),
                 0);
  for (int y = 0; !empty && y != num_y; ++y) {
    uint8_t* const row = cells.values.data() + static_cast<size_t>(y) * num_x;
    grid_.CopyRow(min_y_ + y, min_x_, min_x_ + num_x, row);
    std::copy(row, row + num_x,
              padded_.begin() +
                  static_cast<size_t>(y + kMargin) * padded_stride_ + kMargin);
  }
  // Blocks no larger than the window give closer bounds.
  const int size = std::min(2 * scans_.linear_cells() + 1, int{kBlockSize});
  int last = 0;
  while (scratch_->maxima[last].width != size) last = WidenTo(size, last, -1);
  const int blocks = last;
  while (scratch_->maxima[last].width != size + 2 * kReach) {
    last = WidenTo(size + 2 * kReach, last, blocks);
  }
  blocks_ = &scratch_->maxima[blocks];
  coarse_ = &scratch_->maxima[last];
  // The instructions that gather bytes read three more.
  for (const int i : {blocks, last}) {
    std::vector<uint8_t>& values = scratch_->maxima[i].values;
    values.resize(values.size() + 3);
  }
}

// Widens number `from` of the maxima as far as possible in one step; returns
// the number of the result, which is not `keep`.
int RealTimeRun::WidenTo(const int width, const int from, const int keep) {
  int to = 0;
  while (to == from || to == keep) ++to;
  const RectangleMaxima& maxima = scratch_->maxima[from];
  const int more = std::min(maxima.width, width - maxima.width);
  WidenInto(maxima, more, more, &scratch_->maxima[to]);
  return to;
}

double RealTimeRun::Factor(const int rotation, const int x, const int y) const {
  const double resolution = grid_.Geometry().resolution;
  const double angle =
      (rotation - scans_.num_rotations() / 2) * scans_.angular_step();
  const double delta = std::hypot(-y * resolution, -x * resolution) *
                           options_.translation_delta_cost_weight +
                       std::abs(angle) * options_.rotation_delta_cost_weight;
  return std::exp(-(delta * delta));
}

double RealTimeRun::LargestFactor(const int first, const int last) const {
  if (!(options_.translation_delta_cost_weight >= 0.) ||
      !(options_.rotation_delta_cost_weight >= 0.)) {
    return 1.;
  }
  const int middle = scans_.num_rotations() / 2;
  return Factor(std::min(last, std::max(first, middle)), 0, 0);
}

double RealTimeRun::UpperMean(const int64_t sum) const {
  constexpr double kStep =
      (ProbabilityView::kMaxProbability - ProbabilityView::kMinProbability) /
      255.;
  // Each addition of the exact sum rounds by a part in 2^24, and the last few
  // operations likewise.
  const double rounding = (scans_.num_points() + 8) / 16777216. + 1e-5;
  return ProbabilityView::kMinProbability +
         kStep * static_cast<double>(sum) / scans_.num_points() + rounding;
}

RealTimeSearchResult RealTimeRun::Run() {
  ChooseGroups();
  CopyCells();
  const int linear = scans_.linear_cells();
  for (int group = 0; group != static_cast<int>(group_x_.size()); ++group) {
    for (int x = -linear; x <= linear; x += kBlockSize) {
      for (int y = -linear; y <= linear; y += kBlockSize) {
        const int sum = kernels_.sum_values(
            coarse_->values.data(), coarse_->num_x, coarse_->num_y,
            group_x_[group].data(), group_y_[group].data(),
            x - kReach - min_x_ + coarse_->width - 1,
            y - kReach - min_y_ + coarse_->height - 1, scans_.num_points());
        nodes_.push(
            Node{UpperMean(sum) * LargestFactor(First(group), Last(group)),
                 group, -1, x, y});
      }
    }
  }
  while (!nodes_.empty() && nodes_.top().bound >= best_score_) {
    const Node node = nodes_.top();
    nodes_.pop();
    if (node.rotation < 0) {
      OpenGroup(node);
    } else {
      OpenRotation(node);
    }
  }
  RealTimeSearchResult result;
  result.score = best_score_;
  result.pose = scans_.PoseOf(best_rotation_, best_x_, best_y_);
  const int64_t size = 2 * linear + 1;
  result.poses_in_window = size * size * scans_.num_rotations();
  result.poses_scored = poses_scored_;
  return result;
}

void RealTimeRun::OpenGroup(const Node& node) {
  for (int rotation = First(node.group); rotation <= Last(node.group);
       ++rotation) {
    const RotatedScan& scan = scans_.Get(rotation);
    const int sum = kernels_.sum_values(
        blocks_->values.data(), blocks_->num_x, blocks_->num_y, scan.x, scan.y,
        node.x - min_x_ + blocks_->width - 1,
        node.y - min_y_ + blocks_->height - 1, scans_.num_points());
    const double bound = UpperMean(sum) * LargestFactor(rotation, rotation);
    if (bound < best_score_) continue;
    nodes_.push(Node{bound, node.group, rotation, node.x, node.y});
  }
}

void RealTimeRun::OpenRotation(const Node& node) {
  constexpr int kNumPoses = kBlockSize * kBlockSize;
  const RotatedScan& scan = scans_.Get(node.rotation);
  const int num_points = scans_.num_points();
  int64_t sums[kNumPoses] = {};
  for (int begin = 0; begin < num_points; begin += kPointsPerSquareSum) {
    const int count = std::min(num_points - begin, kPointsPerSquareSum);
    uint16_t words[kNumPoses] = {};
    const int num_places = kernels_.find_places(
        padded_stride_ - kMargin,
        static_cast<int>(padded_.size()) / padded_stride_ - kMargin,
        padded_stride_, scan.x + begin, scan.y + begin,
        node.x - min_x_ + kMargin, node.y - min_y_ + kMargin, count, places_);
    kernels_.add_squares(padded_.data(), padded_stride_, places_, num_places,
                         words);
    for (int k = 0; k != kNumPoses; ++k) sums[k] += words[k];
  }
  const double factor = LargestFactor(node.rotation, node.rotation);
  const int linear = scans_.linear_cells();
  for (int k = 0; k != kNumPoses; ++k) {
    const int x = node.x + k % kBlockSize;
    const int y = node.y + k / kBlockSize;
    if (x > linear || y > linear) continue;
    const double mean = UpperMean(sums[k]);
    if (mean * factor < best_score_) continue;
    if (mean * Factor(node.rotation, x, y) < best_score_) continue;
    Score(node.rotation, x, y);
  }
}

// As defined, with the points in the order of the cloud.
void RealTimeRun::Score(const int rotation, const int x, const int y) {
  ++poses_scored_;
  const RotatedScan& scan = scans_.Get(rotation);
  const int num_points = scans_.num_points();
  float sum = 0.f;
  for (int i = 0; i != num_points; ++i) {
    const int place = scans_.PlaceOf(i);
    sum += grid_.Probability(scan.x[place] + x, scan.y[place] + y);
  }
  const float mean = sum / static_cast<float>(num_points);
  const float score = static_cast<float>(mean * Factor(rotation, x, y));
  if (score < best_score_) return;
  if (score == best_score_ &&
      std::tie(rotation, x, y) >= std::tie(best_rotation_, best_x_, best_y_)) {
    return;
  }
  best_score_ = score;
  best_rotation_ = rotation;
  best_x_ = x;
  best_y_ = y;
}

}  // namespace

RealTimeSearchResult SearchInRealTime(const RealTimeSearchOptions& options,
                                      const ProbabilityView& grid,
                                      const Pose2& initial,
                                      const PlanarCloud& cloud) {
  RealTimeSearchResult result;
  result.pose = initial;
  if (cloud.empty() || cloud.x.size() != cloud.y.size()) return result;
  RealTimeRun run(options, grid, initial, cloud);
  if (run.valid()) return run.Run();
  result.complete = false;
  return result;
}

}  // namespace scan_matching
}  // namespace cartographer_ext
