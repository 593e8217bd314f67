// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
//
// Cartographer ends the program when a configuration is wrong: a missing key, a
// value of the wrong type or out of range, a key nobody reads. A command wants
// to say so and return an exit code, and a search over configurations wants to
// go on with the next. So what may end the program is tried in a child process
// first, whose last words become the error.
#ifndef CARTOGRAPHER_EXT_CONFIGURATION_FATAL_GUARD_H_
#define CARTOGRAPHER_EXT_CONFIGURATION_FATAL_GUARD_H_

#include <functional>

#include "absl/status/status.h"

namespace cartographer_ext {
namespace evaluation {

// Runs `body` in a child process without output and waits for it. OK when it
// returned; InvalidArgument with the text of the failed check when it ended in
// one, ended the process itself with code 0 (os.exit of Lua) or took more than
// `max_cpu_seconds` of all threads; Internal when it crashed or no child could
// be made. Nothing `body`
// changes in memory is seen by the caller. To be called while the process has
// no other threads that might hold locks which `body` needs.
absl::Status TryInChildProcess(const std::function<void()>& body,
                               int max_cpu_seconds = 60);

}  // namespace evaluation
}  // namespace cartographer_ext

#endif  // CARTOGRAPHER_EXT_CONFIGURATION_FATAL_GUARD_H_
