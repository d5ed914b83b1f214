// Symbols of joints. Each joint has up to three solids: one in the first link's colour, one in the
// second's, each moving with its link, and one of steel that moves with the first.

class JointSymbols {
  constructor(shapes) {
    this.shapes = shapes;
    this.scene = shapes.scene;
    this.sizes = shapes.sizes;
    this.motion = shapes.scene.motion;  // as it was when the page began
  }

  // All that a joint's solids are made of.
  inputsOf(index) {
    const joint = this.scene.joints[index], {shapes} = this;
    const side = (name) => [anchorOf(this.scene, joint, name).pose,
      shapes.contacts[joint[name].link], shapes.layers[joint[name].link]];
    const way = kSliding.includes(joint.type)
        ? this.travel(index, this.slidingFreedom(joint)) : null;
    return [joint, side("first"), side("second"), shapes.layered(), shapes.up, way];
  }

  // {first, second, steel}: solids in the axes of the first, the second and the first link.
  solidsOf(index) {
    const joint = this.scene.joints[index];
    const parts = {first: new Solid(), second: new Solid(), steel: new Solid()};
    const first = anchorOf(this.scene, joint, "first").pose;
    const second = anchorOf(this.scene, joint, "second").pose;
    const at = {first: matrixOf(first), second: matrixOf(second),
      offsetFirst: this.shapes.offset(joint.first.link, axisOf(first, 2)),
      offsetSecond: this.shapes.offset(joint.second.link, axisOf(second, 2))};
    const draw = this[joint.type] || this.fixed;
    draw.call(this, parts, at, joint, index);
    return parts;
  }

  // A pin through both links: stacked plates, or an eye between two cheeks.
  revolute(parts, at, joint) {
    const {thick, pin, rod} = this.sizes;
    const a = at.offsetFirst, b = at.offsetSecond;
    if (this.isFlat(joint.first.link) && this.isFlat(joint.second.link) && this.shapes.layered()) {
      const low = Math.min(a, b) - 0.75 * thick, high = Math.max(a, b) + 0.75 * thick;
      this.disc(parts.steel, at.first, 0.5 * (low + high), pin, high - low);
      return;
    }
    const r = 1.75 * rod;
    this.disc(parts.second, at.second, b, r, 2.2 * rod);
    this.disc(parts.first, at.first, a + 1.7 * rod, r, 0.9 * rod);
    this.disc(parts.first, at.first, a - 1.7 * rod, r, 0.9 * rod);
    this.disc(parts.steel, at.first, 0.5 * (a + b), 0.62 * r, 5.4 * rod);
  }

  isFlat(link) {
    return Boolean(this.shapes.layers[link].normal);
  }

  disc(solid, matrix, z, radius, thickness) {
    solid.plate([[0, 0]], radius, thickness, matrix.clone().multiply(
        new THREE.Matrix4().makeTranslation(0, 0, z)));
  }

  // A block on a rail as long as the block's way; where the way begins far from the first anchor of
  // a moving link, as in a cylinder and its piston, one tube in another.
  prismatic(parts, at, joint, index) {
    const {bar, rod, thick} = this.sizes;
    const [low, high] = this.travel(index, 0);
    const near = Math.min(Math.abs(low), Math.abs(high));
    if (joint.first.link !== this.scene.ground && low * high > 0 && near > 0.5 * (high - low)) {
      this.telescope(parts, at, Math.sign(low), near, high - low);
      return;
    }
    const middle = 0.5 * (low + high), long = high - low + 5 * bar;
    const rail = at.first.clone().multiply(
        new THREE.Matrix4().makeTranslation(0, 0, middle));
    parts.first.box(rail, 1.1 * rod, 1.1 * rod, long);
    this.disc(parts.first, at.first, middle - 0.5 * long, 1.6 * rod, 0.6 * thick);
    this.disc(parts.first, at.first, middle + 0.5 * long, 1.6 * rod, 0.6 * thick);
    // A rounded block: the hull of its cross-section's corners along z.
    const half = 0.55 * bar;
    parts.second.plate([[-half, -half], [half, -half], [half, half], [-half, half]], 0.45 * bar,
        3.2 * bar, at.second);
  }

  telescope(parts, at, sign, near, stroke) {
    const {rod} = this.sizes, tube = Math.max(0.55 * near, near - 4 * rod);
    const inside = Math.min(near, stroke + near - tube + 3 * rod);
    this.disc(parts.first, at.first, sign * 0.5 * tube, 1.5 * rod, tube);
    this.disc(parts.first, at.first, sign * tube, 1.85 * rod, 1.6 * rod);
    this.disc(parts.second, at.second, -sign * 0.5 * inside, 0.95 * rod, inside);
  }

  cylindrical(parts, at, joint, index) {
    const {rod, bar} = this.sizes, [low, high] = this.travel(index, this.slidingFreedom(joint));
    this.shaft(parts.steel, at.first, low - 2.2 * bar, high + 2.2 * bar, 0.8 * rod);
    this.disc(parts.second, at.second, 0, 1.7 * rod, 2.8 * bar);
  }

