"use strict";
// The walls of a path: unpacked, and made into triangles. How they are packed is told in page/scene.rs.

/** The bytes of zlib in base64. */
async function unpacked(base64) {
  const packed = Uint8Array.from(atob(base64), (letter) => letter.charCodeAt(0));
  const stream = new Blob([packed]).stream().pipeThrough(new DecompressionStream("deflate"));
  return new Uint8Array(await new Response(stream).arrayBuffer());
}

/** The walls of all drawn states of a run. */
class Walls {
  constructor(scene, bytes, [steps, valueSteps]) {
    Object.assign(this, { steps, valueSteps });
    [this.along, this.through, this.around] = scene.points;
    this.scene = scene;
    this.bytes = bytes;
    this.count = this.along * this.through * this.around;
    this.meridians = this.around * scene.turns;
    this.stride = 2 * this.count * (3 + scene.fields.length);
  }

  /** The numbers of the stored points that come so many-th in a state, between two ends. */
  numbers(state, which, low, high, steps) {
    const start = state * this.stride + 2 * which * this.count;
    const out = new Float32Array(this.count);
    for (let p = 0, step = 0; p < this.count; p++) {
      step = (step + this.bytes[start + p] + 256 * this.bytes[start + this.count + p]) & 0xffff;
      out[p] = low + ((high - low) * step) / steps;
    }
    return out;
  }

  /** Coordinates of the stored points of a state, one array each. */
  coordinates(state) {
    const { low, high } = this.scene;
    return [0, 1, 2].map((i) => this.numbers(state, i, low[i], high[i], this.steps));
  }

  /** A field at the stored points of a state; not a number where it has no value. */
  values(state, field) {
    const [low, high] = this.scene.fields[field].ends[state];
    const values = this.numbers(state, 3 + field, low, high, this.valueSteps);
    // Beyond the last step, and by more than rounding, is what has no value.
    const beyond = high + (high - low) / this.valueSteps;
    return values.map((value) => (high > low && value > beyond ? NaN : value));
  }
}

/** A rectangle of vertices: rows across columns, at an offset in the arrays of a geometry. */
class Grid {
  constructor(offset, columns, rows, closed) {
    Object.assign(this, { offset, columns, rows, closed });
  }
  get vertices() {
    return this.columns * this.rows;
  }
  at(column, row) {
    return this.offset + row * this.columns + column;
  }
  /** The triangles between a row and the next. */
  strip(row, out) {
    for (let c = 0; c + 1 < this.columns; c++) {
      const [a, b, d, e] = [this.at(c, row), this.at(c + 1, row), this.at(c, row + 1), this.at(c + 1, row + 1)];
      out.push(a, b, d, b, e, d);
    }
  }
  /** Normals from the differences between neighbours: along a row, times along a column. */
  normals(position, normal) {
    const last = this.rows - 1;
    for (let r = 0; r < this.rows; r++) {
      const above = r === 0 ? (this.closed ? last - 1 : 0) : r - 1;
      const below = r === last ? (this.closed ? 1 : last) : r + 1;
      for (let c = 0; c < this.columns; c++) {
        const [a, b] = [3 * this.at(Math.max(c - 1, 0), r), 3 * this.at(Math.min(c + 1, this.columns - 1), r)];
        const [d, e] = [3 * this.at(c, above), 3 * this.at(c, below)];
        const [ux, uy, uz] = [0, 1, 2].map((i) => position[b + i] - position[a + i]);
        const [vx, vy, vz] = [0, 1, 2].map((i) => position[e + i] - position[d + i]);
        const [x, y, z] = [uy * vz - uz * vy, uz * vx - ux * vz, ux * vy - uy * vx];
        const n = 3 * this.at(c, r);
        const length = Math.hypot(x, y, z) || 1;
        [normal[n], normal[n + 1], normal[n + 2]] = [x / length, y / length, z / length];
      }
    }
  }
}

