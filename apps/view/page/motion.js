// The recorded motion between its poses. A place in it is a fractional pose index.

// Two poses that are further apart than this (cosine of half the angle) are joined by slerp; nearer
// ones by a cubic through four poses, which keeps a point on its path to fourth order of the step.
const kFarApart = 0.9;

class Motion {
  constructor(recorded, scene) {
    Object.assign(this, recorded);
    this.links = scene.links.length;
    this.rotations = scene.rotations;
    this.count = this.times.length;
    const span = this.times[this.count - 1] - this.times[0];
    // A cycle whose last pose is not its first again has one more step, from the last to the first.
    this.closes = this.cycle > 0 && span < this.cycle * (1 - 1e-9);
    this.end = this.closes ? this.count : this.count - 1;
    this.duration = this.cycle > 0 ? this.cycle : span;
    this.work = {near: [0, 0, 0, 0], steps: [0, 0, 0], pose: new Float64Array(4)};
  }

  timeOfPose(i) {
    const turns = Math.floor(i / this.count);
    return this.times[i - turns * this.count] + turns * this.cycle;
  }

  timeAt(index) {
    const i = Math.min(Math.floor(index), this.end);
    if (i === index) return this.timeOfPose(i);
    const begin = this.timeOfPose(i);
    return begin + (index - i) * (this.timeOfPose(i + 1) - begin);
  }

  indexAt(time) {
    let low = 0, high = this.end;
    while (high - low > 1) {
      const middle = (low + high) >> 1;
      if (this.timeOfPose(middle) <= time) low = middle; else high = middle;
    }
    if (high === low) return low;
    const begin = this.timeOfPose(low), step = this.timeOfPose(high) - begin;
    const part = step > 0 ? (time - begin) / step : 0;
    return low + Math.min(1, Math.max(0, part));
  }

  // The index within the motion: round a cycle, or stopped at an end.
  clamped(index) {
    if (this.cycle > 0 && this.end > 0) return ((index % this.end) + this.end) % this.end;
    return Math.min(this.end, Math.max(0, index));
  }

  axisAt(index) {
    const i = Math.min(Math.floor(index), this.count - 1);
    const values = this.axis.values;
    if (i + 1 < this.count) return values[i] + (index - i) * (values[i + 1] - values[i]);
    const step = this.count > 1 ? values[i] - values[i - 1] : 0;
    return values[i] + (index - i) * step;
  }

  indexAtAxis(value) {
    const values = this.axis.values;
    let best = 0, distance = Infinity;
    for (let i = 0; i + 1 < this.count; ++i) {
      const step = values[i + 1] - values[i];
      const part = step ? Math.min(1, Math.max(0, (value - values[i]) / step)) : 0;
      const miss = Math.abs(values[i] + part * step - value);
      if (miss < distance) { distance = miss; best = i + part; }
    }
    return best;
  }

  // Fills `now` with everything at the index.
  sample(index, now) {
    const i = Math.min(Math.floor(index), this.end - (this.end > 0 ? 1 : 0));
    const part = index - i;
    this.prepare(i);
    for (let link = 0; link < this.links; ++link) this.samplePose(link, part, now.poses);
    this.sampleRow(this.coordinates, i, part, now.coordinates, this.rotations);
    this.sampleRow(this.rates, i, part, now.rates, null);
    this.sampleRow(this.wrenches, i, part, now.wrenches, null);
  }

  // The four poses around step i and the lengths of the three steps; a missing one is -1.
  prepare(i) {
    const {near, steps} = this.work;
    for (let k = 0; k < 4; ++k) near[k] = this.poseNear(i - 1 + k);
    for (let k = 0; k < 3; ++k) {
      steps[k] = near[k] < 0 || near[k + 1] < 0 ? 0
                                                : this.timeNear(i + k) - this.timeNear(i + k - 1);
    }
  }

  poseNear(i) {
    if (i >= 0 && i < this.count) return i;
    if (!(this.cycle > 0)) return -1;
    return this.closes ? (i + this.count) % this.count : (i + this.end) % this.end;
  }

  timeNear(i) {
    const period = this.closes ? this.count : this.end;
    if (i >= 0 && i < this.count) return this.times[i];
    return this.times[((i % period) + period) % period] + (i < 0 ? -this.cycle : this.cycle);
  }

