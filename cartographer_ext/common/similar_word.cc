// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
#include "cartographer_ext/common/similar_word.h"

#include <algorithm>
#include <numeric>

namespace cartographer_ext {
namespace {

int EditDistance(const std::string& a, const std::string& b) {
  std::vector<int> row(b.size() + 1);
  std::iota(row.begin(), row.end(), 0);
  for (size_t i = 1; i <= a.size(); ++i) {
    int diagonal = row[0];
    row[0] = static_cast<int>(i);
    for (size_t j = 1; j <= b.size(); ++j) {
      const int replaced = diagonal + (a[i - 1] == b[j - 1] ? 0 : 1);
      diagonal = row[j];
      row[j] = std::min(replaced, 1 + std::min(row[j - 1], row[j]));
    }
  }
  return row[b.size()];
}

}  // namespace

std::string SimilarWord(const std::string& word,
                        const std::vector<std::string>& names) {
  std::string best;
  int best_distance = 1 + static_cast<int>(word.size()) / 3;
  for (const std::string& name : names) {
    const int distance = EditDistance(word, name);
    if (distance < best_distance) {
      best_distance = distance;
      best = name;
    }
  }
  return best;
}

std::string DidYouMean(const std::string& similar) {
  return similar.empty() ? "" : ", did you mean '" + similar + "'?";
}

}  // namespace cartographer_ext
