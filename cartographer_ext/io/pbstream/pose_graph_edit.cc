// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
#include "cartographer_ext/io/pbstream/pose_graph_edit.h"

#include <cerrno>
#include <cstddef>
#include <fstream>
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

// Most pose graphs end within so many bytes of a file.
constexpr size_t kFirstRead = 4 << 20;

// Of the records up to the pose graph, which follows the header; 0 if `content`
// ends before.
size_t SizeThroughPoseGraph(const absl::string_view content,
                            const std::string& name) {
  PbstreamRecords records(content, name);
  size_t size = PbstreamMagic().size();
  for (int i = 0; i < 2; ++i) {
    const absl::StatusOr<bool> more = records.Skip();
    if (!more.ok() || !*more) return 0;
    size += records.bytes().size();
  }
  return size;
}

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
    const absl::string_view content, const std::string& name,
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
  size_t beginning = 0;
  for (size_t limit = kFirstRead; beginning == 0; limit *= 2) {
    if (!ReadUpTo(limit, &file, &content)) {
      return absl::DataLossError(absl::StrCat(written, ": cannot be read"));
    }
    beginning = SizeThroughPoseGraph(content, filename);
    if (content.size() <= limit) break;
  }
  if (beginning == 0) beginning = content.size();
  const auto edited = WithEditedPoseGraph(
      absl::string_view(content).substr(0, beginning), filename, edit);
  if (!edited.ok()) return edited.status();
  AtomicFile result(filename);
  if (!result.status().ok()) return result.status();
  result.stream() << *edited;
  result.stream() << absl::string_view(content).substr(beginning);
  if (file.peek() != std::ifstream::traits_type::eof()) {
    result.stream() << file.rdbuf();
  }
  return result.Commit();
}

}  // namespace io
}  // namespace cartographer_ext
