// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
//
// cartographer_ext_evaluate on many maps, with its additional flags.
#ifndef CARTOGRAPHER_EXT_TOOLS_EVALUATE_MANY_H_
#define CARTOGRAPHER_EXT_TOOLS_EVALUATE_MANY_H_

#include <string>
#include <vector>

namespace cartographer_ext {
namespace tools {

// An error in the flags for many maps, or their use with one map; otherwise
// empty.
std::string WrongUsageOfMany(bool many);

// Judges all maps named by `inputs` and writes the requested outputs. Returns
// the exit code. Takes the arguments of the program for MPI.
int EvaluateMany(const std::vector<std::string>& inputs, int* argc,
                 char*** argv);

}  // namespace tools
}  // namespace cartographer_ext

#endif  // CARTOGRAPHER_EXT_TOOLS_EVALUATE_MANY_H_
