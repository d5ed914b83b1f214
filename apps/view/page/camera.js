// The eye: it looks at a target from an azimuth and an elevation about the upward axis, in
// perspective or parallel. Mouse, fingers and keys turn it, shift it and bring it nearer.

const kFieldOfView = 28 * Math.PI / 180;
const kSteep = 0.5 * Math.PI - 1e-6;

class Eye {
  constructor(up, length) {
    this.up = up;
    this.east = acrossFrom(up);
    // East and north are axes of the world wherever up is one.
    if (Math.abs(up[2]) > 0.99) this.east = [1, 0, 0];
    else if (Math.abs(up[1]) > 0.99) this.east = [0, 0, 1];
    else if (Math.abs(up[0]) > 0.99) this.east = [0, 1, 0];
    this.north = unit(cross(up, this.east));
    this.east = cross(this.north, up);
    this.target = [0, 0, 0];
    this.length = length;
    this.distance = 3 * length;
    this.azimuth = -1.05;
    this.elevation = 0.38;
    this.parallel = false;
    this.perspective = new THREE.PerspectiveCamera(kFieldOfView * 180 / Math.PI, 1, 0.01, 100);
    this.orthographic = new THREE.OrthographicCamera(-1, 1, 1, -1, 0.01, 100);
    this.aspect = 1;
    this.apply();
  }

  get camera() {
    return this.parallel ? this.orthographic : this.perspective;
  }

  // From the target towards the eye.
  back() {
    const c = Math.cos(this.elevation), s = Math.sin(this.elevation);
    const level = sum(this.east.map((v) => v * c * Math.cos(this.azimuth)), this.north,
        c * Math.sin(this.azimuth));
    return sum(level, this.up, s);
  }

  // Upwards on the screen.
  above() {
    const c = Math.cos(this.elevation), s = Math.sin(this.elevation);
    const level = sum(this.east.map((v) => v * Math.cos(this.azimuth)), this.north,
        Math.sin(this.azimuth));
    return sum(this.up.map((v) => v * c), level, -s);
  }

  lookFrom(direction) {
    const d = unit(direction), height = dot(d, this.up);
    this.elevation = Math.asin(Math.max(-1, Math.min(1, height)));
    if (Math.abs(height) < 0.999) this.azimuth = Math.atan2(dot(d, this.north), dot(d, this.east));
    else this.azimuth = -0.5 * Math.PI;
  }

  apply() {
    const back = this.back(), above = this.above();
    for (const camera of [this.perspective, this.orthographic]) {
      camera.position.fromArray(sum(this.target, back, this.distance));
      camera.up.fromArray(above);
      camera.lookAt(this.target[0], this.target[1], this.target[2]);
      camera.near = Math.max(0.01 * this.distance, this.distance - 12 * this.length);
      camera.far = this.distance + 12 * this.length;
    }
    this.orthographic.near = this.distance - 12 * this.length;
    this.perspective.aspect = this.aspect;
    const half = this.distance * Math.tan(0.5 * kFieldOfView);
    Object.assign(this.orthographic,
        {left: -half * this.aspect, right: half * this.aspect, top: half, bottom: -half});
    this.perspective.updateProjectionMatrix();
    this.orthographic.updateProjectionMatrix();
    this.camera.updateMatrixWorld();
  }

  turn(across, down) {
    this.azimuth -= across;
    this.elevation = Math.max(-kSteep, Math.min(kSteep, this.elevation + down));
  }

  // By fractions of the picture's height.
  shift(across, down) {
    const height = 2 * this.distance * Math.tan(0.5 * kFieldOfView);
    const above = this.above(), right = cross(above, this.back());
    this.target = sum(sum(this.target, right, -across * height), above, down * height);
  }

  zoom(factor) {
    this.distance = Math.max(0.05 * this.length,
        Math.min(60 * this.length, this.distance * factor));
  }

  // Brings all points into the picture, seen from where the eye is; `top` is the part of the height
  // that is covered from above.
  fit(points, margin, top) {
    if (!points.length) return;
    const back = this.back(), above = this.above(), right = cross(above, back);
    const range = (axis) => {
      let low = Infinity, high = -Infinity;
      for (const p of points) {
        const value = dot(p, axis);
        low = Math.min(low, value);
        high = Math.max(high, value);
      }
      return [low, high];
    };
    const x = range(right), y = range(above), z = range(back);
    const middle = (r) => 0.5 * (r[0] + r[1]);
    this.target = sum(sum(right.map((v) => v * middle(x)), above, middle(y)), back, middle(z));
    const tan = Math.tan(0.5 * kFieldOfView);
    let distance = 0.3 * this.length;
    for (const p of points) {
      const depth = this.parallel ? 0 : dot(p, back) - middle(z);
      const high = (Math.abs(dot(p, above) - middle(y)) + margin) / (tan * (1 - top));
      const wide = (Math.abs(dot(p, right) - middle(x)) + margin) / (tan * this.aspect);
      distance = Math.max(distance, depth + Math.max(high, wide));
    }
    this.distance = distance;
    this.target = sum(this.target, above, top * tan * distance);
  }
}
