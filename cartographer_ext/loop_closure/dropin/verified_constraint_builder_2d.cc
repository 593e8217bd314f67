// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
#include "cartographer_ext/loop_closure/dropin/verified_constraint_builder_2d.h"

#include <algorithm>
#include <utility>

#include "absl/memory/memory.h"
#include "glog/logging.h"

namespace cartographer_ext {
namespace loop_closure {

using cartographer::common::Task;
using Proposal = LoopClosure2D::Proposal;

VerifiedConstraintBuilder2D::VerifiedConstraintBuilder2D(
    const ConstraintBuilderOptions& options, const LoopOptions& extension,
    cartographer::common::ThreadPoolInterface* const thread_pool)
    : thread_pool_(thread_pool),
      loop_closure_(options, extension, thread_pool),
      recorder_(loop_closure_.recorder()),
      callback_task_(absl::make_unique<Task>()) {
  pending_id_ = recorder_->AddPending([this]() {
    absl::MutexLock work_lock(&work_mutex_);
    return loop_closure_.Undecided();
  });
}

VerifiedConstraintBuilder2D::~VerifiedConstraintBuilder2D() {
  recorder_->RemovePending(pending_id_);
  absl::MutexLock work_lock(&work_mutex_);
  absl::MutexLock lock(&mutex_);
  CHECK(callback_ == nullptr) << "the last callback has not run yet";
  CHECK(!loop_closure_.has_candidates()) << "WhenDone was not called";
  CHECK_EQ(num_started_nodes_, num_finished_nodes_);
  loop_closure_.Flush();
  LOG(INFO) << "cartographer_ext: in the end " << loop_closure_.Summary();
}

void VerifiedConstraintBuilder2D::Propose(const Proposal& proposal) {
  absl::MutexLock lock(&mutex_);
  LOG_IF(WARNING, callback_ != nullptr)
      << "node " << proposal.node_id << " is added before the last callback";
  proposals_.push_back(proposal);
}

void VerifiedConstraintBuilder2D::NotifyEndOfNode() {
  // Held until the node is a dependency of the callback: only then may its
  // candidates be due.
  absl::MutexLock work_lock(&work_mutex_);
  std::vector<Proposal> proposals;
  {
    absl::MutexLock lock(&mutex_);
    ++num_started_nodes_;
    proposals.swap(proposals_);
  }
  auto end_of_node = absl::make_unique<Task>();
  end_of_node->SetWorkItem([this]() {
    absl::MutexLock lock(&mutex_);
    ++num_finished_nodes_;
  });
  loop_closure_.AddNode(proposals, end_of_node.get());
  const std::weak_ptr<Task> scheduled =
      thread_pool_->Schedule(std::move(end_of_node));
  absl::MutexLock lock(&mutex_);
  callback_task_->AddDependency(scheduled);
}

void VerifiedConstraintBuilder2D::WhenDone(
    const std::function<void(const Result&)>& callback) {
  absl::MutexLock work_lock(&work_mutex_);
  absl::MutexLock lock(&mutex_);
  CHECK(callback_ == nullptr) << "WhenDone was called before the last callback";
  callback_ = callback;
  // The pose graph asks again without a new node only where it optimises for
  // the last time.
  loop_closure_.MarkDue(num_started_nodes_ == num_nodes_at_last_call_);
  num_nodes_at_last_call_ = num_started_nodes_;
  callback_task_->SetWorkItem([this]() { CallBack(); });
  thread_pool_->Schedule(std::move(callback_task_));
  callback_task_ = absl::make_unique<Task>();
}

void VerifiedConstraintBuilder2D::CallBack() {
  Result result;
  {
    absl::MutexLock work_lock(&work_mutex_);
    result = loop_closure_.Verify();
    LOG(INFO) << "cartographer_ext: " << loop_closure_.Summary();
  }
  std::function<void(const Result&)> callback;
  {
    absl::MutexLock lock(&mutex_);
    callback.swap(callback_);
  }
  callback(result);
}

int VerifiedConstraintBuilder2D::GetNumFinishedNodes() {
  absl::MutexLock lock(&mutex_);
  return num_finished_nodes_;
}

void VerifiedConstraintBuilder2D::DeleteScanMatcher(const SubmapId& submap_id) {
  absl::MutexLock work_lock(&work_mutex_);
  {
    absl::MutexLock lock(&mutex_);
    LOG_IF(WARNING, callback_ != nullptr)
        << "submap " << submap_id << " is deleted before the last callback";
    // The host does not delete between the pairs of a node.
    proposals_.erase(std::remove_if(proposals_.begin(), proposals_.end(),
                                    [&](const Proposal& proposal) {
                                      return proposal.submap_id == submap_id;
                                    }),
                     proposals_.end());
  }
  loop_closure_.DeleteSubmap(submap_id);
}

}  // namespace loop_closure
}  // namespace cartographer_ext
