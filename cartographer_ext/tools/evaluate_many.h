// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
//
// cartographer_ext_evaluate over many maps, with the flags that only they have.
#ifndef CARTOGRAPHER_EXT_TOOLS_EVALUATE_MANY_H_
#define CARTOGRAPHER_EXT_TOOLS_EVALUATE_MANY_H_

#include <string>
#include <vector>

namespace cartographer_ext {
namespace tools {

// What is wrong with the flags of many maps, or, for one map, that they are
// given; else empty.
std::string WrongUsageOfMany(bool many);

// Judges all maps that `inputs` name and writes what is asked for. Returns the
// exit code. Takes the arguments of the program for MPI.
int EvaluateMany(const std::vector<std::string>& inputs, int* argc,
                 char*** argv);

}  // namespace tools
}  // namespace cartographer_ext

#endif  // CARTOGRAPHER_EXT_TOOLS_EVALUATE_MANY_H_
