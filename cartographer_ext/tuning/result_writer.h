// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
//
// The result of a search as a Lua configuration file, as a table, and as JSON.
#ifndef CARTOGRAPHER_EXT_TUNING_RESULT_WRITER_H_
#define CARTOGRAPHER_EXT_TUNING_RESULT_WRITER_H_

#include <string>
#include <vector>

#include "cartographer_ext/tuning/tuner.h"
#include "nlohmann/json.hpp"

namespace cartographer_ext {
namespace tuning {

// Confidence that changing a key is better: "high" when it was on every
// recording of at least three, "medium" when it was on every recording of two,
// or on two thirds of more, "low" otherwise, "not measured" if pruning did not
// reach it.
std::string Confidence(const KeyResult& key, size_t num_inputs);

// What the search was about.
struct ResultContext {
  std::string configuration;
  std::vector<std::string> directories;  // where it and its includes are
  std::string filename;                  // of the Lua file, without folders
  std::string objective;                 // "relations"
  std::vector<Parameter> parameters;
  std::vector<TuneInput> inputs;
  std::vector<TuneInput> holdout;
};

// A complete configuration: includes the one that the search started from and
// sets the changed keys, each with its old value, gain and confidence. The
// included files must be in the folders searched.
std::string ToLuaFile(const TuneResult& result, const ResultContext& context);

std::string ToText(const TuneResult& result, const ResultContext& context);

nlohmann::ordered_json ToJson(const TuneResult& result,
                              const ResultContext& context);

}  // namespace tuning
}  // namespace cartographer_ext

#endif  // CARTOGRAPHER_EXT_TUNING_RESULT_WRITER_H_
