// Runs the tests of what computes in Pyodide: another LAPACK, integers of 32 bits, no threads.
//
//   node tests/tools/core.mjs FOLDER [arguments for pytest]
//
// FOLDER is Pyodide's full distribution, unpacked. pytest and hypothesis are fetched from PyPI.

import { dirname, resolve } from "node:path";
import { fileURLToPath, pathToFileURL } from "node:url";

const CORE = ["body", "solvers", "motion", "study"];

const [folder, ...given] = process.argv.slice(2);
if (!folder) {
  console.error("usage: node tests/tools/core.mjs FOLDER [arguments for pytest]");
  process.exit(2);
}
const { loadPyodide } = await import(pathToFileURL(resolve(folder, "pyodide.mjs")));
const pyodide = await loadPyodide({ indexURL: resolve(folder) + "/" });
await pyodide.loadPackage(["micropip", "numpy", "pandas", "scipy", "pygments"]);
await pyodide.pyimport("micropip").install(["pytest", "hypothesis"]);

const root = resolve(dirname(fileURLToPath(import.meta.url)), "../..");
pyodide.FS.mkdirTree("/ikteach");
pyodide.FS.mount(pyodide.FS.filesystems.NODEFS, { root }, "/ikteach");
pyodide.globals.set("given", given.length ? given : CORE.map((one) => `tests/${one}`));
process.exitCode = pyodide.runPython(`
import os, sys

sys.dont_write_bytecode = True
sys.path.insert(0, "/ikteach")
os.chdir("/ikteach")

import pytest

ours = ["--override-ini=addopts=-q", "--capture=sys", "-p", "no:cacheprovider"]
int(pytest.main([*ours, *given]))
`);
