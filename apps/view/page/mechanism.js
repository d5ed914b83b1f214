// The mechanism as nodes of three.js: one per link, with its body and its halves of the joints.

const kLimitColour = new THREE.Color(0xd01810).convertSRGBToLinear();
const kGlass = 0.16;  // opacity of a link that is seen and reached through

class MechanismNodes {
  constructor(scene, shapes, plain) {
    this.scene = scene;
    this.plain = plain;
    this.shapes = shapes;
    this.root = new THREE.Group();
    this.symbols = new JointSymbols(shapes);
    this.made = new Map();    // by the name of a link or joint: what it is drawn by, as text
    this.meshes = new Map();  // by the name of a part
    this.parts = [];          // the meshes; userData {kind, index, link}
    // Links that are glass, by number: at first the ground, if a mesh draws it, for it is often a
    // housing that hides what moves inside.
    const ground = scene.links[scene.ground];
    this.glass = new Set(ground && ground.mesh ? [scene.ground] : []);
    this.links = scene.links.map(() => new THREE.Group());
    for (const node of this.links) this.root.add(node);
    this.rebuild();
  }

  get triangles() {
    return this.parts.reduce((n, mesh) => n + mesh.geometry.attributes.position.count / 3, 0);
  }

  // Draws those links and joints whose numbers have changed since they were drawn.
  rebuild() {
    this.scene.links.forEach((_, index) => this.drawLink(index));
    this.scene.joints.forEach((_, index) => this.drawJoint(index));
    this.parts = Array.from(this.meshes.values());
    for (const mesh of this.parts) this.setMaterial(mesh);
  }

  // What the pointer meets.
  get reachable() {
    return this.parts.filter((mesh) => !this.isGlass(mesh));
  }

  isGlass(mesh) {
    return mesh.userData.kind === "link" && this.glass.has(mesh.userData.link);
  }

  makeGlass(link, on) {
    if (on) this.glass.add(link); else this.glass.delete(link);
    for (const mesh of this.parts) this.setMaterial(mesh);
  }

  setMaterial(mesh) {
    const glass = this.isGlass(mesh);
    Object.assign(mesh.material, {transparent: glass, opacity: glass ? kGlass : 1,
      depthWrite: !glass});
    mesh.castShadow = mesh.receiveShadow = !glass;
  }

  isNew(name, inputs) {
    const text = JSON.stringify(inputs), is = this.made.get(name) !== text;
    this.made.set(name, text);
    return is;
  }

  drawLink(index) {
    const name = "link " + index;
    if (!this.isNew(name, this.shapes.inputsOf(index))) return;
    this.put(name, this.shapes.geometryOf(index), linkColour(this.scene, index),
        {kind: "link", index: index, link: index});
  }

  drawJoint(index) {
    const joint = this.scene.joints[index], name = "joint " + index;
    if (!this.isNew(name, this.symbols.inputsOf(index))) return;
    const solids = this.symbols.solidsOf(index);
    const draw = (part, link, colour) => this.put(name + part,
        solids[part].empty ? null : solids[part].geometry(), colour, {kind: "joint", index, link});
    draw("first", joint.first.link, linkColour(this.scene, joint.first.link));
    draw("second", joint.second.link, linkColour(this.scene, joint.second.link));
    draw("steel", joint.first.link, kSteelColour);
  }

  // A part gets a geometry, which the renderer forgets with the next one; null: nothing to draw.
  put(name, geometry, colour, userData) {
    const mesh = this.meshes.get(name);
    if (mesh) mesh.geometry.dispose();
    if (mesh && geometry) {
      mesh.geometry = geometry;
    } else if (geometry) {
      this.meshes.set(name, this.makePart(geometry, colour, userData));
    } else if (mesh) {
      mesh.material.dispose();
      mesh.parent.remove(mesh);
      this.meshes.delete(name);
    }
  }

  makePart(geometry, colour, userData) {
    const material = this.plain ? new THREE.MeshLambertMaterial({color: shade(colour)})
        : new THREE.MeshStandardMaterial({color: shade(colour), roughness: 0.62, metalness: 0.05});
    const mesh = new THREE.Mesh(geometry, material);
    mesh.userData = Object.assign({colour: material.color.clone()}, userData);
    this.links[userData.link].add(mesh);
    return mesh;
  }

  setPoses(poses) {
    poseNodes(this.links, poses);
  }

  // Lights up a link or joint, and reddens joints at a limit.
  highlight(hovered, picked, atLimit) {
    for (const mesh of this.parts) {
      const own = mesh.userData;
      const is = (what) => what && what.kind === own.kind && what.index === own.index;
      const limit = own.kind === "joint" && atLimit.includes(own.index);
      mesh.material.color.copy(limit ? kLimitColour : own.colour);
      mesh.material.emissive.setHex(is(hovered) || is(picked) ? 0x4a5a6a : 0);
      mesh.material.emissiveIntensity = is(hovered) ? 0.75 : 0.45;
    }
  }

  // A pale copy of the mechanism, for a comparison with another assembly mode.
  makeGhost() {
    const ghost = new THREE.Group();
    const material = new THREE.MeshStandardMaterial({color: shade(0x8090a0), transparent: true,
      opacity: 0.28, depthWrite: false, roughness: 1});
    this.links.forEach((node, link) => {
      const copy = new THREE.Group();
      for (const mesh of link === this.scene.ground ? [] : node.children) {
        if (mesh.userData.kind) copy.add(new THREE.Mesh(mesh.geometry, material));
      }
      ghost.add(copy);
    });
    ghost.setPoses = (poses) => poseNodes(ghost.children, poses);
    ghost.dispose = () => material.dispose();
    return ghost;
  }
}

function poseNodes(nodes, poses) {
  for (let i = 0, at = 0; i < nodes.length; ++i, at += 7) {
    nodes[i].position.set(poses[at], poses[at + 1], poses[at + 2]);
    nodes[i].quaternion.set(poses[at + 4], poses[at + 5], poses[at + 6], poses[at + 3]);
  }
}

// Points that the view should hold, in axes of their links: anchors, grasps, corners of bodies.
function pointsToFit(scene, nodes) {
  return scene.links.map((link, index) => {
    const points = link.anchors.map((anchor) => anchor.pose.slice(0, 3));
    points.push(...scene.grasps.filter((grasp) => grasp.link === index)
        .map((grasp) => grasp.pose.slice(0, 3)));
    for (const body of nodes.links[index].children.filter((mesh) => mesh.userData.kind)) {
      body.geometry.computeBoundingBox();
      const {min, max} = body.geometry.boundingBox;
      for (const x of [min.x, max.x]) {
        for (const y of [min.y, max.y]) for (const z of [min.z, max.z]) points.push([x, y, z]);
      }
    }
    if (!points.length && link.centre) points.push(link.centre);
    return points;
  });
}

// Those points in the world, over the whole motion.
function sweptPoints(scene, nodes) {
  const local = pointsToFit(scene, nodes), swept = [], motion = scene.motion;
  const add = (poses, row) => local.forEach((points, link) => {
    for (const p of points) swept.push(place(poses, (row + link) * 7, p, [0, 0, 0]));
  });
  add(scene.start.poses.flat(), 0);
  if (motion) {
    const step = Math.max(1, Math.floor(motion.count / 48));
    for (let i = 0; i < motion.count; i += step) add(motion.poses, i * motion.links);
  }
  return swept.filter((p) => p.every(Number.isFinite));
}
