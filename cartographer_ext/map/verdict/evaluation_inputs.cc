// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
#include "cartographer_ext/map/verdict/evaluation_inputs.h"

#include <utility>

#include "cartographer_ext/io/relations_file.h"
#include "cartographer_ext/io/trajectory_file.h"
#include "cartographer_ext/map/pbstream_map.h"

namespace cartographer_ext {
namespace evaluation {
namespace {

absl::StatusOr<MapFile> ReadUsedParts(const std::string& filename,
                                      const EvaluationUses& uses) {
  if (uses.contents) {
    MapContentsOptions options;
    options.keep_grids = uses.stored_grids;
    return ReadMapFile(filename, options);
  }
  io::PbstreamReaderOptions reading;
  if (!uses.stored_grids) {
    // Checked and left.
    reading.take_grid = [](const cartographer::mapping::proto::Submap&) {};
  }
  auto pbstream = io::ReadPbstream(filename, reading);
  if (!pbstream.ok()) return pbstream.status();
  return MapFile{*std::move(pbstream), {}};
}

}  // namespace

absl::StatusOr<EvaluationInputs> ReadEvaluationInputs(
    const EvaluationFiles& files, const EvaluationUses& uses) {
  EvaluationInputs inputs;
  if (!files.pbstream.empty()) {
    auto map = ReadUsedParts(files.pbstream, uses);
    if (!map.ok()) return map.status();
    inputs.graph = MakeMapGraph(map->pbstream);
    inputs.odometry = ReadOdometry(map->pbstream);
    inputs.pbstream = std::move(map->pbstream);
    inputs.contents = std::move(map->contents);
  }
  if (!files.trajectory.empty()) {
    auto poses = io::ReadTumTrajectory(files.trajectory);
    if (!poses.ok()) return poses.status();
    inputs.trajectory = Trajectory(*std::move(poses));
  }
  if (!files.relations.empty()) {
    auto relations = io::ReadRelations(files.relations);
    if (!relations.ok()) return relations.status();
    inputs.truth.relations = *std::move(relations);
    inputs.truth.relations_name = files.relations;
  }
  if (!files.reference_trajectory.empty()) {
    auto poses = io::ReadTumTrajectory(files.reference_trajectory);
    if (!poses.ok()) return poses.status();
    inputs.truth.reference = Trajectory(*std::move(poses));
    inputs.truth.reference_name = files.reference_trajectory;
  }
  return inputs;
}

}  // namespace evaluation
}  // namespace cartographer_ext
