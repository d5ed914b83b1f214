// Solids that links and joints are made of. A Solid collects pieces and becomes one geometry.

const kCorner = 24;  // steps round a full circle of a plate's rim
const kRim = 3;      // steps of the rounding of an edge

class Solid {
  constructor() {
    this.positions = [];  // of triangles put one by one
    this.normals = [];
    this.pieces = [];     // attributes of geometries put as a whole
  }

  get empty() {
    return this.positions.length === 0 && !this.pieces.length;
  }

  triangle(a, b, c, na, nb, nc) {
    this.positions.push(a[0], a[1], a[2], b[0], b[1], b[2], c[0], c[1], c[2]);
    this.normals.push(na[0], na[1], na[2], nb[0], nb[1], nb[2], nc[0], nc[1], nc[2]);
  }

  // A geometry of three.js, placed by a matrix.
  add(geometry, matrix) {
    const flat = geometry.index ? geometry.toNonIndexed() : geometry;
    flat.applyMatrix(matrix);
    this.pieces.push(flat.attributes);
    return this;
  }

  sphere(centre, radius) {
    return this.add(unitBall().clone(), new THREE.Matrix4().makeScale(radius, radius, radius)
        .setPosition(centre[0], centre[1], centre[2]));
  }

  // The part of a hollow ball within `angle` of the direction.
  cup(centre, radius, direction, angle) {
    const inner = new THREE.SphereBufferGeometry(radius, 28, 12, 0, 2 * Math.PI, 0, angle);
    return this.add(inner, alongMatrix(centre, direction, 1)
        .multiply(new THREE.Matrix4().makeRotationX(Math.PI / 2)));
  }

  // A cone or cylinder between two points.
  cylinder(from, to, radius, radiusTo) {
    const step = sum(to, from, -1), size = lengthOf(step);
    if (!(size > 0)) return this;
    const geometry = new THREE.CylinderBufferGeometry(
        radiusTo === undefined ? radius : radiusTo, radius, size, 24);
    return this.add(geometry, alongMatrix(sum(from, step, 0.5), step, 1)
        .multiply(new THREE.Matrix4().makeRotationX(Math.PI / 2)));
  }

  // A bar with round ends.
  rod(from, to, radius) {
    return this.cylinder(from, to, radius).sphere(from, radius).sphere(to, radius);
  }

  box(matrix, x, y, z) {
    return this.add(new THREE.BoxBufferGeometry(x, y, z), matrix.clone());
  }

  // The convex hull of points in the matrix's x-y plane, widened by a radius, of some thickness
  // along z, with rounded edges. One point gives a disc, two a bar with round ends.
  plate(points, radius, thickness, matrix) {
    const hull = convexHull(points, radius * 1e-3);
    const round = Math.min(0.28 * thickness, 0.3 * radius);
    const rings = [];
    for (let side = -1; side <= 1; side += 2) {
      for (let k = 0; k <= kRim; ++k) {
        const angle = 0.5 * Math.PI * (side < 0 ? k / kRim - 1 : k / kRim);
        rings.push({grow: radius - round + round * Math.cos(angle), nr: Math.cos(angle),
          nz: Math.sin(angle), z: side * (0.5 * thickness - round) + round * Math.sin(angle)});
      }
    }
    this.loft(rimOf(hull), rings, hull, matrix);
    return this;
  }

