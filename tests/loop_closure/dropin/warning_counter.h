// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
#ifndef TESTS_LOOP_CLOSURE_DROPIN_WARNING_COUNTER_H_
#define TESTS_LOOP_CLOSURE_DROPIN_WARNING_COUNTER_H_

#include <cstddef>
#include <ctime>
#include <string>

#include "glog/logging.h"

namespace cartographer_ext {
namespace loop_closure {
namespace test {

// Counts the warnings logged while it exists.
class WarningCounter : public google::LogSink {
 public:
  WarningCounter() { google::AddLogSink(this); }
  ~WarningCounter() override { google::RemoveLogSink(this); }
  void send(const google::LogSeverity severity, const char* /*full_filename*/,
            const char* /*base_filename*/, int /*line*/,
            const struct ::tm* /*tm_time*/, const char* const message,
            const size_t message_length) override {
    if (severity != google::GLOG_WARNING) return;
    ++count;
    last.assign(message, message_length);
  }

  int count = 0;
  std::string last;
};

}  // namespace test
}  // namespace loop_closure
}  // namespace cartographer_ext

#endif  // TESTS_LOOP_CLOSURE_DROPIN_WARNING_COUNTER_H_
