// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
//
// Which trajectories hang together. Thread-safe.
#ifndef CARTOGRAPHER_MAPPING_INTERNAL_CONNECTED_COMPONENTS_H_
#define CARTOGRAPHER_MAPPING_INTERNAL_CONNECTED_COMPONENTS_H_

#include <map>
#include <utility>
#include <vector>

#include "absl/base/thread_annotations.h"
#include "absl/synchronization/mutex.h"

namespace cartographer {
namespace mapping {

class ConnectedComponents {
 public:
  ConnectedComponents() = default;
  ConnectedComponents(const ConnectedComponents&) = delete;
  ConnectedComponents& operator=(const ConnectedComponents&) = delete;

  // A trajectory connected to itself only; nothing happens if it is known.
  void Add(int trajectory_id) ABSL_LOCKS_EXCLUDED(mutex_);

  // Both become known if they are not. Counts the connection.
  void Connect(int trajectory_id_a, int trajectory_id_b)
      ABSL_LOCKS_EXCLUDED(mutex_);

  // True for a trajectory and itself, even if it is not known.
  bool TransitivelyConnected(int trajectory_id_a, int trajectory_id_b) const
      ABSL_LOCKS_EXCLUDED(mutex_);

  // How often these two were connected directly.
  int ConnectionCount(int trajectory_id_a, int trajectory_id_b) const
      ABSL_LOCKS_EXCLUDED(mutex_);

  // Sorted by their smallest member, each sorted itself.
  std::vector<std::vector<int>> Components() const ABSL_LOCKS_EXCLUDED(mutex_);

  // The component of one trajectory; just that one if it is not known.
  std::vector<int> GetComponent(int trajectory_id) const
      ABSL_LOCKS_EXCLUDED(mutex_);

 private:
  int LabelOf(int trajectory_id) const ABSL_EXCLUSIVE_LOCKS_REQUIRED(mutex_);

  mutable absl::Mutex mutex_;
  // The smallest trajectory id of the component of every trajectory. There are
  // few trajectories, so merging may touch them all.
  std::map<int, int> labels_ ABSL_GUARDED_BY(mutex_);
  std::map<std::pair<int, int>, int> counts_ ABSL_GUARDED_BY(mutex_);
};

}  // namespace mapping
}  // namespace cartographer

#endif  // CARTOGRAPHER_MAPPING_INTERNAL_CONNECTED_COMPONENTS_H_
