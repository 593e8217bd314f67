// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
#include "cartographer_ext/collection/overview_page.h"

#include <algorithm>
#include <filesystem>
#include <system_error>

#include "absl/strings/ascii.h"
#include "absl/strings/str_cat.h"
#include "absl/strings/str_format.h"
#include "absl/strings/str_join.h"
#include "cartographer_ext/report/markup.h"
#include "cartographer_ext/report/sections.h"

namespace cartographer_ext {
namespace collection {
namespace {

using report::Markup;
using report::Number;

constexpr const char* kVerdicts[] = {"failed", "broken", "doubtful", "unknown",
                                     "sound"};

constexpr char kStyle[] = R"css(
.overview td,.overview th{padding:6px 12px 6px 0}
.overview img{display:block;max-width:144px;max-height:144px;
filter:var(--map-filter);image-rendering:pixelated}
.overview .name{max-width:30ch;overflow-wrap:anywhere}
.overview .why{max-width:60ch}
.badge{font-weight:700}.badge.sound{color:var(--green)}
.badge.doubtful{color:var(--orange)}
.badge.broken,.badge.failed{color:var(--red)}
.filters{display:none;flex-wrap:wrap;gap:8px 18px;align-items:center;
margin:14px 0}.filters.on{display:flex}
.filters input[type=search]{font:inherit;padding:4px 8px;min-width:24ch;
background:var(--panel);color:var(--ink);border:1px solid var(--rule);
border-radius:4px}
.overview thead button{all:unset;cursor:pointer;text-decoration:underline dotted}
.overview thead button:focus-visible{outline:2px solid var(--blue)}
.overview th[aria-sort=ascending] button::after{content:" \25B2"}
.overview th[aria-sort=descending] button::after{content:" \25BC"}
)css";

constexpr char kScript[] = R"js(
(function(){
var table=document.querySelector('.overview'),body=table.tBodies[0];
var rows=Array.prototype.slice.call(body.rows);
var bar=document.querySelector('.filters'),text=bar.querySelector('[type=search]');
var boxes=Array.prototype.slice.call(bar.querySelectorAll('[type=checkbox]'));
var shown=document.getElementById('shown');bar.classList.add('on');
function filter(){
var words=text.value.toLowerCase(),on={},n=0;
boxes.forEach(function(b){on[b.value]=b.checked;});
rows.forEach(function(row){
var hide=!on[row.dataset.verdict]||row.textContent.toLowerCase().indexOf(words)<0;
row.hidden=hide;if(!hide)n++;});
shown.textContent=n+' of '+rows.length+' shown';}
text.addEventListener('input',filter);
boxes.forEach(function(b){b.addEventListener('change',filter);});
Array.prototype.forEach.call(table.tHead.rows[0].cells,function(head,column){
if(!head.dataset.sort)return;
var button=document.createElement('button');
button.textContent=head.textContent;head.textContent='';head.appendChild(button);
button.addEventListener('click',function(){
var down=head.getAttribute('aria-sort')!=='descending',sign=down?-1:1;
Array.prototype.forEach.call(table.tHead.rows[0].cells,function(h){
h.removeAttribute('aria-sort');});
head.setAttribute('aria-sort',down?'descending':'ascending');
rows.sort(function(a,b){
var x=a.cells[column].dataset.key,y=b.cells[column].dataset.key;
return sign*(head.dataset.sort==='number'?x-y:x<y?-1:x>y?1:0);});
rows.forEach(function(row){body.appendChild(row);});});});
filter();
})();
)js";

// Letters that a link cannot have as %XX.
std::string InLink(const std::string& path) {
  std::string link;
  for (const char letter : path) {
    const auto byte = static_cast<unsigned char>(letter);
    if (absl::ascii_isalnum(byte) ||
        std::string("-._~/").find(letter) != std::string::npos) {
      link.push_back(letter);
    } else {
      absl::StrAppendFormat(&link, "%%%02X", byte);
    }
  }
  return link;
}

std::string RelativeLink(const std::string& report,
                         const std::string& page_filename) {
  namespace fs = std::filesystem;
  std::error_code error;
  const fs::path from = fs::absolute(page_filename, error).parent_path();
  const fs::path to = fs::absolute(report, error);
  const std::string link = to.lexically_normal()
                               .lexically_relative(from.lexically_normal())
                               .string();
  return InLink(link.empty() ? report : link);
}

void AddCell(const std::string& key, const std::string& text,
             Markup* const page) {
  page->Element("td", {{"data-key", key}, {"class", "number"}}, text);
}

void AddPercentCell(const double share, Markup* const page) {
  AddCell(Number(share, 6), absl::StrFormat("%.1f %%", 100. * share), page);
}

void AddReasons(const MapRecord& record, Markup* const page) {
  page->Open("td", {{"class", "why"}});
  if (!record.reasons.empty()) page->Text(record.reasons.front());
  if (record.reasons.size() > 1) {
    page->Open("details");
    page->Element("summary", {},
                  absl::StrCat(record.reasons.size() - 1, " more"));
    page->Open("ul");
    for (size_t i = 1; i < record.reasons.size(); ++i) {
      page->Element("li", {}, record.reasons[i]);
    }
    page->Close();
    page->Close();
  }
  page->Close();
}

void AddRow(const MapRecord& record, const MapChange* const change,
            const std::string& page_filename, Markup* const page) {
  page->Open("tr", {{"data-verdict", record.verdict}});
  page->Open("td");
  if (!record.picture.empty()) {
    page->Empty("img", {{"src", record.picture},
                        {"alt", absl::StrCat("Map ", record.filename)}});
  }
  page->Close();
  page->Open(
      "th",
      {{"scope", "row"}, {"class", "name"}, {"data-key", record.filename}});
  if (record.report.empty()) {
    page->Text(record.filename);
  } else {
    page->Element("a", {{"href", RelativeLink(record.report, page_filename)}},
                  record.filename);
  }
  page->Close();
  const auto place =
      std::find(std::begin(kVerdicts), std::end(kVerdicts), record.verdict);
  page->Open("td", {{"data-key", absl::StrCat(std::end(kVerdicts) - place)}});
  page->Element("span", {{"class", absl::StrCat("badge ", record.verdict)}},
                record.verdict);
  if (change != nullptr && change->kind != "same") {
    page->Element("div", {{"class", "soft"}},
                  change->before.empty()
                      ? change->kind
                      : absl::StrCat(change->kind, ", was ", change->before));
  }
  page->Close();
  AddPercentCell(record.severe_share, page);
  AddPercentCell(record.open_cycles, page);
  AddCell(Number(record.path, 3), absl::StrFormat("%.0f m", record.path), page);
  AddCell(absl::StrCat(record.nodes), absl::StrCat(record.nodes), page);
  AddCell(absl::StrCat(record.loops), absl::StrCat(record.loops), page);
  AddReasons(record, page);
  page->Close();
}

void AddFilters(const std::map<std::string, int>& counts, Markup* const page) {
  page->Open("div", {{"class", "filters"}});
  page->Empty("input", {{"type", "search"},
                        {"placeholder", "name or reason"},
                        {"aria-label", "Show maps whose row contains this"}});
  for (const char* const verdict : kVerdicts) {
    const auto count = counts.find(verdict);
    if (count == counts.end()) continue;
    page->Open("label");
    page->Empty("input",
                {{"type", "checkbox"}, {"value", verdict}, {"checked", ""}});
    page->Text(absl::StrCat(" ", verdict, " (", count->second, ")"));
    page->Close();
  }
  page->Element("span", {{"id", "shown"}, {"class", "soft"}}, "");
  page->Close();
}

void AddTableHead(Markup* const page) {
  page->Open("thead");
  page->Open("tr");
  page->Element("th", {}, "");
  page->Element("th", {{"data-sort", "text"}}, "map");
  page->Element("th", {{"data-sort", "number"}}, "verdict");
  for (const char* const label :
       {"contradicted", "open cycles", "path", "nodes", "loops"}) {
    page->Element("th", {{"data-sort", "number"}, {"class", "number"}}, label);
  }
  page->Element("th", {}, "why");
  page->Close();
  page->Close();
}

void AddChanges(const std::vector<MapChange>& changes, Markup* const page) {
  if (changes.empty()) return;
  report::Table table({"map", "before", "now", ""});
  for (const MapChange& change : changes) {
    if (change.kind == "same" || change.kind == "new") continue;
    table.AddRow({change.filename, change.before,
                  change.after.empty() ? "-" : change.after, change.kind});
  }
  page->Element("h2", {}, "Since the baseline");
  if (table.empty()) {
    page->Element("p", {}, "No verdict has changed.");
  } else {
    page->Raw(table.ToHtml("Maps whose verdict has changed"));
  }
}

}  // namespace

