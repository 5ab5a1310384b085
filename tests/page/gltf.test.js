// What we write as glTF, as three's loader has it.

import assert from "node:assert/strict";
import { execFileSync } from "node:child_process";
import { mkdtempSync, readFileSync, rmSync } from "node:fs";
import { tmpdir } from "node:os";
import { join } from "node:path";
import { after, before, test } from "node:test";
import { fileURLToPath } from "node:url";
import { AnimationMixer, LoopOnce, Vector3 } from "three";
import { GLTFLoader } from "three/addons/loaders/GLTFLoader.js";

const ROOT = fileURLToPath(new URL("../..", import.meta.url));
const PYTHON = process.env.PYTHON ?? join(ROOT, ".venv", "bin", "python");
const NEAR = 1e-6; // m: numbers in the file have four bytes
let folder;

before(() => {
  folder = mkdtempSync(join(tmpdir(), "glb-"));
  execFileSync(PYTHON, [join(ROOT, "tests", "tools", "glb.py"), folder]);
});
after(() => rmSync(folder, { recursive: true }));

for (const name of ["human", "skew"]) {
  test(`rows and effectors of ${name} are where they were`, async () => {
    const facts = JSON.parse(readFileSync(join(folder, `${name}.json`), "utf8"));
    const file = readFileSync(join(folder, `${name}.glb`));
    const gltf = await new GLTFLoader().parseAsync(new Uint8Array(file).buffer, "");
    const nodes = await gltf.parser.getDependencies("node");
    const mixer = new AnimationMixer(gltf.scene);
    const action = mixer.clipAction(gltf.animations[0]).setLoop(LoopOnce);
    action.clampWhenFinished = true; // or the last frame would be the first
    action.play();
    const n = facts.rows.length;
    const names = [...facts.rows, "ground", ...facts.effectors];
    assert.deepEqual(
      gltf.parser.json.nodes.slice(0, names.length).map((node) => node.name),
      names,
    );
    for (let t = 0; t < facts.positions.length; t += 7) {
      mixer.setTime(t * facts.dt);
      gltf.scene.updateMatrixWorld(true);
      facts.positions[t].forEach((place, j) => {
        assertNear(nodes[j], [0, 0, 0], place);
        const [x, y, z] = facts.orientations[t][j].map((row) => row[1]);
        assertNear(nodes[j], [0, 1, 0], [place[0] + x, place[1] + y, place[2] + z]);
      });
      facts.ends[t].forEach((place, i) => {
        assertNear(nodes[n + 1 + i], [0, 0, 0], place);
      });
    }
  });
}

/** Check where a point of a node is in the world. */
function assertNear(node, point, place) {
  const gap = node.localToWorld(new Vector3(...point)).distanceTo(new Vector3(...place));
  assert.ok(gap < NEAR, `${node.name} is ${gap} m away`);
}
