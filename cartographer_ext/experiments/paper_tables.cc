// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
#include "cartographer_ext/experiments/paper_tables.h"

namespace cartographer_ext {
namespace experiments {
namespace {

constexpr const char* kTypes[4] = {"R", "L", "RG", "LG"};

// Of one set, four counts by the types R, L, RG, LG.
struct Block {
  const char* dataset;
  double baseline[4][4];
  double method[4][4];
};

std::vector<PrintedRow> Rows(const std::vector<Block>& blocks,
                             const int first_count, const int step) {
  std::vector<PrintedRow> rows;
  for (const Block& block : blocks) {
    for (int i = 0; i != 4; ++i) {
      for (int k = 0; k != 4; ++k) {
        PrintedRow row;
        row.dataset = block.dataset;
        row.type = kTypes[k];
        row.count = first_count + i * step;
        row.baseline = block.baseline[i][k];
        row.method = block.method[i][k];
        rows.push_back(row);
      }
    }
  }
  return rows;
}

}  // namespace

std::vector<PrintedRow> AcsTable2() {
  return Rows({{"city10000",
                {{40.5, 32.4, 50.4, 25.2},
                 {95.6, 33.8, 84.1, 31.4},
                 {218.4, 45.1, 123.4, 41.8},
                 {320.2, 47.6, 240.6, 53.4}},
                {{15.6, 8.5, 9.4, 4.2},
                 {40.1, 9.2, 23.5, 5.3},
                 {65.1, 12.4, 31.1, 8.2},
                 {206.9, 11.7, 180.1, 10.8}}},
               {"bicocca25b_0.800",
                {{-1., -1., -1., -1.},
                 {-1., -1., -1., -1.},
                 {-1., -1., -1., -1.},
                 {-1., -1., -1., -1.}},
                {{2.1, 0.9, 1.7, 1.0},
                 {2.5, 1.1, 2.4, 1.4},
                 {3.7, 1.7, 3.4, 1.3},
                 {5.1, 2.7, 6.8, 2.4}}},
               {"manhattan_olson",
                {{12.6, 2.3, 9.7, 2.4},
                 {19.7, 2.4, 16.5, 2.1},
                 {28.6, 3.4, 32.6, 3.6},
                 {45.6, 4.5, 38.2, 4.8}},
                {{6.4, 1.2, 3.9, 1.6},
                 {7.5, 2.1, 8.4, 1.9},
                 {19.6, 2.3, 21.9, 3.2},
                 {24.8, 3.1, 20.7, 4.4}}},
               {"manhattan_g2o",
                {{3.8, 1.7, 3.5, 1.2},
                 {7.6, 2.6, 4.5, 2.8},
                 {9.4, 3.2, 11.2, 5.1},
                 {12.6, 3.4, 12.1, 6.7}},
                {{2.1, 1.1, 2.3, 0.9},
                 {4.5, 1.7, 3.2, 1.6},
                 {6.5, 1.9, 5.7, 2.6},
                 {8.4, 2.2, 7.5, 4.1}}}},
              1000, 1000);
}

std::vector<PrintedRow> RIsamTable2() {
  return Rows(
      {{"intel",
        {{0.32, 0.18, 0.38, 0.20},
         {0.59, 0.39, 0.68, 0.32},
         {1.24, 0.61, 1.13, 0.52},
         {1.60, 0.94, 1.58, 0.91}},
        {{9, 6, 8, 7}, {13, 8, 12, 8}, {15, 10, 16, 9}, {18, 13, 20, 14}}},
       {"manhattan_olson",
        {{2.2, 1.2, 2.8, 1.5},
         {3.8, 1.7, 3.5, 1.6},
         {5.4, 2.8, 5.2, 2.1},
         {7.6, 2.6, 4.5, 2.8}},
        {{13, 9, 15, 10},
         {19, 13, 21, 14},
         {26, 18, 28, 19},
         {38, 25, 37, 28}}},
       {"city10000",
        {{32.4, 21.5, 38.1, 19.5},
         {40.5, 32.4, 50.4, 25.2},
         {78.5, 35.3, 71.2, 32.1},
         {95.6, 33.8, 84.1, 31.4}},
        {{41, 27, 39, 24},
         {67, 39, 59, 42},
         {84, 53, 76, 59},
         {112, 71, 104, 82}}}},
      500, 500);
}

}  // namespace experiments
}  // namespace cartographer_ext
