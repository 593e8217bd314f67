// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
#ifndef CARTOGRAPHER_COMMON_LUA_PARAMETER_DICTIONARY_H_
#define CARTOGRAPHER_COMMON_LUA_PARAMETER_DICTIONARY_H_

#include <map>
#include <memory>
#include <string>
#include <vector>

#include "cartographer/common/port.h"

namespace cartographer {
namespace common {

// Finds configuration files by name. A file that cannot be found or read is
// fatal.
class FileResolver {
 public:
  virtual ~FileResolver() {}
  virtual std::string GetFullPathOrDie(const std::string& basename) = 0;
  virtual std::string GetFileContentOrDie(const std::string& basename) = 0;
};

// The table that a piece of Lua code returns. The code sees the standard
// libraries and
//   include "file"         runs another file, once at most,
//   read "file"            the content of a file as a string,
//   choose(condition, a, b)
//
// Strictness: when a dictionary goes away, every string key must have been read
// exactly once, otherwise the program ends with a message that names the key by
// its path from the root table ("pose_graph.constraint_builder.min_score").
// HasKey and GetKeys do not count as reading. The same for a missing key or a
// value of the wrong type. Sub-dictionaries must go away before their parent.
class LuaParameterDictionary {
 public:
  LuaParameterDictionary(const std::string& code,
                         std::unique_ptr<FileResolver> file_resolver);
  LuaParameterDictionary(const LuaParameterDictionary&) = delete;
  LuaParameterDictionary& operator=(const LuaParameterDictionary&) = delete;
  ~LuaParameterDictionary();

  // Without the exactly-once rule.
  static std::unique_ptr<LuaParameterDictionary> NonReferenceCounted(
      const std::string& code, std::unique_ptr<FileResolver> file_resolver);

  // String keys in alphabetical order.
  std::vector<std::string> GetKeys() const;
  bool HasKey(const std::string& key) const;

  std::string GetString(const std::string& key);
  double GetDouble(const std::string& key);
  // A number with a fraction is fatal.
  int GetInt(const std::string& key);
  bool GetBool(const std::string& key);
  std::unique_ptr<LuaParameterDictionary> GetDictionary(const std::string& key);
  // A negative value is fatal.
  int GetNonNegativeInt(const std::string& key);

  // The table as Lua source text, without counting as a read.
  std::string ToString() const;

  // The values of integer keys 1, 2, ... in order; these are not counted.
  std::vector<double> GetArrayValuesAsDoubles();
  std::vector<std::string> GetArrayValuesAsStrings();
  std::vector<std::unique_ptr<LuaParameterDictionary>>
  GetArrayValuesAsDictionaries();

 private:
  class State;  // the interpreter, shared by a dictionary and its parts

  // Runs the code and leaves the table it returns on the stack.
  static std::shared_ptr<State> Run(const std::string& code,
                                    std::unique_ptr<FileResolver> resolver);

  // Takes the table from the top of the stack.
  LuaParameterDictionary(std::shared_ptr<State> state, std::string path,
                         bool reference_counted);

  void PushTable() const;
  // Counts the read.
  void PushValueOrDie(const std::string& key);
  void CheckType(bool matches, const std::string& key,
                 const char* expected) const;
  std::string KeyPath(const std::string& key) const;

  // Take the value from the top of the stack; `key` is for messages.
  double PopDouble(const std::string& key) const;
  std::string PopString(const std::string& key) const;
  std::unique_ptr<LuaParameterDictionary> PopDictionary(
      const std::string& key) const;
  std::string PopAsText(const std::string& indent) const;
  // Pushes the array values in turn; `pop_value` gets the index as text.
  template <typename PopValue>
  void ForEachArrayValue(const PopValue& pop_value) const;

  const std::shared_ptr<State> state_;
  const std::string path_;  // "" for the root
  const bool reference_counted_;
  int registry_reference_;
  std::map<std::string, int> read_counts_;
};

}  // namespace common
}  // namespace cartographer

#endif  // CARTOGRAPHER_COMMON_LUA_PARAMETER_DICTIONARY_H_
