"use strict";
// Canvas with the tubes: light, camera, and control by mouse, touch and keyboard.

/** Named directions towards the viewer: (along the tube, up, to the front). */
const DIRECTIONS = {
  oblique: [-0.35, 0.42, 1],
  front: [0, 0, 1],
  colon: [-1, 0.3, 0.5],
  ileum: [1, 0.3, 0.5],
};
/** Height of the lane of a tube, in diameters at rest. */
const LANE = 1.45;

class View {
  constructor(stage, canvas, runs, colours) {
    this.stage = stage;
    this.canvas = canvas;
    this.renderer = new THREE.WebGLRenderer({ canvas, antialias: true, alpha: true, preserveDrawingBuffer: true });
    this.renderer.setPixelRatio(Math.min(window.devicePixelRatio || 1, 2));
    this.scene = new THREE.Scene();
    this.camera = new THREE.PerspectiveCamera(24, 1, 0.05, 500);
    const sun = new THREE.DirectionalLight(0xffffff, 1.7);
    sun.position.set(-0.4, 0.9, 1);
    // The light moves with the viewer and comes from above one shoulder.
    this.camera.add(sun, sun.target);
    sun.target.position.set(0, 0, -1);
    this.scene.add(new THREE.AmbientLight(0xffffff, 1.45), this.camera);

    const [sequential, diverging] = colours;
    // Tube.show describes the rows of the texture.
    const rows = [...sequential, ...sequential.map(() => [150, 150, 150]), ...diverging];
    const flat = new Uint8Array(rows.flatMap(([r, g, b]) => [r, g, b, 255]));
    const map = new THREE.DataTexture(flat, sequential.length, 3, THREE.RGBAFormat);
    map.colorSpace = THREE.SRGBColorSpace;
    [map.minFilter, map.magFilter] = [THREE.LinearFilter, THREE.LinearFilter];
    map.needsUpdate = true;
    this.lane = Math.max(...runs.map(({ scene }) => Math.max(LANE * scene.diameter, 2.25 * scene.radius)));
    this.tubes = runs.map((run, i) => {
      const tube = new Tube(run.walls, map);
      tube.group.position.y = this.lane * ((runs.length - 1) / 2 - i);
      this.scene.add(tube.group);
      return tube;
    });
    this.length = Math.max(...runs.map(({ scene }) => scene.high[0] - scene.low[0]));
    this.labels = runs.flatMap(({ name, ends, scene }, i) => {
      const half = 0.5 * (scene.high[0] - scene.low[0]) + 0.22 * scene.diameter;
      const y = this.tubes[i].group.position.y;
      const labels = [this.label(ends[0], "end", -half, y), this.label(ends[1], "end", half, y)];
      return runs.length > 1 ? [...labels, this.label(name, "end name", -0.5 * (scene.high[0] - scene.low[0]), y + 0.5 * this.lane)] : labels;
    });
    this.controls = new THREE.OrbitControls(this.camera, canvas);
    this.controls.enablePan = true;
    this.controls.addEventListener("change", () => this.draw());
    this.controls.addEventListener("start", () => this.onRotate?.());
    canvas.addEventListener("keydown", (event) => this.key(event));
    new ResizeObserver(() => this.resize()).observe(stage);
    this.resize();
    this.look("oblique");
  }

  /** Adds a text at a fixed position of the scene. */
  label(text, style, x, y) {
    const label = document.createElement("span");
    label.className = style;
    label.textContent = text;
    this.stage.append(label);
    return { label, place: new THREE.Vector3(x, y, 0) };
  }

  /** Shows all tubes from a named direction. */
  look(name) {
    const height = this.lane * this.tubes.length;
    const tangent = Math.tan((this.camera.fov * Math.PI) / 360);
    const wide = this.length * 1.16;
    const distance = Math.max((0.5 * wide) / (tangent * this.camera.aspect), (0.55 * height) / tangent) + 0.5 * this.lane;
    const direction = new THREE.Vector3(...DIRECTIONS[name]).normalize();
    this.camera.position.copy(direction.multiplyScalar(distance));
    this.controls.target.set(0, 0, 0);
    this.controls.update();
    this.draw();
  }

  key(event) {
    const { camera } = this;
    const angle = 0.12;
    const place = camera.position.clone().sub(this.controls.target);
    const axis = { ArrowLeft: [0, 1], ArrowRight: [0, -1], ArrowUp: [1, 0], ArrowDown: [-1, 0] }[event.key];
    if (axis) {
      const [over, about] = axis;
      const radius = place.length();
      const polar = Math.min(Math.max(Math.acos(place.y / radius) - angle * over, 0.02), Math.PI - 0.02);
      const azimuth = Math.atan2(place.x, place.z) - angle * about;
      place.set(Math.sin(polar) * Math.sin(azimuth), Math.cos(polar), Math.sin(polar) * Math.cos(azimuth)).multiplyScalar(radius);
    } else if (event.key === "+" || event.key === "=") {
      place.multiplyScalar(1 / 1.15);
    } else if (event.key === "-") {
      place.multiplyScalar(1.15);
    } else if (event.key === "0") {
      this.look("oblique");
      event.preventDefault();
      return;
    } else {
      return;
    }
    event.preventDefault();
    this.onRotate?.();
    camera.position.copy(place.add(this.controls.target));
    this.controls.update();
    this.draw();
  }

  resize() {
    const { clientWidth: width, clientHeight: height } = this.stage;
    if (width === 0 || height === 0) return;
    this.renderer.setSize(width, height, false);
    this.camera.aspect = width / height;
    this.camera.updateProjectionMatrix();
    this.draw();
  }

  /** Requests one redraw with the next frame. */
  draw() {
    if (this.waiting) return;
    this.waiting = true;
    requestAnimationFrame(() => this.now());
  }

  now() {
    this.waiting = false;
    this.renderer.render(this.scene, this.camera);
    const { clientWidth: width, clientHeight: height } = this.stage;
    for (const { label, place } of this.labels) {
      const { x, y } = place.clone().project(this.camera);
      label.style.left = `${(0.5 + 0.5 * x) * width}px`;
      label.style.top = `${(0.5 - 0.5 * y) * height}px`;
    }
  }
}
