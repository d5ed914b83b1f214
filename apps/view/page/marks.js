// What can be shown beside the bodies: frames, centres of gravity, grasps, cut joints and limits.

class Marks {
  constructor(scene, nodes, shapes) {
    this.scene = scene;
    this.sizes = shapes.sizes;
    this.shapes = shapes;
    this.nodes = nodes;
    // The marks of each kind; null while they are not shown.
    this.groups = {frames: null, centres: null, grasps: null, cuts: null, limits: null};
    this.materials = makeMarkMaterials();
  }

  show(name, visible) {
    this.clear(name);
    this.groups[name] = visible ? [] : null;
    if (visible) this.build(name);
  }

  // Marks for other numbers of the mechanism; their materials stay.
  rebuild() {
    for (const [name, objects] of Object.entries(this.groups)) {
      if (objects) this.show(name, true);
    }
  }

  clear(name) {
    for (const object of this.groups[name] || []) {
      object.parent.remove(object);
      object.traverse((part) => { if (part.geometry) part.geometry.dispose(); });
    }
  }

  build(name) {
    const {joints} = this.scene;
    if (name === "frames") this.addFrames();
    if (name === "centres") this.addCentres();
    if (name === "grasps") this.addGrasps();
    if (name === "cuts") joints.filter((joint) => joint.cut).forEach((joint) => this.addCut(joint));
    if (name === "limits") joints.forEach((joint) => joint.freedoms.forEach(
        (freedom) => this.addLimit(joint, freedom)));
  }

  put(name, link, object) {
    object.castShadow = false;
    this.nodes.links[link].add(object);
    this.groups[name].push(object);
  }

  addFrames() {
    this.scene.links.forEach((link, index) => {
      const lines = [], colours = [];
      addTriad(lines, colours, [0, 0, 0, 1, 0, 0, 0], 0.12 * this.sizes.length);
      for (const anchor of link.anchors) {
        addTriad(lines, colours, anchor.pose, 0.075 * this.sizes.length);
      }
      this.put("frames", index, this.triadLines(lines, colours));
    });
  }

  // The usual sign of a centre of gravity: a ball in quarters of black and white.
  addCentres() {
    const ball = quarteredBall(0.016 * this.sizes.length);
    this.scene.links.forEach((link, index) => {
      if (!(link.mass > 0) || index === this.scene.ground) return;
      const mesh = new THREE.Mesh(ball, this.materials.quarters);
      mesh.position.fromArray(link.centre);
      mesh.renderOrder = 5;
      this.put("centres", index, mesh);
    });
  }

  addGrasps() {
    const {rod, length} = this.sizes;
    for (const grasp of this.scene.grasps) {
      const group = new THREE.Group();
      const ring = new THREE.Mesh(new THREE.TorusBufferGeometry(2.1 * rod, 0.35 * rod, 10, 36),
          this.materials.grasp);
      const lines = [], colours = [];
      addTriad(lines, colours, [0, 0, 0, 1, 0, 0, 0], 0.07 * length);
      group.add(ring);
      if (!grasp.point) group.add(this.triadLines(lines, colours));
      group.applyMatrix(matrixOf(grasp.pose));
      this.put("grasps", grasp.link, group);
    }
  }

  addCut(joint) {
    const {rod} = this.sizes, pose = anchorOf(this.scene, joint, "first").pose;
    const group = new THREE.Group(), kDashes = 8;
    for (let k = 0; k < kDashes; ++k) {
      const dash = new THREE.Mesh(new THREE.TorusBufferGeometry(
          3.1 * rod, 0.24 * rod, 6, 6, Math.PI / kDashes), this.materials.cut);
      dash.rotation.z = 2 * Math.PI * k / kDashes;
      group.add(dash);
    }
    const offset = this.shapes.offset(joint.first.link, axisOf(pose, 2));
    group.applyMatrix(matrixOf(pose).multiply(new THREE.Matrix4().makeTranslation(0, 0, offset)));
    this.put("cuts", joint.first.link, group);
  }

  // The range of a turning freedom as a sector, of a sliding one as two stops.
  addLimit(joint, freedom) {
    if (!Number.isFinite(freedom.lower) || !Number.isFinite(freedom.upper)) return;
    if (!kPinTypes.includes(joint.type) && joint.type !== "prismatic") return;
    const pose = anchorOf(this.scene, joint, "first").pose, {bar, rod} = this.sizes;
    const material = this.materials.limit;
    const group = new THREE.Group();
    if (freedom.rotation) {
      const sweep = Math.min(2 * Math.PI, freedom.upper - freedom.lower);
      group.add(new THREE.Mesh(new THREE.RingBufferGeometry(
          1.9 * bar, 3.1 * bar, 48, 1, freedom.lower, sweep), material));
    } else {
      for (const value of [freedom.lower, freedom.upper]) {
        const stop = new THREE.Mesh(
            new THREE.BoxBufferGeometry(2.6 * bar, 2.6 * bar, 0.5 * rod), material);
        stop.position.z = value + Math.sign(value - freedom.lower || -1) * 1.7 * bar;
        group.add(stop);
      }
    }
    group.applyMatrix(matrixOf(pose));
    this.put("limits", joint.first.link, group);
  }

  triadLines(lines, colours) {
    const geometry = new THREE.BufferGeometry();
    geometry.setAttribute("position", new THREE.Float32BufferAttribute(lines, 3));
    geometry.setAttribute("color", new THREE.Float32BufferAttribute(colours, 3));
    const object = new THREE.LineSegments(geometry, this.materials.lines);
    object.renderOrder = 4;
    return object;
  }
}

function makeMarkMaterials() {
  const over = {vertexColors: THREE.VertexColors, depthTest: false, transparent: true};
  return {
    lines: new THREE.LineBasicMaterial(over), quarters: new THREE.MeshBasicMaterial(over),
    grasp: new THREE.MeshStandardMaterial({color: shade(0x0b8f63), roughness: 0.5}),
    cut: new THREE.MeshBasicMaterial({color: shade(0xd6336c)}),
    limit: new THREE.MeshBasicMaterial({color: shade(0xd9822b), transparent: true, opacity: 0.4,
      side: THREE.DoubleSide, depthWrite: false})};
}

function addTriad(lines, colours, pose, size) {
  const kAxisColours = [[0.85, 0.2, 0.2], [0.15, 0.6, 0.25], [0.15, 0.4, 0.9]];
  for (let axis = 0; axis < 3; ++axis) {
    lines.push(...pose.slice(0, 3), ...sum(pose, axisOf(pose, axis), size));
    colours.push(...kAxisColours[axis], ...kAxisColours[axis]);
  }
}

function quarteredBall(radius) {
  const ball = new THREE.SphereBufferGeometry(radius, 24, 16).toNonIndexed();
  const p = ball.attributes.position.array, colours = [];
  for (let i = 0; i < p.length; i += 9) {
    const middle = [0, 1, 2].map((k) => p[i + k] + p[i + 3 + k] + p[i + 6 + k]);
    const white = middle[0] * middle[1] * middle[2] > 0 ? 1 : 0.03;
    for (let k = 0; k < 9; ++k) colours.push(white);
  }
  ball.setAttribute("color", new THREE.Float32BufferAttribute(colours, 3));
  return ball;
}
