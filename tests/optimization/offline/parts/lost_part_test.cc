// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
#include "cartographer_ext/optimization/offline/parts/lost_part.h"

#include <random>

#include "cartographer_ext/optimization/solvers/refused_loops.h"
#include "gmock/gmock.h"

namespace cartographer_ext {
namespace optimization {
namespace {

constexpr int kPoses = 64 * kStretchOfPath;

WhitenedEdge Loop(const int from, const int to) {
  WhitenedEdge result;
  result.from = from;
  result.to = to;
  result.is_loop = true;
  return result;
}

// As many loops between random poses as poses.
std::vector<WhitenedEdge> RandomLoops(std::mt19937* const random) {
  std::vector<WhitenedEdge> result;
  for (int i = 0; i != kPoses; ++i) {
    result.push_back(Loop((*random)() % kPoses, (*random)() % kPoses));
  }
  return result;
}

TEST(LostPartTest, IsLeftByLoopsWithOneEndInIt) {
  const PartOfPath part = {10, 20};
  EXPECT_TRUE(part.IsLeftBy(Loop(10, 20)));
  EXPECT_TRUE(part.IsLeftBy(Loop(9, 19)));
  EXPECT_FALSE(part.IsLeftBy(Loop(10, 19)));
  EXPECT_FALSE(part.IsLeftBy(Loop(9, 20)));
}

TEST(LostPartTest, NoneWhereLoopsAreRefusedEverywhereAlike) {
  for (const unsigned share : {1, 5, 9}) {
    std::mt19937 random(share);
    const std::vector<WhitenedEdge> edges = RandomLoops(&random);
    std::vector<double> weights;
    for (size_t i = 0; i != edges.size(); ++i) {
      weights.push_back(random() % 10 < share ? 0. : 1.);
    }
    EXPECT_FALSE(FindLostPart(edges, weights).has_value()) << share;
  }
}

TEST(LostPartTest, FindsThePartWithoutLoopsToTheRest) {
  std::mt19937 random(1);
  std::vector<WhitenedEdge> edges = RandomLoops(&random);
  const PartOfPath lost = {16 * kStretchOfPath, 24 * kStretchOfPath};
  std::vector<double> weights;
  for (const WhitenedEdge& edge : edges) {
    weights.push_back(lost.IsLeftBy(edge) || random() % 2 == 0 ? 0. : 1.);
  }
  // One wrong group in force that has led to it.
  for (int i = 0; i != 5; ++i) {
    edges.push_back(Loop(lost.begin + i, lost.end + 100 + i));
    weights.push_back(1.);
  }
  const absl::optional<PartOfPath> found = FindLostPart(edges, weights);
  ASSERT_TRUE(found.has_value());
  EXPECT_EQ(found->begin, lost.begin);
  EXPECT_EQ(found->end, lost.end);
}

TEST(LostPartTest, ItsEndsAreThoseOfWhatIsLost) {
  std::mt19937 random(2);
  const std::vector<WhitenedEdge> edges = RandomLoops(&random);
  for (const PartOfPath lost :
       {PartOfPath{0, 12 * kStretchOfPath},
        PartOfPath{13 * kStretchOfPath, 21 * kStretchOfPath},
        PartOfPath{51 * kStretchOfPath, kPoses}}) {
    std::vector<double> weights;
    for (const WhitenedEdge& edge : edges) {
      weights.push_back(lost.IsLeftBy(edge) || random() % 5 == 0 ? 0. : 1.);
    }
    const absl::optional<PartOfPath> found = FindLostPart(edges, weights);
    ASSERT_TRUE(found.has_value());
    EXPECT_EQ(found->begin, lost.begin);
    EXPECT_EQ(found->end, lost.end);
  }
}

TEST(LostPartTest, LoopsOfTheSameStretchesAreOnePieceOfEvidence) {
  // A part that only two pairs of stretches join with the rest, by many loops.
  std::mt19937 random(1);
  std::vector<WhitenedEdge> edges;
  std::vector<double> weights;
  for (const WhitenedEdge& edge : RandomLoops(&random)) {
    if (std::max(edge.from, edge.to) >= 60 * kStretchOfPath) continue;
    edges.push_back(edge);
    weights.push_back(random() % 2 == 0 ? 0. : 1.);
  }
  for (int i = 0; i != 2 * kStretchOfPath; ++i) {
    edges.push_back(Loop(30 * kStretchOfPath, 62 * kStretchOfPath + i));
    weights.push_back(0.);
  }
  EXPECT_FALSE(FindLostPart(edges, weights).has_value());
}

TEST(LostPartTest, NoneWithoutLoops) {
  EXPECT_FALSE(FindLostPart({}, {}).has_value());
  WhitenedEdge odometry = Loop(0, 1);
  odometry.is_loop = false;
  EXPECT_FALSE(FindLostPart({odometry}, {1.}).has_value());
}

}  // namespace
}  // namespace optimization
}  // namespace cartographer_ext
