// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
#include "cartographer/mapping/internal/connected_components.h"

#include <algorithm>

namespace cartographer {
namespace mapping {
namespace {

std::pair<int, int> Sorted(const int a, const int b) {
  return std::make_pair(std::min(a, b), std::max(a, b));
}

}  // namespace

void ConnectedComponents::Add(const int trajectory_id) {
  absl::MutexLock lock(&mutex_);
  labels_.emplace(trajectory_id, trajectory_id);
}

void ConnectedComponents::Connect(const int trajectory_id_a,
                                  const int trajectory_id_b) {
  absl::MutexLock lock(&mutex_);
  labels_.emplace(trajectory_id_a, trajectory_id_a);
  labels_.emplace(trajectory_id_b, trajectory_id_b);
  ++counts_[Sorted(trajectory_id_a, trajectory_id_b)];
  const auto labels =
      Sorted(LabelOf(trajectory_id_a), LabelOf(trajectory_id_b));
  for (auto& id_label : labels_) {
    if (id_label.second == labels.second) {
      id_label.second = labels.first;
    }
  }
}

bool ConnectedComponents::TransitivelyConnected(
    const int trajectory_id_a, const int trajectory_id_b) const {
  absl::MutexLock lock(&mutex_);
  return LabelOf(trajectory_id_a) == LabelOf(trajectory_id_b);
}

int ConnectedComponents::ConnectionCount(const int trajectory_id_a,
                                         const int trajectory_id_b) const {
  absl::MutexLock lock(&mutex_);
  const auto it = counts_.find(Sorted(trajectory_id_a, trajectory_id_b));
  return it == counts_.end() ? 0 : it->second;
}

std::vector<std::vector<int>> ConnectedComponents::Components() const {
  absl::MutexLock lock(&mutex_);
  std::map<int, std::vector<int>> by_label;
  for (const auto& id_label : labels_) {
    by_label[id_label.second].push_back(id_label.first);
  }
  std::vector<std::vector<int>> components;
  components.reserve(by_label.size());
  for (auto& label_ids : by_label) {
    components.push_back(std::move(label_ids.second));
  }
  return components;
}

std::vector<int> ConnectedComponents::GetComponent(
    const int trajectory_id) const {
  absl::MutexLock lock(&mutex_);
  if (labels_.count(trajectory_id) == 0) {
    return {trajectory_id};
  }
  std::vector<int> component;
  for (const auto& id_label : labels_) {
    if (id_label.second == labels_.at(trajectory_id)) {
      component.push_back(id_label.first);
    }
  }
  return component;
}

int ConnectedComponents::LabelOf(const int trajectory_id) const {
  const auto it = labels_.find(trajectory_id);
  return it == labels_.end() ? trajectory_id : it->second;
}

}  // namespace mapping
}  // namespace cartographer
