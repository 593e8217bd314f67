// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
#include "cartographer_ext/navigation/closed_loop/navigation_run.h"

#include <algorithm>
#include <cmath>
#include <memory>
#include <utility>

#include "absl/memory/memory.h"
#include "absl/strings/str_cat.h"
#include "absl/strings/str_format.h"
#include "cartographer_ext/common/thread_time.h"
#include "cartographer_ext/navigation/closed_loop/contact_counter.h"
#include "cartographer_ext/navigation/closed_loop/goals.h"
#include "cartographer_ext/navigation/closed_loop/localization_error.h"
#include "cartographer_ext/navigation/closed_loop/navigator_input.h"
#include "cartographer_ext/navigation/closed_loop/online_localizer.h"
#include "cartographer_ext/navigation/closed_loop/true_plan.h"
#include "cartographer_ext/navigation/closed_loop/walkers.h"
#include "cartographer_ext/simulation/obstacle_motion.h"
#include "cartographer_ext/simulation/seeds.h"
#include "cartographer_ext/simulation/sensors/laser_model.h"
#include "cartographer_ext/slam/resource_usage.h"

namespace cartographer_ext {
namespace navigation {
namespace {

using simulation::Disc;

constexpr uint64_t kStream = 104;
constexpr double kStep = 0.01;          // seconds
constexpr double kControlDelay = 0.03;  // seconds after the scan
constexpr double kFirstCommand = 1.;    // seconds: localisation settles
constexpr double kBegin = 10000.;  // stamp of the start: long after the map

NavigatorOptions MakeNavigatorOptions(const simulation::World& world) {
  NavigatorOptions options;
  RobotLimits& robot = options.robot;
  robot.footprint = Footprint::Disc(world.robot.radius);
  robot.max_speed = world.robot.speed;
  robot.max_turn_rate = world.robot.turn_rate;
  robot.acceleration = world.robot.acceleration;
  robot.deceleration = 2. * world.robot.acceleration;
  robot.turn_acceleration = world.robot.turn_acceleration;
  return options;
}

CostmapOptions MakeCostmapOptions(const simulation::World& world) {
  CostmapOptions options;
  options.inscribed_radius = world.robot.radius;
  return options;
}

class ClosedLoop {
 public:
  ClosedLoop(const simulation::World& world,
             const NavigationRunOptions& options, const Costmap* const costmap,
             NavigationRun* const run)
      : world_(world),
        options_(options),
        costmap_(costmap),
        run_(run),
        plan_(world.segments, world.discs),
        motion_(world.obstacles, options.seed),
        people_(&motion_, &plan_, world.robot.radius, options.people),
        laser_(world.laser, &plan_, &motion_, options.seed),
        navigator_options_(MakeNavigatorOptions(world)),
        robot_(world, navigator_options_.robot, LiveRobotOptions(), world.start,
               options.seed),
        contacts_(world.robot.radius) {}

  absl::Status Run(const evaluation::SlamConfiguration& configuration);

 private:
  absl::Status Prepare();
  absl::Status DrawDisturbances();
  absl::Status StartLocalization(
      const evaluation::SlamConfiguration& configuration);
  void SenseOdometry();
  void SenseScan();
  void TakeEstimate();
  void Control();
  void CheckContacts();
  void RecordFrame();
  void MeasurePath();
  std::vector<Disc> Everything() const;
  std::vector<Disc> People() const;
  io::TimeNs Stamp() const { return io::FromSeconds(kBegin + robot_.time()); }
  Pose2 TruePoseInMap() const { return run_->map_from_world * robot_.pose(); }

  const simulation::World& world_;
  const NavigationRunOptions& options_;
  const Costmap* const costmap_;
  NavigationRun* const run_;
  const simulation::RayCaster plan_;
  const simulation::ObstacleMotion motion_;
  Walkers people_;
  simulation::LaserModel laser_;
  const NavigatorOptions navigator_options_;
  LiveRobot robot_;
  std::vector<Eigen::Vector2d> goals_;  // map frame
  Disturbances disturbances_;
  std::unique_ptr<OnlineLocalizer> localizer_;
  std::unique_ptr<Navigator> navigator_;

