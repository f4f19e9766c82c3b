// Tests the wheel in Pyodide, which Node runs: `node pyodide.mjs PYODIDE WHEEL CPLAN`. PYODIDE is the folder of the npm package,
// CPLAN the program, whose results must be the same. Prints a line per test; exits with 1 if one fails.

import { spawnSync } from 'node:child_process';
import { readFileSync } from 'node:fs';
import { basename, resolve } from 'node:path';
import { performance } from 'node:perf_hooks';

const [pyodideFolder, wheel, program] = process.argv.slice(2).map((path) => resolve(path));
const root = resolve(import.meta.dirname, '../..');
const { loadPyodide } = await import(`${pyodideFolder}/pyodide.mjs`);

const begun = performance.now();
const pyodide = await loadPyodide();
const packages = pyodide.runPython('import site; site.getsitepackages()[0]');
pyodide.unpackArchive(new Uint8Array(readFileSync(wheel)), 'wheel', { extractDir: packages });
pyodide.FS.mkdirTree('/work');
for (const file of ['robots/planar_2r.urdf', 'workspaces/shelf.toml', 'workspaces/no_path.toml']) {
  pyodide.FS.writeFile(`/work/${basename(file)}`, readFileSync(resolve(root, file)));
}
await pyodide.runPythonAsync(`
import importlib
import os
importlib.invalidate_caches()
os.chdir("/work")
import cplan
arm, world = cplan.Arm.from_urdf("planar_2r.urdf"), cplan.World.from_toml("shelf.toml")
plan = cplan.plan(arm, world)
`);
console.log(`first plan after ${((performance.now() - begun) / 1000).toFixed(1)} s, Pyodide's own start included`);

const printed = (...words) => spawnSync(program, words, { cwd: root, encoding: 'utf8' }).stdout;
const files = ['robots/planar_2r.urdf', 'workspaces/shelf.toml'];

/** Returns true if two values of JSON are equal, numbers to nine digits: sines differ in their last digit between platforms. */
function same(a, b) {
  if (typeof a === 'number' && typeof b === 'number') return Math.abs(a - b) <= 1e-9 * Math.max(1, Math.abs(a));
  if (a === null || b === null || typeof a !== 'object' || typeof b !== 'object') return a === b;
  const keys = Object.keys(a);
  return keys.length === Object.keys(b).length && keys.every((key) => same(a[key], b[key]));
}

const tests = {
  'a plan is that of the program': () =>
    same(JSON.parse(pyodide.runPython('plan.to_json()')), JSON.parse(printed(...files, '--json'))),
  'a picture and a page are drawn': () =>
    pyodide.runPython('plan.svg().startswith("<svg") and "<html" in plan.html() and plan._repr_html_().startswith("<iframe")'),
  'files are written': () =>
    pyodide.runPython(`
names = ["plan.json", "plan.csv", "plan.yaml", "plan.mcap", "plan.svg", "plan.png", "plan.gif", "plan.html", "cspace.json"]
for name in names:
    plan.save(name)
open("plan.svg").read() == plan.svg() and all(os.path.getsize(name) > 100 for name in names)`),
  'an explanation is that of the program': () => {
    const own = pyodide.runPython('cplan.explain(arm, cplan.World.from_toml("no_path.toml"), time=600.0).to_json()');
    const words = ['explain', 'robots/planar_2r.urdf', 'workspaces/no_path.toml', '--time=600', '--json'];
    return same(JSON.parse(own), JSON.parse(printed(...words)));
  },
  'planners are compared': () =>
    pyodide.runPython(`
compared = cplan.compare(arm, world, planners=["shortest", "wavefront"], cells=64)
[run.outcome for run in compared.planners] == ["found", "found"]`),
  'a plan is verified': () => pyodide.runPython('cplan.verify(arm, world, plan).free'),
  'input errors have their line': () =>
    pyodide.runPython(`
try:
    cplan.plan(arm, cplan.World.from_text("[start]\\njoints = [0.0, 0.0]\\nsize = 3\\n", "mine.toml"))
    line = None
except cplan.InputError as error:
    line = error.diagnostics[0]["line"]
line == 3`),
  'an exception of progress ends a plan': () =>
    pyodide.runPython(`
def refuse(line):
    raise KeyboardInterrupt
try:
    cplan.plan(arm, world, planner="visibility", gap=1e-9, levels=6, progress=refuse)
    ended = False
except KeyboardInterrupt:
    ended = True
ended and "found" in plan.summary()`),
  'the program runs': () => pyodide.runPython('from cplan._cplan import run; run(["cplan", "planar_2r.urdf", "shelf.toml", "--quiet"]) == 0'),
};

let failed = 0;
for (const [name, test] of Object.entries(tests)) {
  const passes = test();
  console.log(`${passes ? 'passed' : 'FAILED'}: ${name}`);
  failed += !passes;
}

// Arrays need numpy, which Pyodide fetches from its own server.
await pyodide.loadPackage('numpy', { messageCallback: () => {}, errorCallback: () => {} }).catch(() => {});
if (pyodide.runPython('from importlib.util import find_spec; find_spec("numpy") is not None')) {
  const passes = pyodide.runPython(`
import numpy as np
path = plan.path
grade = cplan.grade(cplan.grading.Path(arm, world), path)
(isinstance(path, np.ndarray) and path.shape[1] == 2 and np.array_equal(path[-1], plan.trajectory.position[-1])
    and grade.right and grade.svg().startswith("<svg"))`);
  console.log(`${passes ? 'passed' : 'FAILED'}: paths are arrays, and are graded`);
  failed += !passes;
} else {
  console.log('numpy for Pyodide cannot be fetched: arrays and grades are not tested there');
}
process.exit(failed === 0 ? 0 : 1);
