// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
//
// A LineJournal whose lines are items that are looked up by a key: what an
// earlier command has finished need not be done again.
#ifndef CARTOGRAPHER_EXT_IO_KEYED_JOURNAL_H_
#define CARTOGRAPHER_EXT_IO_KEYED_JOURNAL_H_

#include <functional>
#include <map>
#include <memory>
#include <string>
#include <utility>

#include "absl/status/status.h"
#include "absl/status/statusor.h"
#include "cartographer_ext/io/line_journal.h"
#include "nlohmann/json.hpp"

namespace cartographer_ext {
namespace io {

template <typename Item>
class KeyedJournal {
 public:
  // The key and the item of a line, or an error, which is reported with file
  // and line.
  using Parser = std::function<absl::StatusOr<std::pair<std::string, Item>>(
      const nlohmann::json&)>;

  // As LineJournal::Open. Of several lines with a key the last one counts.
  absl::Status Open(const std::string& filename, const JournalKind& kind,
                    const std::string& fingerprint, const Parser& parse) {
    auto lines = LineJournal::Open(
        filename, kind, fingerprint, [&](const nlohmann::json& line) {
          auto entry = parse(line);
          if (entry.ok()) {
            items_[entry->first] = std::move(entry->second);
          }
          return entry.status();
        });
    if (!lines.ok()) return lines.status();
    lines_ = *std::move(lines);
    return absl::OkStatus();
  }

  // Of the lines read; null if there is none.
  const Item* Find(const std::string& key) const {
    const auto found = items_.find(key);
    return found == items_.end() ? nullptr : &found->second;
  }

  // On disk if it returns OK.
  absl::Status Append(const nlohmann::ordered_json& line) {
    return lines_->Append(line);
  }

 private:
  std::unique_ptr<LineJournal> lines_;
  std::map<std::string, Item> items_;
};

}  // namespace io
}  // namespace cartographer_ext

#endif  // CARTOGRAPHER_EXT_IO_KEYED_JOURNAL_H_
