"use strict";
// Walls of a path: decoding and triangulation. page/scene.rs describes the encoding.

/** Decodes base64 and decompresses zlib data. */
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
    this.meridians = this.around * scene.sectors;
    this.stride = 2 * this.count * (3 + scene.fields.length);
  }

  /** Decodes one array of a state (a coordinate or a field) with values from `low` to `high`. */
  numbers(state, which, low, high, steps) {
    const start = state * this.stride + 2 * which * this.count;
    const out = new Float32Array(this.count);
    for (let p = 0, step = 0; p < this.count; p++) {
      step = (step + this.bytes[start + p] + 256 * this.bytes[start + this.count + p]) & 0xffff;
      out[p] = low + ((high - low) * step) / steps;
    }
    return out;
  }

  /** Returns the coordinates of the stored points of a state, one array each. */
  coordinates(state) {
    const { low, high } = this.scene;
    return [0, 1, 2].map((i) => this.numbers(state, i, low[i], high[i], this.steps));
  }

  /** Returns a field at the stored points of a state; NaN for missing values. */
  values(state, field) {
    const [low, high] = this.scene.fields[field].ends[state];
    const values = this.numbers(state, 3 + field, low, high, this.valueSteps);
    // Values beyond the last step by more than rounding are missing.
    const beyond = high + (high - low) / this.valueSteps;
    return values.map((value) => (high > low && value > beyond ? NaN : value));
  }
}

/** A structured grid of vertices at an offset in the arrays of a geometry. */
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
  /** Appends the triangles between a row and the next. */
  strip(row, out) {
    for (let c = 0; c + 1 < this.columns; c++) {
      const [a, b, d, e] = [this.at(c, row), this.at(c + 1, row), this.at(c, row + 1), this.at(c + 1, row + 1)];
      out.push(a, b, d, b, e, d);
    }
  }
  /** Computes normals as cross products of differences along rows and columns. */
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

/** The obstacles of a state. */
class Obstacles {
  constructor(scene) {
    this.states = scene.obstacles ?? [];
    this.middle = 0.5 * (scene.low[0] + scene.high[0]);
    this.group = new THREE.Group();
    const material = { color: 0x969696, side: THREE.DoubleSide };
    this.solid = new THREE.MeshLambertMaterial(material);
    this.ghost = new THREE.MeshLambertMaterial({ ...material, transparent: true, opacity: 0.14, depthWrite: false });
  }

  /** Shows those of a state. */
  show(state) {
    this.group.children.forEach((mesh) => mesh.geometry.dispose());
    this.group.clear();
    for (const body of this.states[state] ?? []) {
      const mesh = new THREE.Mesh(this.surface(body), body.translucent ? this.ghost : this.solid);
      mesh.frustumCulled = false;
      this.group.add(mesh);
    }
  }

  /** Returns the surface of a body: its profile turned about its axis, or its four corners. */
  surface({ profile, axis, corners }) {
    const around = 64;
    const grid = corners ? new Grid(0, 2, 2, false) : new Grid(0, profile.length, around + 1, true);
    const point = (c, r) => {
      if (corners) return corners[2 * r + c];
      const [z, radius] = profile[c];
      const angle = (2 * Math.PI * r) / around;
      return [z, axis[0] + radius * Math.cos(angle), axis[1] + radius * Math.sin(angle)];
    };
    const made = geometry(grid.vertices);
    const triangles = [];
    for (let r = 0; r < grid.rows; r++) {
      for (let c = 0; c < grid.columns; c++) {
        const [z, x, y] = point(c, r);
        made.attributes.position.array.set([z - this.middle, x, y], 3 * grid.at(c, r));
      }
      if (r > 0) grid.strip(r - 1, triangles);
    }
    made.setIndex(triangles);
    refresh(made, [grid]);
    return made;
  }
}

/** A tube as two meshes: the faces and ends, and the two cut faces. */
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
    this.cuts = geometry(2 * along * through);
    const across = [];
    this.sides.forEach((grid) => {
      for (let k = 0; k + 1 < through; k++) grid.strip(k, across);
    });
    this.cuts.setIndex(across);

    const material = { map: colours, side: THREE.DoubleSide };
    this.solid = new THREE.MeshLambertMaterial(material);
    this.ghost = new THREE.MeshLambertMaterial({ ...material, transparent: true, opacity: 0.16, depthWrite: false });
    this.group = new THREE.Group();
    this.cutMesh = new THREE.Mesh(this.cuts, this.solid);
    this.group.add(new THREE.Mesh(this.shell, [this.solid, this.ghost]), this.cutMesh);
    this.group.children.forEach((mesh) => (mesh.frustumCulled = false));
    this.obstacles = new Obstacles(walls.scene);
    this.group.add(this.obstacles.group);
  }

  /** Shows a state coloured by a field from `low` to `high`, with `degrees` of the wall removed. */
  show(state, field, [low, high], degrees, ghost) {
    const { walls } = this;
    this.obstacles.show(state);
    const { along, through, around, meridians } = walls;
    const [z, x, y] = walls.coordinates(state);
    const values = walls.values(state, field);
    const middle = 0.5 * (walls.scene.low[0] + walls.scene.high[0]);
    const { diverging } = walls.scene.fields[field];
    const colour = (value) => (0.5 + 255 * Math.min(Math.max((value - low) / (high - low), 0), 1)) / 256;
    const rotations = Array.from({ length: walls.scene.sectors }, (_, sector) => {
      const angle = (2 * Math.PI * sector) / walls.scene.sectors;
      return [Math.cos(angle), Math.sin(angle)];
    });
    // Sets a vertex to a stored point rotated into its sector.
    const put = (geometry, vertex, meridian, point) => {
      const [cos, sin] = rotations[Math.floor(meridian / around) % rotations.length];
      const position = geometry.attributes.position.array;
      position[3 * vertex] = z[point] - middle;
      position[3 * vertex + 1] = x[point] * cos - y[point] * sin;
      position[3 * vertex + 2] = x[point] * sin + y[point] * cos;
      const uv = geometry.attributes.uv.array;
      const value = values[point];
      // Rows of the texture: sequential map, colour of missing values, diverging map.
      [uv[2 * vertex], uv[2 * vertex + 1]] = Number.isNaN(value) ? [0, 0.5] : [colour(value), diverging ? 5 / 6 : 1 / 6];
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
    this.cutMesh.visible = first > 0;
    [first, meridians].forEach((meridian, side) => {
      for (let k = 0; k < through; k++) {
        for (let i = 0; i < along; i++) {
          put(this.cuts, this.sides[side].at(i, k), meridian, point(meridian, k, i));
        }
      }
    });
    refresh(this.cuts, this.sides);
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
