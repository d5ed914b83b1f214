// The mechanism as glTF 2.0: a node for each link, its body and joints, and the motion as an
// animation of those nodes.

const kGltfFloat = 5126;
const kGltfUnsigned = 5125;
const kGltfVertices = 34962;
const kGltfIndices = 34963;

class GltfWriter {
  constructor(view) {
    this.view = view;
    this.pieces = [];
    this.bytes = 0;
    this.json = {asset: {version: "2.0", generator: "vmech " + (view.scene.version || "")},
      scene: 0, scenes: [{name: view.scene.title || "mechanism", nodes: [0]}], nodes: [],
      meshes: [], materials: [], accessors: [], bufferViews: [], buffers: []};
  }

  write() {
    const {view, json} = this;
    json.nodes.push({name: "world", children: view.scene.links.map((_, link) => link + 1),
      rotation: this.upright()});
    view.scene.links.forEach((link, index) => this.addLink(link, index));
    if (view.scene.motion && view.scene.motion.count > 1) this.addMotion(view.scene.motion);
    json.buffers.push({byteLength: this.bytes,
      uri: "data:application/octet-stream;base64," + base64Of(this.pieces, this.bytes)});
    if (!json.meshes.length) { delete json.meshes; delete json.materials; }
    if (!this.bytes) { delete json.buffers; delete json.bufferViews; delete json.accessors; }
    return json;
  }

  // glTF's y axis is up.
  upright() {
    const turn = new THREE.Quaternion().setFromUnitVectors(
        vectorOf(this.view.shapes.up), new THREE.Vector3(0, 1, 0));
    return [turn.x, turn.y, turn.z, turn.w];
  }

  addLink(link, index) {
    const pose = this.view.scene.start.poses[index];
    const size = Math.hypot(pose[3], pose[4], pose[5], pose[6]);
    const node = {name: link.name || "link " + index, translation: pose.slice(0, 3),
      rotation: [pose[4] / size, pose[5] / size, pose[6] / size, pose[3] / size]};
    const primitives = this.view.nodes.links[index].children
        .filter((mesh) => mesh.userData.kind).map((mesh) => this.primitive(mesh));
    if (primitives.length) {
      node.mesh = this.json.meshes.length;
      this.json.meshes.push({name: node.name, primitives: primitives});
    }
    this.json.nodes.push(node);
  }

  primitive(mesh) {
    const {position, normal} = mesh.geometry.attributes;
    return {attributes: {
      POSITION: this.accessor(position.array, 3, "VEC3", kGltfVertices, true),
      NORMAL: this.accessor(unitNormals(normal.array), 3, "VEC3", kGltfVertices, false)},
    material: this.material(mesh.userData.colour)};
  }

  material(colour) {
    const rgba = [colour.r, colour.g, colour.b, 1];
    const found = this.json.materials.findIndex((other) => other.pbrMetallicRoughness
        .baseColorFactor.every((value, k) => value === rgba[k]));
    if (found >= 0) return found;
    return this.json.materials.push({doubleSided: true, pbrMetallicRoughness:
        {baseColorFactor: rgba, metallicFactor: 0.05, roughnessFactor: 0.62}}) - 1;
  }

  accessor(values, width, type, target, ranged) {
    const view = {buffer: 0, byteOffset: this.bytes, byteLength: values.byteLength};
    if (target) view.target = target;
    this.pieces.push(new Uint8Array(values.buffer, values.byteOffset, values.byteLength));
    this.bytes += values.byteLength;
    const accessor = {bufferView: this.json.bufferViews.push(view) - 1, type: type,
      componentType: values instanceof Uint32Array ? kGltfUnsigned : kGltfFloat,
      count: values.length / width};
    if (ranged) Object.assign(accessor, rangeOf(values, width));
    return this.json.accessors.push(accessor) - 1;
  }

  addMotion(motion) {
    const rows = motion.closes ? motion.count + 1 : motion.count;
    const times = new Float32Array(rows);
    for (let i = 0; i < rows; ++i) times[i] = motion.timeOfPose(i) - motion.times[0];
    const input = this.accessor(times, 1, "SCALAR", 0, true);
    const animation = {name: "motion", channels: [], samplers: []};
    const add = (link, path, values, width, type) => {
      animation.channels.push({sampler: animation.samplers.length, target: {node: link + 1, path}});
      animation.samplers.push({input: input, interpolation: "LINEAR",
        output: this.accessor(values, width, type, 0, false)});
    };
    for (let link = 0; link < motion.links; ++link) {
      if (link === this.view.scene.ground) continue;
      add(link, "translation", track(motion, link, rows, 0, 3), 3, "VEC3");
      add(link, "rotation", track(motion, link, rows, 3, 4), 4, "VEC4");
    }
    if (animation.channels.length) this.json.animations = [animation];
  }
}

// Three places of a link over the motion, or its quaternion in the order x, y, z, w.
function track(motion, link, rows, begin, width) {
  const values = new Float32Array(rows * width);
  for (let i = 0; i < rows; ++i) {
    const at = ((i % motion.count) * motion.links + link) * 7 + begin;
    if (width === 3) {
      values.set(motion.poses.subarray(at, at + 3), 3 * i);
      continue;
    }
    const q = motion.poses, size = Math.hypot(q[at], q[at + 1], q[at + 2], q[at + 3]) || 1;
    const turned = [q[at + 1], q[at + 2], q[at + 3], q[at]].map((value) => value / size);
    const alike = i === 0 ? 1 : turned.reduce((a, v, k) => a + v * values[4 * i - 4 + k], 0);
    for (let k = 0; k < 4; ++k) values[4 * i + k] = alike < 0 ? -turned[k] : turned[k];
  }
  return values;
}

function rangeOf(values, width) {
  const min = new Array(width).fill(Infinity), max = new Array(width).fill(-Infinity);
  for (let i = 0; i < values.length; ++i) {
    min[i % width] = Math.min(min[i % width], values[i]);
    max[i % width] = Math.max(max[i % width], values[i]);
  }
  return {min, max};
}

function unitNormals(normals) {
  const out = new Float32Array(normals.length);
  for (let i = 0; i < normals.length; i += 3) {
    const size = Math.hypot(normals[i], normals[i + 1], normals[i + 2]);
    out[i] = size > 0 ? normals[i] / size : 0;
    out[i + 1] = size > 0 ? normals[i + 1] / size : 0;
    out[i + 2] = size > 0 ? normals[i + 2] / size : 1;
  }
  return out;
}

function base64Of(pieces, bytes) {
  const all = new Uint8Array(bytes), parts = [], kPart = 0x6000;
  let at = 0;
  for (const piece of pieces) {
    all.set(piece, at);
    at += piece.length;
  }
  for (let i = 0; i < bytes; i += kPart) {
    parts.push(btoa(String.fromCharCode.apply(null, all.subarray(i, i + kPart))));
  }
  return parts.join("");
}
