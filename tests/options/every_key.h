// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
//
// What holds for every key of an option message that becomes plain options.
#ifndef TESTS_OPTIONS_EVERY_KEY_H_
#define TESTS_OPTIONS_EVERY_KEY_H_

#include <functional>
#include <map>
#include <string>
#include <vector>

#include "cartographer_ext/options/option_description.h"
#include "gmock/gmock.h"
#include "google/protobuf/message.h"
#include "gtest/gtest.h"

namespace cartographer_ext {
namespace options {
namespace test {

// Key to what it sets.
using KeyValues = std::map<std::string, double>;

template <typename Message>
Message Defaults() {
  Message message;
  SetDefaults(&message);
  return message;
}

// `values` of a message with the defaults has every key, and is `plain`, what
// the plain options have initially.
template <typename Message>
void ExpectSameDefaults(const std::function<KeyValues(const Message&)>& values,
                        const KeyValues& plain) {
  const KeyValues shipped = values(Defaults<Message>());
  EXPECT_EQ(shipped, plain);
  std::vector<std::string> compared, keys;
  for (const auto& value : shipped) compared.push_back(value.first);
  for (const auto& option : Describe(Defaults<Message>())) {
    keys.push_back(option.key);
  }
  EXPECT_THAT(keys, testing::UnorderedElementsAreArray(compared));
}

template <typename Message>
void ExpectEveryKeyHasAnEffect(
    const std::function<KeyValues(const Message&)>& values) {
  using google::protobuf::FieldDescriptor;
  const auto& block = *Message::descriptor();
  int num_keys = 0;
  for (int i = 0; i < block.field_count(); ++i) {
    const auto* const table = block.field(i)->message_type();
    if (table == nullptr) continue;
    for (int k = 0; k < table->field_count(); ++k, ++num_keys) {
      const auto* const field = table->field(k);
      std::vector<double> read;
      for (const int value : {0, 7}) {
        Message message = Defaults<Message>();
        auto* const target =
            message.GetReflection()->MutableMessage(&message, block.field(i));
        const auto* const reflection = target->GetReflection();
        switch (field->cpp_type()) {
          case FieldDescriptor::CPPTYPE_BOOL:
            reflection->SetBool(target, field, value > 0);
            break;
          case FieldDescriptor::CPPTYPE_STRING:
            reflection->SetString(target, field, std::string(value, 'x'));
            break;
          case FieldDescriptor::CPPTYPE_INT32:
            reflection->SetInt32(target, field, value);
            break;
          default:
            reflection->SetDouble(target, field, value);
        }
        read.push_back(
            values(message).at(block.field(i)->name() + "." + field->name()));
      }
      EXPECT_NE(read[0], read[1]) << field->full_name();
    }
  }
  EXPECT_EQ(num_keys, static_cast<int>(Describe(Defaults<Message>()).size()));
}

}  // namespace test
}  // namespace options
}  // namespace cartographer_ext

#endif  // TESTS_OPTIONS_EVERY_KEY_H_
