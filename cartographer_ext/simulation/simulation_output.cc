// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
#include "cartographer_ext/simulation/simulation_output.h"

#include <utility>

#include "absl/strings/str_cat.h"
#include "absl/strings/str_format.h"
#include "absl/types/variant.h"
#include "cartographer_ext/common/atomic_file.h"
#include "cartographer_ext/io/carmen/carmen_writer.h"
#include "cartographer_ext/io/occupancy_map.h"
#include "cartographer_ext/io/relations_file.h"
#include "cartographer_ext/io/ros/ros1/rosbag_writer.h"
#include "cartographer_ext/io/ros/rosbag2_writer.h"
#include "cartographer_ext/io/trajectory_file.h"
#include "cartographer_ext/simulation/truth.h"
#include "cartographer_ext/simulation/truth_map.h"
#include "cartographer_ext/simulation/world_source.h"

namespace cartographer_ext {
namespace simulation {
namespace {

std::string Seconds(const io::TimeNs time) {
  return absl::StrFormat("%d.%09d", time / 1000000000, time % 1000000000);
}

// Writes each event to the log and to the bags, whichever are open.
class LogWriter {
 public:
  absl::Status Open(const Simulation& simulation,
                    const SimulationOutputOptions& options,
                    SimulationSummary* summary) {
    summary_ = summary;
    if (options.carmen) {
      const std::string filename = options.filestem + ".clf";
      auto carmen = io::CarmenWriter::Open(
          filename, absl::StrCat("simulated world ", simulation.world().name,
                                 ", seed ", simulation.options().seed));
      if (!carmen.ok()) return carmen.status();
      carmen_ = *std::move(carmen);
      summary->files.push_back(filename);
    }
    if (options.bag) {
      const std::string filename = options.filestem + ".bag";
      const absl::Status status =
          AddBag(filename,
                 io::RosbagWriter::Open(filename, io::RosbagWriterOptions()));
      if (!status.ok()) return status;
    }
    io::RosbagWriterOptions ros2;
    ros2.compression = "zstd";
    if (options.mcap) {
      const std::string filename = options.filestem + ".mcap";
      const absl::Status status = AddBag(
          filename,
          io::OpenRosbag2Writer(filename, io::Rosbag2Storage::kMcap, ros2));
      if (!status.ok()) return status;
    }
    if (options.db3) {
      const std::string filename = options.filestem + ".db3";
      return AddBag(filename, io::OpenRosbag2Writer(
                                  filename, io::Rosbag2Storage::kDb3, ros2));
    }
    return absl::OkStatus();
  }

  absl::Status operator()(const io::OdometryReading& reading) {
    ++summary_->odometry_readings;
    // Velocities as the driver of a robot computes them: from the change since
    // the previous message.
    double linear = 0., angular = 0.;
    if (has_odometry_ && reading.time > odometry_.time) {
      const double seconds = io::ToSeconds(reading.time - odometry_.time);
      const Pose2 change = Between(odometry_.pose, reading.pose);
      linear = change.x / seconds;
      angular = change.theta / seconds;
    }
    odometry_ = reading;
    has_odometry_ = true;
    if (carmen_ != nullptr) {
      const absl::Status status =
          carmen_->AddOdometry(reading, linear, angular);
      if (!status.ok()) return status;
    }
    return ToBags([&](io::RosbagWriter* bag) {
      return bag->AddOdometry(reading, linear, angular);
    });
  }

  absl::Status operator()(const io::ImuReading& reading) {
    ++summary_->imu_readings;
    return ToBags([&](io::RosbagWriter* bag) { return bag->AddImu(reading); });
  }

  absl::Status operator()(const io::LaserScan& scan) {
    ++summary_->scans;
    summary_->beams += scan.ranges.size();
    if (carmen_ != nullptr) {
      // The pose in a scan line is that of the last odometry message, as on a
      // real robot.
      const absl::Status status = carmen_->AddScan(scan, odometry_.pose);
      if (!status.ok()) return status;
    }
    return ToBags([&](io::RosbagWriter* bag) { return bag->AddScan(scan); });
  }

  absl::Status Finish() {
    if (carmen_ != nullptr) {
      const absl::Status status = carmen_->Finish();
      if (!status.ok()) return status;
    }
    return ToBags([](io::RosbagWriter* bag) { return bag->Finish(); });
  }

 private:
  absl::Status AddBag(const std::string& filename,
                      absl::StatusOr<std::unique_ptr<io::RosbagWriter>> bag) {
    if (!bag.ok()) return bag.status();
    bags_.push_back(*std::move(bag));
    summary_->files.push_back(filename);
    return absl::OkStatus();
  }

  template <typename Action>
  absl::Status ToBags(const Action& action) {
    for (const auto& bag : bags_) {
      const absl::Status status = action(bag.get());
      if (!status.ok()) return status;
    }
    return absl::OkStatus();
  }

