// The body of each link: its mesh if the file has one, else bars, plates and rods between its
// anchors.

// Sizes of everything that is drawn, in proportion to the mechanism.
function sizesOf(scene) {
  const length = scene.length > 0 ? scene.length : 0.1;
  return {length: length, rod: 0.017 * length, bar: 0.034 * length, thick: 0.028 * length,
    pitch: 0.033 * length, pin: 0.0145 * length};
}

const kSliding = ["prismatic", "cylindrical", "screw"];

class Shapes {
  constructor(scene) {
    this.scene = scene;
    this.sizes = sizesOf(scene);
    this.measure();
  }

  // What follows from the numbers of the mechanism. Bars keep their thickness when these change.
  measure() {
    const {scene} = this;
    this.contacts = scene.links.map((_, link) => contactsOf(scene, link));
    this.layers = layersOf(scene, this.contacts, this.sizes.thick);
    this.up = upOf(scene);
  }

  // How far a link's plate is drawn from its anchors, along the pins' axis `z`.
  offset(link, z) {
    const layer = this.layers[link];
    if (!layer.normal || !this.layered()) return 0;
    return (layer.layer - 1) * this.sizes.pitch * Math.sign(dot(layer.normal, z));
  }

  layered() {
    return this.layers.some((layer) => layer.layer > 1);
  }

  // All that the geometry of a link's body is made of.
  inputsOf(link) {
    if (this.scene.links[link].mesh) return ["mesh"];
    return [this.contacts[link], this.layers[link], this.layered(), this.scene.links[link].centre,
      this.up];
  }

  // The geometry of a link's body, or null if joints alone show it.
  geometryOf(link) {
    if (this.scene.links[link].mesh) return readStl(this.scene.links[link].mesh);
    const solid = new Solid();
    if (link === this.scene.ground) this.addGround(solid, link);
    else this.addBody(solid, link);
    return solid.empty ? null : solid.geometry();
  }

  addBody(solid, link) {
    const contacts = this.contacts[link], {normal} = this.layers[link];
    const least = 0.5 * this.sizes.rod;
    const joints = contacts.filter((contact) => contact.type !== "grasp");
    const points = apartFrom(joints.map((contact) => contact.point), least);
    const plane = normal || (points.length > 2 ? planeOf(points, this.sizes.rod) : null);
    const grasps = apartFrom(contacts.map((contact) => contact.point), least).filter(
        (point) => !points.includes(point));
    const beside = (p) => plane && Math.abs(dot(sum(p, points[0], -1), plane)) < this.sizes.thick;
    if (plane) {
      const offset = this.offset(link, plane), flat = points.concat(grasps.filter(beside));
      this.addPlate(solid, flat, plane, offset);
      const hub = sum(middleOf(points), plane, offset);
      for (const point of grasps) if (!beside(point)) solid.rod(hub, point, 0.6 * this.sizes.rod);
    } else {
      this.addFrame(solid, link, points.concat(grasps), joints);
    }
  }

  // Rods between the points.
  addFrame(solid, link, points, joints) {
    const centre = this.scene.links[link].centre || [0, 0, 0];
    if (points.length === 0) {
      solid.sphere(centre, 2.2 * this.sizes.rod);
    } else if (points.length === 1) {
      // A sliding joint shows its links well enough.
      if (!joints.some((contact) => kSliding.includes(contact.type))) {
        this.addSingle(solid, points[0], centre);
      }
    } else if (points.length === 2) {
      solid.rod(points[0], points[1], this.sizes.rod);
    } else {
      this.addSpokes(solid, points);
    }
  }

  // One anchor: a rod to the centre of mass, or a ball where that is near.
  addSingle(solid, point, centre) {
    if (lengthOf(sum(centre, point, -1)) > 0.06 * this.sizes.length) {
      solid.rod(point, centre, this.sizes.rod).sphere(centre, 2.4 * this.sizes.rod);
    } else {
      solid.sphere(point, 1.5 * this.sizes.rod);
    }
  }

  addSpokes(solid, points) {
    const hub = middleOf(points);
    for (const point of points) solid.rod(point, hub, this.sizes.rod);
    solid.sphere(hub, 1.6 * this.sizes.rod);
  }

  // One or two points make a bar; more make a frame along their hull with a thin web in it.
  addPlate(solid, points, normal, offset) {
    const {bar, thick} = this.sizes;
    const mean = points.reduce((a, p) => a + dot(p, normal) / points.length, 0);
    const x = acrossFrom(normal), y = cross(normal, x);
    const flat = points.map((p) => [dot(p, x), dot(p, y)]);
    const matrix = new THREE.Matrix4().makeBasis(vectorOf(x), vectorOf(y), vectorOf(normal))
        .setPosition(vectorOf(normal).multiplyScalar(mean + offset));
    const hull = convexHull(flat, 1e-3 * bar);
    if (hull.length < 3) {
      solid.plate(flat, bar, thick, matrix);
      return;
    }
    solid.plate(hull, 0.1 * bar, 0.3 * thick, matrix);
    hull.forEach((p, k) => solid.plate([p, hull[(k + 1) % hull.length]], 0.6 * bar, thick, matrix));
    for (const p of flat) solid.plate([p], bar, 1.02 * thick, matrix);
  }

