// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
//
// Reads damaged versions of a file, many of them; see tests/fuzz/run.
//
//   fuzz_readers KIND SAMPLE WORK_FILE COUNT [FIRST]
//
// WORK_FILE, with the ending that the reader wants, holds the damaged version
// being read, so what is left there after a crash is the input that caused it.
// Prints how many were taken. One that takes longer than a minute ends the
// program.
#include <cstdlib>
#include <functional>
#include <iostream>
#include <map>
#include <string>
#include <vector>

#include "cartographer_ext/common/host_ticks.h"
#include "cartographer_ext/configuration/lua_value.h"
#include "cartographer_ext/front_end/match_record.h"
#include "cartographer_ext/io/g2o.h"
#include "cartographer_ext/io/occupancy_map.h"
#include "cartographer_ext/io/pbstream/pbstream_reader.h"
#include "cartographer_ext/io/pbstream/pbstream_records.h"
#include "cartographer_ext/io/relations_file.h"
#include "cartographer_ext/io/sensor_source.h"
#include "cartographer_ext/io/trajectory_file.h"
#include "cartographer_ext/loop_closure/decision_log.h"
#include "cartographer_ext/map/host_types.h"
#include "cartographer_ext/map/map_contents.h"
#include "cartographer_ext/map/pbstream_map.h"
#include "cartographer_ext/simulation/world_source.h"
#include "cartographer_ext/slam/decision_files.h"
#include "cartographer_ext/slam/match_files.h"
#include "glog/logging.h"
#include "tests/fuzz/table_readers.h"
#include "tests/mutation.h"

