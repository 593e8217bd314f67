// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
#include "cartographer_ext/io/ros/rosbag2_writer.h"

#include <sqlite3.h>

#include <limits>
#include <map>
#include <utility>

#include "absl/memory/memory.h"
#include "absl/status/status.h"
#include "absl/strings/str_cat.h"
#include "cartographer_ext/common/atomic_file.h"
#include "cartographer_ext/io/ros/mcap_writer.h"
#include "cartographer_ext/io/ros/ros2_messages.h"
#include "cartographer_ext/io/ros/sqlite_database.h"

namespace cartographer_ext {
namespace io {
namespace {

// Where encoded messages go.
class Sink {
 public:
  virtual ~Sink() = default;
  virtual absl::Status Write(const std::string& topic, const std::string& type,
                             TimeNs time, const std::string& data) = 0;
  virtual absl::Status Finish() = 0;
};

class McapSink : public Sink {
 public:
  McapSink(const std::string& filename, const std::string& compression)
      : filename_(filename), file_(filename), compression_(compression) {}

  absl::Status Open() {
    if (!file_.status().ok()) return file_.status();
    writer_ = absl::make_unique<McapWriter>(&file_.stream(), compression_);
    return absl::OkStatus();
  }

  absl::Status Write(const std::string& topic, const std::string& type,
                     const TimeNs time, const std::string& data) override {
    auto channel = channels_.find(topic);
    if (channel == channels_.end()) {
      channel = channels_
                    .emplace(topic, writer_->AddChannel(topic, type,
                                                        DefinitionOfRos2(type)))
                    .first;
    }
    const absl::Status status = writer_->Write(channel->second, time, data);
    if (!status.ok()) return status;
    return file_.stream() ? absl::OkStatus()
                          : absl::UnavailableError(
                                absl::StrCat("cannot write ", filename_));
  }

  absl::Status Finish() override {
    const absl::Status status = writer_->Finish();
    return status.ok() ? file_.Commit() : status;
  }

 private:
  const std::string filename_;
  AtomicFile file_;
  const std::string compression_;
  std::unique_ptr<McapWriter> writer_;
  std::map<std::string, uint16_t> channels_;
};

class Db3Sink : public Sink {
 public:
  explicit Db3Sink(const std::string& filename)
      : filename_(filename), file_(filename) {}
  ~Db3Sink() override { sqlite3_finalize(insert_); }

  absl::Status Open() {
    if (!file_.status().ok()) return file_.status();
    sqlite3* raw = nullptr;
    const int code = sqlite3_open(file_.temporary_path().c_str(), &raw);
    database_.reset(raw);
    if (code != SQLITE_OK) return Error();
    // The file is renamed when it is complete, so no journal is needed.
    const absl::Status status = Execute(
        "PRAGMA journal_mode = OFF; PRAGMA synchronous = OFF;"
        "CREATE TABLE schema(schema_version INTEGER PRIMARY KEY, ros_distro "
        "TEXT NOT NULL);"
        "INSERT INTO schema VALUES (3, 'humble');"
        "CREATE TABLE metadata(id INTEGER PRIMARY KEY, metadata_version "
        "INTEGER NOT NULL, metadata TEXT NOT NULL);"
        "CREATE TABLE topics(id INTEGER PRIMARY KEY, name TEXT NOT NULL, type "
        "TEXT NOT NULL,"
        " serialization_format TEXT NOT NULL, offered_qos_profiles TEXT NOT "
        "NULL);"
        "CREATE TABLE messages(id INTEGER PRIMARY KEY, topic_id INTEGER NOT "
        "NULL, timestamp INTEGER NOT NULL,"
        " data BLOB NOT NULL);"
        "CREATE INDEX timestamp_idx ON messages (timestamp ASC);"
        "BEGIN;");
    if (!status.ok()) return status;
    if (sqlite3_prepare_v2(
            raw,
            "INSERT INTO messages (topic_id, timestamp, data) VALUES (?, ?, ?)",
            -1, &insert_, nullptr) != SQLITE_OK) {
      return Error();
    }
    return absl::OkStatus();
  }

  absl::Status Write(const std::string& topic, const std::string& type,
                     const TimeNs time, const std::string& data) override {
    auto known = topics_.emplace(topic, static_cast<int>(topics_.size()) + 1);
    if (known.second) {
      const absl::Status status = AddTopic(known.first->second, topic, type);
      if (!status.ok()) return status;
    }
    sqlite3_reset(insert_);
    sqlite3_bind_int(insert_, 1, known.first->second);
    sqlite3_bind_int64(insert_, 2, time);
    sqlite3_bind_blob64(insert_, 3, data.data(), data.size(), SQLITE_TRANSIENT);
    return sqlite3_step(insert_) == SQLITE_DONE ? absl::OkStatus() : Error();
  }

  absl::Status Finish() override {
    const absl::Status status = Execute("COMMIT;");
    if (!status.ok()) return status;
    sqlite3_finalize(insert_);
    insert_ = nullptr;
    if (sqlite3_close(database_.release()) != SQLITE_OK) {
      return absl::UnavailableError(absl::StrCat("cannot write ", filename_));
    }
    return file_.Commit();
  }