  // Rings round a rim, one above the other, and a fan at either end.
  loft(rim, rings, hull, matrix) {
    const normalMatrix = new THREE.Matrix3().setFromMatrix4(matrix);
    const v = new THREE.Vector3();
    const point = (x, y, z) => v.set(x, y, z).applyMatrix4(matrix).toArray();
    const normal = (x, y, z) => v.set(x, y, z).applyMatrix3(normalMatrix).normalize().toArray();
    const at = rings.map((ring) => rim.map((r) => point(
        r.x + ring.grow * r.nx, r.y + ring.grow * r.ny, ring.z)));
    const out = rings.map((ring) => rim.map(
        (r) => normal(r.nx * ring.nr, r.ny * ring.nr, ring.nz)));
    const count = rim.length, last = rings.length - 1;
    const part = 1 / hull.length;
    const centre = hull.reduce((a, p) => [a[0] + part * p[0], a[1] + part * p[1]], [0, 0]);
    const bottom = point(centre[0], centre[1], rings[0].z), down = normal(0, 0, -1);
    const top = point(centre[0], centre[1], rings[last].z), up = normal(0, 0, 1);
    for (let i = 0, j = count - 1; i < count; j = i++) {
      this.triangle(bottom, at[0][i], at[0][j], down, down, down);
      this.triangle(top, at[last][j], at[last][i], up, up, up);
      for (let k = 0; k < last; ++k) {
        const p = at[k], q = at[k + 1], m = out[k], n = out[k + 1];
        this.triangle(p[j], p[i], q[i], m[j], m[i], n[i]);
        this.triangle(p[j], q[i], q[j], m[j], n[i], n[j]);
      }
    }
  }

  geometry() {
    const geometry = new THREE.BufferGeometry();
    const add = (name, values) => geometry.setAttribute(name, new THREE.BufferAttribute(
        joined([values, ...this.pieces.map((piece) => piece[name].array)]), 3));
    add("position", this.positions);
    add("normal", this.normals);
    return geometry;
  }
}

let madeBall = null;

// A ball of radius one, which is made once.
function unitBall() {
  madeBall = madeBall || new THREE.SphereBufferGeometry(1, 24, 16).toNonIndexed();
  return madeBall;
}

// Lists of numbers one after the other.
function joined(lists) {
  const out = new Float32Array(lists.reduce((n, list) => n + list.length, 0));
  let at = 0;
  for (const list of lists) {
    out.set(list, at);
    at += list.length;
  }
  return out;
}

// A frame with its z axis along a direction.
function alongMatrix(origin, direction, scale) {
  const z = unit(direction), x = acrossFrom(z), y = cross(z, x);
  return new THREE.Matrix4().set(
      x[0] * scale, y[0] * scale, z[0] * scale, origin[0],
      x[1] * scale, y[1] * scale, z[1] * scale, origin[1],
      x[2] * scale, y[2] * scale, z[2] * scale, origin[2], 0, 0, 0, 1);
}

// Andrew's monotone chain, counter-clockwise; points nearer than `least` count as one.
function convexHull(points, least) {
  const sorted = points.slice().sort((a, b) => a[0] - b[0] || a[1] - b[1]);
  const apart = sorted.filter((p, i) => !sorted.slice(0, i).some(
      (q) => Math.hypot(p[0] - q[0], p[1] - q[1]) < least));
  if (apart.length < 3) return apart;
  const half = (list) => {
    const chain = [];
    for (const p of list) {
      while (chain.length > 1 && turn(chain[chain.length - 2], chain[chain.length - 1], p) <= 0) {
        chain.pop();
      }
      chain.push(p);
    }
    return chain.slice(0, -1);
  };
  return half(apart).concat(half(apart.slice().reverse()));
}

function turn(a, b, c) {
  return (b[0] - a[0]) * (c[1] - a[1]) - (b[1] - a[1]) * (c[0] - a[0]);
}

// Points of the hull with outward normals: at each corner an arc from one edge's normal to the
// next.
function rimOf(hull) {
  const rim = [], count = hull.length;
  const edge = (i) => {
    const a = hull[i % count], b = hull[(i + 1) % count];
    return Math.atan2(-(b[0] - a[0]), b[1] - a[1]);
  };
  for (let i = 0; i < count; ++i) {
    const begin = count > 1 ? edge(i + count - 1) : 0;
    let sweep = count > 1 ? edge(i) - begin : 2 * Math.PI;
    while (sweep < 0) sweep += 2 * Math.PI;
    const steps = Math.max(1, Math.ceil(kCorner * sweep / (2 * Math.PI)));
    for (let k = 0; k <= steps - (count > 1 ? 0 : 1); ++k) {
      const angle = begin + sweep * k / steps;
      rim.push({x: hull[i][0], y: hull[i][1], nx: Math.cos(angle), ny: Math.sin(angle)});
    }
  }
  return rim;
}
