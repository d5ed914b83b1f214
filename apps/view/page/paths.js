// Paths of chosen points: the whole curve of a recorded motion, or the last seconds of a live one.

const kTrail = 1500;  // points of a live path

class Paths {
  constructor(view) {
    this.view = view;
    this.root = new THREE.Group();
    this.paths = [];
    this.work = [0, 0, 0];
  }

  // `point` in the axes of the link; that of a grasp goes with the grasp.
  add(link, point, name, grasp) {
    const path = {link, point, name, grasp};
    this.locate(path);
    const colour = shade(linkColour(this.view.scene, link));
    path.dot = new THREE.Mesh(new THREE.SphereBufferGeometry(
        0.9 * this.view.shapes.sizes.rod, 16, 12), new THREE.MeshBasicMaterial({color: colour}));
    path.line = this.view.scene.motion ? this.curve(path, colour) : this.trail(path, colour);
    this.root.add(path.dot, path.line);
    this.paths.push(path);
    this.update(this.view.now);
    this.view.emit("paths");
    return path;
  }

  remove(path) {
    this.root.remove(path.dot, path.line);
    for (const object of [path.dot, path.line]) {
      object.geometry.dispose();
      object.material.dispose();
    }
    this.paths = this.paths.filter((other) => other !== path);
    this.view.emit("paths");
  }

  // The mechanism has other numbers: a curve that was recorded is not its curve.
  rebuild() {
    for (const path of this.paths) {
      this.locate(path);
      if (path.count === undefined) this.startTrail(path);
    }
  }

  locate(path) {
    const grasp = this.view.scene.grasps[path.grasp];
    if (grasp) path.point = grasp.pose.slice(0, 3);
  }

  startTrail(path) {
    this.root.remove(path.line);
    path.line.geometry.dispose();
    path.line.material.dispose();
    path.line = this.trail(path, path.dot.material.color);
    this.root.add(path.line);
  }

  // The curve over the motion as a thin tube.
  curve(path, colour) {
    const motion = this.view.scene.motion, points = [];
    for (let i = 0; i < motion.count; ++i) {
      points.push(new THREE.Vector3(...place(motion.poses, (i * motion.links + path.link) * 7,
          path.point, [0, 0, 0])));
    }
    if (motion.closes) points.push(points[0].clone());
    const curve = new Polyline(points);
    return new THREE.Mesh(new THREE.TubeBufferGeometry(curve, Math.max(2, points.length - 1),
        0.0038 * this.view.shapes.sizes.length, 6), new THREE.MeshBasicMaterial({color: colour}));
  }

  trail(path, colour) {
    const geometry = new THREE.BufferGeometry();
    geometry.setAttribute("position", new THREE.BufferAttribute(new Float32Array(3 * kTrail), 3)
        .setUsage(THREE.DynamicDrawUsage));
    geometry.setDrawRange(0, 0);
    path.count = 0;
    const line = new THREE.Line(geometry, new THREE.LineBasicMaterial({color: colour}));
    line.frustumCulled = false;
    return line;
  }

  update(now) {
    for (const path of this.paths) {
      place(now.poses, 7 * path.link, path.point, this.work);
      path.dot.position.fromArray(this.work);
      if (now.live && path.count !== undefined) this.lengthen(path);
    }
  }

  lengthen(path) {
    const attribute = path.line.geometry.attributes.position;
    if (path.count === kTrail) {
      attribute.array.copyWithin(0, 3);
      --path.count;
    }
    attribute.array.set(this.work, 3 * path.count++);
    attribute.needsUpdate = true;
    path.line.geometry.setDrawRange(0, path.count);
  }
}

// Straight lines from point to point, each of the same share of the parameter.
class Polyline extends THREE.Curve {
  constructor(points) {
    super();
    this.points = points;
  }

  getPoint(t) {
    const last = this.points.length - 1, i = Math.min(last - 1, Math.floor(t * last));
    if (last < 1) return this.points[0].clone();
    return this.points[i].clone().lerp(this.points[i + 1], t * last - i);
  }

  getPointAt(t) {
    return this.getPoint(t);
  }

  getTangentAt(t) {
    const last = this.points.length - 1;
    const i = Math.min(last - 1, Math.max(0, Math.round(t * last) - 1)), j = Math.min(last, i + 2);
    const way = last < 1 ? new THREE.Vector3() : this.points[j].clone().sub(this.points[i]);
    return way.lengthSq() > 0 ? way.normalize() : new THREE.Vector3(1, 0, 0);
  }
}
