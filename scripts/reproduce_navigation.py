# SPDX-FileCopyrightText: 2026 The cartographer_ext authors
# SPDX-License-Identifier: Apache-2.0
"""Section 3.5 of paper C for scripts/reproduce: four goals on the finished map, the last one is the start, in closed loop.

One map is made of each world by default.lua from one drive. Every run then has its own seed for goals, noise, slip, people
and what the map does not show. Stock's localisation gets the very same readings of the runs without obstacles.
"""
import json
import statistics

common = None

MAP_SEED = 101
SEEDS = 5
WORLDS = ("ri_corridor", "factory_shelves", "office")
CASES = {"free": (0, 0), "obstacles": (5, 3)}  # name: obstacles, crossings


def make_map(commands, world):
    pbstream = commands.out / (world + ".pbstream")
    commands.run("slam", "-input_filename", common.WORLDS / (world + ".world"), "-seed", MAP_SEED, "-configuration_directory",
                 common.CONFIGURATIONS, "-configuration_basename", "default.lua", "-pbstream_filename", pbstream,
                 "-num_background_threads", 1, unless=pbstream)
    return pbstream


def drive(commands, world, case, seed):
    """The figures of one run."""
    obstacles, crossings = CASES[case]
    stem = commands.out / ("%s.%s.%d" % (world, case, seed))
    result = stem.with_name(stem.name + ".json")
    arguments = ["-pbstream_filename", commands.out / (world + ".pbstream"), "-world_filename",
                 common.WORLDS / (world + ".world"), "-seed", seed, "-obstacles", obstacles, "-crossings", crossings,
                 "-configuration_directory", common.CONFIGURATIONS, "-configuration_basename", "localization.lua",
                 "-picture_filename", stem.with_name(stem.name + ".png"), "-json", result]
    if seed == 1:
        arguments += ["-animation_filename", stem.with_name(stem.name + ".html")]
    if case == "free":
        arguments += ["-other_configuration_basename", "stock_localization.lua"]
    commands.run("navigate", *arguments, unless=result)
    return json.loads(result.read_text())


def summary(world, case, runs):
    number = common.number
    errors = [goal["true_error"] for run in runs for goal in run["each_goal"] if goal["reached"]]
    ratios = [run["path_ratio"] for run in runs if run["reached"] == run["goals"]]
    return [world, case, len(runs),
            "%d of %d" % (sum(run["reached"] for run in runs), sum(run["goals"] for run in runs)),
            number(max(errors), 3) if errors else "-",
            sum(run["collisions"]["static"] for run in runs), sum(run["collisions"]["moving"] for run in runs),
            sum(run["collisions"]["moving_unseen"] for run in runs),
            sum(run["collisions"]["run_into_standing_still"] for run in runs),
            "%s, %s" % (number(statistics.median(ratios), 2), number(max(ratios), 2)) if ratios else "-",
            "%.1f %%" % (100. * statistics.mean(run["cpu_share"]["total"] for run in runs)),
            number(max(run["control_cycle_milliseconds"]["p99"] for run in runs), 1)]


def localization(world, method, figures):
    number = common.number
    return [world, method, len(figures), number(statistics.median(f["median"] for f in figures), 3),
            number(max(f["max"] for f in figures), 2), sum(f["jumps"] for f in figures)]


def c_navigation(commands, options):
    """C, section 3.5: four goals on the finished map, with obstacles and sudden crossings, in closed loop."""
    seeds = range(1, 1 + (options.seeds or SEEDS))
    commands.each(lambda world: make_map(commands, world), WORLDS)
    lines, poses = [], []
    for world in WORLDS:
        for case in CASES:
            runs = commands.each(lambda seed: drive(commands, world, case, seed), seeds)
            lines.append(summary(world, case, runs))
            poses.append(localization(world, "ours, " + case, [run["localization"] for run in runs]))
            if case == "free":
                poses.append(localization(world, "stock, " + case, [run["other_localization"] for run in runs]))
    text = common.table(["world", "case", "runs", "goals reached", "largest true error at a goal m", "collisions with stationary things",
                         "with people, moving", "of these unseen", "run into standing still", "path ratio median, worst", "CPU of a core",
                         "control cycle p99 ms"], lines)
    text += "\nLocalisation on these drives:\n\n" + common.table(
        ["world", "method", "runs", "median m", "largest m", "jumps > 0.5 m"], poses)
    return ("C, section 3.5: navigation on the finished map",
            "Four goals a run, the last one is the start; `obstacles`: five things put in the path and three sudden crossings. "
            "The map was made with seed %d, the runs have seeds %d to %d. Contacts by the true shapes; path against the "
            "shortest collision-free one." % (MAP_SEED, seeds[0], seeds[-1]), text)


EXPERIMENTS = [c_navigation]
