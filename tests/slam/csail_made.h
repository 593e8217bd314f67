// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
//
// The log of CSAIL, and the map that the real Cartographer has made of it with
// a known configuration.
#ifndef TESTS_SLAM_CSAIL_MADE_H_
#define TESTS_SLAM_CSAIL_MADE_H_

#include <memory>
#include <string>
#include <utility>

#include "cartographer_ext/configuration/slam_configuration.h"
#include "cartographer_ext/io/pbstream/pbstream_reader.h"
#include "cartographer_ext/io/sensor_source.h"
#include "cartographer_ext/slam/open_recording.h"
#include "gtest/gtest.h"
#include "tests/test_data.h"

namespace cartographer_ext {
namespace evaluation {

class CsailMadeTest : public testing::Test {
 protected:
  void SetUp() override {
    const std::string log = test::SharedData("carmen/mit-csail.clf.xz");
    const std::string map =
        test::SharedData("pbstream/csail-made-by-cartographer.pbstream");
    const std::string name = "csail-made-by-cartographer.lua";
    CARTOGRAPHER_EXT_SKIP_WITHOUT(log);
    CARTOGRAPHER_EXT_SKIP_WITHOUT(map);
    CARTOGRAPHER_EXT_SKIP_WITHOUT(test::Golden("configs/" + name));
    auto configuration = LoadSlamConfiguration(
        {test::Golden("configs"), "configuration_files"}, name);
    ASSERT_TRUE(configuration.ok()) << configuration.status();
    configuration_ = *configuration;
    configuration_.sensors.odometry_source = "scan";
    configuration_.sensors.min_range = 0.1;
    configuration_.sensors.max_range = 80.;
    auto source =
        OpenRecording(log, ToSourceOptions(configuration_.sensors), 0);
    ASSERT_TRUE(source.ok()) << source.status();
    source_ = std::move(*source);
    auto pbstream = io::ReadPbstream(map);
    ASSERT_TRUE(pbstream.ok()) << pbstream.status();
    pbstream_ = std::move(*pbstream);
  }

  SlamConfiguration configuration_;
  std::unique_ptr<io::SensorSource> source_;
  io::Pbstream pbstream_;
};

}  // namespace evaluation
}  // namespace cartographer_ext

#endif  // TESTS_SLAM_CSAIL_MADE_H_
