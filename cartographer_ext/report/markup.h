// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
//
// A small writer of HTML and SVG. Names of elements and attributes are trusted;
// values and texts are escaped.
//
//   Markup page;
//   page.Open("p", {{"class", "note"}});
//   page.Text("a < b");
//   page.Close();
//   page.str();  // <p class="note">a &lt; b</p>
#ifndef CARTOGRAPHER_EXT_REPORT_MARKUP_H_
#define CARTOGRAPHER_EXT_REPORT_MARKUP_H_

#include <string>
#include <utility>
#include <vector>

#include "absl/strings/string_view.h"

namespace cartographer_ext {
namespace report {

using Attributes = std::vector<std::pair<std::string, std::string>>;

// & < > " ' as references; characters that XML does not allow become a space.
std::string Escape(absl::string_view text);

// A number with at most `decimals` decimals and no trailing zeros. Numbers that
// are not finite become 0, since SVG cannot represent them.
std::string Number(double value, int decimals = 2);

class Markup {
 public:
  void Open(const std::string& name, const Attributes& attributes = {});
  // Closes the innermost open element.
  void Close();
  void Text(absl::string_view text);
  // <name attributes>text</name>
  void Element(const std::string& name, const Attributes& attributes,
               absl::string_view text);
  // <name attributes/>
  void Empty(const std::string& name, const Attributes& attributes);
  // Adds markup without escaping.
  void Raw(absl::string_view markup);

  // All elements must be closed.
  const std::string& str() const;
  bool empty() const { return text_.empty(); }

 private:
  void Start(const std::string& name, const Attributes& attributes);

  std::string text_;
  std::vector<std::string> open_;
};

// Rows of text as a table; numbers are right-aligned.
class Table {
 public:
  explicit Table(std::vector<std::string> head) : head_(std::move(head)) {}
  void AddRow(std::vector<std::string> cells) {
    rows_.push_back(std::move(cells));
  }
  bool empty() const { return rows_.empty(); }
  // The first column is the header of its row.
  std::string ToHtml(const std::string& caption) const;

 private:
  std::vector<std::string> head_;
  std::vector<std::vector<std::string>> rows_;
};

}  // namespace report
}  // namespace cartographer_ext

#endif  // CARTOGRAPHER_EXT_REPORT_MARKUP_H_
