// The forces and moments of one instant as arrows: joints, external loads, weights, the hand.

const kForceColours = {certain: 0xcf222e, undetermined: 0x8250df, load: 0x1a7f9c, weight: 0x7d8894,
  hand: 0x0b8f63, dynamic: 0xd9822b};

const kUnloaded = 1e-9;  // of a joint's wrench: what is open and carries nothing matters to nobody

// Is a joint's force (begin 0) or moment (begin 3), as it is loaded, what statics says?
function isCertain(words, begin, wrenches, at) {
  if (!words || !wrenches) return true;
  let largest = 0;
  for (let k = at; k < at + 6; ++k) largest = Math.max(largest, Math.abs(wrenches[k]));
  for (let k = begin; k < begin + 3; ++k) {
    if (words[k] !== "certain" && Math.abs(wrenches[at + k]) > kUnloaded * largest) return false;
  }
  return true;
}

class Forces {
  constructor(view) {
    this.view = view;
    this.scene = view.scene;
    this.root = new THREE.Group();
    this.length = view.shapes.sizes.length;
    const capacity = 2 * this.scene.joints.length + this.scene.links.length + 16;
    this.pools = {};
    for (const [name, colour] of Object.entries(kForceColours)) {
      this.pools[name] = new ArrowPool(this.root, colour, capacity, 0.0062 * this.length);
    }
    this.loads = (this.scene.motion ? this.scene.motion.loads : []);
    this.work = {point: [0, 0, 0], force: [0, 0, 0], moment: [0, 0, 0]};
    this.scaleUp = 1;
    this.findScales();
    this.measure();
  }

  // Where the arrows of joints and weights begin, in the axes of the links.
  measure() {
    const {scene} = this, g = lengthOf(scene.gravity || [0, 0, 0]);
    this.anchors = scene.joints.map((joint) => ({
      link: joint.second.link, point: anchorOf(scene, joint, "second").pose.slice(0, 3),
      axes: joint.first.link, turned: anchorOf(scene, joint, "first").pose}));
    this.largest.weight = Math.max(0, ...scene.links.map((link) => g * (link.mass || 0)));
  }

  // The largest force takes 0.4 of the mechanism's length, and so does the largest moment.
  findScales() {
    this.largest = {force: 0, moment: 0, weight: 0};
    const motion = this.scene.motion;
    if (motion && motion.wrenches) this.include(motion.wrenches);
    for (const load of this.loads) this.include(load.wrenches);
    if (motion && motion.hand) this.include(motion.hand.wrenches);
  }

  include(wrenches) {
    const largest = this.largest;
    for (let i = 0; i + 5 < wrenches.length; i += 6) {
      const f = Math.hypot(wrenches[i], wrenches[i + 1], wrenches[i + 2]);
      const m = Math.hypot(wrenches[i + 3], wrenches[i + 4], wrenches[i + 5]);
      if (Number.isFinite(f)) largest.force = Math.max(largest.force, f);
      if (Number.isFinite(m)) largest.moment = Math.max(largest.moment, m);
    }
  }

  arrow(pool, point, v, kind) {
    const size = lengthOf(v), most = this.largest[kind === "moment" ? "moment" : "force"];
    if (!(most > 0)) return;
    const scaled = 0.4 * this.length * this.scaleUp * size / most;
    this.pools[pool].add(point, v[0], v[1], v[2], scaled, kind === "moment");
  }

  update(now, shown) {
    for (const pool of Object.values(this.pools)) pool.clear();
    if (now.live && now.wrenches) this.include(now.wrenches);
    if (now.wrenches && (shown.forces || shown.moments)) this.addJoints(now, shown);
    if (shown.loads && !now.live) this.addLoads(now, shown);
    if (shown.weights) this.addWeights(now);
    if (now.haptic) this.addHaptic(now);
    for (const pool of Object.values(this.pools)) pool.finish();
  }

  addJoints(now, shown) {
    const {point, force, moment} = this.work;
    for (let j = 0; j < this.anchors.length; ++j) {
      const anchor = this.anchors[j], at = 6 * j;
      const words = now.certainty ? now.certainty[j] : null;
      this.toWorld(now.poses, anchor, now.wrenches, at, force);
      place(now.poses, 7 * anchor.link, anchor.point, point);
      if (shown.forces) {
        this.arrow(isCertain(words, 0, now.wrenches, at) ? "certain" : "undetermined", point, force, "force");
      }
      if (shown.moments) {
        this.toWorld(now.poses, anchor, now.wrenches, at + 3, moment);
        this.arrow(isCertain(words, 3, now.wrenches, at) ? "certain" : "undetermined", point, moment, "moment");
      }
    }
  }

  // Components in the axes of a joint's first anchor, turned into the world's.
  toWorld(poses, anchor, values, at, out) {
    out[0] = values[at];
    out[1] = values[at + 1];
    out[2] = values[at + 2];
    rotate(anchor.turned, 0, out, out);
    rotate(poses, 7 * anchor.axes, out, out);
  }

  addLoads(now, shown) {
    const {point, force} = this.work;
    const draw = (rows, pool) => {
      this.rowAt(rows, now.index, 0, force);
      this.arrow(pool, point, force, "force");
      if (!shown.moments) return;
      this.rowAt(rows, now.index, 3, force);
      this.arrow(pool, point, force, "moment");
    };
    for (const load of this.loads) {
      place(now.poses, 7 * load.link, load.point, point);
      draw(load.wrenches, "load");
    }
    const hand = this.scene.motion && this.scene.motion.hand;
    if (hand) {
      const grasp = this.scene.grasps[hand.grasp];
      place(now.poses, 7 * grasp.link, grasp.pose, point);
      draw(hand.wrenches, "hand");
    }
  }

  rowAt(rows, index, begin, out) {
    const count = rows.length / 6, i = Math.min(Math.floor(index), count - 1);
    const next = (i + 1) % count, part = index - i;
    for (let k = 0; k < 3; ++k) {
      const value = rows[6 * i + begin + k];
      out[k] = value + part * (rows[6 * next + begin + k] - value);
    }
  }

  // Weights have a scale of their own where they are much smaller than the other forces.
  addWeights(now) {
    const {point} = this.work, g = this.scene.gravity || [0, 0, 0];
    this.scene.links.forEach((link, index) => {
      if (index === this.scene.ground || !(link.mass > 0) || !(this.largest.weight > 0)) return;
      place(now.poses, 7 * index, link.centre, point);
      const size = link.mass * lengthOf(g) / this.largest.weight;
      const long = 0.22 * this.length * this.scaleUp * size;
      this.pools.weight.add(point, g[0], g[1], g[2], long, false);
    });
  }

  addHaptic(now) {
    const {constraint, dynamic, grasp} = now.haptic;
    if (constraint) { this.include(constraint); this.arrow("hand", grasp, constraint, "force"); }
    if (dynamic) { this.include(dynamic); this.arrow("dynamic", grasp, dynamic, "force"); }
  }
}
