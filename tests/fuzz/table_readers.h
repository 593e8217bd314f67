// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
//
// What reads the tables, journals and lists that the commands take, for
// fuzz_readers.
#ifndef TESTS_FUZZ_TABLE_READERS_H_
#define TESTS_FUZZ_TABLE_READERS_H_

#include <functional>
#include <map>
#include <string>

namespace cartographer_ext {
namespace test {

// By kind: reads the file of this name and says whether it was taken.
std::map<std::string, std::function<bool(const std::string&)>> TableReaders();

}  // namespace test
}  // namespace cartographer_ext

#endif  // TESTS_FUZZ_TABLE_READERS_H_
