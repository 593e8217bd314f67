// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
#include "cartographer_ext/io/g2o.h"

#include <algorithm>
#include <array>
#include <utility>

#include "Eigen/Cholesky"
#include "absl/strings/str_cat.h"
#include "cartographer_ext/common/atomic_file.h"
#include "cartographer_ext/io/line_reader.h"
#include "cartographer_ext/io/tokens.h"

namespace cartographer_ext {
namespace io {
namespace {

constexpr size_t kMaxElements = 50000000;
// Sums of chi-square stay finite.
constexpr double kMaxInformation = 1e100;

using InformationNumbers = std::array<double, 6>;

constexpr char kNotPositiveDefinite[] =
    "the information matrix is not positive definite";

// Collects the elements; references are checked at the end, as the order of the
// lines is free.
class G2oParser {
 public:
  // Elements of a graph, empty lines and comments; the error lacks the place.
  absl::Status Parse(absl::string_view text, int64_t line_number);
  // Chooses the order of the numbers of EDGE2; the error begins with the line.
  absl::Status FinishInformation();
  absl::Status CheckReferences() const;

  G2oGraph graph;

 private:
  struct Fix {
    int64_t id;
    int64_t line;
  };

  absl::Status ParseVertex(Tokens* tokens);
  enum class EdgeForm { kPlain, kEdge2, kSwitchable };
  absl::Status ParseEdge(EdgeForm form, Tokens* tokens, int64_t line_number);
  absl::Status ParseFix(Tokens* tokens, int64_t line_number);

