// Meshes: binary STL, made smooth where its faces meet at less than kCrease.

const kCrease = Math.cos(32 * Math.PI / 180);

function readStl(base64) {
  const bytes = bytesOf(base64);
  const view = new DataView(bytes.buffer);
  const count = bytes.length < 84 ? 0 : Math.min(view.getUint32(80, true),
      Math.floor((bytes.length - 84) / 50));
  const positions = new Float32Array(9 * count);
  for (let i = 0, at = 84; i < count; ++i, at += 50) {
    for (let k = 0; k < 9; ++k) {
      const value = view.getFloat32(at + 12 + 4 * k, true);
      positions[9 * i + k] = Number.isFinite(value) ? value : 0;
    }
  }
  const geometry = new THREE.BufferGeometry();
  geometry.setAttribute("position", new THREE.BufferAttribute(positions, 3));
  geometry.setAttribute("normal", new THREE.BufferAttribute(smoothNormals(positions, count), 3));
  return geometry;
}

// Twice the area times the normal of every face.
function faceNormals(p, count) {
  const faces = new Float32Array(3 * count);
  for (let i = 0; i < count; ++i) {
    const a = 9 * i;
    const ux = p[a + 3] - p[a], uy = p[a + 4] - p[a + 1], uz = p[a + 5] - p[a + 2];
    const vx = p[a + 6] - p[a], vy = p[a + 7] - p[a + 1], vz = p[a + 8] - p[a + 2];
    faces[3 * i] = uy * vz - uz * vy;
    faces[3 * i + 1] = uz * vx - ux * vz;
    faces[3 * i + 2] = ux * vy - uy * vx;
  }
  return faces;
}

// For every corner the next corner at the same point, in a ring, by open addressing on the bits.
function ringsOfCorners(positions, corners) {
  const bits = new Uint32Array(positions.buffer);
  let size = 1;
  while (size < 2 * corners) size *= 2;
  const table = new Int32Array(size).fill(-1), next = new Int32Array(corners);
  for (let c = 0; c < corners; ++c) {
    const x = bits[3 * c], y = bits[3 * c + 1], z = bits[3 * c + 2];
    let slot = Math.imul(x, 73856093) ^ Math.imul(y, 19349663) ^ Math.imul(z, 83492791);
    slot = (slot ^ (slot >>> 15)) & (size - 1);
    for (;;) {
      const other = table[slot];
      if (other < 0) { table[slot] = c; next[c] = c; break; }
      if (bits[3 * other] === x && bits[3 * other + 1] === y && bits[3 * other + 2] === z) {
        next[c] = next[other];
        next[other] = c;
        break;
      }
      slot = (slot + 1) & (size - 1);
    }
  }
  return next;
}

function smoothNormals(positions, count) {
  const faces = faceNormals(positions, count);
  const next = ringsOfCorners(positions, 3 * count);
  const sizes = new Float32Array(count);
  for (let i = 0; i < count; ++i) {
    sizes[i] = Math.hypot(faces[3 * i], faces[3 * i + 1], faces[3 * i + 2]);
  }
  const normals = new Float32Array(9 * count);
  for (let c = 0; c < 3 * count; ++c) {
    const f = (c / 3) | 0, fx = faces[3 * f], fy = faces[3 * f + 1], fz = faces[3 * f + 2];
    let x = fx, y = fy, z = fz;
    for (let other = next[c]; other !== c; other = next[other]) {
      const g = (other / 3) | 0, gx = faces[3 * g], gy = faces[3 * g + 1], gz = faces[3 * g + 2];
      if (fx * gx + fy * gy + fz * gz <= kCrease * sizes[f] * sizes[g]) continue;
      x += gx;
      y += gy;
      z += gz;
    }
    const size = Math.sqrt(x * x + y * y + z * z);
    normals[3 * c] = size > 0 ? x / size : 0;
    normals[3 * c + 1] = size > 0 ? y / size : 0;
    normals[3 * c + 2] = size > 0 ? z / size : 1;
  }
  return normals;
}