 private:
  absl::Status Error() const {
    return absl::UnavailableError(absl::StrCat(
        "cannot write ", filename_, ": ", sqlite3_errmsg(database_.get())));
  }
  absl::Status Execute(const char* sql) {
    return sqlite3_exec(database_.get(), sql, nullptr, nullptr, nullptr) ==
                   SQLITE_OK
               ? absl::OkStatus()
               : Error();
  }
  absl::Status AddTopic(const int id, const std::string& topic,
                        const std::string& type) {
    char* sql =
        sqlite3_mprintf("INSERT INTO topics VALUES (%d, %Q, %Q, 'cdr', '')", id,
                        topic.c_str(), type.c_str());
    const absl::Status status = Execute(sql);
    sqlite3_free(sql);
    return status;
  }

  const std::string filename_;
  AtomicFile file_;
  SqliteDatabase database_;
  sqlite3_stmt* insert_ = nullptr;
  std::map<std::string, int> topics_;
};

class Writer : public RosbagWriter {
 public:
  Writer(const std::string& filename, std::unique_ptr<Sink> sink,
         const RosbagWriterOptions& options)
      : filename_(filename), sink_(std::move(sink)), options_(options) {}

  absl::Status AddScan(const LaserScan& scan) override {
    const TimeNs time = FirstBeamTime(scan);
    if (!laser_pose_written_) {
      const absl::Status status =
          Write("/tf_static", kRos2Transforms, time,
                EncodeTransform(time, options_.tracking_frame,
                                options_.laser_frame, scan.laser_pose));
      if (!status.ok()) return status;
      laser_pose_written_ = true;
    }
    return Write(options_.scan_topic,
                 scan.echoes.empty() ? kRos2LaserScan : kRos2MultiEchoLaserScan,
                 time, EncodeLaserScan(scan, options_.laser_frame));
  }

  absl::Status AddOdometry(const OdometryReading& reading,
                           const double linear_velocity,
                           const double angular_velocity) override {
    const absl::Status status =
        Write(options_.odometry_topic, kRos2Odometry, reading.time,
              EncodeOdometry(reading, linear_velocity, angular_velocity,
                             options_.odometry_frame, options_.tracking_frame));
    if (!status.ok()) return status;
    return Write("/tf", kRos2Transforms, reading.time,
                 EncodeTransform(reading.time, options_.odometry_frame,
                                 options_.tracking_frame, reading.pose));
  }

  absl::Status AddImu(const ImuReading& reading) override {
    if (!imu_pose_written_) {
      const absl::Status status =
          Write("/tf_static", kRos2Transforms, reading.time,
                EncodeTransform(reading.time, options_.tracking_frame,
                                options_.imu_frame, Pose2()));
      if (!status.ok()) return status;
      imu_pose_written_ = true;
    }
    return Write(options_.imu_topic, kRos2Imu, reading.time,
                 EncodeImu(reading, options_.imu_frame));
  }

  absl::Status Finish() override {
    if (sink_ == nullptr) return Ended();
    const std::unique_ptr<Sink> sink = std::move(sink_);
    return sink->Finish();
  }

 private:
  absl::Status Ended() const {
    return absl::FailedPreconditionError(
        absl::StrCat(filename_, ": finished or failed before"));
  }
  absl::Status Write(const std::string& topic, const std::string& type,
                     const TimeNs time, const std::string& data) {
    if (sink_ == nullptr) return Ended();
    if (time <= 0 || time / 1000000000 > std::numeric_limits<int32_t>::max()) {
      return absl::InvalidArgumentError(
          absl::StrCat(filename_, ": ROS 2 messages cannot hold the stamp ",
                       ToSeconds(time), " s"));
    }
    const absl::Status status = sink_->Write(topic, type, time, data);
    if (!status.ok()) sink_.reset();
    return status;
  }

  const std::string filename_;
  std::unique_ptr<Sink> sink_;
  const RosbagWriterOptions options_;
  bool laser_pose_written_ = false;
  bool imu_pose_written_ = false;
};

}  // namespace

absl::StatusOr<std::unique_ptr<RosbagWriter>> OpenRosbag2Writer(
    const std::string& filename, const Rosbag2Storage storage,
    const RosbagWriterOptions& options) {
  std::unique_ptr<Sink> sink;
  absl::Status status;
  if (storage == Rosbag2Storage::kMcap) {
    if (options.compression != "none" && options.compression != "lz4" &&
        options.compression != "zstd") {
      return absl::InvalidArgumentError(
          absl::StrCat("compression must be none, lz4 or zstd, not \"",
                       options.compression, "\""));
    }
    auto mcap = absl::make_unique<McapSink>(
        filename, options.compression == "none" ? "" : options.compression);
    status = mcap->Open();
    sink = std::move(mcap);
  } else {
    auto db3 = absl::make_unique<Db3Sink>(filename);
    status = db3->Open();
    sink = std::move(db3);
  }
  if (!status.ok()) return status;
  return std::unique_ptr<RosbagWriter>(
      absl::make_unique<Writer>(filename, std::move(sink), options));
}

}  // namespace io
}  // namespace cartographer_ext
