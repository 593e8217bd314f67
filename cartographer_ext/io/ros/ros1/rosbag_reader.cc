// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
#include "cartographer_ext/io/ros/ros1/rosbag_reader.h"

#include "absl/strings/str_cat.h"

#ifndef CARTOGRAPHER_EXT_HAS_ROSBAG

namespace cartographer_ext {
namespace io {

absl::StatusOr<std::unique_ptr<SensorSource>> OpenRosbag(
    const std::string& filename, const SensorSourceOptions& options) {
  return absl::UnimplementedError(absl::StrCat(
      filename, ": built without librosbag-storage, bags cannot be read"));
}

}  // namespace io
}  // namespace cartographer_ext

#else  // CARTOGRAPHER_EXT_HAS_ROSBAG

#include <exception>
#include <set>
#include <utility>

#include "absl/memory/memory.h"
#include "cartographer_ext/io/ros/ros1/rosbag_check.h"
#include "cartographer_ext/io/ros/ros_container.h"
#include "rosbag/bag.h"
#include "rosbag/view.h"

namespace cartographer_ext {
namespace io {
namespace {

// Lets the bag library copy the bytes of a message.
struct MessageBytes {
  std::string bytes;
  uint8_t* advance(uint32_t size) {
    bytes.resize(size);
    return reinterpret_cast<uint8_t*>(&bytes[0]);
  }
};

class RosbagContainer : public RosContainer {
 public:
  // May throw what the bag library throws.
  explicit RosbagContainer(const std::string& filename) : filename_(filename) {
    bag_.open(filename_, rosbag::bagmode::Read);
    rosbag::View all(bag_);
    for (const rosbag::ConnectionInfo* connection : all.getConnections()) {
      topics_[connection->topic] = RosTopicType{connection->datatype, connection->md5sum};
    }
  }

  std::string format() const override { return "rosbag"; }
  RosEncoding encoding() const override { return RosEncoding::kRos1; }
  const RosTopics& topics() const override { return topics_; }

  absl::Status Rewind(const std::set<std::string>& topics) override {
    return Guarded([&] {
      view_ = absl::make_unique<rosbag::View>(bag_, [topics](const rosbag::ConnectionInfo* connection) {
        return topics.count(connection->topic) > 0;
      });
      next_ = view_->begin();
    });
  }

  absl::StatusOr<bool> Next(RosMessage* message) override {
    bool more = false;
    const absl::Status status = Guarded([&] {
      if (view_ == nullptr || next_ == view_->end()) return;
      MessageBytes bytes;
      bytes.bytes.swap(message->data);
      bytes.bytes.clear();
      (*next_).write(bytes);
      message->data.swap(bytes.bytes);
      message->topic = (*next_).getTopic();
      message->received = (*next_).getTime().toNSec();
      ++next_;
      more = true;
    });
    if (!status.ok()) return status;
    return more;
  }

 private:
  template <typename Action>
  absl::Status Guarded(const Action& action) {
    try {
      action();
      return absl::OkStatus();
    } catch (const std::exception& exception) {
      return absl::DataLossError(absl::StrCat(filename_, ": ", exception.what()));
    } catch (...) {
      return absl::DataLossError(absl::StrCat(filename_, ": unknown error"));
    }
  }

  const std::string filename_;
  rosbag::Bag bag_;
  RosTopics topics_;
  std::unique_ptr<rosbag::View> view_;
  rosbag::View::iterator next_;
};

}  // namespace

absl::StatusOr<std::unique_ptr<SensorSource>> OpenRosbag(
    const std::string& filename, const SensorSourceOptions& options) {
  const absl::Status sound = CheckRosbag(filename);
  if (!sound.ok()) return sound;
  std::unique_ptr<RosContainer> container;
  try {
    container = absl::make_unique<RosbagContainer>(filename);
  } catch (const std::exception& exception) {
    return absl::DataLossError(absl::StrCat(filename, ": ", exception.what()));
  } catch (...) {
    return absl::DataLossError(absl::StrCat(filename, ": unknown error"));
  }
  return OpenRosRecording(filename, std::move(container), options);
}

}  // namespace io
}  // namespace cartographer_ext

#endif  // CARTOGRAPHER_EXT_HAS_ROSBAG
