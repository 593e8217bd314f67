// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
//
// What holds for the values of flags in every command.
#ifndef CARTOGRAPHER_EXT_TOOLS_FLAG_VALUES_H_
#define CARTOGRAPHER_EXT_TOOLS_FLAG_VALUES_H_

#include <string>
#include <vector>

#include "absl/status/status.h"

namespace cartographer_ext {
namespace tools {

// An error for a number that means nothing: NaN, negative (but for flags with
// the default -1, which may be -1), infinite (but for limits, -max_...), more
// threads or processes than a computer has, or a -resolution without a map; also
// for standard output (-) where a map or picture is named.
// Words that are no number are left to gflags.
absl::Status CheckFlagValue(const std::string& name, const std::string& value);

// The only values of a flag, or how its file name may end.
struct FlagChoices {
  enum class Kind { kOne, kList, kEnding };  // a list has commas
  std::string flag;
  std::vector<std::string> values;
  Kind kind = Kind::kOne;
};

// An error that names the values where a flag has another one; similar ones are
// suggested. A flag whose default is empty may be empty, devices and pipes have
// no ending. Pictures (-..picture_filename) end in .png unless `choices` say
// otherwise.
absl::Status CheckFlagChoices(const std::vector<FlagChoices>& choices);

// Marks an error as one of wrong usage: its exit code is kExitUsage.
absl::Status WrongUsage(absl::Status status);
bool IsWrongUsage(const absl::Status& status);

// The shortest text that reads back as the same number: gflags prints 0.05 as
// 0.050000000000000003. Other texts stay.
std::string ShortestNumber(const std::string& text);

// The text with control characters, which could move the cursor of a terminal,
// replaced by '?'. Line ends and tabulators stay, and so does UTF-8.
std::string Printable(const std::string& text);

}  // namespace tools
}  // namespace cartographer_ext

#endif  // CARTOGRAPHER_EXT_TOOLS_FLAG_VALUES_H_
