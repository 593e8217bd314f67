# SPDX-FileCopyrightText: 2026 The cartographer_ext authors
# SPDX-License-Identifier: Apache-2.0
"""Maps with known truth, for scripts/reproduce: how often the verdict without ground truth is wrong, and what a repair makes of them.

A case is a generated building, a laser, a grade of odometry, a seed and what is done to the map: nothing, stock behaviour, loops that
are believed too easily, local SLAM that follows bad odometry, no loops, things moved between two visits, or two floors one over the
other. Finished maps are kept with a line each in journal.jsonl; a map is judged again when cartographer_ext_evaluate is newer than its
verdict. Limits may be chosen on maps with even seeds; those with odd seeds judge them.
"""
import json
import math
import os
import random
import shutil
import threading

common = None

KINDS = ("office", "hotel", "warehouse")
WIDE_KINDS = ("hall", "street", "campus")  # with --kinds; their seeds follow those of a thousand cases
LASERS = ("ld06", "rplidar_a1", "urg_04lx", "sick_lms", "utm_30lx", "depth_camera")
GRADES = ("fair", "poor")
TREATMENTS = ("ours", "stock", "credulous", "ours", "bent", "moved", "ours", "no_loops", "floors")
SEED = 30000  # of the first case
SOUND_LOOP_ERROR = 0.2  # metres, mean over relations of revisits, and over those of any two scans
PAIRS = 500  # of scans at any two times
TRUTHS = ("sound", "bent", "broken")
WORDS = ("sound", "unknown", "doubtful", "broken")
OWN_TREATMENTS = sorted(set(TREATMENTS) - {"floors"})
# Repairs: maps of each kind, and metres within which two errors are alike.
BROKEN_MAPS = 100
SOUND_MAPS = 20
FLOORS = 10
SAME_ERROR = 0.02

OWN_LUA = {
    # Our local SLAM; stock's loop closure takes what scores 0.4 within 7 m.
    "credulous": """include "common_2d.lua"
include "front_end_default.lua"
POSE_GRAPH.constraint_builder.min_score = 0.4
POSE_GRAPH.constraint_builder.global_localization_min_score = 0.45
""",
    # Stock's local SLAM hardly looks at the scans; loop closure is ours.
    "bent": """include "common_2d.lua"
include "loop_closure_default.lua"
TRAJECTORY_BUILDER_2D.ceres_scan_matcher.translation_weight = 1e3
TRAJECTORY_BUILDER_2D.ceres_scan_matcher.rotation_weight = 1e4
""",
    "no_loops": """include "common_2d.lua"
POSE_GRAPH.constraint_builder.max_constraint_distance = 0.
POSE_GRAPH.global_sampling_ratio = 0.
""",
}
LUA_END = "return { map_builder = MAP_BUILDER, trajectory_builder = TRAJECTORY_BUILDER }\n"


