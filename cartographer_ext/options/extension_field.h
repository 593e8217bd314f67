// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
//
// How our options travel through Cartographer's own option messages: encoded as
// a message of ours in unknown field 51966 of the stock message that the Lua
// table extends. Unknown fields survive copies, moves, nesting, serialisation,
// pbstreams and gRPC, so nothing of Cartographer has to know about them. The
// field is there only when the user's Lua has our block; without it the stock
// message stays as it is, bit for bit.
//
// Our messages have `int32 schema = 1`. A schema newer than ours is fatal: a
// file written by a newer version must not be half understood.
#ifndef CARTOGRAPHER_EXT_OPTIONS_EXTENSION_FIELD_H_
#define CARTOGRAPHER_EXT_OPTIONS_EXTENSION_FIELD_H_

#include "google/protobuf/message.h"

namespace cartographer_ext {
namespace options {

// Number of the unknown field.
constexpr int kExtensionFieldNumber = 51966;
// Newest schema this code understands. Since 2 only the keys that
// docs/options.md lists are options; what a message of schema 1 has beside them
// is ignored, since the values are constants.
constexpr int kSchema = 2;

// Replaces the extension of `stock_options` by `extension`, with its schema set
// to kSchema.
void SetExtension(const google::protobuf::Message& extension,
                  google::protobuf::Message* stock_options);

bool HasExtension(const google::protobuf::Message& stock_options);

// Decodes into `extension` and returns true where there is one. Bytes that do
// not decode, and a newer schema, are fatal. Several entries (from merging
// messages) are merged in order.
bool GetExtension(const google::protobuf::Message& stock_options,
                  google::protobuf::Message* extension);

}  // namespace options
}  // namespace cartographer_ext

#endif  // CARTOGRAPHER_EXT_OPTIONS_EXTENSION_FIELD_H_