  // Ground: a plate under anchors in a plane of their own, else a foot below each.
  addGround(solid, link) {
    const contacts = this.contacts[link], {normal} = this.layers[link];
    const points = apartFrom(contacts.map((contact) => contact.point), this.sizes.rod);
    const plane = points.length > 2 && !normal ? planeOf(points, this.sizes.rod) : null;
    if (plane) {
      this.addBase(solid, points, dot(plane, this.up) < 0 ? plane.map((v) => -v) : plane);
      return;
    }
    for (const contact of contacts) {
      if (contact.type === "prismatic" || contact.type === "grasp") continue;
      this.addFoot(solid, contact, normal ? this.offset(link, contact.axis) : 0);
    }
  }

  // A slab below the anchors with a short post to each.
  addBase(solid, points, normal) {
    const {bar, thick, rod} = this.sizes, deep = 2.6 * bar;
    const x = acrossFrom(normal), y = cross(normal, x), height = dot(points[0], normal);
    const matrix = new THREE.Matrix4().makeBasis(vectorOf(x), vectorOf(y), vectorOf(normal))
        .setPosition(vectorOf(normal).multiplyScalar(height - deep));
    solid.plate(points.map((p) => [dot(p, x), dot(p, y)]), 1.9 * bar, thick, matrix);
    for (const point of points) {
      const foot = sum(point, normal, -deep), head = sum(point, normal, -1.2 * rod);
      solid.cylinder(foot, head, 1.3 * bar, 0.7 * bar);
    }
  }

  // A pin across gravity stands on a triangle, any other anchor on a cone.
  addFoot(solid, contact, offset) {
    const {bar, rod, thick} = this.sizes, up = this.up, axis = contact.axis;
    const tall = 3.4 * bar;
    if (contact.pin && Math.abs(dot(axis, up)) < 0.5) {
      const y = unit(sum(up, axis, -dot(up, axis))), x = cross(y, axis);
      const matrix = new THREE.Matrix4().makeBasis(vectorOf(x), vectorOf(y), vectorOf(axis))
          .setPosition(vectorOf(sum(contact.point, axis, offset)));
      solid.plate([[0, 0], [-1.25 * bar, -tall], [1.25 * bar, -tall]], 0.78 * bar, thick, matrix);
      const foot = matrix.clone().multiply(
          new THREE.Matrix4().makeTranslation(0, -tall - 0.5 * bar, 0));
      solid.box(foot, 5.4 * bar, 0.7 * bar, 2.6 * thick);
    } else {
      const base = sum(contact.point, up, -tall);
      solid.cylinder(base, sum(contact.point, up, -rod), 1.5 * bar, 0.9 * bar);
      solid.plate([[0, 0]], 2.1 * bar, thick, alongMatrix(base, up, 1));
    }
  }
}

function vectorOf(p) {
  return new THREE.Vector3(p[0], p[1], p[2]);
}

// Up is against gravity, or z without it.
function upOf(scene) {
  const gravity = scene.gravity || [0, 0, 0];
  return lengthOf(gravity) > 0 ? unit(gravity).map((value) => -value) : [0, 0, 1];
}

function middleOf(points) {
  return points.reduce((a, p) => sum(a, p, 1 / points.length), [0, 0, 0]);
}

// The points without those that are nearer than `least` to an earlier one.
function apartFrom(points, least) {
  const apart = [];
  for (const point of points) {
    if (apart.every((other) => lengthOf(sum(point, other, -1)) >= least)) apart.push(point);
  }
  return apart;
}

// The normal of the plane through three or more points, or null if they do not lie in one.
function planeOf(points, tolerance) {
  let normal = [0, 0, 0];
  for (let i = 1; i + 1 < points.length; ++i) {
    for (let j = i + 1; j < points.length; ++j) {
      const n = cross(sum(points[i], points[0], -1), sum(points[j], points[0], -1));
      if (lengthOf(n) > lengthOf(normal)) normal = n;
    }
  }
  if (lengthOf(normal) < tolerance * tolerance) return null;
  normal = unit(normal);
  const height = (p) => Math.abs(dot(sum(p, points[0], -1), normal));
  return points.every((p) => height(p) < tolerance) ? normal : null;
}
