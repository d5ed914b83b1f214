// Arrows to scale. A pool draws all arrows of one colour as two instanced meshes.

class ArrowPool {
  constructor(parent, colour, capacity, thickness) {
    this.thickness = thickness;
    const tint = shade(colour);
    this.material = new THREE.MeshLambertMaterial({color: tint,
      emissive: tint.clone().multiplyScalar(0.5)});
    this.veiled = new THREE.MeshBasicMaterial({color: tint, transparent: true, opacity: 0.38,
      depthFunc: THREE.GreaterDepth, depthWrite: false});
    this.shafts = this.instanced(
        new THREE.CylinderBufferGeometry(1, 1, 1, 12), capacity);
    this.heads = this.instanced(new THREE.ConeBufferGeometry(1, 1, 20), 2 * capacity);
    this.capacity = capacity;
    this.hidden = [this.shafts, this.heads].map((mesh) => this.behind(mesh));
    parent.add(this.shafts, this.heads, ...this.hidden);
    this.z = new THREE.Vector3(0, 0, 1);
    this.way = new THREE.Vector3();
    this.at = new THREE.Vector3();
    this.turn = new THREE.Quaternion();
    this.size = new THREE.Vector3();
    this.matrix = new THREE.Matrix4();
    this.clear();
  }

  instanced(geometry, capacity) {
    geometry.rotateX(Math.PI / 2).translate(0, 0, 0.5);
    const mesh = new THREE.InstancedMesh(geometry, this.material, capacity);
    mesh.frustumCulled = false;
    mesh.count = 0;
    return mesh;
  }

  // The same arrows where something stands before them, as a veil over it.
  behind(mesh) {
    const veil = new THREE.InstancedMesh(mesh.geometry, this.veiled, this.capacity);
    veil.instanceMatrix = mesh.instanceMatrix;
    veil.frustumCulled = false;
    veil.renderOrder = 2;
    return veil;
  }

  clear() {
    this.shafts.count = this.heads.count = 0;
  }

  // An arrow of `length` from `from` along (x, y, z); a moment has two heads.
  add(from, x, y, z, length, moment) {
    const size = Math.sqrt(x * x + y * y + z * z);
    if (!(size > 0) || !Number.isFinite(size) || !(length > this.thickness * 0.4) ||
        this.shafts.count >= this.capacity) return;
    this.way.set(x / size, y / size, z / size);
    this.turn.setFromUnitVectors(this.z, this.way);
    const head = Math.min(7.5 * this.thickness, 0.6 * length), wide = head / 2.7;
    const shaft = Math.max(length - head * (moment ? 1.6 : 1), 1e-9);
    this.at.set(from[0], from[1], from[2]);
    this.put(this.shafts, Math.min(this.thickness, 0.45 * wide), shaft);
    this.at.addScaledVector(this.way, length - head);
    this.put(this.heads, wide, head);
    if (moment) {
      this.at.addScaledVector(this.way, -0.6 * head);
      this.put(this.heads, wide, head);
    }
  }

  put(mesh, wide, long) {
    this.matrix.compose(this.at, this.turn, this.size.set(wide, wide, long));
    mesh.setMatrixAt(mesh.count++, this.matrix);
  }

  finish() {
    this.hidden[0].count = this.shafts.count;
    this.hidden[1].count = this.heads.count;
    for (const mesh of this.hidden) mesh.visible = this.shafts.count > 0;
    this.shafts.visible = this.heads.visible = this.shafts.count > 0;
    this.shafts.instanceMatrix.needsUpdate = this.heads.instanceMatrix.needsUpdate = true;
  }
}