  struct TakenScan {
    io::TimeNs time;
    NavigatorScan scan;
    Pose2 odometry;   // (odometry <- robot) at the scan, by the nearest reading
    Pose2 true_pose;  // (map <- robot)
  };
  std::vector<TakenScan> scans_;  // the last few
  absl::optional<PoseEstimate> estimate_;
  Pose2 estimate_odometry_;
  Pose2 odometry_, odometry_before_;
  double odometry_time_ = 0., odometry_before_time_ = 0.;
  Pose2 reported_;  // (map <- robot) now
  ContactCounter contacts_;
  size_t goals_done_ = 0;
  double last_frame_ = -1e9;
  double localization_cpu_ = 0.;  // of this thread
};

std::vector<Disc> ClosedLoop::Everything() const {
  std::vector<Disc> discs = People();
  discs.insert(discs.end(), disturbances_.stationary().begin(),
               disturbances_.stationary().end());
  return discs;
}

std::vector<Disc> ClosedLoop::People() const {
  std::vector<Disc> discs = people_.At();
  discs.insert(discs.end(), disturbances_.moving().begin(),
               disturbances_.moving().end());
  return discs;
}

absl::Status ClosedLoop::Prepare() {
  // The origin of a map is the pose at which its robot started.
  run_->map_from_world =
      AlignMapToWorld(run_->map, costmap_->options().occupied_probability,
                      plan_, world_.start.Inverse());
  run_->start = TruePoseInMap().translation();
  goals_ = options_.goals;
  if (goals_.empty()) {
    auto drawn =
        DrawGoals(*costmap_, run_->start, options_.num_goals, options_.seed);
    if (!drawn.ok()) return drawn.status();
    goals_ = *std::move(drawn);
  }
  return DrawDisturbances();
}

absl::Status ClosedLoop::DrawDisturbances() {
  DisturbanceOptions options;
  options.obstacles = options_.obstacles;
  options.crossings = options_.crossings;
  options.doors = options_.doors;
  options.robot_radius = world_.robot.radius;
  std::vector<std::vector<Eigen::Vector2d>> legs;
  PathPlanner planner(costmap_);
  const Pose2 world_from_map = run_->map_from_world.Inverse();
  Eigen::Vector2d from = run_->start;
  for (const Eigen::Vector2d& goal : goals_) {
    const Plan plan = planner.MakePlan(from, goal, nullptr);
    if (!plan.found()) continue;
    std::vector<Eigen::Vector2d> leg;
    for (const Eigen::Vector2d& point : plan.points) {
      leg.push_back(world_from_map * point);
    }
    legs.push_back(leg);
    from = goal;
  }
  if (legs.empty()) return absl::OkStatus();
  auto disturbances = Disturbances::Create(plan_, legs, options, options_.seed);
  if (!disturbances.ok()) return disturbances.status();
  disturbances_ = *std::move(disturbances);
  return absl::OkStatus();
}

absl::Status ClosedLoop::StartLocalization(
    const evaluation::SlamConfiguration& configuration) {
  // The operator's guess, refined by fitting the echoes to the walls.
  Random random(
      simulation::MixBits(simulation::MixBits(options_.seed) ^ kStream));
  const Pose2 truth = TruePoseInMap();
  const Pose2 guess(truth.x + options_.start_sigma * random.Normal(),
                    truth.y + options_.start_sigma * random.Normal(),
                    NormalizeAngle(truth.theta + options_.start_heading_sigma *
                                                     random.Normal()));
  const NavigatorScan first =
      ToNavigatorScan(laser_.Snapshot(robot_.pose(), Everything()));
  run_->initial_pose = RefinePose(*costmap_, first.echoes, guess);
  auto localizer = OnlineLocalizer::Create(
      configuration, options_.pbstream_filename, run_->initial_pose);
  if (!localizer.ok()) return localizer.status();
  localizer_ = *std::move(localizer);
  return absl::OkStatus();
}

void ClosedLoop::SenseOdometry() {
  odometry_before_ = odometry_;
  odometry_before_time_ = odometry_time_;
  odometry_ = robot_.odometry();
  odometry_time_ = robot_.time();
  io::OdometryReading reading;
  reading.time = Stamp();
  reading.pose = odometry_;
  if (options_.keep_readings) run_->readings.push_back(reading);
  const double begin = ThreadCpuSeconds();
  localizer_->Add(reading);
  localization_cpu_ += ThreadCpuSeconds() - begin;
}

void ClosedLoop::SenseScan() {
  io::LaserScan scan = laser_.Snapshot(robot_.pose(), Everything());
  scan.time = Stamp();
  TakenScan taken;
  taken.time = scan.time;
  taken.scan = ToNavigatorScan(scan);
  taken.scan.time = robot_.time();
  // Between readings, odometry is extrapolated with the speed of the last two.
  const double span = odometry_time_ - odometry_before_time_;
  taken.odometry =
      span <= 0. ? odometry_
                 : Interpolate(odometry_before_, odometry_,
                               (robot_.time() - odometry_before_time_) / span);
  taken.true_pose = TruePoseInMap();
  std::vector<Eigen::Vector2d> echoes;  // world frame
  for (const Eigen::Vector2d& echo : taken.scan.echoes) {
    echoes.push_back(robot_.pose() * echo);
  }
  contacts_.AddScan(echoes, People(), robot_.time());
  run_->true_path.push_back(taken.true_pose);
  scans_.push_back(taken);
  if (scans_.size() > 20) scans_.erase(scans_.begin());
  if (options_.keep_readings) {
    run_->readings.push_back(scan);
    run_->true_poses.push_back(taken.true_pose);
  }
  const double begin = ThreadCpuSeconds();
  localizer_->Add(scan);
  localization_cpu_ += ThreadCpuSeconds() - begin;
}

void ClosedLoop::TakeEstimate() {
  const absl::optional<PoseEstimate> latest = localizer_->Latest();
  if (!latest.has_value() ||
      (estimate_.has_value() && latest->time <= estimate_->time)) {
    return;
  }
  for (const TakenScan& taken : scans_) {
    // The host's clock has ticks of 100 ns.
    if (std::abs(taken.time - latest->time) > 100) continue;
    NavigatorScan scan = taken.scan;
    scan.map_from_robot = latest->map_from_robot;
    scan.odometry_step = Between(estimate_odometry_, taken.odometry);
    estimate_ = latest;
    estimate_odometry_ = taken.odometry;
    run_->localization.push_back(
        {taken.time,
         latest->map_from_robot.translation() - taken.true_pose.translation()});
    navigator_->AddScan(scan);
    return;
  }
}

void ClosedLoop::Control() {
  const double begin = ThreadCpuSeconds();
  TakeEstimate();
  Velocity command;
  if (estimate_.has_value() && robot_.time() >= kFirstCommand) {
    NavigatorStep step;
    step.time = robot_.time();
    step.motion_since_scan = Between(estimate_odometry_, odometry_);
    step.map_from_robot = estimate_->map_from_robot * step.motion_since_scan;
    const double span = odometry_time_ - odometry_before_time_;
    const Pose2 motion = Between(odometry_before_, odometry_);
    if (span > 0.) step.velocity = {motion.x / span, motion.theta / span};
    reported_ = step.map_from_robot;
    command = navigator_->Step(step);
  }
  const double seconds = ThreadCpuSeconds() - begin;
  run_->cycle_seconds.push_back(seconds);
  run_->planning_cpu_seconds += seconds;
  robot_.Command(command);
  run_->lost_cycles += navigator_->state() == DriveState::kLost ||
                       navigator_->state() == DriveState::kBlind;
  for (; goals_done_ < navigator_->results().size(); ++goals_done_) {
    run_->goal_errors.push_back((TruePoseInMap().translation() -
                                 navigator_->results()[goals_done_].goal)
                                    .norm());
  }
}

void ClosedLoop::CheckContacts() {
  contacts_.Check(robot_, plan_, disturbances_.stationary(), People());
}

void ClosedLoop::RecordFrame() {
  if (!options_.record_frames ||
      robot_.time() - last_frame_ < options_.frame_seconds - 1e-6) {
    return;
  }
  last_frame_ = robot_.time();
  NavigationFrame frame;
  frame.time = robot_.time();
  frame.true_pose = TruePoseInMap();
  frame.pose = reported_;
  frame.velocity = robot_.velocity();
  frame.state = navigator_->state();
  frame.message = navigator_->message();
  frame.goal = navigator_->goal();
  const auto to_map = [this](std::vector<Disc> discs) {
    for (Disc& disc : discs) disc.center = run_->map_from_world * disc.center;
    return discs;
  };
  frame.stationary = to_map(disturbances_.stationary());
  frame.moving = to_map(People());
  if (!scans_.empty() && estimate_.has_value()) {
    const auto& echoes = scans_.back().scan.echoes;
    for (size_t i = 0; i < echoes.size(); i += 4) {
      frame.echoes.push_back(estimate_->map_from_robot * echoes[i]);
    }
  }
  frame.path = navigator_->plan().points;
  run_->frames.push_back(std::move(frame));
}

void ClosedLoop::MeasurePath() {
  // The shortest path takes the obstacles present at the end into account.
  const Pose2 world_from_map = run_->map_from_world.Inverse();
  std::vector<Disc> discs = world_.discs;
  discs.insert(discs.end(), disturbances_.stationary().begin(),
               disturbances_.stationary().end());
  Eigen::Vector2d from = world_.start.translation();
  for (const GoalResult& result : run_->goals) {
    if (!result.reached) continue;
    const Eigen::Vector2d to = world_from_map * result.goal;
    const auto path =
        ShortestPath(world_.segments, discs, world_.robot.radius, from, to);
    if (path.ok() && path->found()) run_->shortest += path->length;
    from = to;
  }
  run_->path_ratio =
      run_->shortest > 0. ? run_->travelled / run_->shortest : 0.;
}

absl::Status ClosedLoop::Run(
    const evaluation::SlamConfiguration& configuration) {
  absl::Status status = Prepare();
  if (status.ok()) status = StartLocalization(configuration);
  if (!status.ok()) return status;
  navigator_ =
      absl::make_unique<Navigator>(costmap_, navigator_options_, goals_);
  const double process_begin = evaluation::ProcessCpuSeconds();
  const double thread_begin = ThreadCpuSeconds();
  const auto every = [](const double seconds) {
    return std::max<int64_t>(1, std::llround(seconds / kStep));
  };
  const int64_t odometry_every = every(1. / world_.odometry.rate);
  const int64_t odometry_phase = every(world_.odometry.phase + kStep) - 1;
  const int64_t scan_every = every(1. / world_.laser.rate);
  const int64_t delay = every(kControlDelay);
  const int64_t last = std::llround(options_.max_seconds / kStep);
  for (int64_t tick = 1; tick <= last && !navigator_->finished(); ++tick) {
    robot_.Advance(kStep);
    people_.Advance(kStep, robot_.pose(), robot_.velocity());
    disturbances_.Update(robot_.time(), robot_.pose().translation());
    if (tick % 2 == 0) CheckContacts();
    if (tick % odometry_every == odometry_phase) SenseOdometry();
    if (tick % scan_every == 0 && odometry_time_ > 0.) SenseScan();
    if (tick % scan_every == delay) {
      Control();
      RecordFrame();
    }
  }
  run_->seconds = robot_.time();
  run_->travelled = robot_.travelled();
  run_->goals = navigator_->results();
  run_->plans = navigator_->plans();
  run_->recoveries = navigator_->recoveries();
  run_->times_given_way = navigator_->times_given_way();
  run_->disturbances = disturbances_.all();
  run_->static_collisions = contacts_.static_collisions();
  run_->moving_collisions = contacts_.moving_collisions();
  run_->unseen_collisions = contacts_.unseen_collisions();
  run_->run_into = contacts_.run_into();
  run_->people_waited_seconds = people_.waited_seconds();
  run_->least_clearance = contacts_.least_clearance();
  run_->contacts = contacts_.contacts();
  for (Contact& contact : run_->contacts) {
    contact.place = run_->map_from_world * contact.place;
  }
  run_->jumps = CountJumps(run_->localization);
  run_->late_optimizations = localizer_->timeouts();
  for (size_t i = run_->goals.size(); i < goals_.size(); ++i) {
    const bool says_why =
        i == navigator_->results().size() && !navigator_->message().empty();
    run_->goals.push_back(
        {goals_[i], false,
         says_why ? absl::StrCat("out of time, ", navigator_->message())
                  : "out of time",
         run_->seconds});
    run_->goal_errors.push_back(
        (TruePoseInMap().translation() - goals_[i]).norm());
  }
  // CPU time of all threads but this one is time of the localisation.
  const double others = (evaluation::ProcessCpuSeconds() - process_begin) -
                        (ThreadCpuSeconds() - thread_begin);
  run_->localization_cpu_seconds = localization_cpu_ + std::max(0., others);
  MeasurePath();
  return absl::OkStatus();
}

}  // namespace

int NavigationRun::reached() const {
  return std::count_if(goals.begin(), goals.end(),
                       [](const GoalResult& goal) { return goal.reached; });
}

absl::StatusOr<NavigationRun> RunNavigation(
    const simulation::World& world, const io::OccupancyMap& map,
    const evaluation::SlamConfiguration& configuration,
    const NavigationRunOptions& options) {
  if (!(world.robot.radius > 0.)) {
    return absl::InvalidArgumentError(absl::StrCat(
        "world '", world.name, "': navigation needs a robot with a radius"));
  }
  const auto costmap = Costmap::Create(map, MakeCostmapOptions(world));
  if (!costmap.ok()) return costmap.status();
  NavigationRun run;
  run.map = map;
  run.robot_radius = world.robot.radius;
  run.frame_seconds = options.frame_seconds;
  ClosedLoop loop(world, options, &*costmap, &run);
  const absl::Status status = loop.Run(configuration);
  if (!status.ok()) return status;
  return run;
}

}  // namespace navigation
}  // namespace cartographer_ext