  samplePose(link, part, poses) {
    const {near, pose} = this.work;
    const rows = near.map((i) => (i < 0 ? -1 : (i * this.links + link) * 7));
    const to = link * 7;
    for (let k = 0; k < 3; ++k) poses[to + k] = this.cubic(rows, k, part, 1, 1, 1);
    const sign = (row) => (row < 0 || this.alike(row, rows[1]) >= 0 ? 1 : -1);
    const before = sign(rows[0]), after = sign(rows[2]), later = sign(rows[3]);
    const alike = rows[2] < 0 ? 1 : Math.abs(this.alike(rows[1], rows[2]));
    for (let k = 0; k < 4; ++k) {
      pose[k] = alike > kFarApart ? this.cubic(rows, 3 + k, part, before, after, later)
                                  : this.slerp(rows, 3 + k, part, after, alike);
    }
    const size = Math.hypot(pose[0], pose[1], pose[2], pose[3]) || 1;
    for (let k = 0; k < 4; ++k) poses[to + 3 + k] = pose[k] / size;
  }

  alike(a, b) {
    const q = this.poses;
    return q[a + 3] * q[b + 3] + q[a + 4] * q[b + 4] + q[a + 5] * q[b + 5] + q[a + 6] * q[b + 6];
  }

  slerp(rows, k, part, sign, alike) {
    const angle = Math.acos(Math.min(1, alike));
    const size = Math.sin(angle);
    const one = size > 1e-9 ? Math.sin((1 - part) * angle) / size : 1 - part;
    const other = size > 1e-9 ? Math.sin(part * angle) / size : part;
    return one * this.poses[rows[1] + k] + other * sign * this.poses[rows[2] + k];
  }

  // Cubic Hermite interpolation; a slope is the difference across two steps, and that of a parabola
  // where the motion begins or ends.
  cubic(rows, k, part, before, after, later) {
    const p = this.poses, [h0, h, h2] = this.work.steps;
    const p1 = p[rows[1] + k];
    if (rows[2] < 0 || !(h > 0)) return p1;
    const p2 = after * p[rows[2] + k], slope = (p2 - p1) / h;
    let m1 = rows[0] < 0 || !(h0 > 0) ? NaN : (p1 - before * p[rows[0] + k]) / h0;
    let m2 = rows[3] < 0 || !(h2 > 0) ? NaN : (later * p[rows[3] + k] - p2) / h2;
    m1 = (h * m1 + h0 * slope) / (h + h0);
    m2 = (h * m2 + h2 * slope) / (h + h2);
    if (Number.isNaN(m1) && Number.isNaN(m2)) m1 = m2 = slope;
    else if (Number.isNaN(m1)) m1 = 2 * slope - m2;
    else if (Number.isNaN(m2)) m2 = 2 * slope - m1;
    const s = part, rest = 1 - s;
    return (1 + 2 * s) * rest * rest * p1 + s * rest * rest * h * m1 +
        s * s * (3 - 2 * s) * p2 - s * s * rest * h * m2;
  }

  sampleRow(rows, i, part, out, rotations) {
    if (!rows || !out) return;
    const width = out.length, next = this.poseNear(i + 1);
    for (let k = 0; k < width; ++k) {
      const value = rows[i * width + k];
      let step = next < 0 ? 0 : rows[next * width + k] - value;
      // From the end of a cycle to its beginning an angle goes the short way round.
      if (rotations && rotations[k]) step -= 2 * Math.PI * Math.round(step / (2 * Math.PI));
      out[k] = value + part * step;
    }
  }
}

// What is shown at one instant: by the player out of a recorded motion, by the session as it comes.
function makeNow(scene) {
  const motion = scene.motion;
  return {index: 0, time: 0, poses: Float64Array.from(scene.start.poses.flat()),
    coordinates: Float64Array.from(scene.start.coordinates || new Array(scene.freedoms).fill(0)),
    rates: new Float64Array(scene.freedoms),
    wrenches: motion && motion.wrenches ? new Float64Array(6 * scene.joints.length) : null,
    certainty: motion ? motion.certainty : null, atLimit: [], hand: null, haptic: null,
    live: false};
}
