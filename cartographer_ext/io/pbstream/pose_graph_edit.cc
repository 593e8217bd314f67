// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
#include "cartographer_ext/io/pbstream/pose_graph_edit.h"

#include <cerrno>
#include <cstddef>
#include <fstream>
#include <limits>
#include <vector>

#include "absl/strings/str_cat.h"
#include "absl/strings/string_view.h"
#include "cartographer/mapping/proto/serialization.pb.h"
#include "cartographer_ext/common/atomic_file.h"
#include "cartographer_ext/common/bounded_read.h"
#include "cartographer_ext/common/withdrawn_loops.h"
#include "cartographer_ext/io/pbstream/pbstream_reader.h"
#include "cartographer_ext/io/pbstream/pbstream_records.h"

namespace cartographer_ext {
namespace io {
namespace {

namespace proto = cartographer::mapping::proto;

// For states that this process has written.
class LargestRecord : public ContentLimit {
 public:
  int64_t For(absl::string_view, int64_t) const override {
    return PbstreamLimits().max_record_size;
  }
};

}  // namespace

int64_t RemoveWithdrawnLoops(proto::PoseGraph* const pose_graph) {
  auto* const constraints = pose_graph->mutable_constraint();
  const std::vector<size_t> withdrawn = FindWithdrawnLoops(
      *constraints, DescribeConstraintProto<proto::PoseGraph::Constraint>);
  if (withdrawn.empty()) return 0;
  auto next = withdrawn.begin();
  int kept = 0;
  for (int i = 0; i != constraints->size(); ++i) {
    if (next != withdrawn.end() && *next == static_cast<size_t>(i)) {
      ++next;
      continue;
    }
    if (kept != i) constraints->SwapElements(kept, i);
    ++kept;
  }
  constraints->DeleteSubrange(kept, constraints->size() - kept);
  return static_cast<int64_t>(withdrawn.size());
}

absl::StatusOr<std::string> WithEditedPoseGraph(
    const std::string& content, const std::string& name,
    const std::function<void(proto::PoseGraph*)>& edit) {
  PbstreamRecords records(content, name);
  if (!records.status().ok()) return records.status();
  std::string result(PbstreamMagic());
  bool is_edited = false;
  for (;;) {
    const bool is_pose_graph = records.index() == 0;  // it follows the header
    std::string record;
    const absl::StatusOr<bool> more =
        is_pose_graph ? records.Next(LargestRecord(), &record) : records.Skip();
    if (!more.ok()) return more.status();
    if (!*more) break;
    if (!is_pose_graph) {
      result.append(records.bytes().data(), records.bytes().size());
      continue;
    }
    proto::SerializedData data;
    if (!data.ParseFromString(record) || !data.has_pose_graph()) {
      return records.Error(absl::StatusCode::kInvalidArgument,
                           "this is not a pose graph");
    }
    edit(data.mutable_pose_graph());
    AppendPbstreamRecord(data.SerializeAsString(), &result);
    is_edited = true;
  }
  if (!is_edited) {
    return absl::DataLossError(
        absl::StrCat(name, ": ends before the pose graph"));
  }
  return result;
}

absl::Status CopyWithEditedPoseGraph(
    const std::string& written, const std::string& filename,
    const std::function<void(proto::PoseGraph*)>& edit) {
  std::ifstream file(written, std::ios::binary);
  if (!file) {
    return absl::ErrnoToStatus(errno, absl::StrCat("cannot open ", written));
  }
  std::string content;
  if (!ReadUpTo(std::numeric_limits<size_t>::max(), &file, &content)) {
    return absl::DataLossError(absl::StrCat(written, ": cannot be read"));
  }
  const auto edited = WithEditedPoseGraph(content, filename, edit);
  if (!edited.ok()) return edited.status();
  return WriteFileAtomically(filename, *edited);
}

}  // namespace io
}  // namespace cartographer_ext