def cases(count, kinds=KINDS, seed=SEED):
    """`count` cases (kind, laser, grade, seed, treatment): of 162 cases each treatment has every kind with every laser once, of 324 with
    both grades."""
    result = []
    pairs = len(kinds) * len(LASERS)
    for i in range(count):
        block, place = divmod(i, len(TREATMENTS))
        result.append((kinds[(place + block) % len(kinds)], LASERS[(place + block // len(kinds)) % len(LASERS)],
                       GRADES[(place // 3 + block + block // pairs) % len(GRADES)], seed + i, TREATMENTS[place]))
    return result


def chosen(options):
    """(name, case) of the cases that the user wants."""
    result = []
    wide = any(kind in WIDE_KINDS for kind in options.kinds.split(","))
    seed = options.first_seed or (SEED + 1000 if wide else SEED)
    for case in cases(options.runs or 300, WIDE_KINDS if wide else KINDS, seed):
        wanted = zip((options.kinds, options.lasers, options.odometry), case)
        if all(not words or own in words.split(",") for words, own in wanted):
            result.append(("%s.%s.%s.%d.%s" % case, case))
    return result


# --- two recordings behind each other ---------------------------------------


def compose(a, b):
    return (a[0] + math.cos(a[2]) * b[0] - math.sin(a[2]) * b[1], a[1] + math.sin(a[2]) * b[0] + math.cos(a[2]) * b[1], a[2] + b[2])


def inverse(a):
    return (-math.cos(a[2]) * a[0] - math.sin(a[2]) * a[1], math.sin(a[2]) * a[0] - math.cos(a[2]) * a[1], -a[2])


def wrapped(angle):
    return math.atan2(math.sin(angle), math.cos(angle))


def truth_of(path):
    """[(stamp, pose)] of a TUM file."""
    result = []
    for line in path.read_text().splitlines():
        if line and not line.startswith("#"):
            t, x, y, _, _, _, qz, qw = map(float, line.split())
            result.append((t, (x, y, 2. * math.atan2(qz, qw))))
    return result


class CarmenLine:
    """A line of a CARMEN log, by its stamp and its odometry poses."""

    def __init__(self, line):
        self.words = line.split()
        self.poses = {"ODOM": (slice(1, 4),), "FLASER": (slice(-6, -3), slice(-9, -6)),
                      "ROBOTLASER1": (slice(-11, -8), slice(-14, -11))}[self.words[0]]
        self.time = float(self.words[-3])

    def odometry(self):
        return tuple(map(float, self.words[self.poses[0]]))

    def moved(self, seconds, transform):
        words = list(self.words)
        for place in self.poses:
            words[place] = ["%.6f" % v for v in compose(transform, tuple(map(float, self.words[place])))]
        words[-1] = words[-3] = "%.9f" % (self.time + seconds)
        return " ".join(words)


def carmen_lines(path):
    return [CarmenLine(line) for line in path.read_text().splitlines() if line.startswith(("ODOM ", "FLASER ", "ROBOTLASER1 "))]


def odometry_at(lines, time):
    return min((line for line in lines if line.words[0] == "ODOM"), key=lambda line: abs(line.time - time)).odometry()


def relation(t1, t2, a, b):
    x, y, theta = compose(inverse(a), b)
    return "%.9f %.9f %.9f %.9f 0 0 0 %.9f" % (t1, t2, x, y, wrapped(theta))


def write_pairs(truth, path):
    """Relations of scans at any two times: a map may be right where a place is seen again and bent between."""
    generator = random.Random(len(truth))
    pairs = [sorted(generator.sample(range(len(truth)), 2)) for _ in range(PAIRS)]
    path.write_text("".join(relation(truth[a][0], truth[b][0], truth[a][1], truth[b][1]) + "\n" for a, b in pairs))


def joined(first, second, together, one_place):
    """Writes recording and relations `together` of two drives, the second behind the first. `one_place`: both are in one building, and
    the second is cut so that it begins near the end of the first; otherwise the robot is carried."""
    lines, more = carmen_lines(first.with_suffix(".clf")), carmen_lines(second.with_suffix(".clf"))
    truth, other = truth_of(first.with_suffix(".tum")), truth_of(second.with_suffix(".tum"))
    end_time, end = truth[-1]
    start_time, start = other[0]
    if one_place:
        def far(item):
            return math.hypot(item[1][0] - end[0], item[1][1] - end[1]) + abs(wrapped(item[1][2] - end[2]))
        start_time, start = min(other[:len(other) // 2], key=far)
    seconds = end_time - start_time + 1.
    step = compose(inverse(end), start) if one_place else (0., 0., 0.)
    transform = compose(compose(odometry_at(lines, end_time), step), inverse(odometry_at(more, start_time)))
    text = [line.moved(0., (0., 0., 0.)) for line in lines]
    text += [line.moved(seconds, transform) for line in more if line.time >= start_time]
    together.with_suffix(".clf").write_text("\n".join(text) + "\n")
    later = [(t + seconds, pose) for t, pose in other if t >= start_time]
    if one_place:
        write_pairs(truth + later, together.with_suffix(".pairs"))
    relations = first.with_suffix(".relations").read_text().splitlines()
    for line in second.with_suffix(".relations").read_text().splitlines():
        words = line.split()
        if float(words[0]) >= start_time:
            relations.append(" ".join(["%.9f" % (float(w) + seconds) for w in words[:2]] + words[2:]))
    if one_place:
        # What was seen in the first visit, seen again in the second.
        for t, pose in later[::50]:
            near = min(truth[::5], key=lambda item: math.hypot(item[1][0] - pose[0], item[1][1] - pose[1]))
            if math.hypot(near[1][0] - pose[0], near[1][1] - pose[1]) < 2.:
                relations.append(relation(near[0], t, near[1], pose))
    together.with_suffix(".relations").write_text("\n".join(relations) + "\n")


def extent(words):
    values = [float(word) for word in words if "=" not in word]
    if len(values) == 3:
        return 2. * values[2]
    return max(max(values[0::2]) - min(values[0::2]), max(values[1::2]) - min(values[1::2]))


def without_some(world, generator):
    """The world without a third of its small objects: furniture, goods, closed doors."""
    lines = []
    for line in world.read_text().splitlines():
        words = line.split()
        small = bool(words) and words[0] in ("circle", "polyline", "polygon") and extent(words[1:]) < 1.3
        if not small or generator.random() > 1. / 3.:
            lines.append(line)
    return "\n".join(lines) + "\n"


# --- a case -----------------------------------------------------------------


class Bench:
    def __init__(self, commands):
        self.commands = commands
        self.maps = commands.out / "maps"
        self.lua = commands.out / "lua"
        for folder in (self.maps, self.lua):
            folder.mkdir(parents=True, exist_ok=True)
        for name, text in OWN_LUA.items():
            (self.lua / (name + ".lua")).write_text(text + LUA_END)
        self.path, self.lock, self.cases = commands.out / "journal.jsonl", threading.Lock(), {}
        if self.path.exists():
            for line in self.path.read_text().splitlines():
                try:
                    case = json.loads(line)
                except ValueError:
                    continue  # cut short when the program was ended
                self.cases[case["name"]] = case

    def simulate(self, stem, case, world=None, seed=None, carmen=True):
        kind, laser, grade, own_seed, _ = case
        source = ["-world_filename", world, "-seed", own_seed] if world else \
                 ["-generate", kind, "-seed", own_seed if seed is None else seed, "-laser", laser, "-odometry", grade]
        self.commands.run("simulate", *source, "-output_filestem", stem, "-truth_map=false",
                          "-carmen=%s" % ("true" if carmen else "false"), *([] if carmen else ["-mcap"]),
                          *([] if world else ["-world_output_filename", str(stem) + ".world"]))

    def record(self, folder, case):
        """The recording; its relations are beside it."""
        treatment, stem = case[4], folder / "run"
        if treatment == "moved":
            self.simulate(folder / "plan", case)
            generator = random.Random(case[3])
            for name in ("a", "b"):
                (folder / (name + ".world")).write_text(without_some(folder / "plan.world", generator))
                self.simulate(folder / name, case, world=folder / (name + ".world"))
            joined(folder / "a", folder / "b", stem, True)
        elif treatment == "floors":
            self.simulate(folder / "a", case)
            self.simulate(folder / "b", case, seed=case[3] + 10000)
            joined(folder / "a", folder / "b", stem, False)
        else:
            self.simulate(stem, case, carmen=False)
            write_pairs(truth_of(stem.with_suffix(".tum")), stem.with_suffix(".pairs"))
            return stem.with_suffix(".mcap")
        return stem.with_suffix(".clf")

    def map(self, name, case):
        """Records, maps and measures; a line of the journal."""
        treatment = case[4]
        result = dict(zip(("kind", "laser", "odometry", "seed", "treatment"), case), name=name)
        folder = self.commands.out / ("work." + name)
        shutil.rmtree(str(folder), ignore_errors=True)
        folder.mkdir(parents=True)
        stem = folder / "run"
        basename = {"stock": "stock.lua", "ours": "default.lua"}.get(treatment, treatment + ".lua" if treatment in OWN_LUA else "default.lua")
        try:
            recording = self.record(folder, case)
            self.commands.run("slam", "-input_filename", recording, "-configuration_directory", "%s,%s" % (self.lua, common.CONFIGURATIONS),
                              "-configuration_basename", basename, "-pbstream_filename", stem.with_suffix(".pbstream"),
                              "-num_background_threads", 1)
            for suffix in (".relations", ".pairs", ".pbstream"):
                if stem.with_suffix(suffix).exists():
                    os.replace(str(stem.with_suffix(suffix)), str(self.maps / (name + suffix)))
            result.update(self.by_truth(result, self.maps / (name + ".pbstream")))
        except common.Failed as error:
            result.update(failure=str(error), truth="failed")
        finally:
            shutil.rmtree(str(folder), ignore_errors=True)
        self.write(result)

    def json_of(self, command, path, *arguments, codes=(0,)):
        """The JSON that a command writes, unless it is there and newer than the command."""
        if path.exists() and path.stat().st_mtime < os.stat(self.commands.path(command)).st_mtime:
            path.unlink()
        self.commands.run(command, *arguments, "-json", path, unless=path, codes=codes)
        return json.loads(path.read_text())

    def verdict(self, name):
        """The verdict of cartographer_ext_evaluate on the map alone."""
        return self.json_of("evaluate", self.maps / (name + ".json"), "-pbstream_filename", self.maps / (name + ".pbstream"))["consistency"]

    def relations(self, path, pbstream, filename):
        return self.json_of("evaluate", path, "-pbstream_filename", pbstream, "-relations_filename", filename, "-self_consistency=false")["relations"]

    def by_truth(self, case, pbstream):
        """Errors of a map of this case, by relations of revisits and of any two scans."""
        name = case["name"]
        relations = self.relations(pbstream.with_suffix(".truth.json"), pbstream, self.maps / (name + ".relations"))
        loops = relations.get("loop", {})
        result = dict(treatment=case["treatment"], loops=loops.get("count", 0), error=relations["translation"]["mean"],
                      max=relations["translation"]["max"], loop_error=loops["translation"]["mean"] if loops.get("count") else None,
                      loop_max=loops["translation"]["max"] if loops.get("count") else None, pair_error=None)
        if case["treatment"] != "floors":
            pairs = self.relations(pbstream.with_suffix(".pairs.json"), pbstream, self.maps / (name + ".pairs"))
            result["pair_error"] = pairs["translation"]["mean"]
        return dict(result, truth=truth(result))

    def complete(self, case):
        """A case of the journal, which may be of an earlier version: with the relations of any two scans."""
        if case["truth"] == "failed":
            return case
        if case["treatment"] == "floors" or "pair_error" in case:
            return dict(case, truth=truth(case))
        name, folder = case["name"], self.commands.out / ("work." + case["name"])
        shutil.rmtree(str(folder), ignore_errors=True)
        folder.mkdir(parents=True)
        self.record(folder, tuple(case[key] for key in ("kind", "laser", "odometry", "seed", "treatment")))
        os.replace(str(folder / "run.pairs"), str(self.maps / (name + ".pairs")))
        shutil.rmtree(str(folder), ignore_errors=True)
        return self.write(dict(case, **self.by_truth(case, self.maps / (name + ".pbstream"))))

    def write(self, case):
        with self.lock:
            self.cases[case["name"]] = case
            with open(str(self.path), "a") as stream:
                stream.write(json.dumps(case) + "\n")
        return case

    def repair(self, case):
        """The case with its map repaired: errors by truth before and after, and what the command says."""
        original = self.maps / (case["name"] + ".pbstream")
        path = self.maps / (case["name"] + ".repaired.pbstream")
        said = self.json_of("repair", path.with_suffix(".json"), original, "-output_filename", path, "-keep_frame",
                            "-num_background_threads", 1, codes=(0, 3))
        before = self.by_truth(case, original)
        return dict(case, before=before, after=self.by_truth(case, path) if said["written"] else before, said=said)


def truth(case):
    """sound, bent or broken by its relations or, where nothing was visited twice, unknown. Superimposed floors are always broken. A bent
    map is right where places are seen again, as far as the relations tell, and wrong between."""
    if case["treatment"] == "floors":
        return "broken"
    if not case["loops"]:
        return "unknown"
    if case["loop_error"] > SOUND_LOOP_ERROR or case["max"] > 0.5:
        return "broken"
    return "bent" if (case.get("pair_error") or 0.) > SOUND_LOOP_ERROR else "sound"


# --- what is shown ----------------------------------------------------------


def confusion(label, cases_):
    lines = []
    for name in TRUTHS:
        own = [case for case in cases_ if case["truth"] == name]
        lines.append([label, name, len(own)] + [sum(case["verdict"] == word for case in own) for word in WORDS])
    return lines


def verdicts(commands, options):
    """Maps with known truth, sound and broken in many ways: the verdict without ground truth, compared with it."""
    bench = Bench(commands)
    log = list(commands.log)

    def one(item):
        name, case = item
        if name not in bench.cases:
            bench.map(name, case)
        result = dict(bench.complete(bench.cases[name]))
        if result["truth"] in TRUTHS:
            consistency = bench.verdict(name)
            result.update(verdict=consistency["verdict"], measures=consistency)
        commands.log[:] = log
        return result

    results = commands.each(one, chosen(options))
    judged = [case for case in results if "verdict" in case]
    halves = [("chosen on", [c for c in judged if c["seed"] % 2 == 0]), ("judged", [c for c in judged if c["seed"] % 2 == 1])]
    text = common.table(["half", "truth", "maps"] + list(WORDS), [line for label, own in halves for line in confusion(label, own)]) + "\n"
    text += common.table(["treatment", "truth", "maps"] + list(WORDS),
                         [line for name in sorted(set(TREATMENTS))
                          for line in confusion(name, [c for c in judged if c["treatment"] == name]) if line[2]]) + "\n"
    wrong = [c for c in judged if (c["truth"] == "sound" and c["verdict"] != "sound") or
             (c["truth"] != "sound" and c["verdict"] in ("sound", "unknown"))]
    text += "Verdicts that are not the truth:\n\n" + common.table(
        ["map", "truth", "loops m", "largest m", "any two scans m", "verdict", "severe %", "displaced %"],
        [[c["name"], c["truth"], common.number(c["loop_error"], 2), common.number(c["max"], 2), common.number(c.get("pair_error"), 2),
          c["verdict"], common.number(100. * c["measures"]["severe_share"], 1), common.number(100. * c["measures"]["displaced_share"], 1)]
         for c in wrong])
    failed = [c for c in results if c["truth"] == "failed"]
    if failed:
        text += "Not mapped: %s.\n\n" % "; ".join("%s (%s)" % (c["name"], c["failure"]) for c in failed)
    return ("Verdicts against truth",
            "Broken: relations of revisits are off by more than %.1f m in the mean, or one of them, or one along the path, by more than "
            "half a metre; or two superimposed floors. Bent: not broken, but relations of any two scans are off by more than %.1f m in "
            "the mean. Halves by the parity of the seed." % (SOUND_LOOP_ERROR, SOUND_LOOP_ERROR), text)


# --- repairs ----------------------------------------------------------------


def outcome(case):
    """What a repair did to a map, by truth: unchanged, worse, sound, better or alike."""
    if not case["said"]["written"]:
        return "unchanged"
    before, after = case["before"], case["after"]
    if after["loop_error"] > before["loop_error"] + SAME_ERROR or (before["truth"] == "sound" != after["truth"]):
        return "worse"
    if after["truth"] == "sound":
        return "sound"
    return "better" if after["loop_error"] < before["loop_error"] - SAME_ERROR else "alike"


OUTCOMES = ("sound", "better", "alike", "unchanged", "worse")


def repair_line(label, cases_):
    found = [outcome(case) for case in cases_]
    errors = [[case[when]["loop_error"] for case in cases_] for when in ("before", "after")]
    return [label, len(cases_)] + [found.count(word) for word in OUTCOMES] + [common.number(common.median(e), 2) for e in errors]


def repairs(commands, options):
    """Maps with known truth repaired from the pbstream alone: the broken ones, and the first of the sound ones."""
    bench = Bench(commands)
    log = list(commands.log)
    own = commands.each(bench.complete, [bench.cases[name] for name, _ in chosen(options) if name in bench.cases])
    sound = [case for case in own if case["truth"] == "sound"][:SOUND_MAPS]
    broken = [case for case in own if case["truth"] in ("bent", "broken") and case["loops"]]
    # Two floors are no one map, whatever is done to it.
    floors = [case for case in broken if case["treatment"] == "floors"][:FLOORS]
    broken = [case for case in broken if case["treatment"] != "floors"][:BROKEN_MAPS]

    def one(case):
        result = bench.repair(case)
        commands.log[:] = log
        return result

    if not broken + sound:
        raise common.Failed("there are no maps yet: run scripts/reproduce verdicts first")
    broken, sound, floors = [commands.each(one, group) for group in (broken, sound, floors)]
    header = ["maps", "count"] + list(OUTCOMES) + ["loops before m", "after m"]
    lines = [repair_line("broken", broken)] + [repair_line(name, [c for c in broken if c["treatment"] == name]) for name in OWN_TREATMENTS]
    text = common.table(header, [line for line in lines + [repair_line("floors", floors), repair_line("sound", sound)] if line[1]]) + "\n"
    left = [c for c in broken if outcome(c) != "sound"] + [c for c in floors + sound if outcome(c) == "worse"]
    text += "Broken maps that are not sound afterwards, and others that are worse:\n\n" + common.table(
        ["map", "outcome", "loops m before", "after", "largest m", "verdict before", "after", "said"],
        [[c["name"], outcome(c), common.number(c["before"]["loop_error"], 2), common.number(c["after"]["loop_error"], 2),
          common.number(c["after"]["max"], 2), c["said"]["before"]["verdict"], c["said"]["after"]["verdict"],
          c["said"]["conclusion"]] for c in left])
    return ("Broken maps repaired",
            "By ground truth: sound as in the verdicts; better, worse: relations of revisits differ by more than %.0f cm in the mean; "
            "unchanged: nothing was written. Two superimposed floors cannot be one sound map." % (100. * SAME_ERROR), text)


EXPERIMENTS = [verdicts, repairs]
