// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
#include "cartographer_ext/configuration/option_ranges.h"

#include <cmath>
#include <limits>

#include "absl/strings/match.h"
#include "absl/strings/numbers.h"
#include "absl/strings/str_cat.h"
#include "absl/types/optional.h"
#include "cartographer_ext/configuration/lua_value.h"
#include "cartographer_ext/configuration/option_types.h"

namespace cartographer_ext {
namespace evaluation {
namespace {

using google::protobuf::Descriptor;
using google::protobuf::FieldDescriptor;
using nlohmann::json;

constexpr double kInfinity = std::numeric_limits<double>::infinity();
// Squares of weights up to here are finite.
constexpr double kMaxWeight = 1e100;

enum class Bound { kAtLeast, kAbove };
enum class Otherwise { kRefuse, kWarn };

struct Rule {
  const char* field;  // message.field, without the package
  Bound bound;
  double low;
  double high;  // belongs to the range unless `below_high`
  Otherwise otherwise;
  const char* reason;
  bool below_high = false;
};

constexpr char kWeight[] = "weights are inverse standard deviations";
constexpr char kMatcherWeight[] = "the scan matcher needs every cost";
constexpr char kNoScore[] = "scores are between 0 and 1";
constexpr char kNoLoop[] = "no loop would be searched";
constexpr char kNoRange[] = "no range would be used";
constexpr char kRatio[] = "it is the fraction of candidates that is searched";
constexpr char kVoxel[] = "it is the voxel size in metres";
constexpr char kSearchMemory[] =
    "the candidates of one search would not fit into memory";

const Rule kRules[] = {
    {"MapBuilderOptions.num_background_threads", Bound::kAtLeast, 1,
     kMaxBackgroundThreads, Otherwise::kRefuse,
     "each is an operating system thread"},
    {"LocalTrajectoryBuilderOptions2D.max_range", Bound::kAbove, 0., kInfinity,
     Otherwise::kRefuse, kNoRange},
    {"LocalTrajectoryBuilderOptions2D.missing_data_ray_length", Bound::kAtLeast,
     0., kInfinity, Otherwise::kWarn,
     "free space would be inserted behind the sensor"},
    {"LocalTrajectoryBuilderOptions2D.num_accumulated_range_data",
     Bound::kAtLeast, 1, kInfinity, Otherwise::kWarn, "it counts as 1"},
    {"LocalTrajectoryBuilderOptions2D.voxel_filter_size", Bound::kAtLeast, 1e-6,
     kInfinity, Otherwise::kRefuse, kVoxel},
    {"AdaptiveVoxelFilterOptions.max_length", Bound::kAtLeast, 1e-6, kInfinity,
     Otherwise::kRefuse, kVoxel},
    {"AdaptiveVoxelFilterOptions.max_range", Bound::kAbove, 0., kInfinity,
     Otherwise::kRefuse, kNoRange},
    {"CeresScanMatcherOptions2D.occupied_space_weight", Bound::kAbove, 0.,
     kMaxWeight, Otherwise::kRefuse, kMatcherWeight},
    {"CeresScanMatcherOptions2D.translation_weight", Bound::kAbove, 0.,
     kMaxWeight, Otherwise::kRefuse, kMatcherWeight},
    {"CeresScanMatcherOptions2D.rotation_weight", Bound::kAbove, 0., kMaxWeight,
     Otherwise::kRefuse, kMatcherWeight},
    {"CeresSolverOptions.max_num_iterations", Bound::kAtLeast, 1, kInfinity,
     Otherwise::kRefuse, "the solver would do nothing"},
    {"CeresSolverOptions.num_threads", Bound::kAtLeast, 1, kInfinity,
     Otherwise::kRefuse, "the solver would do nothing"},
    {"RealTimeCorrelativeScanMatcherOptions.linear_search_window",
     Bound::kAtLeast, 0., 100., Otherwise::kRefuse, kSearchMemory},
    {"RealTimeCorrelativeScanMatcherOptions.angular_search_window",
     Bound::kAtLeast, 0., 100., Otherwise::kRefuse, kSearchMemory},
    {"SubmapsOptions2D.num_range_data", Bound::kAtLeast, 1, kInfinity,
     Otherwise::kRefuse, "a submap is made of scans"},
    {"GridOptions2D.resolution", Bound::kAtLeast, 1e-4, kInfinity,
     Otherwise::kRefuse,
     "it is the cell size in metres, and ten metres of smaller cells do not "
     "fit into memory"},
    {"GridOptions2D.resolution", Bound::kAtLeast, 0.005, 1., Otherwise::kWarn,
     "it is the cell size in metres: smaller cells need much memory, larger "
     "ones do not resolve walls"},
    {"ProbabilityGridRangeDataInserterOptions2D.hit_probability", Bound::kAbove,
     0.5, 1., Otherwise::kRefuse,
     "a hit makes a cell more likely to be occupied", true},
    {"ProbabilityGridRangeDataInserterOptions2D.miss_probability",
     Bound::kAtLeast, 0., 0.5, Otherwise::kRefuse,
     "a miss makes a cell less likely to be occupied", true},
    {"PureLocalizationTrimmerOptions.max_submaps_to_keep", Bound::kAtLeast, 2,
     kInfinity, Otherwise::kRefuse, "two submaps are under construction"},
    {"PoseGraphOptions.matcher_translation_weight", Bound::kAtLeast, 0.,
     kMaxWeight, Otherwise::kRefuse, kWeight},
    {"PoseGraphOptions.matcher_rotation_weight", Bound::kAtLeast, 0.,
     kMaxWeight, Otherwise::kRefuse, kWeight},
    {"PoseGraphOptions.max_num_final_iterations", Bound::kAtLeast, 1, kInfinity,
     Otherwise::kRefuse, "the last optimization would do nothing"},
    {"PoseGraphOptions.global_sampling_ratio", Bound::kAtLeast, 0., 1.,
     Otherwise::kRefuse, kRatio},
    {"ConstraintBuilderOptions.sampling_ratio", Bound::kAtLeast, 0., 1.,
     Otherwise::kRefuse, kRatio},
    {"ConstraintBuilderOptions.max_constraint_distance", Bound::kAbove, 0.,
     kInfinity, Otherwise::kWarn, kNoLoop},
    {"ConstraintBuilderOptions.min_score", Bound::kAtLeast, 0., 1.,
     Otherwise::kWarn, kNoScore},
    {"ConstraintBuilderOptions.global_localization_min_score", Bound::kAtLeast,
     0., 1., Otherwise::kWarn, kNoScore},
    {"ConstraintBuilderOptions.loop_closure_translation_weight",
     Bound::kAtLeast, 0., kMaxWeight, Otherwise::kRefuse, kWeight},
    {"ConstraintBuilderOptions.loop_closure_rotation_weight", Bound::kAtLeast,
     0., kMaxWeight, Otherwise::kRefuse, kWeight},
    {"FastCorrelativeScanMatcherOptions2D.branch_and_bound_depth",
     Bound::kAtLeast, 1, 18, Otherwise::kRefuse,
     "the coarsest grid has (2^(depth - 1))^2 cells more"},
    {"FastCorrelativeScanMatcherOptions2D.linear_search_window",
     Bound::kAtLeast, 0., 1e4, Otherwise::kRefuse, kSearchMemory},
    {"FastCorrelativeScanMatcherOptions2D.angular_search_window",
     Bound::kAtLeast, 0., 100., Otherwise::kRefuse, kSearchMemory},
    {"FastCorrelativeScanMatcherOptions2D.angular_search_window",
     Bound::kAtLeast, 0., 3.15, Otherwise::kWarn,
     "it is the half width in radians; beyond pi, rotations are searched "
     "twice"},
    {"OptimizationProblemOptions.huber_scale", Bound::kAbove, 0., kInfinity,
     Otherwise::kWarn, "loops would have no effect"},
    {"OptimizationProblemOptions.local_slam_pose_translation_weight",
     Bound::kAtLeast, 0., kMaxWeight, Otherwise::kRefuse, kWeight},
    {"OptimizationProblemOptions.local_slam_pose_rotation_weight",
     Bound::kAtLeast, 0., kMaxWeight, Otherwise::kRefuse, kWeight},
    {"OptimizationProblemOptions.odometry_translation_weight", Bound::kAtLeast,
     0., kMaxWeight, Otherwise::kRefuse, kWeight},
    {"OptimizationProblemOptions.odometry_rotation_weight", Bound::kAtLeast, 0.,
     kMaxWeight, Otherwise::kRefuse, kWeight},
};

// As the host reads it: a number may be written as a string.
absl::optional<double> NumberOf(const json& value) {
  if (value.is_number()) return value.get<double>();
  double number;
  if (value.is_string() &&
      absl::SimpleAtod(value.get_ref<const std::string&>(), &number)) {
    return number;
  }
  return absl::nullopt;
}

std::string Text(const double number) {
  return std::isnan(number)
             ? "not a number"
             : ToLua(json(number == std::floor(number) && std::abs(number) < 1e9
                              ? json(static_cast<int64_t>(number))
                              : json(number)));
}

bool IsIn(const Rule& rule, const double number) {
  const bool is_high_enough =
      rule.bound == Bound::kAbove ? number > rule.low : number >= rule.low;
  return is_high_enough &&
         (rule.below_high ? number < rule.high : number <= rule.high);
}

std::string Explain(const Rule& rule) {
  return absl::StrCat(
      rule.bound == Bound::kAbove ? "above " : "at least ", Text(rule.low),
      rule.high == kInfinity
          ? ""
          : absl::StrCat(rule.below_high ? " and below " : " and at most ",
                         Text(rule.high)));
}

absl::Status CheckNumber(const FieldDescriptor& field, const std::string& key,
                         const double number,
                         std::vector<std::string>* const warnings) {
  if (std::isnan(number) || std::fpclassify(number) == FP_SUBNORMAL) {
    return absl::InvalidArgumentError(absl::StrCat(
        key, " is ", Text(number),
        std::isnan(number) ? "" : ", which is numerically too small"));
  }
  const std::string name =
      absl::StrCat(field.containing_type()->name(), ".", field.name());
  for (const Rule& rule : kRules) {
    if (name != rule.field || IsIn(rule, number)) continue;
    const bool warns = rule.otherwise == Otherwise::kWarn;
    const std::string text = absl::StrCat(key, " is ", Text(number),
                                          warns ? ", should be " : ", must be ",
                                          Explain(rule), ": ", rule.reason);
    if (!warns) return absl::InvalidArgumentError(text);
    warnings->push_back(text);
  }
  return absl::OkStatus();
}

bool IsSwitchedOff(const json& table, const std::string& key) {
  const auto flag = [&table](const char* const name) {
    const auto found = table.find(name);
    return found == table.end() || !found->is_boolean() || found->get<bool>();
  };
  return (key == "real_time_correlative_scan_matcher" &&
          !flag("use_online_correlative_scan_matching")) ||
         (key == "imu_based" && !flag("use_imu_based"));
}

// Between two keys of one table.
absl::Status CheckTogether(const json& table, const Descriptor& message,
                           const std::string& path) {
  if (message.name() != "LocalTrajectoryBuilderOptions2D") {
    return absl::OkStatus();
  }
  const auto low = table.find("min_range");
  const auto high = table.find("max_range");
  if (low == table.end() || high == table.end()) return absl::OkStatus();
  const auto min_range = NumberOf(*low);
  const auto max_range = NumberOf(*high);
  if (!min_range.has_value() || !max_range.has_value() ||
      *min_range < *max_range) {
    return absl::OkStatus();
  }
  return absl::InvalidArgumentError(
      absl::StrCat(path, ".min_range is ", Text(*min_range),
                   ", must be below max_range, which is ", Text(*max_range),
                   ": ", kNoRange));
}

}  // namespace

absl::Status CheckOptionRanges(const json& table, const Descriptor& message,
                               const std::string& path,
                               std::vector<std::string>* const warnings) {
  for (const auto& item : table.items()) {
    const FieldDescriptor* const field = FindOptionField(message, item.key());
    if (field == nullptr || field->is_repeated()) continue;
    const std::string key = absl::StrCat(path, ".", item.key());
    absl::Status status;
    if (field->cpp_type() == FieldDescriptor::CPPTYPE_MESSAGE) {
      if (!item.value().is_object() || IsSwitchedOff(table, item.key()) ||
          absl::EndsWith(field->message_type()->name(), "3D")) {
        continue;
      }
      status = CheckOptionRanges(item.value(), *field->message_type(), key,
                                 warnings);
    } else if (field->cpp_type() != FieldDescriptor::CPPTYPE_BOOL &&
               field->cpp_type() != FieldDescriptor::CPPTYPE_STRING &&
               field->cpp_type() != FieldDescriptor::CPPTYPE_ENUM) {
      const auto number = NumberOf(item.value());
      if (number.has_value()) {
        status = CheckNumber(*field, key, *number, warnings);
      }
    }
    if (!status.ok()) return status;
  }
  return CheckTogether(table, message, path);
}

}  // namespace evaluation
}  // namespace cartographer_ext