  std::unique_ptr<io::CarmenWriter> carmen_;
  std::vector<std::unique_ptr<io::RosbagWriter>> bags_;
  SimulationSummary* summary_ = nullptr;
  io::OdometryReading odometry_;
  bool has_odometry_ = false;
};

absl::Status WriteLogs(std::shared_ptr<const Simulation> simulation,
                       const SimulationOutputOptions& options,
                       SimulationSummary* summary) {
  LogWriter writer;
  absl::Status status = writer.Open(*simulation, options, summary);
  if (!status.ok()) return status;
  WorldSource source(std::move(simulation));
  io::SensorEvent event;
  while (true) {
    const absl::StatusOr<bool> more = source.Next(&event);
    if (!more.ok()) return more.status();
    if (!*more) break;
    status = absl::visit(writer, event);
    if (!status.ok()) return status;
    if (options.progress) options.progress(summary->scans);
  }
  return writer.Finish();
}

std::string LoopsCsv(const std::vector<TrueRelation>& loops) {
  std::string csv = "time1,time2,x,y,theta\n";
  for (const TrueRelation& loop : loops) {
    absl::StrAppendFormat(&csv, "%s,%s,%.6f,%.6f,%.6f\n", Seconds(loop.first),
                          Seconds(loop.second), loop.relative.x,
                          loop.relative.y, loop.relative.theta);
  }
  return csv;
}

std::string PlacesCsv(const std::vector<PlaceVisit>& visits) {
  std::string csv = "place,visit,time,x,y,theta,distance\n";
  for (const PlaceVisit& visit : visits) {
    absl::StrAppendFormat(&csv, "%s,%d,%s,%.6f,%.6f,%.6f,%.3f\n", visit.place,
                          visit.visit, Seconds(visit.time), visit.pose.x,
                          visit.pose.y, visit.pose.theta, visit.distance);
  }
  return csv;
}

std::string DistancesCsv(const std::vector<KeyDistanceView>& views) {
  std::string csv =
      "name,length,ax,ay,bx,by,seen,time_a,a_robot_x,a_robot_y,time_b,"
      "b_robot_x,b_robot_y\n";
  for (const KeyDistanceView& view : views) {
    absl::StrAppendFormat(
        &csv, "%s,%.6f,%.6f,%.6f,%.6f,%.6f,%d,%s,%.6f,%.6f,%s,%.6f,%.6f\n",
        view.distance.name, view.length, view.distance.a.x(),
        view.distance.a.y(), view.distance.b.x(), view.distance.b.y(),
        view.seen ? 1 : 0, Seconds(view.time_a), view.a_in_robot.x(),
        view.a_in_robot.y(), Seconds(view.time_b), view.b_in_robot.x(),
        view.b_in_robot.y());
  }
  return csv;
}

std::string FaultsCsv(const OdometryRun& odometry) {
  std::string csv = "kind,start,end,distance,angle\n";
  for (const FaultLabel& label : odometry.labels) {
    absl::StrAppendFormat(&csv, "%s,%.6f,%.6f,%.6f,%.6f\n",
                          FaultName(label.kind), label.start, label.end,
                          label.distance, label.angle);
  }
  return csv;
}

absl::Status WriteTruth(const Simulation& simulation,
                        const SimulationOutputOptions& options,
                        SimulationSummary* summary) {
  const std::vector<TruePose> trajectory = TrueTrajectory(simulation);
  std::vector<io::StampedPose> poses;
  for (const TruePose& pose : trajectory) {
    poses.push_back(io::MakeStampedPose(pose.time, pose.pose));
  }
  const std::vector<TrueRelation> loops = LoopRelations(simulation, trajectory);
  std::vector<TrueRelation> relations = SequentialRelations(trajectory);
  summary->sequential_relations = relations.size();
  summary->loop_relations = loops.size();
  relations.insert(relations.end(), loops.begin(), loops.end());
  std::vector<io::StampedRelation> stamped;
  for (const TrueRelation& relation : relations) {
    io::StampedRelation line;
    line.time1 = relation.first;
    line.time2 = relation.second;
    line.relative = io::MakeStampedPose(0, relation.relative).pose;
    stamped.push_back(line);
  }
  const std::vector<PlaceVisit> visits = PlaceVisits(simulation, trajectory);
  summary->place_visits = visits.size();

  absl::Status status;
  const auto write = [&](const std::string& extension, const auto& writer) {
    if (!status.ok()) return;
    const std::string filename = options.filestem + extension;
    status = writer(filename);
    if (status.ok()) summary->files.push_back(filename);
  };
  const auto write_text = [&](const std::string& extension,
                              const std::string& text) {
    write(extension, [&text](const std::string& filename) {
      return WriteFileAtomically(filename, text);
    });
  };
  write(".tum", [&](const std::string& filename) {
    return io::WriteTumTrajectory(poses, filename);
  });
  write(".relations", [&](const std::string& filename) {
    return io::WriteRelations(stamped, filename);
  });
  write_text(".truth.loops.csv", LoopsCsv(loops));
  write_text(".places.csv", PlacesCsv(visits));
  write_text(".distances.csv",
             DistancesCsv(KeyDistanceViews(simulation, trajectory)));
  write_text(".faults.csv", FaultsCsv(simulation.odometry()));
  return status;
}

}  // namespace

absl::Status WriteSimulation(std::shared_ptr<const Simulation> simulation,
                             const SimulationOutputOptions& options,
                             SimulationSummary* summary) {
  *summary = SimulationSummary();
  absl::Status status = WriteTruth(*simulation, options, summary);
  if (!status.ok()) return status;
  if (options.truth_map) {
    const absl::StatusOr<io::OccupancyMap> map =
        MakeTruthMap(*simulation, options.map_resolution);
    if (!map.ok()) return map.status();
    const std::string filestem = options.filestem + ".truth";
    status = io::WriteOccupancyMap(*map, filestem);
    if (!status.ok()) return status;
    summary->files.push_back(filestem + ".pgm");
    summary->files.push_back(filestem + ".yaml");
  }
  return WriteLogs(std::move(simulation), options, summary);
}

}  // namespace simulation
}  // namespace cartographer_ext
