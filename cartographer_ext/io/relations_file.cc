// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
#include "cartographer_ext/io/relations_file.h"

#include <array>
#include <cmath>

#include "absl/strings/str_cat.h"
#include "absl/strings/str_format.h"
#include "absl/strings/str_split.h"
#include "absl/strings/string_view.h"
#include "cartographer_ext/common/atomic_file.h"
#include "cartographer_ext/io/line_reader.h"
#include "cartographer_ext/io/tokens.h"

namespace cartographer_ext {
namespace io {
namespace {

absl::Status ParseLine(Tokens* tokens, StampedRelation* relation) {
  if (!ParseTime(tokens->Next(), &relation->time1) ||
      !ParseTime(tokens->Next(), &relation->time2)) {
    return absl::InvalidArgumentError("invalid stamp");
  }
  std::array<double, 6> values;
  for (double& value : values) {
    if (!ParseCoordinate(tokens->Next(), &value)) {
      return absl::InvalidArgumentError(
          "expected numbers up to 1e9: t1 t2 x y z roll pitch yaw");
    }
  }
  if (tokens->More()) return absl::InvalidArgumentError("too many words");
  relation->relative = Eigen::Isometry3d::Identity();
  relation->relative.translation() << values[0], values[1], values[2];
  relation->relative.linear() =
      (Eigen::AngleAxisd(values[5], Eigen::Vector3d::UnitZ()) *
       Eigen::AngleAxisd(values[4], Eigen::Vector3d::UnitY()) *
       Eigen::AngleAxisd(values[3], Eigen::Vector3d::UnitX()))
          .toRotationMatrix();
  return absl::OkStatus();
}

}  // namespace

absl::StatusOr<std::vector<StampedRelation>> ReadRelations(
    const std::string& filename) {
  std::vector<StampedRelation> relations;
  const absl::Status status =
      ForEachRecord(filename, [&relations](Tokens* const tokens) {
        StampedRelation relation;
        const absl::Status parsed = ParseLine(tokens, &relation);
        if (parsed.ok()) relations.push_back(relation);
        return parsed;
      });
  if (!status.ok()) return status;
  if (relations.empty()) {
    return absl::InvalidArgumentError(absl::StrCat(filename, ": no relation"));
  }
  return relations;
}

absl::Status WriteRelations(const std::vector<StampedRelation>& relations,
                            const std::string& filename,
                            const std::string& comment) {
  std::string content;
  for (const absl::string_view line :
       absl::StrSplit(comment, '\n', absl::SkipEmpty())) {
    absl::StrAppend(&content, "# ", line, "\n");
  }
  for (const StampedRelation& relation : relations) {
    const Eigen::Vector3d& translation = relation.relative.translation();
    const Eigen::Matrix3d rotation = relation.relative.linear();
    const double pitch =
        std::atan2(-rotation(2, 0), std::hypot(rotation(2, 1), rotation(2, 2)));
    const double roll = std::atan2(rotation(2, 1), rotation(2, 2));
    const double yaw = std::atan2(rotation(1, 0), rotation(0, 0));
    absl::StrAppendFormat(&content, "%s %s %.9f %.9f %.9f %.9f %.9f %.9f\n",
                          FormatTime(relation.time1),
                          FormatTime(relation.time2), translation.x(),
                          translation.y(), translation.z(), roll, pitch, yaw);
  }
  return WriteFileAtomically(filename, content);
}

}  // namespace io
}  // namespace cartographer_ext
