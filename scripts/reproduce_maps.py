# SPDX-FileCopyrightText: 2026 The cartographer_ext authors
# SPDX-License-Identifier: Apache-2.0
"""Stored maps judged and re-run, for scripts/reproduce, which puts itself in as `common`."""
import pathlib

common = None

# By the beginning of a map's name.
RELATIONS = {"aces": "aces.relations", "csail": "mit-csail.relations"}


def percent(value, digits=1):
    return "-" if value is None else "%.*f %%" % (digits, 100. * value)


def judged(run):
    """Columns of the quality of a map."""
    own = run["evaluation"]
    loops, consistency = own["loops"], own["consistency"]
    truth = "relations" in own
    cycles = consistency["loop_cycles"]
    return [percent(loops.get("precision")) + (", %d of %d" % (loops["revisits_closed"], loops["revisits"]) if truth else ""),
            common.number(own["relations"]["translation"]["mean"], 4) if truth else "-",
            percent(cycles["inconsistent"] / cycles["count"] if cycles["count"] else None),
            percent(consistency["severe_share"]),
            "%.1f / %.1f" % (100. * consistency["wall_thickness_single_visit"]["mean"],
                             100. * consistency["wall_thickness_revisited"]["mean"]) if
            consistency.get("wall_thickness_revisited", {}).get("count") else "-",
            own["verdict"] if truth else consistency["verdict"]]


def stored_maps(commands, options):
    """Finished maps: verdict, and loop closure re-run, stock and ours."""
    folder = pathlib.Path(options.data) / "pbstream"
    configurations = pathlib.Path(options.data).parent / "golden" / "configs"
    maps = sorted(folder.glob("*.pbstream"))
    if not maps:
        raise common.Failed("no map in %s (--data DIR)" % folder)

    def one(path):
        arguments = ["-pbstream_filename", path, "-rerun_configuration_basename", "default.lua"]
        own = configurations / (path.stem + ".lua")
        directories = [common.CONFIGURATIONS]
        if own.exists():
            directories.insert(0, configurations)
            arguments += ["-rerun_stock_configuration_basename", own.name]
        for beginning, relations in RELATIONS.items():
            if path.stem.startswith(beginning):
                arguments += ["-relations_filename", pathlib.Path(options.data) / "relations" / relations]
        return commands.evaluate(path.stem, "-rerun_configuration_directory", ",".join(map(str, directories)), *arguments)

    lines = []
    for path, result in zip(maps, commands.each(one, maps)):
        options_known = "its Lua" if (configurations / (path.stem + ".lua")).exists() else "assumed"
        for run in result["runs"]:
            line = [path.stem if run is result["runs"][0] else "", run["name"], run["loops"]]
            if "run" in run:
                same = run["against_stored"]
                line += ["%s (%s)" % (percent(same["fraction_of_stored"]), options_known) if run["name"] == "stock re-run" else
                         percent(same["fraction_of_stored"])]
                resources = [common.number(run["run"]["loop_search_cpu_seconds"], 1), "%.0f" % (run["run"]["peak_memory_bytes"] / 2.**20)]
            else:
                line += [""]
                resources = ["", ""]
            lines.append(line + judged(run) + resources)
    return ("Stored maps: stock and ours with the same local SLAM",
            "Only loop closure is re-run, from the .pbstream alone. Ground truth exists for aces and csail only. Stock's options are those of "
            "the file beside the map, or Cartographer's defaults (assumed); ours is the same with the blocks of default.lua. The "
            "runs are deterministic, so there are no seeds.",
            common.table(["map", "run", "loops", "stored pairs reproduced", "precision, revisits closed", "relations m", "open cycles",
                          "severe", "walls cm, one visit / all", "verdict", "loop closure CPU s", "MiB"], lines))


EXPERIMENTS = [stored_maps]
