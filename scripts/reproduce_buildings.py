# SPDX-FileCopyrightText: 2026 The cartographer_ext authors
# SPDX-License-Identifier: Apache-2.0
"""Generated buildings, for scripts/reproduce: how often, and where, mapping fails on buildings not used during development.

A run is a kind of building, a laser, a grade of odometry, a seed and a method. Runs are taken from the cases in an order whose
every beginning is balanced, so that a sample is one of all of them. Each finished run is a line of journal.jsonl and is not
repeated; recordings and maps are deleted after it.
"""
import csv
import html
import json
import math
import os
import shutil
import threading

common = None

KINDS = ("office", "hotel", "warehouse", "hall", "street", "campus")
LASERS = ("depth_camera", "rplidar_a1", "ld06", "urg_04lx", "utm_30lx", "sick_lms")
GRADES = ("fair", "poor")
OUTDOORS = ("street", "campus")
CONFIGURATIONS = {"ours": "default.lua", "stock": "stock.lua"}
SEED = 1000  # of the first run
# A map is right where at least nine of ten true revisits lie together.
OPEN_SHARE = 0.1
WRONG_LOOPS = 0.05
SAMPLES_PER_BIN = 50  # fewer say little about the calibration

FIELDS = ["kind", "laser", "odometry", "seed", "method", "outcome", "metres", "ate", "ate_per_metre", "loop_error", "loops_apart",
          "sequential_error", "sequential_degrees", "precision", "recall", "accepted", "verdict", "cpu_seconds", "front_end_cpu_seconds",
          "search_cpu_seconds", "searches", "peak_megabytes", "sensor_seconds", "nodes", "submaps", "error"]


def names(text, known, what):
    chosen = [name for name in text.split(",") if name] or list(known)
    for name in chosen:
        if name not in known and name not in ("good", "none"):
            raise common.Failed("%s: %s is none of %s" % (what, name, ", ".join(known)))
    return chosen


