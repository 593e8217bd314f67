// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
#include "cartographer_ext/experiments/golden_pairs.h"

#include <cmath>
#include <map>

#include "absl/status/status.h"
#include "absl/strings/str_cat.h"
#include "absl/strings/str_split.h"
#include "cartographer_ext/io/line_reader.h"
#include "cartographer_ext/io/tokens.h"

namespace cartographer_ext {
namespace evaluation {
namespace {

const char* const kColumns[] = {"kind",
                                "submap_trajectory",
                                "submap_index",
                                "node_trajectory",
                                "node_index",
                                "points",
                                "initial_x",
                                "initial_y",
                                "initial_theta",
                                "min_score",
                                "found",
                                "score",
                                "x",
                                "y",
                                "theta",
                                "search_us",
                                "refined_x",
                                "refined_y",
                                "refined_theta",
                                "final_cost",
                                "refine_us",
                                "build_us"};

// One line of the file, by column name.
class Line {
 public:
  Line(const std::map<std::string, int>* columns,
       const absl::string_view content)
      : columns_(columns), cells_(absl::StrSplit(content, ',')) {}

  absl::string_view Text(const std::string& column) const {
    return cells_[columns_->at(column)];
  }
  double Number(const std::string& column) {
    double value = 0.;
    if (!io::ParseFinite(Text(column), &value)) Complain(column);
    return value;
  }
  int Integer(const std::string& column) {
    int64_t value = 0;
    constexpr int64_t kMost = int64_t{1} << 30;
    if (!io::ParseInt(Text(column), &value) || value < -kMost ||
        value > kMost) {
      Complain(column);
      return 0;
    }
    return static_cast<int>(value);
  }
  Pose2 Pose(const std::string& prefix) {
    return Pose2(Number(prefix + "x"), Number(prefix + "y"),
                 Number(prefix + "theta"));
  }
  void Complain(const std::string& column) {
    if (complaint_.empty()) {
      complaint_ = absl::StrCat("bad ", column, " '", Text(column), "'");
    }
  }
  size_t size() const { return cells_.size(); }
  const std::string& complaint() const { return complaint_; }

 private:
  const std::map<std::string, int>* columns_;
  const std::vector<absl::string_view> cells_;
  std::string complaint_;
};

GoldenPair PairFromLine(Line* const line) {
  GoldenPair pair;
  pair.full_submap = line->Text("kind") == "full";
  if (!pair.full_submap && line->Text("kind") != "local")
    line->Complain("kind");
  pair.submap_id.trajectory_id = line->Integer("submap_trajectory");
  pair.submap_id.submap_index = line->Integer("submap_index");
  pair.node_id.trajectory_id = line->Integer("node_trajectory");
  pair.node_id.node_index = line->Integer("node_index");
  pair.num_points = line->Integer("points");
  pair.initial_pose = line->Pose("initial_");
  pair.min_score = line->Number("min_score");
  pair.found = line->Integer("found") != 0;
  pair.score = line->Number("score");
  pair.pose = line->Pose("");
  pair.search_microseconds = line->Number("search_us");
  pair.refined_pose = line->Pose("refined_");
  pair.final_cost = line->Number("final_cost");
  pair.refine_microseconds = line->Number("refine_us");
  pair.build_microseconds = line->Number("build_us");
  return pair;
}

absl::StatusOr<std::map<std::string, int>> ReadHeader(
    io::LineReader* const reader) {
  absl::string_view header;
  const absl::StatusOr<bool> has_header = reader->Next(&header);
  if (!has_header.ok()) return has_header.status();
  std::map<std::string, int> columns;
  int index = 0;
  for (const absl::string_view name : absl::StrSplit(header, ',')) {
    if (!columns.emplace(std::string(name), index++).second) {
      return absl::InvalidArgumentError(absl::StrCat(
          reader->filename(), ": the first line has two columns '", name, "'"));
    }
  }
  for (const char* const name : kColumns) {
    if (columns.count(name) == 0) {
      return absl::InvalidArgumentError(
          absl::StrCat(reader->filename(), ": the first line has no column '",
                       name, "'; this is not a golden file"));
    }
  }
  return columns;
}

}  // namespace

absl::StatusOr<std::vector<GoldenPair>> ReadGoldenPairs(
    const std::string& filename) {
  auto reader = io::LineReader::Open(filename);
  if (!reader.ok()) return reader.status();
  const auto columns = ReadHeader(reader->get());
  if (!columns.ok()) return columns.status();
  std::vector<GoldenPair> pairs;
  absl::string_view content;
  while (true) {
    const absl::StatusOr<bool> more = (*reader)->Next(&content);
    if (!more.ok()) return more.status();
    if (!*more) break;
    if (content.empty()) continue;
    Line line(&*columns, content);
    if (line.size() != columns->size()) {
      return absl::InvalidArgumentError(
          absl::StrCat((*reader)->Location(), ": ", line.size(),
                       " values, not ", columns->size()));
    }
    pairs.push_back(PairFromLine(&line));
    pairs.back().line = (*reader)->line_number();
    if (!line.complaint().empty()) {
      return absl::InvalidArgumentError(
          absl::StrCat((*reader)->Location(), ": ", line.complaint()));
    }
  }
  return pairs;
}

}  // namespace evaluation
}  // namespace cartographer_ext