  std::vector<Fix> fixes_;
  struct Edge2 {
    size_t index = 0;  // of graph.edges
    InformationNumbers numbers = {};
  };
  std::vector<Edge2> edges2_;
};

// Landmarks, sensor offsets, priors and switches, which a pose graph does not
// need.
bool IsSkipped(const absl::string_view tag) {
  for (const char* const name :
       {"VERTEX_XY", "EDGE_SE2_XY", "EDGE_SE2_POINT_XY", "EDGE_BEARING_SE2_XY",
        "PARAMS_SE2OFFSET", "LANDMARK2", "LANDMARK", "BR", "EQUIV",
        "EDGE_PRIOR_SE2", "EDGE_SE2_PRIOR", "VERTEX_SWITCH",
        "EDGE_SWITCH_PRIOR"}) {
    if (tag == name) return true;
  }
  return false;
}

// I11 I12 I13 I22 I23 I33.
Eigen::Matrix3d RowByRow(const InformationNumbers& v) {
  Eigen::Matrix3d information;
  information << v[0], v[1], v[2], v[1], v[3], v[4], v[2], v[4], v[5];
  return information;
}

// I11 I12 I22 I33 I13 I23.
Eigen::Matrix3d OrderOfToro(const InformationNumbers& v) {
  return RowByRow({v[0], v[1], v[4], v[2], v[5], v[3]});
}

bool IsPositiveDefinite(const Eigen::Matrix3d& information) {
  return Eigen::LLT<Eigen::Matrix3d>(information).info() == Eigen::Success;
}

absl::Status Malformed(absl::string_view what) {
  return absl::InvalidArgumentError(what);
}

absl::Status At(const std::string& filename, int64_t line,
                absl::string_view what) {
  return absl::InvalidArgumentError(
      absl::StrCat(filename, ":", line, ": ", what));
}

bool ParsePose(Tokens* tokens, Pose2* pose) {
  if (!ParseCoordinate(tokens->Next(), &pose->x) ||
      !ParseCoordinate(tokens->Next(), &pose->y) ||
      !ParseCoordinate(tokens->Next(), &pose->theta)) {
    return false;
  }
  pose->theta = NormalizeAngle(pose->theta);
  return true;
}

absl::Status G2oParser::ParseVertex(Tokens* tokens) {
  int64_t id;
  Pose2 pose;
  if (!ParseInt(tokens->Next(), &id)) {
    return Malformed("the id of the vertex is not an integer");
  }
  if (!ParsePose(tokens, &pose)) {
    return Malformed(
        "a vertex needs three finite numbers up to 1e9, x y theta");
  }
  if (!graph.vertices.emplace(id, pose).second) {
    return Malformed(absl::StrCat("vertex ", id, " was defined before"));
  }
  return absl::OkStatus();
}

absl::Status G2oParser::ParseEdge(const EdgeForm form, Tokens* tokens,
                                  int64_t line_number) {
  G2oEdge edge;
  edge.line = line_number;
  if (!ParseInt(tokens->Next(), &edge.from) ||
      !ParseInt(tokens->Next(), &edge.to)) {
    return Malformed("the ids of the edge are not integers");
  }
  double of_the_switch;
  if (form == EdgeForm::kSwitchable &&
      !ParseFinite(tokens->Next(), &of_the_switch)) {
    return Malformed("no switch or weight behind the ids of the edge");
  }
  if (!ParsePose(tokens, &edge.measurement)) {
    return Malformed(
        "an edge needs three finite numbers up to 1e9, dx dy dtheta");
  }
  InformationNumbers numbers;
  for (double& number : numbers) {
    if (!ParseFinite(tokens->Next(), &number) ||
        std::abs(number) > kMaxInformation) {
      return Malformed(
          "an edge needs six finite numbers up to 1e100, I11 I12 I13 I22 I23 "
          "I33");
    }
  }
  if (edge.from == edge.to) {
    return Malformed(
        absl::StrCat("edge from vertex ", edge.from, " to itself"));
  }
  if (form == EdgeForm::kEdge2) {
    edges2_.push_back(Edge2{graph.edges.size(), numbers});
  } else {
    edge.information = RowByRow(numbers);
    if (!IsPositiveDefinite(edge.information)) {
      return Malformed(kNotPositiveDefinite);
    }
  }
  graph.edges.push_back(edge);
  return absl::OkStatus();
}

absl::Status G2oParser::FinishInformation() {
  // A matrix read in the wrong order is rarely positive definite, and never so
  // if it is diagonal.
  size_t first_bad = 0;
  for (const auto order : {RowByRow, OrderOfToro}) {
    size_t i = 0;
    for (; i < edges2_.size(); ++i) {
      G2oEdge& edge = graph.edges[edges2_[i].index];
      edge.information = order(edges2_[i].numbers);
      if (!IsPositiveDefinite(edge.information)) break;
    }
    if (i == edges2_.size()) return absl::OkStatus();
    first_bad = std::max(first_bad, i);
  }
  return Malformed(absl::StrCat(graph.edges[edges2_[first_bad].index].line,
                                ": ", kNotPositiveDefinite));
}

absl::Status G2oParser::ParseFix(Tokens* tokens, int64_t line_number) {
  do {
    int64_t id;
    if (!ParseInt(tokens->Next(), &id)) {
      return Malformed("FIX needs integer ids");
    }
    graph.fixed.insert(id);
    fixes_.push_back(Fix{id, line_number});
  } while (tokens->More());
  return absl::OkStatus();
}

absl::Status G2oParser::Parse(absl::string_view text, int64_t line_number) {
  Tokens tokens(text);
  const absl::string_view tag = tokens.Next();
  if (tag.empty() || tag[0] == '#') return absl::OkStatus();
  if (graph.vertices.size() + graph.edges.size() + fixes_.size() >=
      kMaxElements) {
    return Malformed(absl::StrCat("more than ", kMaxElements, " elements"));
  }
  absl::Status status;
  if (tag == "VERTEX_SE2" || tag == "VERTEX2") {
    status = ParseVertex(&tokens);
  } else if (tag == "EDGE_SE2") {
    status = ParseEdge(EdgeForm::kPlain, &tokens, line_number);
  } else if (tag == "EDGE2") {
    status = ParseEdge(EdgeForm::kEdge2, &tokens, line_number);
  } else if (tag == "EDGE_SE2_SWITCHABLE" || tag == "EDGE_SE2_MAXMIX") {
    status = ParseEdge(EdgeForm::kSwitchable, &tokens, line_number);
  } else if (tag == "FIX") {
    status = ParseFix(&tokens, line_number);
  } else if (IsSkipped(tag)) {
    ++graph.skipped[std::string(tag)];
    return absl::OkStatus();
  } else {
    return Malformed(
        absl::StrCat("unknown element \"", tag.substr(0, 40),
                     "\"; planar VERTEX_SE2, EDGE_SE2 and FIX are read"));
  }
  if (status.ok() && tokens.More()) return Malformed("too many words");
  return status;
}

absl::Status G2oParser::CheckReferences() const {
  const auto check = [this](int64_t id, int64_t line) {
    if (graph.vertices.count(id) > 0) return absl::OkStatus();
    return Malformed(absl::StrCat(line, ": vertex ", id, " is not defined"));
  };
  for (const G2oEdge& edge : graph.edges) {
    for (const int64_t id : {edge.from, edge.to}) {
      const absl::Status status = check(id, edge.line);
      if (!status.ok()) return status;
    }
  }
  for (const Fix& fix : fixes_) {
    const absl::Status status = check(fix.id, fix.line);
    if (!status.ok()) return status;
  }
  return absl::OkStatus();
}

// Poses chained from the origin along the edges between consecutive ids.
absl::StatusOr<std::map<int64_t, Pose2>> ChainConsecutive(
    const G2oGraph& graph, const std::string& filename) {
  std::map<int64_t, Pose2> steps;  // (i <- i + 1), the first edge of each pair
  std::set<int64_t> ids;
  for (const G2oEdge& edge : graph.edges) {
    ids.insert(edge.from);
    ids.insert(edge.to);
    if (edge.to - 1 == edge.from) {
      steps.emplace(edge.from, edge.measurement);
    } else if (edge.from - 1 == edge.to) {
      steps.emplace(edge.to, edge.measurement.Inverse());
    }
  }
  std::map<int64_t, Pose2> poses;
  Pose2 pose;
  int64_t last = 0;
  for (const int64_t id : ids) {
    if (!poses.empty()) {
      const auto step = steps.find(last);
      if (id - 1 != last || step == steps.end()) {
        return absl::InvalidArgumentError(
            absl::StrCat(filename, ": no vertices, and no edge leads from ",
                         last, " to ", id, " to chain their poses"));
      }
      pose = pose * step->second;
    }
    poses[id] = pose;
    last = id;
  }
  return poses;
}

}  // namespace

absl::StatusOr<G2oGraph> ReadG2o(const std::string& filename) {
  auto reader = LineReader::Open(filename);
  if (!reader.ok()) return reader.status();
  G2oParser parser;
  absl::string_view text;
  while (true) {
    const auto more = (*reader)->Next(&text);
    if (!more.ok()) return more.status();
    if (!*more) break;
    const absl::Status status = parser.Parse(text, (*reader)->line_number());
    if (!status.ok()) {
      return At(filename, (*reader)->line_number(), status.message());
    }
  }
  const absl::Status information = parser.FinishInformation();
  if (!information.ok()) {
    return absl::InvalidArgumentError(
        absl::StrCat(filename, ":", information.message()));
  }
  G2oGraph& graph = parser.graph;
  if (graph.vertices.empty()) {
    if (graph.edges.empty()) {
      return absl::InvalidArgumentError(
          absl::StrCat(filename, ": neither VERTEX_SE2 nor EDGE_SE2 found"));
    }
    graph.lacks_vertices = true;
    for (const G2oEdge& edge : graph.edges) {
      graph.vertices[edge.from] = graph.vertices[edge.to] = Pose2();
    }
  }
  const absl::Status status = parser.CheckReferences();
  if (!status.ok()) {
    return absl::InvalidArgumentError(
        absl::StrCat(filename, ":", status.message()));
  }
  return std::move(parser.graph);
}

absl::Status WriteG2o(const G2oGraph& graph, const std::string& filename) {
  AtomicFile file(filename);
  if (!file.status().ok()) return file.status();
  std::ostream& out = file.stream();
  for (const auto& vertex : graph.vertices) {
    out << "VERTEX_SE2 " << vertex.first << ' ' << FormatDouble(vertex.second.x)
        << ' ' << FormatDouble(vertex.second.y) << ' '
        << FormatDouble(vertex.second.theta) << '\n';
  }
  for (const int64_t id : graph.fixed) out << "FIX " << id << '\n';
  for (const G2oEdge& edge : graph.edges) {
    out << "EDGE_SE2 " << edge.from << ' ' << edge.to << ' '
        << FormatDouble(edge.measurement.x) << ' '
        << FormatDouble(edge.measurement.y) << ' '
        << FormatDouble(edge.measurement.theta);
    for (int row = 0; row < 3; ++row) {
      for (int column = row; column < 3; ++column) {
        out << ' ' << FormatDouble(edge.information(row, column));
      }
    }
    out << '\n';
  }
  return file.Commit();
}

absl::StatusOr<std::map<int64_t, Pose2>> ReadPosesById(
    const std::string& filename) {
  auto reader = LineReader::Open(filename);
  if (!reader.ok()) return reader.status();
  G2oParser parser;
  std::map<int64_t, Pose2> numbered;
  absl::string_view text;
  while (true) {
    const auto more = (*reader)->Next(&text);
    if (!more.ok()) return more.status();
    if (!*more) break;
    const int64_t line = (*reader)->line_number();
    Tokens first(text);
    double unused;
    if (ParseDouble(first.Next(), &unused)) {
      Tokens tokens(text);
      Pose2 pose;
      if (!ParsePose(&tokens, &pose) || tokens.More()) {
        return At(filename, line, "expected three finite numbers x y theta");
      }
      if (numbered.size() >= kMaxElements) {
        return At(filename, line, "too many poses");
      }
      numbered[numbered.size()] = pose;
      continue;
    }
    const absl::Status status = parser.Parse(text, line);
    if (!status.ok()) return At(filename, line, status.message());
  }
  if (!numbered.empty()) {
    if (!parser.graph.vertices.empty() || !parser.graph.edges.empty()) {
      return absl::InvalidArgumentError(absl::StrCat(
          filename, ": both graph elements and plain poses in one file"));
    }
    return numbered;
  }
  if (!parser.graph.vertices.empty()) return std::move(parser.graph.vertices);
  if (!parser.graph.edges.empty()) {
    return ChainConsecutive(parser.graph, filename);
  }
  return absl::InvalidArgumentError(absl::StrCat(filename, ": no pose found"));
}

}  // namespace io
}  // namespace cartographer_ext
