// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
#include "cartographer_ext/report/markup.h"

#include <cmath>

#include "absl/strings/ascii.h"
#include "absl/strings/str_cat.h"
#include "absl/strings/str_format.h"
#include "glog/logging.h"

namespace cartographer_ext {
namespace report {
namespace {

// Figures, with the few characters that may surround them.
bool LooksLikeNumber(const std::string& text) {
  constexpr size_t kMaxLength = 24;
  if (text.empty() || text.size() > kMaxLength) return false;
  const char first = text[0];
  return absl::ascii_isdigit(static_cast<unsigned char>(first)) ||
         ((first == '-' || first == '+') && text.size() > 1 &&
          absl::ascii_isdigit(static_cast<unsigned char>(text[1])));
}

}  // namespace

std::string Escape(const absl::string_view text) {
  std::string result;
  result.reserve(text.size());
  for (const char c : text) {
    switch (c) {
      case '&':
        result += "&amp;";
        break;
      case '<':
        result += "&lt;";
        break;
      case '>':
        result += "&gt;";
        break;
      case '"':
        result += "&quot;";
        break;
      case '\'':
        result += "&#39;";
        break;
      default: {
        const auto byte = static_cast<unsigned char>(c);
        const bool control = byte < 0x20 && c != '\n' && c != '\t';
        result += control ? ' ' : c;
      }
    }
  }
  return result;
}

std::string Number(const double value, const int decimals) {
  if (!std::isfinite(value)) return "0";
  std::string text = absl::StrFormat("%.*f", decimals, value);
  if (text.find('.') != std::string::npos) {
    text.erase(text.find_last_not_of('0') + 1);
    if (text.back() == '.') text.pop_back();
  }
  return text == "-0" ? "0" : text;
}

void Markup::Start(const std::string& name, const Attributes& attributes) {
  absl::StrAppend(&text_, "<", name);
  for (const auto& attribute : attributes) {
    absl::StrAppend(&text_, " ", attribute.first, "=\"",
                    Escape(attribute.second), "\"");
  }
}

void Markup::Open(const std::string& name, const Attributes& attributes) {
  Start(name, attributes);
  text_ += ">";
  open_.push_back(name);
}

void Markup::Close() {
  CHECK(!open_.empty());
  absl::StrAppend(&text_, "</", open_.back(), ">\n");
  open_.pop_back();
}

void Markup::Text(const absl::string_view text) { text_ += Escape(text); }

void Markup::Element(const std::string& name, const Attributes& attributes,
                     const absl::string_view text) {
  Start(name, attributes);
  absl::StrAppend(&text_, ">", Escape(text), "</", name, ">\n");
}

void Markup::Empty(const std::string& name, const Attributes& attributes) {
  Start(name, attributes);
  text_ += "/>";
}

void Markup::Raw(const absl::string_view markup) {
  absl::StrAppend(&text_, markup);
}

const std::string& Markup::str() const {
  CHECK(open_.empty()) << open_.back() << " is still open";
  return text_;
}

std::string Table::ToHtml(const std::string& caption) const {
  Markup markup;
  markup.Open("div", {{"class", "scroll"}});
  markup.Open("table");
  if (!caption.empty()) markup.Element("caption", {}, caption);
  markup.Open("thead");
  markup.Open("tr");
  for (const std::string& cell : head_) {
    markup.Element("th", {{"scope", "col"}}, cell);
  }
  markup.Close();
  markup.Close();
  markup.Open("tbody");
  for (const auto& row : rows_) {
    markup.Open("tr");
    for (size_t i = 0; i < row.size(); ++i) {
      if (i == 0) {
        markup.Element("th", {{"scope", "row"}}, row[i]);
      } else if (LooksLikeNumber(row[i])) {
        markup.Element("td", {{"class", "number"}}, row[i]);
      } else {
        markup.Element("td", {}, row[i]);
      }
    }
    markup.Close();
  }
  markup.Close();
  markup.Close();
  markup.Close();
  return markup.str();
}

}  // namespace report
}  // namespace cartographer_ext
