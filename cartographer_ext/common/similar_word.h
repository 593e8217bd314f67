// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
//
// "Did you mean": the known name that is most similar to an unknown one.
#ifndef CARTOGRAPHER_EXT_COMMON_SIMILAR_WORD_H_
#define CARTOGRAPHER_EXT_COMMON_SIMILAR_WORD_H_

#include <string>
#include <vector>

namespace cartographer_ext {

// The first of `names` with the fewest letters to change, add or drop
// (Levenshtein distance), if that is at most a third of the letters of `word`;
// else empty.
std::string SimilarWord(const std::string& word,
                        const std::vector<std::string>& names);

// ", did you mean 'NAME'?", to end a message; empty where there is no name.
std::string DidYouMean(const std::string& similar);

}  // namespace cartographer_ext

#endif  // CARTOGRAPHER_EXT_COMMON_SIMILAR_WORD_H_
