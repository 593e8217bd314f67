// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
//
// How our options are carried in Cartographer's own option messages: encoded as
// a message of ours in unknown field 51966 of the stock message that the Lua
// table extends. Unknown fields survive copies, moves, nesting, serialisation,
// pbstreams and gRPC, so Cartographer need not be aware of them. The field is
// present only if the user's Lua has our block; without it the stock message is
// unchanged, bit for bit.
//
// Our messages have `int32 schema = 1`. A schema newer than ours is fatal: a
// file written by a newer version must not be interpreted partially.
#ifndef CARTOGRAPHER_EXT_OPTIONS_EXTENSION_FIELD_H_
#define CARTOGRAPHER_EXT_OPTIONS_EXTENSION_FIELD_H_

#include "google/protobuf/message.h"

namespace cartographer_ext {
namespace options {

// Number of the unknown field.
constexpr int kExtensionFieldNumber = 51966;
// Newest schema this code understands. Since schema 2 only the keys in
// docs/options.md are options; other fields of a message of schema 1 are
// ignored, since their values are now constants.
constexpr int kSchema = 2;

// Replaces the extension of `stock_options` by `extension`, with its schema set
// to kSchema.
void SetExtension(const google::protobuf::Message& extension,
                  google::protobuf::Message* stock_options);

// Whether `stock_options` has our options.
bool HasExtension(const google::protobuf::Message& stock_options);

// Decodes the extension, if any, into `extension` and returns whether there is
// one. Bytes that cannot be decoded, and a newer schema, are fatal. Several
// entries (from merging messages) are merged in order.
bool GetExtension(const google::protobuf::Message& stock_options,
                  google::protobuf::Message* extension);

}  // namespace options
}  // namespace cartographer_ext

#endif  // CARTOGRAPHER_EXT_OPTIONS_EXTENSION_FIELD_H_
