// Poses: seven numbers x, y, z, qw, qx, qy, qz from `at` on in an array; all arithmetic in doubles.

// out = R p with the rotation of the pose.
function rotate(poses, at, p, out) {
  const w = poses[at + 3], x = poses[at + 4], y = poses[at + 5], z = poses[at + 6];
  const tx = 2 * (y * p[2] - z * p[1]);
  const ty = 2 * (z * p[0] - x * p[2]);
  const tz = 2 * (x * p[1] - y * p[0]);
  const px = p[0], py = p[1], pz = p[2];
  out[0] = px + w * tx + y * tz - z * ty;
  out[1] = py + w * ty + z * tx - x * tz;
  out[2] = pz + w * tz + x * ty - y * tx;
  return out;
}

// out = R p + t.
function place(poses, at, p, out) {
  rotate(poses, at, p, out);
  out[0] += poses[at];
  out[1] += poses[at + 1];
  out[2] += poses[at + 2];
  return out;
}

// out = R' (p - t), the inverse of `place`.
function placeBack(poses, at, p, out) {
  const inverse = [0, 0, 0, poses[at + 3], -poses[at + 4], -poses[at + 5], -poses[at + 6]];
  return rotate(inverse, 0,
      [p[0] - poses[at], p[1] - poses[at + 1], p[2] - poses[at + 2]], out);
}

const kUnit = [[1, 0, 0], [0, 1, 0], [0, 0, 1]];

// The axis 0, 1 or 2 of a pose.
function axisOf(pose, index) {
  return rotate(pose, 0, kUnit[index], [0, 0, 0]);
}

function matrixOf(pose) {
  return new THREE.Matrix4().compose(new THREE.Vector3(pose[0], pose[1], pose[2]),
      new THREE.Quaternion(pose[4], pose[5], pose[6], pose[3]), new THREE.Vector3(1, 1, 1));
}

function dot(a, b) {
  return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
}

function cross(a, b) {
  return [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]];
}

function sum(a, b, factor) {
  return [a[0] + factor * b[0], a[1] + factor * b[1], a[2] + factor * b[2]];
}

function lengthOf(a) {
  return Math.hypot(a[0], a[1], a[2]);
}

function unit(a) {
  const size = lengthOf(a);
  return size > 0 ? [a[0] / size, a[1] / size, a[2] / size] : [0, 0, 0];
}

// A unit vector at right angles to the unit vector n.
function acrossFrom(n) {
  const least = [0, 1, 2].reduce((a, b) => (Math.abs(n[a]) <= Math.abs(n[b]) ? a : b));
  return unit(cross(n, kUnit[least]));
}