namespace cartographer_ext {
namespace {

constexpr int kMaxEvents = 1000;

bool Drain(absl::StatusOr<std::unique_ptr<io::SensorSource>> source) {
  if (!source.ok()) return false;
  io::SensorEvent event;
  for (int i = 0; i < kMaxEvents; ++i) {
    const auto more = (*source)->Next(&event);
    if (!more.ok() || !*more) return more.ok();
  }
  return true;
}

bool ReadRecording(const std::string& name) {
  return Drain(io::OpenSensorSource(name, {}));
}

bool ReadWorld(const std::string& name) {
  return Drain(simulation::OpenWorld(name, 1));
}

// Both ways of reading: whole, and each grid alone. The map is then painted.
bool ReadMap(const std::string& name) {
  constexpr double kResolution = 0.05;  // metres
  const auto whole = io::ReadPbstream(name);
  const auto map = evaluation::ReadMapFile(name, {});
  CHECK_EQ(whole.ok(), map.ok());
  if (!map.ok()) return false;
  const auto graph = evaluation::MakeMapGraph(map->pbstream);
  const auto contents = evaluation::ReadMapContents(*whole, {});
  CHECK(evaluation::LoopScores(graph, map->contents) ==
        evaluation::LoopScores(graph, contents));
  CHECK_EQ(evaluation::PaintContents(graph, map->contents, kResolution).ok(),
           evaluation::PaintContents(graph, contents, kResolution).ok());
  return true;
}

bool ReadDecisions(const std::string& name) {
  const auto decisions = evaluation::ReadDecisions(name);
  if (!decisions.ok()) return false;
  return !loop_closure::DecisionCsv(*decisions).empty();
}

// Written as a table, and marked in a map with nodes before and after all.
bool ReadMatchRecords(const std::string& name) {
  const auto matches = evaluation::ReadMatches(name);
  if (!matches.ok()) return false;
  evaluation::MapGraph graph;
  graph.nodes[{0, 0}].time = evaluation::FromHostTicks(kUnixEpochTicks);
  graph.nodes[{0, 1}].time = evaluation::FromHostTicks(kMaxHostTicks);
  evaluation::MarkMatches(*matches, &graph);
  evaluation::CountMatches(*matches);
  return !front_end::RecordCsv(*matches).empty();
}

bool ReadLua(const std::string& name) {
  evaluation::RestrictLua(true);
  return evaluation::EvaluateLua(test::ReadBytes(name), "damaged",
                                 {"configuration_files"})
      .ok();
}

// The picture that the damaged description names, or the damaged picture that
// an intact one names.
bool ReadPicture(const std::string& name) {
  const std::string yaml = name.substr(0, name.size() - 3) + "yaml";
  test::WriteBytes(
      yaml, "image: " + name.substr(name.rfind('/') + 1) +
                "\nresolution: 0.05\norigin: [-1., -2., 0.]\n"
                "negate: 0\noccupied_thresh: 0.65\nfree_thresh: 0.196\n");
  return io::ReadOccupancyMap(yaml).ok();
}

class NoLimit : public io::ContentLimit {
 public:
  int64_t For(absl::string_view, int64_t) const override { return 1 << 30; }
};

// The message of one record damaged and packed again, where the checksums of
// compression would stop every other damage.
std::string DamageOneRecord(const std::string& sample,
                            test::Mutator* const mutator, const int which) {
  io::PbstreamRecords records(sample, "sample");
  std::vector<std::string> messages(1);
  while (*records.Next(NoLimit(), &messages.back())) messages.emplace_back();
  messages.pop_back();
  std::string& damaged = messages[which % messages.size()];
  damaged = mutator->Mutate(damaged);
  std::string content(io::PbstreamMagic());
  for (const std::string& message : messages) {
    io::AppendPbstreamRecord(message, &content);
  }
  return content;
}

int Run(const std::string& kind, const std::string& sample_name,
        const std::string& work_name, const int count, const int first) {
  std::map<std::string, std::function<bool(const std::string&)>> readers = {
      {"pbstream", ReadMap},
      {"recording", ReadRecording},
      {"world", ReadWorld},
      {"lua", ReadLua},
      {"pgm", ReadPicture},
      {"decisions", ReadDecisions},
      {"matches", ReadMatchRecords},
      {"poses",
       [](const std::string& name) { return io::ReadPosesById(name).ok(); }},
      {"yaml",
       [](const std::string& name) { return io::ReadOccupancyMap(name).ok(); }},
      {"g2o", [](const std::string& name) { return io::ReadG2o(name).ok(); }},
      {"tum",
       [](const std::string& name) {
         return io::ReadTumTrajectory(name).ok();
       }},
      {"relations",
       [](const std::string& name) { return io::ReadRelations(name).ok(); }}};
  for (const auto& entry : test::TableReaders()) readers.insert(entry);
  const auto reader = readers.find(kind);
  const std::string sample = test::ReadBytes(sample_name);
  if (reader == readers.end() || sample.empty()) {
    std::cerr << "unknown kind or empty sample\n";
    return 2;
  }
  test::WriteBytes(work_name, sample);
  if (!reader->second(work_name)) {
    std::cerr << "the sample itself is not taken\n";
    return 2;
  }
  constexpr unsigned int kMaxSeconds = 60;
  int taken = 0;
  for (int i = first; i != first + count; ++i) {
    test::Mutator mutator(static_cast<uint64_t>(i));
    const bool inside = kind == "pbstream" && i % 2 == 0;
    test::WriteBytes(work_name, inside
                                    ? DamageOneRecord(sample, &mutator, i / 2)
                                    : mutator.Mutate(sample));
    ::alarm(kMaxSeconds);
    taken += reader->second(work_name);
    ::alarm(0);
  }
  std::cout << kind << ": " << count << " inputs, " << taken << " taken\n";
  return 0;
}

}  // namespace
}  // namespace cartographer_ext

int main(int argc, char** argv) {
  if (argc < 5) {
    std::cerr << "fuzz_readers KIND SAMPLE WORK_FILE COUNT [FIRST]\n";
    return 2;
  }
  return cartographer_ext::Run(argv[1], argv[2], argv[3], std::atoi(argv[4]),
                               argc > 5 ? std::atoi(argv[5]) : 0);
}
