// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
//
// Operations on whole option messages: our blocks inside them, and differences.
#ifndef CARTOGRAPHER_EXT_CONFIGURATION_OPTION_MESSAGES_H_
#define CARTOGRAPHER_EXT_CONFIGURATION_OPTION_MESSAGES_H_

#include <string>
#include <vector>

#include "google/protobuf/message.h"

namespace cartographer_ext {
namespace evaluation {

// Removes our blocks from a message and its parts. Returns whether there were
// any.
bool RemoveExtensions(google::protobuf::Message* message);

// Copies our blocks from `source` and its parts to the same places of
// `target`. Parts that only `source` has are ignored.
void CopyExtensions(const google::protobuf::Message& source,
                    google::protobuf::Message* target);

// Differing keys of two option messages, one per line:
// "constraint_builder_options.min_score: 0.55 -> 0.6".
std::vector<std::string> DescribeDifferences(
    const google::protobuf::Message& first,
    const google::protobuf::Message& second);

}  // namespace evaluation
}  // namespace cartographer_ext

#endif  // CARTOGRAPHER_EXT_CONFIGURATION_OPTION_MESSAGES_H_
