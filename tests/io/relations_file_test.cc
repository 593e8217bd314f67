// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
#include "cartographer_ext/io/relations_file.h"

#include <cmath>
#include <string>
#include <vector>

#include "cartographer_ext/common/random.h"
#include "gmock/gmock.h"
#include "gtest/gtest.h"
#include "tests/mutation.h"
#include "tests/test_data.h"

namespace cartographer_ext {
namespace io {
namespace {

using ::testing::HasSubstr;

absl::StatusOr<std::vector<StampedRelation>> ReadText(const std::string& text) {
  test::TemporaryFile file(".relations");
  test::WriteBytes(file.path(), text);
  return ReadRelations(file.path());
}

TEST(RelationsFileTest, ReadsKnownText) {
  const auto relations = ReadText(
      "# t1 t2 x y z roll pitch yaw\n"
      "10.5 11.25 1 2 3 0 0 1.5707963267948966\n"
      "11 10 0 0 0 1.5707963267948966 0 1.5707963267948966\n");
  ASSERT_TRUE(relations.ok()) << relations.status();
  ASSERT_EQ(relations->size(), 2u);
  EXPECT_EQ((*relations)[0].time1, 10500000000);
  EXPECT_EQ((*relations)[0].time2, 11250000000);
  EXPECT_TRUE(((*relations)[0].relative * Eigen::Vector3d(1., 0., 0.))
                  .isApprox(Eigen::Vector3d(1., 3., 3.), 1e-12));
  // Roll first, then yaw: y goes to z and stays there.
  EXPECT_TRUE(((*relations)[1].relative * Eigen::Vector3d(0., 1., 0.))
                  .isApprox(Eigen::Vector3d(0., 0., 1.), 1e-12));
}

TEST(RelationsFileTest, RoundTrip) {
  Random random(4);
  std::vector<StampedRelation> relations;
  for (int i = 0; i < 100; ++i) {
    StampedRelation relation;
    relation.time1 = 1000000000LL * i + 123456789;
    relation.time2 = relation.time1 + random.UniformInt(0, 1000000000000);
    relation.relative.translation() =
        Eigen::Vector3d(random.Normal(), random.Normal(), random.Normal());
    relation.relative.linear() =
        Eigen::Quaterniond(random.Normal(), random.Normal(), random.Normal(),
                           random.Normal())
            .normalized()
            .toRotationMatrix();
    relations.push_back(relation);
  }
  test::TemporaryFile file(".relations");
  ASSERT_TRUE(WriteRelations(relations, file.path()).ok());
  const auto again = ReadRelations(file.path());
  ASSERT_TRUE(again.ok()) << again.status();
  ASSERT_EQ(again->size(), relations.size());
  for (size_t i = 0; i < relations.size(); ++i) {
    EXPECT_EQ((*again)[i].time1, relations[i].time1);
    EXPECT_EQ((*again)[i].time2, relations[i].time2);
    EXPECT_LT(
        ((*again)[i].relative.matrix() - relations[i].relative.matrix()).norm(),
        1e-7);
  }
}

TEST(RelationsFileTest, ErrorsNameTheLine) {
  const auto message = [](const std::string& text) {
    return std::string(ReadText(text).status().message());
  };
  EXPECT_THAT(message("# x\n"), HasSubstr("no relation"));
  EXPECT_THAT(message("1 2 0 0 0 0 0\n"), HasSubstr(".relations:1: expected"));
  EXPECT_THAT(message("1 b 0 0 0 0 0 0\n"), HasSubstr(":1: invalid stamp"));
  EXPECT_THAT(message("1 2 0 0 0 0 0 0 0\n"), HasSubstr(":1: too many words"));
  EXPECT_FALSE(WriteRelations({}, "/nonexistent/a.relations").ok());
}

TEST(RelationsFileTest, SharedData) {
  const struct {
    const char* name;
    size_t count;
  } kFiles[] = {{"aces", 1279}, {"intel", 2984}, {"mit-csail", 1172}};
  for (const auto& expected : kFiles) {
    const std::string file = test::SharedData(std::string("relations/") +
                                              expected.name + ".relations");
    CARTOGRAPHER_EXT_SKIP_WITHOUT(file);
    const auto relations = ReadRelations(file);
    ASSERT_TRUE(relations.ok()) << relations.status();
    EXPECT_EQ(relations->size(), expected.count);
  }
}

TEST(RelationsFileTest, SurvivesMutations) {
  const std::string sample =
      "10.5 11.25 1 2 3 0 0 1.57\n11 10 0 0 0 1.5 0 1.5\n"
      "12 13 0 0 0 0 0 0\n";
  test::ForEachMutation(sample, [](const std::string& damaged) {
    const auto relations = ReadText(damaged);
    if (!relations.ok()) return;
    for (const StampedRelation& relation : *relations) {
      EXPECT_TRUE(relation.relative.matrix().allFinite());
    }
  });
}

}  // namespace
}  // namespace io
}  // namespace cartographer_ext
