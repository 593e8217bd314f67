// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
//
// Cartographer aborts if a configuration is wrong: a missing key, a value of
// the wrong type or out of range, an unused key. A command should report this
// and return an exit code, and a search over configurations should continue
// with the next one. So code that may abort is first run in a child process,
// whose last message becomes the error.
#ifndef CARTOGRAPHER_EXT_CONFIGURATION_FATAL_GUARD_H_
#define CARTOGRAPHER_EXT_CONFIGURATION_FATAL_GUARD_H_

#include <functional>

#include "absl/status/status.h"

namespace cartographer_ext {
namespace evaluation {

// Runs `body` in a child process without output and waits for it. OK if it
// returned; InvalidArgument with the text of the failed check if it aborted in
// one, ended the process itself with code 0 (os.exit of Lua) or took more than
// `max_cpu_seconds` in all threads; Internal if it crashed or no child could be
// created. Changes of `body` in memory are not visible to the caller. Must be
// called while the process has no other threads that might hold locks needed by
// `body`.
absl::Status TryInChildProcess(const std::function<void()>& body,
                               int max_cpu_seconds = 60);

}  // namespace evaluation
}  // namespace cartographer_ext

#endif  // CARTOGRAPHER_EXT_CONFIGURATION_FATAL_GUARD_H_