  screw(parts, at, joint, index) {
    const {rod, bar} = this.sizes, [low, high] = this.travel(index, this.slidingFreedom(joint));
    const begin = low - 2.2 * bar, end = high + 2.2 * bar;
    this.shaft(parts.steel, at.first, begin, end, 0.75 * rod);
    const turns = Math.min(40, Math.max(3, Math.round((end - begin) / (1.1 * rod))));
    parts.steel.add(new THREE.TubeBufferGeometry(
        new Helix(begin, end, turns, 0.85 * rod), 14 * turns, 0.2 * rod, 6), at.first);
    const nut = [0, 1, 2, 3, 4, 5].map((k) => [1.5 * rod * Math.cos(k * Math.PI / 3),
      1.5 * rod * Math.sin(k * Math.PI / 3)]);
    parts.second.plate(nut, 0.35 * rod, 1.6 * bar, at.second);
  }

  shaft(solid, matrix, low, high, radius) {
    this.disc(solid, matrix, 0.5 * (low + high), radius, high - low);
  }

  // A cross: one bar along the first anchor's x, one along the second's y.
  universal(parts, at) {
    const {rod} = this.sizes, half = 1.9 * rod;
    const bar = (solid, matrix, axis) => {
      const along = (distance) => vectorOf(axis).multiplyScalar(distance).applyMatrix4(matrix)
          .toArray();
      solid.cylinder(along(-half), along(half), 0.7 * rod);
      for (const side of [-half, half]) {
        solid.cylinder(along(0.8 * side), along(1.2 * side), 1.05 * rod);
      }
    };
    bar(parts.first, at.first, kUnit[0]);
    bar(parts.second, at.second, kUnit[1]);
    parts.steel.sphere(new THREE.Vector3().setFromMatrixPosition(at.first).toArray(), 1.15 * rod);
  }

  // A ball in a cup that opens towards the second link.
  spherical(parts, at, joint) {
    const {rod} = this.sizes;
    const centre = new THREE.Vector3().setFromMatrixPosition(at.first).toArray();
    const away = this.towards(joint, "first");
    parts.first.cup(centre, 2 * rod, away, 1.35);
    parts.steel.sphere(centre, 1.75 * rod);
  }

  // Two plates that lie on each other.
  planar(parts, at) {
    const {bar, thick} = this.sizes, half = 3 * bar;
    parts.first.plate([[-half, -half], [half, -half], [half, half], [-half, half]], 0.4 * bar,
        0.5 * thick, at.first.clone().multiply(
            new THREE.Matrix4().makeTranslation(0, 0, -0.26 * thick)));
    this.disc(parts.second, at.second, 0.26 * thick, 1.8 * bar, 0.5 * thick);
  }

  fixed(parts, at) {
    const size = 2.3 * this.sizes.rod;
    parts.steel.box(at.first, size, size, size);
  }

  // The direction from a joint to the middle of what else its link carries.
  towards(joint, side) {
    const here = anchorOf(this.scene, joint, side).pose;
    const others = this.shapes.contacts[joint[side].link].map((contact) => contact.point);
    const middle = others.reduce((a, p) => sum(a, p, 1 / others.length), [0, 0, 0]);
    const step = sum(middle, here, -1);
    if (lengthOf(step) > 1e-3 * this.sizes.length) return step;
    return joint[side].link === this.scene.ground ? this.shapes.up.map((v) => -v) : axisOf(here, 2);
  }

  slidingFreedom(joint) {
    return Math.max(0, joint.freedoms.findIndex((freedom) => !freedom.rotation));
  }

  // How far a sliding joint goes: within the motion, its limits, or a part of the
  // mechanism's length.
  travel(index, freedom) {
    const joint = this.scene.joints[index], at = joint.at + freedom, {motion} = this;
    const start = this.scene.start.coordinates ? this.scene.start.coordinates[at] || 0 : 0;
    let low = start, high = start;
    const settings = joint.freedoms[freedom];
    if (settings && settings.rotation) return [-2 * this.sizes.bar, 2 * this.sizes.bar];
    if (motion && motion.coordinates) {
      for (let i = at; i < motion.coordinates.length; i += this.scene.freedoms) {
        low = Math.min(low, motion.coordinates[i]);
        high = Math.max(high, motion.coordinates[i]);
      }
    } else {
      low -= 0.2 * this.sizes.length;
      high += 0.2 * this.sizes.length;
    }
    if (settings && Number.isFinite(settings.lower)) low = settings.lower;
    if (settings && Number.isFinite(settings.upper)) high = settings.upper;
    return [low, high];
  }
}

// The thread of a screw along z.
class Helix extends THREE.Curve {
  constructor(begin, end, turns, radius) {
    super();
    Object.assign(this, {begin, end, turns, radius});
  }

  getPoint(t) {
    const angle = 2 * Math.PI * this.turns * t;
    return new THREE.Vector3(this.radius * Math.cos(angle), this.radius * Math.sin(angle),
        this.begin + t * (this.end - this.begin));
  }
}