std::map<std::string, int> CountVerdicts(
    const std::vector<MapRecord>& records) {
  std::map<std::string, int> counts;
  for (const MapRecord& record : records) ++counts[record.verdict];
  return counts;
}

std::string CountsInWords(const std::vector<MapRecord>& records) {
  const auto counts = CountVerdicts(records);
  std::vector<std::string> parts;
  for (const char* const verdict : kVerdicts) {
    const auto count = counts.find(verdict);
    if (count != counts.end()) {
      parts.push_back(absl::StrCat(count->second, " ", verdict));
    }
  }
  return absl::StrJoin(parts, ", ");
}

std::string MakeOverview(const std::vector<MapRecord>& records,
                         const std::vector<MapChange>& changes,
                         const std::string& page_filename) {
  std::vector<const MapRecord*> order;
  for (const MapRecord& record : records) order.push_back(&record);
  std::stable_sort(order.begin(), order.end(),
                   [](const MapRecord* const a, const MapRecord* const b) {
                     const int first = Severity(a->verdict);
                     const int second = Severity(b->verdict);
                     return first != second ? first > second
                                            : a->severe_share > b->severe_share;
                   });
  std::map<std::string, const MapChange*> change_of;
  for (const MapChange& change : changes) change_of[change.filename] = &change;

  const std::string title = absl::StrCat(records.size(), " maps");
  Markup page;
  page.Raw("<!DOCTYPE html>\n");
  page.Open("html", {{"lang", "en"}});
  report::AddHead(title, &page);
  page.Open("body");
  page.Open("style");
  page.Raw(kStyle);
  page.Close();
  page.Open("main");
  page.Element("h1", {}, title);
  page.Element("p", {}, CountsInWords(records));
  AddChanges(changes, &page);
  AddFilters(CountVerdicts(records), &page);
  page.Open("div", {{"class", "scroll"}});
  page.Open("table", {{"class", "overview"}});
  AddTableHead(&page);
  page.Open("tbody");
  for (const MapRecord* const record : order) {
    const auto change = change_of.find(record->filename);
    AddRow(*record, change == change_of.end() ? nullptr : change->second,
           page_filename, &page);
  }
  page.Close();
  page.Close();
  page.Close();
  page.Close();
  page.Open("script");
  page.Raw(kScript);
  page.Close();
  page.Close();
  page.Close();
  return page.str();
}

}  // namespace collection
}  // namespace cartographer_ext
