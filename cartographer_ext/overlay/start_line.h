// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
#ifndef CARTOGRAPHER_EXT_OVERLAY_START_LINE_H_
#define CARTOGRAPHER_EXT_OVERLAY_START_LINE_H_

#include <string>

#include "cartographer_ext/options/option_printing.h"
#include "cartographer_ext/swaps.h"
#include "glog/logging.h"
#include "google/protobuf/message.h"

namespace cartographer_ext {

// Logs that one of our classes is used in place of `stock_class`, because the
// configuration has the block `lua_path`, with these options.
inline void LogStart(const std::string& stock_class,
                     const std::string& lua_path,
                     const google::protobuf::Message& options) {
  LOG(INFO) << "cartographer_ext " << CARTOGRAPHER_EXT_SWAPPED_VERSION
            << " in place of " << stock_class << ", " << lua_path << ": "
            << options::ChangesToText(options);
}

}  // namespace cartographer_ext

#endif  // CARTOGRAPHER_EXT_OVERLAY_START_LINE_H_
