// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
//
// scripts/reproduce: usage, errors, and the arithmetic behind its tables.
#include <stdlib.h>

#include "gmock/gmock.h"
#include "gtest/gtest.h"
#include "tests/tools/run_command.h"

namespace cartographer_ext {
namespace test {
namespace {

using testing::HasSubstr;

struct ShellResult {
  int exit_code = -1;
  std::string out;
};

// Standard output and error together.
ShellResult Shell(const std::string& command) {
  const TemporaryFolder folder;
  const int state =
      std::system((command + " > " + folder / "out" + " 2>&1").c_str());
  ShellResult result;
  if (WIFEXITED(state)) result.exit_code = WEXITSTATUS(state);
  result.out = ReadFile(folder / "out");
  return result;
}

TEST(ReproduceTest, ListsEveryTable) {
  const ShellResult result = Shell("python3 scripts/reproduce list");
  EXPECT_EQ(result.exit_code, 0) << result.out;
  for (const char* name :
       {"a_table_2", "r_table_2", "g_table_2", "g_table_3", "c_table_1",
        "c_table_3", "c_table_4", "c_table_5", "c_gamma", "c_alpha_beta",
        "stored_maps", "c_navigation", "any_building", "verdicts", "repairs"}) {
    EXPECT_THAT(result.out, HasSubstr(name));
  }
}

TEST(ReproduceTest, SaysWhatIsWrong) {
  const TemporaryFolder folder;
  const ShellResult unknown = Shell("python3 scripts/reproduce z_table_1");
  EXPECT_EQ(unknown.exit_code, 2);
  EXPECT_THAT(unknown.out, HasSubstr("unknown experiment z_table_1"));
  EXPECT_EQ(Shell("python3 scripts/reproduce a_table_2 --seeds -1").exit_code,
            2);
  const ShellResult not_built =
      Shell("python3 scripts/reproduce r_table_2 --out " + folder.path() +
            "/out --build " + folder.path());
  EXPECT_EQ(not_built.exit_code, 1);
  EXPECT_THAT(not_built.out, HasSubstr("cartographer_ext_robustness is not"));
}

// A sample of the cases is balanced whatever its size, and all of them are all
// combinations.
TEST(ReproduceTest, CasesOfBuildingsAreBalanced) {
  const ShellResult result = Shell(
      "python3 -c \"import collections; m = {}; "
      "exec(open('scripts/reproduce_buildings.py').read(), m); "
      "all = m['cases'](m['KINDS'], m['LASERS'], m['GRADES'], 72); "
      "count = lambda runs, of: "
      "sorted(set(collections.Counter(map(of, runs)).values())); "
      "print(len({c[:3] for c in all}), "
      "[count(all[:36], lambda c, i=i: c[i]) for i in (0, 1, 2)], "
      "count(all[:36], lambda c: c[:2]), count(all[:36], lambda c: c[1:3]))\"");
  EXPECT_EQ(result.exit_code, 0) << result.out;
  EXPECT_EQ(result.out, "72 [[6], [6], [18]] [1] [3]\n");
}

TEST(ReproduceTest, OutcomesOfBuildings) {
  const ShellResult result = Shell(
      "python3 -c \"m = {}; "
      "exec(open('scripts/reproduce_buildings.py').read(), m); "
      "run = lambda apart, precision, accepted: m['outcome'](dict("
      "loops_apart=apart, precision=precision, accepted=accepted)); "
      "print(run(0.1, 0.2, 9), run(0.2, 1., 9), run(0.2, 0.9, 9), "
      "run(1., None, 0), run(None, None, 0), m['outcome']({'error': 'x'}))\"");
  EXPECT_EQ(result.exit_code, 0) << result.out;
  EXPECT_EQ(result.out, "right open folded open not judged failed\n");
}

TEST(ReproduceTest, ReliabilityOfBuildingsIsPooled) {
  const ShellResult result = Shell(
      "python3 -c \"m = {}; "
      "exec(open('scripts/reproduce_buildings.py').read(), m); "
      "none = [[0, 0., 0.]]; "
      "bins = m['pooled']([{'reliability': none * 9 + [[3, 0.96, 1.]]}, {}, "
      "{'reliability': none * 9 + [[1, 1., 0.]]}]); "
      "print(bins[0], bins[9][0], '%.2f %.2f' % bins[9][1:])\"");
  EXPECT_EQ(result.exit_code, 0) << result.out;
  EXPECT_EQ(result.out, "(0, None, None) 4 0.97 0.75\n");
}

// Each half of the seeds has every treatment; what is sound follows from the
// relations, but for floors over each other.
TEST(ReproduceTest, CasesOfVerdicts) {
  const ShellResult result = Shell(
      "python3 -c \"m = {}; "
      "exec(open('scripts/reproduce_verdicts.py').read(), m); "
      "runs = m['cases'](54); "
      "print([len({c[4] for c in runs if c[3] % 2 == i}) for i in (0, 1)], "
      "[len({c[i] for c in runs}) for i in (0, 1, 2)]); "
      "of = lambda loop, top, loops=1, t='ours', pair=0.1: m['truth'](dict("
      "treatment=t, loops=loops, loop_error=loop, max=top, pair_error=pair)); "
      "print(of(0.1, 0.4), of(0.3, 0.4), of(0.1, 0.6), of(None, 0.1, 0), "
      "of(0.1, 0.1, 1, 'floors'), of(0.1, 0.4, pair=0.3), "
      "of(0.3, 0.4, pair=0.3)); "
      "a = (1., 2., 0.5); "
      "print(all(abs(v) < 1e-9 for v in "
      "m['compose'](a, m['inverse'](a))))\"");
  EXPECT_EQ(result.exit_code, 0) << result.out;
  EXPECT_EQ(result.out,
            "[7, 7] [3, 6, 2]\n"
            "sound broken broken unknown broken bent broken\nTrue\n");
}

TEST(ReproduceTest, OutcomesOfRepairs) {
  const ShellResult result = Shell(
      "python3 -c \"m = {}; "
      "exec(open('scripts/reproduce_verdicts.py').read(), m); "
      "of = lambda before, after, top=0.4, written=True: m['outcome'](dict("
      "said=dict(written=written), "
      "before=dict(loop_error=before, truth='broken'), "
      "after=dict(loop_error=after, truth=m['truth'](dict(treatment='ours', "
      "loops=1, loop_error=after, max=top))))); "
      "print(of(3., 0.1), of(3., 1.), of(3., 3.01), of(3., 3.1), "
      "of(3., 3., written=False), of(0.1, 0.15, 0.6))\"");
  EXPECT_EQ(result.exit_code, 0) << result.out;
  EXPECT_EQ(result.out, "sound better alike worse unchanged worse\n");
}

// The second recording goes on in odometry where the first one ends.
TEST(ReproduceTest, RecordingsBehindEachOther) {
  const TemporaryFolder folder;
  for (const char* name : {"a", "b"}) {
    WriteFile(folder / (std::string(name) + ".clf"),
              "ODOM 0.0 0.0 0.0 0 0 0 10.0 nohost 10.0\n"
              "ODOM 2.0 0.0 0.0 0 0 0 20.0 nohost 20.0\n");
    WriteFile(folder / (std::string(name) + ".tum"),
              "10.0 5 5 0 0 0 0 1\n20.0 7 5 0 0 0 0 1\n");
    WriteFile(folder / (std::string(name) + ".relations"),
              "10.0 20.0 2 0 0 0 0 0\n");
  }
  const ShellResult result = Shell(
      "python3 -c \"import pathlib; m = {}; "
      "exec(open('scripts/reproduce_verdicts.py').read(), m); "
      "f = pathlib.Path('" +
      folder.path() + "'); m['joined'](f / 'a', f / 'b', f / 'c', False)\"");
  EXPECT_EQ(result.exit_code, 0) << result.out;
  EXPECT_THAT(ReadFile(folder / "c.clf"),
              HasSubstr("ODOM 4.000000 0.000000 0.000000 0 0 0 31.000000000"));
  EXPECT_THAT(ReadFile(folder / "c.relations"),
              HasSubstr("21.000000000 31.000000000 2 0"));
}

TEST(ReproduceTest, ClosingErrorsAndDistances) {
  const TemporaryFolder folder;
  // The estimate puts the second visit 0.3 m too far to the left of the first,
  // whose heading is 90 degrees in the map and 0 in the world.
  WriteFile(folder / "run.tum",
            "10.000 5 5 0 0 0 0.70710678 0.70710678\n"
            "20.000 4.7 6 0 0 0 0.70710678 0.70710678\n");
  WriteFile(folder / "places.csv",
            "place,visit,time,x,y,theta,distance\n"
            "p1,1,10.0,1,1,0,0\n"
            "p1,2,20.0,2,1,0,0\n"
            "p2,1,10.0,1,1,0,0\n");
  // a is 1 m ahead at the first scan, b 3 m ahead at the second.
  WriteFile(folder / "distances.csv",
            "name,length,ax,ay,bx,by,seen,time_a,a_robot_x,a_robot_y,time_b,"
            "b_robot_x,b_robot_y\n"
            "a,3,0,0,0,0,1,10.0,1,0,20.0,3,0\n"
            "b,9,0,0,0,0,0,10.0,1,0,20.0,3,0\n");
  WriteFile(folder / "check.py",
            "import importlib.machinery, math, sys\n"
            "sys.dont_write_bytecode = True\n"
            "r = importlib.machinery.SourceFileLoader('r', "
            "'scripts/reproduce').load_module()\n"
            "folder = sys.argv[1]\n"
            "t = r.Trajectory(folder + '/run.tum')\n"
            "errors = r.closing_errors(folder + '/places.csv', t)\n"
            "assert list(errors) == ['p1'], errors\n"
            "assert abs(errors['p1'] - 0.3) < 1e-6, errors\n"
            "d = r.measured_distances(folder + '/distances.csv', t)\n"
            "assert list(d) == ['a'], d\n"
            "assert abs(d['a'][1] - math.hypot(0.3, 3)) < 1e-6, d\n"
            "assert r.median([3, None, 1]) == 2 and r.median([]) is None\n"
            "assert r.change(2., 1.) == '-50.0 %'\n"
            "assert r.table(['a', 'b'], [[1, 2]]) == "
            "'| a | b |\\n|---|---|\\n| 1 | 2 |\\n'\n");
  const ShellResult result =
      Shell("python3 " + folder / "check.py" + " " + folder.path());
  EXPECT_EQ(result.exit_code, 0) << result.out;
}

TEST(ReproduceTest, TablesOfSearchesAndMaps) {
  const TemporaryFolder folder;
  WriteFile(
      folder / "check.py",
      "import importlib.machinery, json, pathlib, sys, types\n"
      "sys.dont_write_bytecode = True\n"
      "r = importlib.machinery.SourceFileLoader('r', "
      "'scripts/reproduce').load_module()\n"
      "folder = pathlib.Path(sys.argv[1])\n"
      "key = 'A.window_gamma'\n"
      "def line(gamma, seed, status, precision):\n"
      "    return json.dumps({'values': {key: gamma}, 'status': status,\n"
      "        'input': 'ri_corridor.world#%d@5936' % seed,\n"
      "        'metrics': {'loop_precision': precision, 'relations': 1.}})\n"
      "(folder / 'journal.jsonl').write_text('{}\\n' + '\\n'.join([\n"
      "    line(0.3, 1, 'ok', 0.9), line(0.3, 2, 'ok', 0.7),\n"
      "    line(0.3, 3, 'ok', 0.1), line(0.1, 1, 'ok', 0.5),\n"
      "    line(0.1, 2, 'failed', 0.)]) + '\\n')\n"
      "commands = types.SimpleNamespace(out=folder, run=lambda *a: '')\n"
      "options = types.SimpleNamespace(jobs=1, seeds=2)\n"
      "title, note, table = r.EXPERIMENTS['c_gamma'](commands, options)\n"
      "rows = table.splitlines()\n"
      // The third seed is not asked for, the failed run has no figures.
      "assert rows[2].startswith('| 0.1 |  | 0.500 | - |'), rows\n"
      "assert '| 0.800 (0.700-0.900) | - | - | 1.000' in rows[3], rows\n"
      "assert 'chosen' in rows[3] and len(rows) == 4, rows\n"
      "options = types.SimpleNamespace(data=str(folder / 'none'))\n"
      "try:\n"
      "    r.EXPERIMENTS['stored_maps'](commands, options)\n"
      "    assert False\n"
      "except r.Failed as error:\n"
      "    assert 'no map in' in str(error)\n");
  const ShellResult result =
      Shell("python3 " + folder / "check.py" + " " + folder.path());
  EXPECT_EQ(result.exit_code, 0) << result.out;
}

}  // namespace
}  // namespace test
}  // namespace cartographer_ext
