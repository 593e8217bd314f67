// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
//
// What a user is told about a mistake in one of our blocks: the full key, the
// value and what is allowed, for each place where a block may stand.
#include <string>
#include <vector>

#include "cartographer_ext/swaps.h"
#include "gtest/gtest.h"
#include "tests/host/slam_test_helpers.h"

namespace cartographer_ext {
namespace overlay {
namespace {

// Where a block may stand, and a number of it that has to be positive.
struct Place {
  std::string name;
  std::string stock_table;
  std::string sub_table;
  std::string number;
};

const std::vector<Place>& Places() {
  static const auto* const places = new std::vector<Place>{
#ifdef CARTOGRAPHER_EXT_SWAP_CONSTRAINT_BUILDER
      {"constraint_builder", "POSE_GRAPH.constraint_builder", "search",
       "max_searches_per_node"},
#ifdef CARTOGRAPHER_EXT_SWAP_CERES_SCAN_MATCHER
      {"loop_scan_matcher", "POSE_GRAPH.constraint_builder.ceres_scan_matcher",
       "degeneracy", "translation_floor"},
#endif
#endif
#ifdef CARTOGRAPHER_EXT_SWAP_CERES_SCAN_MATCHER
      {"local_scan_matcher", "TRAJECTORY_BUILDER_2D.ceres_scan_matcher",
       "degeneracy", "translation_floor"},
#endif
#ifdef CARTOGRAPHER_EXT_SWAP_OPTIMIZATION_PROBLEM
      {"optimization_problem", "POSE_GRAPH.optimization_problem", "",
       "loop_sigma"},
#endif
#ifdef CARTOGRAPHER_EXT_SWAP_LOCAL_TRAJECTORY_BUILDER
      {"local_trajectory_builder", "TRAJECTORY_BUILDER_2D", "odometry",
       "translation_noise"},
#endif
  };
  return *places;
}

class BlockErrorsTest : public testing::TestWithParam<Place> {
 protected:
  void ExpectError(const std::string& block, const std::string& error) {
    const std::string table = GetParam().stock_table + ".cartographer_ext";
    EXPECT_DEATH(
        cartographer::mapping::test::LoadSlamOptions(table + " = " + block),
        table + error);
  }
  // The number with a value, within its table.
  std::string Number(const std::string& value) const {
    const std::string assignment = GetParam().number + " = " + value;
    return GetParam().sub_table.empty()
               ? "{ " + assignment + " }"
               : "{ " + GetParam().sub_table + " = { " + assignment + " } }";
  }
  std::string NumberKey() const {
    return (GetParam().sub_table.empty() ? "" : "." + GetParam().sub_table) +
           "." + GetParam().number;
  }
};
using BlockErrorsDeathTest = BlockErrorsTest;

TEST_P(BlockErrorsDeathTest, UnknownKey) {
  ExpectError("{ no_key = 1 }", ".no_key: unknown key, allowed: [a-z]");
}

TEST_P(BlockErrorsDeathTest, WrongType) {
  ExpectError("true", ": true is not a table");
  ExpectError(Number("'many'"),
              NumberKey() + ": \"many\" is not a number, allowed: >");
}

TEST_P(BlockErrorsDeathTest, OutOfRange) {
  ExpectError(Number("-1"), NumberKey() + ": -1 is out of range, allowed: >");
}

#if defined(CARTOGRAPHER_EXT_SWAP_CONSTRAINT_BUILDER) && \
    !(defined(CARTOGRAPHER_EXT_SWAP_FULL_INFORMATION) && \
      defined(CARTOGRAPHER_EXT_SWAP_OPTIMIZATION_PROBLEM))
TEST(FullMatrixDeathTest, NeedsItsSwaps) {
  EXPECT_DEATH(cartographer::mapping::test::LoadSlamOptions(
                   "POSE_GRAPH.constraint_builder.cartographer_ext = "
                   "{ information = { full_matrix = true } }"),
               "information.full_matrix: true needs the swaps");
}
#endif

INSTANTIATE_TEST_SUITE_P(EachPlace, BlockErrorsDeathTest,
                         testing::ValuesIn(Places()),
                         [](const testing::TestParamInfo<Place>& info) {
                           return info.param.name;
                         });

}  // namespace
}  // namespace overlay
}  // namespace cartographer_ext
