// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
#include "cartographer/common/internal/ceres_solver_options.h"

#include <memory>
#include <string>
#include <vector>

#include "cartographer/common/configuration_file_resolver.h"
#include "gtest/gtest.h"

namespace cartographer {
namespace common {
namespace {

proto::CeresSolverOptions Load(const std::string& code) {
  LuaParameterDictionary dictionary(
      code, std::unique_ptr<FileResolver>(
                new ConfigurationFileResolver(std::vector<std::string>())));
  return CreateCeresSolverOptionsProto(&dictionary);
}

TEST(CeresSolverOptionsTest, FromLuaToCeres) {
  const auto options = CreateCeresSolverOptions(
      Load("return { use_nonmonotonic_steps = true, max_num_iterations = 7, "
           "num_threads = 3 }"));
  EXPECT_TRUE(options.use_nonmonotonic_steps);
  EXPECT_EQ(options.max_num_iterations, 7);
  EXPECT_EQ(options.num_threads, 3);
}

TEST(CeresSolverOptionsDeathTest, RefusesZero) {
  EXPECT_DEATH(Load("return { use_nonmonotonic_steps = true, "
                    "max_num_iterations = 0, num_threads = 3 }"),
               "max_num_iterations");
  EXPECT_DEATH(Load("return { use_nonmonotonic_steps = true, "
                    "max_num_iterations = 1, num_threads = 0 }"),
               "num_threads");
}

}  // namespace
}  // namespace common
}  // namespace cartographer
