// Two kinds of movers: (numbers of a frame) => an object of three.js is where they say.
//
// A row of a frame has 12 numbers, the columns x, y, z and position of a matrix [R | p].

/**
 * Move an object as a whole, by a row.
 * @param {Object3D} object
 * @param {number} row
 * @returns {Mover}
 */
export function whole(object, row) {
  return (numbers) => {
    const [ax, ay, az, bx, by, bz, cx, cy, cz, px, py, pz] = matrix(numbers, row);
    object.matrix.set(ax, bx, cx, px, ay, by, cy, py, az, bz, cz, pz, 0, 0, 0, 1);
    object.matrixWorldNeedsUpdate = true;
  };
}

/**
 * Move the points of a mesh in runs, each by a row.
 * @param {Mesh} object
 * @param {[row: number, points: number][]} runs
 * @returns {Mover}
 */
export function parts(object, runs) {
  const { position, normal } = object.geometry.attributes;
  for (const one of [position, normal]) if (one) one.rest = one.rest ?? one.array.slice();
  return (numbers) => {
    let from = 0;
    for (const [row, points] of runs) {
      const moved = matrix(numbers, row);
      const to = from + 3 * points;
      carry(position, moved, from, to);
      if (normal) carry(normal, upright(moved), from, to);
      from = to;
    }
    position.needsUpdate = true;
    if (normal) normal.needsUpdate = true;
    object.visible = true;
  };
}

/**
 * @param {Float32Array} numbers
 * @param {number} row
 */
function matrix(numbers, row) {
  return numbers.subarray(12 * row, 12 * row + 12);
}

/**
 * Write R x + p of each point x at rest, from one number to another.
 * @param {BufferAttribute} attribute
 * @param {Float32Array} matrix
 * @param {number} from
 * @param {number} to
 */
function carry({ rest, array }, [ax, ay, az, bx, by, bz, cx, cy, cz, px, py, pz], from, to) {
  for (let i = from; i < to; i += 3) {
    const x = rest[i];
    const y = rest[i + 1];
    const z = rest[i + 2];
    array[i] = ax * x + bx * y + cx * z + px;
    array[i + 1] = ay * x + by * y + cy * z + py;
    array[i + 2] = az * x + bz * y + cz * z + pz;
  }
}

/**
 * How normals turn where R stretches along its columns: R (RᵀR)⁻¹.
 * @param {Float32Array} matrix
 */
export function upright(matrix) {
  const turned = new Float32Array(12);
  for (let i = 0; i < 9; i += 3) {
    const [x, y, z] = matrix.subarray(i, i + 3);
    const square = x * x + y * y + z * z;
    turned.set([x / square, y / square, z / square], i);
  }
  return turned;
}
