// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
#include "cartographer/mapping/internal/trajectory_states.h"

namespace cartographer {
namespace mapping {

void TrajectoryStates::Set(const int trajectory_id, const State state) {
  states_[trajectory_id] = state;
  if (state == State::DELETED) {
    confirmed_deletions_.erase(trajectory_id);
  }
}

bool TrajectoryStates::Contains(const int trajectory_id) const {
  return states_.count(trajectory_id) == 1;
}

bool TrajectoryStates::Is(const int trajectory_id, const State state) const {
  return Contains(trajectory_id) && states_.at(trajectory_id) == state;
}

bool TrajectoryStates::AcceptsData(const int trajectory_id) const {
  return !Is(trajectory_id, State::FINISHED) &&
         !Is(trajectory_id, State::DELETED) &&
         confirmed_deletions_.count(trajectory_id) == 0;
}

bool TrajectoryStates::ConfirmDeletion(const int trajectory_id) {
  if (!Is(trajectory_id, State::FINISHED) &&
      !Is(trajectory_id, State::FROZEN)) {
    return false;
  }
  confirmed_deletions_.insert(trajectory_id);
  return true;
}

std::vector<int> TrajectoryStates::ConfirmedDeletions() const {
  return {confirmed_deletions_.begin(), confirmed_deletions_.end()};
}

}  // namespace mapping
}  // namespace cartographer