/** A tube as two meshes: its faces and ends, and the two sections where it is cut open. */
class Tube {
  constructor(walls, colours) {
    this.walls = walls;
    const { along, through, meridians } = walls;
    this.outer = new Grid(0, along, meridians + 1, true);
    this.inner = new Grid(this.outer.vertices, along, meridians + 1, true);
    const ends = 2 * this.outer.vertices;
    this.ends = [0, 1].map((k) => new Grid(ends + k * through * (meridians + 1), through, meridians + 1, true));
    const shell = [this.outer, this.inner, ...this.ends];
    this.shell = geometry(ends + 2 * this.ends[0].vertices);
    const triangles = [];
    for (let j = 0; j < meridians; j++) {
      shell.forEach((grid) => grid.strip(j, triangles));
    }
    this.perMeridian = triangles.length / meridians;
    this.shell.setIndex(triangles);
    this.grids = shell;

    this.sides = [0, 1].map((k) => new Grid(k * along * through, along, through, false));
    this.section = geometry(2 * along * through);
    const across = [];
    this.sides.forEach((grid) => {
      for (let k = 0; k + 1 < through; k++) grid.strip(k, across);
    });
    this.section.setIndex(across);

    const look = { map: colours, side: THREE.DoubleSide };
    this.solid = new THREE.MeshLambertMaterial(look);
    this.ghost = new THREE.MeshLambertMaterial({ ...look, transparent: true, opacity: 0.16, depthWrite: false });
    this.group = new THREE.Group();
    this.sectionMesh = new THREE.Mesh(this.section, this.solid);
    this.group.add(new THREE.Mesh(this.shell, [this.solid, this.ghost]), this.sectionMesh);
    this.group.children.forEach((mesh) => (mesh.frustumCulled = false));
  }

  /** Shows a state, coloured by a field between two values, with degrees of the wall taken away. */
  show(state, field, [low, high], degrees, ghost) {
    const { walls } = this;
    const { along, through, around, meridians } = walls;
    const [z, x, y] = walls.coordinates(state);
    const values = walls.values(state, field);
    const middle = 0.5 * (walls.scene.low[0] + walls.scene.high[0]);
    const { signed } = walls.scene.fields[field];
    const colour = (value) => (0.5 + 255 * Math.min(Math.max((value - low) / (high - low), 0), 1)) / 256;
    const turns = Array.from({ length: walls.scene.turns }, (_, t) => {
      const angle = (2 * Math.PI * t) / walls.scene.turns;
      return [Math.cos(angle), Math.sin(angle)];
    });
    // A vertex from a stored point, turned.
    const put = (geometry, vertex, meridian, point) => {
      const [cos, sin] = turns[Math.floor(meridian / around) % turns.length];
      const position = geometry.attributes.position.array;
      position[3 * vertex] = z[point] - middle;
      position[3 * vertex + 1] = x[point] * cos - y[point] * sin;
      position[3 * vertex + 2] = x[point] * sin + y[point] * cos;
      const uv = geometry.attributes.uv.array;
      const value = values[point];
      // The texture's second row is the colour of what has no value, the third are those of two signs.
      [uv[2 * vertex], uv[2 * vertex + 1]] = Number.isNaN(value) ? [0, 0.5] : [colour(value), signed ? 5 / 6 : 1 / 6];
    };
    const point = (meridian, level, i) => ((meridian % around) * through + level) * along + i;
    for (let j = 0; j <= meridians; j++) {
      for (let i = 0; i < along; i++) {
        put(this.shell, this.outer.at(i, j), j, point(j, through - 1, i));
        put(this.shell, this.inner.at(i, j), j, point(j, 0, i));
      }
      for (let k = 0; k < through; k++) {
        put(this.shell, this.ends[0].at(k, j), j, point(j, k, 0));
        put(this.shell, this.ends[1].at(k, j), j, point(j, k, along - 1));
      }
    }
    refresh(this.shell, this.grids);

    const first = Math.round((degrees / 360) * meridians);
    this.shell.clearGroups();
    this.shell.addGroup(first * this.perMeridian, (meridians - first) * this.perMeridian, 0);
    this.shell.addGroup(0, first * this.perMeridian, 1);
    this.ghost.visible = ghost;
    this.sectionMesh.visible = first > 0;
    [first, meridians].forEach((meridian, side) => {
      for (let k = 0; k < through; k++) {
        for (let i = 0; i < along; i++) {
          put(this.section, this.sides[side].at(i, k), meridian, point(meridian, k, i));
        }
      }
    });
    refresh(this.section, this.sides);
  }
}

function geometry(vertices) {
  const made = new THREE.BufferGeometry();
  for (const [name, size] of [["position", 3], ["normal", 3], ["uv", 2]]) {
    made.setAttribute(name, new THREE.BufferAttribute(new Float32Array(size * vertices), size));
  }
  return made;
}

function refresh(geometry, grids) {
  const { position, normal, uv } = geometry.attributes;
  grids.forEach((grid) => grid.normals(position.array, normal.array));
  [position, normal, uv].forEach((attribute) => (attribute.needsUpdate = true));
}
