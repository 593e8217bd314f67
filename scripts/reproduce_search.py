# SPDX-FileCopyrightText: 2026 The cartographer_ext authors
# SPDX-License-Identifier: Apache-2.0
"""The searches of the 2025 paper, for scripts/reproduce, which puts itself in as `common`."""
import collections
import json
import math
import re
import statistics

common = None


def runs_of_grid(commands, options, search, names, seeds):
    """{values of `names`: [metrics of a seed]} of a grid of the tuning command over runs of the corridor world."""
    inputs = ",".join("%s#%d" % (common.WORLDS / "ri_corridor.world", seed) for seed in range(1, seeds + 1))
    journal = commands.out / "journal.jsonl"
    commands.run("tune", "-search_filename", common.CONFIGURATIONS / "tuning" / search,
                 "-configuration_directory", common.CONFIGURATIONS, "-inputs", inputs, "-method", "grid", "-noprune",
                 "-journal_filename", journal, "-json", commands.out / "tune.json",
                 "-picture_filename", commands.out / "tune.png", "-workers", options.jobs)
    result = {}
    for line in journal.read_text().splitlines()[1:]:
        run = json.loads(line)
        seed = re.match(r"ri_corridor\.world#(\d+)", run["input"])
        # A journal may hold more seeds than are asked for now.
        if run["status"] != "ok" or not seed or int(seed.group(1)) > seeds:
            continue
        values = tuple(next(round(v, 6) for k, v in run["values"].items() if k.endswith("." + name)) for name in names)
        result.setdefault(values, []).append(run["metrics"])
    if not result:
        raise common.Failed("no run succeeded (%s)" % journal)
    return collections.OrderedDict(sorted(result.items()))


def spread(values, digits):
    """Median and range of what is known."""
    known = [v for v in values if v is not None]
    if not known:
        return "-"
    if len(known) == 1:
        return common.number(known[0], digits)
    return "%.*f (%.*f-%.*f)" % (digits, statistics.median(known), digits, min(known), digits, max(known))


def c_gamma(commands, options):
    """Grid search for gamma of the variable window."""
    common.require_configuration("paper_2025.lua")
    commands.seeds = options.seeds or 3
    runs = runs_of_grid(commands, options, "paper_2025_gamma.lua", ["window_gamma"], commands.seeds)
    printed = {0.3: "chosen: accuracy +12 %, time +5 %"}
    lines = [["%.1f" % values[0], printed.get(values[0], "")] +
             [spread([m.get(key) for m in metrics], digits) for key, digits in
              (("loop_precision", 3), ("loop_recall", 2), ("loops", 0), ("relations", 3), ("loop_search_cpu_seconds", 1))]
             for values, metrics in runs.items()]
    note = ("The paper searches 0.1 to 0.5 in simulation for the best accuracy of loop detection and takes 0.3; it does not say "
            "against what. Window of equation 4 with the age of the submap in seconds; corridor world, in brackets the least and "
            "the largest.")
    if len({tuple(line[2:6]) for line in lines}) == 1:
        note += (" Gamma changes nothing here: the window has its full length of 6 nodes at the latest 14 s after a submap "
                 "was begun, and no place is seen again sooner.")
    return ("C, section 1.2: grid search for gamma", note,
            common.table(["gamma", "paper", "share of right loops", "revisits closed", "loops", "relations m",
                          "CPU s of loop closure"], lines))


def c_alpha_beta(commands, options):
    """Calibration of the exponents of the weights."""
    common.require_configuration("paper_2025.lua")
    commands.seeds = options.seeds or 3
    runs = runs_of_grid(commands, options, "paper_2025_alpha_beta.lua", ["alpha", "beta"], commands.seeds)
    best = min(runs, key=lambda values: statistics.median([m.get("relations", math.inf) for m in runs[values]]))
    lines = []
    for values, metrics in runs.items():
        remark = ["chosen by the paper"] if values == (1.2, 1.5) else []
        remark += ["least error"] if values == best else []
        lines.append(["%.1f" % v for v in values] + [", ".join(remark)] +
                     [spread([m.get(key) for m in metrics], 4) for key in ("relations", "relations_median", "ate")])
    return ("C, section 1.4: calibration of alpha and beta",
            "The paper fixes alpha and varies beta for the least error of the map and usually uses 1.2 and 1.5; it prints no "
            "errors. Corridor world, errors of the true relations, in brackets the least and the largest.",
            common.table(["alpha", "beta", "", "mean m", "median m", "ATE m"], lines))


EXPERIMENTS = [c_gamma, c_alpha_beta]