def cases(kinds, lasers, grades, count):
    """`count` runs (kind, laser, grade, seed); every prefix has all kinds, lasers and grades about equally often."""
    result = []
    for i in range(count):
        kind, block = i % len(kinds), i // len(kinds)
        laser = (kind + block) % len(lasers)
        grade = (kind // 2 + block + block // len(lasers)) % len(grades)
        result.append((kinds[kind], lasers[laser], grades[grade], SEED + i))
    return result


def outcome(run):
    """right, open (revisits not closed) or folded (closed at wrong places)."""
    if run.get("error"):
        return "failed"
    if run["loops_apart"] is None:
        return "not judged"
    if run["loops_apart"] <= OPEN_SHARE:
        return "right"
    wrong = run["precision"] is not None and run["precision"] < 1. - WRONG_LOOPS
    return "folded" if wrong and run["accepted"] > 0 else "open"


def figures(evaluation, slam):
    relations, loops = evaluation.get("relations", {}), evaluation.get("loops", {})
    loop, sequential = relations.get("loop", {}), relations.get("sequential", {})
    count = loop.get("count", 0)
    metres = evaluation.get("trajectory_metres")
    ate = evaluation.get("ate", {}).get("rmse")
    return {"metres": metres, "ate": ate,
            "ate_per_metre": ate / metres if metres and ate is not None else None,
            "loop_error": loop["translation"]["mean"] if count else None,
            "loops_apart": loop["fraction_above_half_metre"] if count else None,
            "sequential_error": sequential.get("translation", {}).get("mean"),
            "sequential_degrees": sequential.get("rotation_degrees", {}).get("mean"),
            "precision": loops.get("precision"), "recall": loops.get("recall"), "accepted": loops.get("accepted", 0),
            "verdict": evaluation.get("consistency", {}).get("verdict"), "cpu_seconds": slam["cpu_seconds"],
            "front_end_cpu_seconds": slam["front_end_cpu_seconds"], "search_cpu_seconds": slam["loop_search"]["cpu_seconds"],
            "searches": slam["loop_search"]["count"], "peak_megabytes": slam["peak_memory_bytes"] / 2.**20,
            "sensor_seconds": slam["sensor_seconds"], "nodes": slam["nodes"], "submaps": slam["submaps"]}


def map_case(commands, case, method):
    """Simulates, maps and evaluates one run in its own folder."""
    kind, laser, grade, seed = case
    run = {"kind": kind, "laser": laser, "odometry": grade, "seed": seed, "method": method}
    folder = commands.out / ("work.%s.%s.%s.%d.%s" % (kind, laser, grade, seed, method))
    shutil.rmtree(str(folder), ignore_errors=True)
    folder.mkdir(parents=True)
    stem = folder / "run"
    try:
        commands.run("simulate", "-generate", kind, "-laser", laser, "-odometry", grade, "-seed", seed, "-output_filestem", stem,
                     "-carmen=false", "-truth_map=false", "-mcap")
        commands.run("slam", "-input_filename", str(stem) + ".mcap", "-configuration_directory", common.CONFIGURATIONS,
                     "-configuration_basename", CONFIGURATIONS[method], "-pbstream_filename", str(stem) + ".pbstream",
                     "-trajectory_filename", str(stem) + ".map.tum", "-num_background_threads", 1, "-json", str(stem) + ".slam.json")
        commands.run("evaluate", "-pbstream_filename", str(stem) + ".pbstream", "-trajectory_filename", str(stem) + ".map.tum",
                     "-relations_filename", str(stem) + ".relations", "-reference_trajectory_filename", str(stem) + ".tum",
                     "-json", str(stem) + ".json")
        with open(str(stem) + ".json") as evaluation, open(str(stem) + ".slam.json") as slam:
            run.update(figures(json.load(evaluation), json.load(slam)))
        if method == "ours" and run["searches"]:
            commands.run("label_loops", "-pbstream_filename", str(stem) + ".pbstream", "-reference_trajectory_filename",
                         str(stem) + ".tum", "-json", str(stem) + ".labels.json")
            with open(str(stem) + ".labels.json") as labels:
                run["reliability"] = [[b["count"], b["mean_score"], b["true_share"]] for b in json.load(labels)["calibration"]["bins"]]
    except common.Failed as error:
        run["error"] = str(error)
    finally:
        shutil.rmtree(str(folder), ignore_errors=True)
    run["outcome"] = outcome(run)
    return run


class Journal:
    """Finished runs, one per line; an incomplete last line is dropped."""

    def __init__(self, path):
        self.path, self.lock, self.runs = path, threading.Lock(), {}
        if path.exists():
            for line in path.read_text().splitlines():
                try:
                    run = json.loads(line)
                except ValueError:
                    continue
                self.runs[self.key(run)] = run

    @staticmethod
    def key(run):
        return (run["kind"], run["laser"], run["odometry"], run["seed"], run["method"])

    def add(self, run):
        with self.lock:
            self.runs[self.key(run)] = run
            with open(str(self.path), "a") as stream:
                stream.write(json.dumps(run) + "\n")


# --- what is shown ----------------------------------------------------------


def share(part, whole, digits=0):
    return "%.*f %% (%d of %d)" % (digits, 100. * part / whole, part, whole) if whole else "-"


def quantile(values, fraction):
    values = sorted(v for v in values if v is not None)
    if fraction == 0.5:
        return common.median(values)
    return values[min(len(values) - 1, int(fraction * len(values)))] if values else None


def summary(label, runs):
    number = common.number
    counts = {name: sum(run["outcome"] == name for run in runs) for name in ("right", "open", "folded", "failed")}
    # Of all accepted loops of the group, not a mean over runs.
    right = sum(run["precision"] * run["accepted"] for run in runs if run.get("precision") is not None)
    accepted = sum(run["accepted"] for run in runs if run.get("precision") is not None)
    recalls = [run["recall"] for run in runs if run.get("recall") is not None]
    ates = [run.get("ate") for run in runs]
    shares = [100. * run["ate_per_metre"] for run in runs if run.get("ate_per_metre") is not None]
    return [label, len(runs), counts["right"], counts["open"], counts["folded"], counts["failed"],
            "%.3f" % (right / accepted) if accepted else "-", number(sum(recalls) / len(recalls), 2) if recalls else "-",
            number(quantile(ates, 0.5)), number(quantile(ates, 0.9), 2), number(quantile(shares, 0.5), 2),
            number(quantile([run.get("sequential_error") for run in runs], 0.5)),
            number(quantile([run.get("cpu_seconds") for run in runs], 0.5), 1),
            number(quantile([run.get("peak_megabytes") for run in runs], 0.5), 0)]


HEADER = ["runs of", "n", "right", "open", "folded", "failed", "precision", "recall", "ATE m, median", "9 of 10 below",
          "ATE / path %, median", "sequential m", "CPU s", "MB"]


def tables(runs, methods, grouping):
    text = ""
    for method in methods:
        own = [run for run in runs if run["method"] == method]
        if not own:
            continue
        lines = [summary("**all**", own), summary("indoors", [r for r in own if r["kind"] not in OUTDOORS]),
                 summary("outdoors", [r for r in own if r["kind"] in OUTDOORS])]
        for field, values in grouping:
            lines += [summary(value, [r for r in own if r[field] == value]) for value in values]
        text += "**%s** (`%s`)\n\n%s\n" % (method, CONFIGURATIONS[method], common.table(HEADER, [l for l in lines if l[1]]))
    return text


def pooled(runs):
    """Reliability diagrams of several runs as one: (candidates, mean probability, share of true ones) of each tenth."""
    bins = []
    for i in range(10):
        parts = [run["reliability"][i] for run in runs if run.get("reliability")]
        count = sum(part[0] for part in parts)
        bins.append((count,) + tuple(sum(part[0] * part[j] for part in parts) / count if count else None for j in (1, 2)))
    return bins


def calibration(runs, lasers):
    """Whether candidates are right as often as their probabilities say: reliability diagrams as a table."""
    lines = []
    for label, group in [("**all**", runs)] + [(laser, [r for r in runs if r["laser"] == laser]) for laser in lasers]:
        tenths = pooled(group)
        bins = [b for b in tenths if b[0]]
        total = sum(b[0] for b in bins)
        if not total:
            continue
        error = sum(b[0] * abs(b[1] - b[2]) for b in bins) / total
        worst = max([abs(b[1] - b[2]) for b in bins if b[0] >= SAMPLES_PER_BIN], default=None)
        lines.append([label, total, "%.3f" % error, common.number(worst)] +
                     ["%.2f / %.2f (%d)" % (b[1], b[2], b[0]) if b[0] else "-" for b in tenths])
    if not lines:
        return ""
    header = ["candidates of", "n", "calibration error", "worst bin"] + ["%.1f-%.1f" % (i / 10., (i + 1) / 10.) for i in range(10)]
    return ("Mean probability / share of true candidates (number) by tenths of the probability. The calibration error is the mean of the "
            "difference, the worst bin that with at least %d candidates.\n\n%s" % (SAMPLES_PER_BIN, common.table(header, lines)))


def failures(runs):
    lines = []
    for run in runs:
        if run["outcome"] != "right":
            lines.append([run["method"], run["kind"], run["laser"], run["odometry"], run["seed"], run["outcome"],
                          common.number(run.get("ate"), 2), common.number(run.get("sequential_error")), run.get("accepted", "-"),
                          common.number(run.get("precision"), 2), common.number(run.get("recall"), 2), run.get("verdict", "-"),
                          run.get("error", "")])
    return common.table(["method", "kind", "laser", "odometry", "seed", "outcome", "ATE m", "sequential m", "loops", "precision",
                         "recall", "verdict without truth", "error"], lines)


COLORS = {"ours": "#0072b2", "stock": "#d55e00"}


def distribution(title, runs, methods):
    """SVG: the share of runs (up) whose ATE over path length is below a value (right, logarithmic)."""

    width, height, left, low, high = 420, 220, 40, -5., 0.
    parts = ['<svg width="%d" height="%d" xmlns="http://www.w3.org/2000/svg"><text x="%d" y="14">%s</text>' %
             (width, height, left, html.escape(title))]
    x = lambda value: left + (width - left - 10) * (max(low, min(high, math.log10(max(value, 1e-9)))) - low) / (high - low)
    y = lambda value: height - 25 - (height - 50) * value
    for exponent in range(int(low), int(high) + 1):
        parts.append('<line x1="%.1f" x2="%.1f" y1="25" y2="%d" stroke="#ddd"/><text x="%.1f" y="%d" font-size="10">%g %%</text>' %
                     (x(10.**exponent), x(10.**exponent), height - 25, x(10.**exponent) - 8, height - 10, 100. * 10.**exponent))
    for value in (0., 0.5, 1.):
        parts.append('<line x1="%d" x2="%d" y1="%.1f" y2="%.1f" stroke="#ddd"/><text x="5" y="%.1f" font-size="10">%g %%</text>' %
                     (left, width - 10, y(value), y(value), y(value) + 3, 100 * value))
    for method in methods:
        values = sorted(r["ate_per_metre"] for r in runs if r["method"] == method and r.get("ate_per_metre") is not None)
        points = ["%.1f,%.1f" % (x(low), y(0.))]
        for i, value in enumerate(values):
            points += ["%.1f,%.1f" % (x(value), y(i / len(values))), "%.1f,%.1f" % (x(value), y((i + 1) / len(values)))]
        if values:
            parts.append('<polyline fill="none" stroke="%s" stroke-width="2" points="%s"/>' % (COLORS[method], " ".join(points)))
    return "".join(parts) + "</svg>"


def page(runs, methods, lasers, kinds):
    charts = [distribution("all runs", runs, methods)]
    charts += [distribution(laser, [r for r in runs if r["laser"] == laser], methods) for laser in lasers]
    charts += [distribution(kind, [r for r in runs if r["kind"] == kind], methods) for kind in kinds]
    rows = "".join("<tr>%s</tr>" % "".join("<td>%s</td>" % html.escape("%.4g" % v if isinstance(v, float) else str(v))
                                           for v in (run.get(field, "") for field in FIELDS)) for run in runs)
    return ("<!DOCTYPE html><meta charset='utf-8'><title>Any building</title><style>body{font-family:sans-serif}td,th{padding:2px "
            "6px;font-size:12px}</style><h1>Any building</h1><p>Share of runs whose absolute trajectory error over the length of the "
            "path is below a value. %s</p>%s<h2>All runs</h2><table><tr>%s</tr>%s</table>\n" %
            (", ".join("<span style='color:%s'>%s</span>" % (COLORS[m], m) for m in methods), "".join(charts),
             "".join("<th>%s</th>" % field for field in FIELDS), rows))


def write(path, text):
    temporary = path.with_name(path.name + ".tmp")
    temporary.write_text(text)
    os.replace(str(temporary), str(path))


def any_building(commands, options):
    """Generated buildings x lasers x odometry x seeds, ours and stock: distributions and the failing seeds."""
    kinds = names(options.kinds, KINDS, "--kinds")
    lasers = names(options.lasers, LASERS, "--lasers")
    grades = names(options.odometry, GRADES, "--odometry")
    count = options.runs or len(kinds) * len(lasers) * len(grades) * (options.seeds or 1)
    stock = count if options.stock_runs < 0 else options.stock_runs
    todo = [(case, "ours") for case in cases(kinds, lasers, grades, count)]
    todo += [(case, "stock") for case in cases(kinds, lasers, grades, min(count, stock))]
    journal = Journal(commands.out / "journal.jsonl")
    log = list(commands.log)

    def one(item):
        case, method = item
        key = case[:3] + (case[3], method)
        if key not in journal.runs:
            journal.add(map_case(commands, case, method))
            commands.log[:] = log
        return journal.runs[key]

    runs = commands.each(one, todo)
    methods = [m for m in CONFIGURATIONS if any(r["method"] == m for r in runs)]
    write(commands.out / "runs.json", json.dumps(runs, indent=1))
    with open(str(commands.out / "runs.csv.tmp"), "w", newline="") as stream:
        writer = csv.DictWriter(stream, FIELDS, extrasaction="ignore")
        writer.writeheader()
        writer.writerows(runs)
    os.replace(str(commands.out / "runs.csv.tmp"), str(commands.out / "runs.csv"))
    write(commands.out / "runs.html", page(runs, methods, lasers, kinds))
    bad = [run for run in runs if run["outcome"] != "right"]
    text = tables(runs, methods, [("odometry", grades), ("laser", lasers), ("kind", kinds)])
    text += "Runs that are not right: %s.\n\n%s" % (share(len(bad), len(runs)), failures(runs))
    text += calibration([run for run in runs if run["method"] == "ours"], lasers)
    return ("Any building",
            "Right: at most a tenth of the true revisits lie more than half a metre apart. Folded: not right, and more than a twentieth "
            "of the accepted loops are wrong; open: not right because loops are missing. Precision is that of all loops of a group together. "
            "Sequential: mean error of relations about 1 m apart, which is local SLAM's. Every run with its figures is in "
            "runs.html, runs.csv and runs.json in %s." % commands.out, text)


EXPERIMENTS = [any_building]
