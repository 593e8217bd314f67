// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
//
// Opening a log and reading it to its end, both passes and decompression
// included. Needs the shared data; see tests/test_data.h.
#include <cstdint>
#include <string>

#include "benchmark/benchmark.h"
#include "cartographer_ext/io/sensor_source.h"
#include "tests/test_data.h"

namespace cartographer_ext {
namespace io {
namespace {

void ReadLog(benchmark::State& state, const std::string& name) {
  const std::string file = test::SharedData(name);
  if (!test::Exists(file)) {
    state.SkipWithError("data not available (set CARTOGRAPHER_EXT_DATA_DIR)");
    return;
  }
  int64_t num_events = 0;
  for (auto _ : state) {
    auto source = OpenSensorSource(file, {});
    if (!source.ok()) {
      state.SkipWithError(source.status().ToString().c_str());
      return;
    }
    SensorEvent event;
    while (true) {
      const auto more = (*source)->Next(&event);
      if (!more.ok() || !*more) break;
      ++num_events;
    }
  }
  state.SetItemsProcessed(num_events);
}

BENCHMARK_CAPTURE(ReadLog, aces_carmen, "carmen/aces.clf.xz")
    ->Unit(benchmark::kMillisecond);
BENCHMARK_CAPTURE(ReadLog, intel_carmen, "carmen/intel.clf.xz")
    ->Unit(benchmark::kMillisecond);
BENCHMARK_CAPTURE(ReadLog, csail_carmen, "carmen/mit-csail.clf.xz")
    ->Unit(benchmark::kMillisecond);
BENCHMARK_CAPTURE(ReadLog, aces_bag, "bags/aces.sort.bag")
    ->Unit(benchmark::kMillisecond);

}  // namespace
}  // namespace io
}  // namespace cartographer_ext
