// The picture: renderer, lights, floor and the loop, which draws only when something has changed.

const kKeptTimes = 600;  // frames whose times are kept
const kCoarse = 0.6;

class Stage {
  constructor(view, box) {
    this.view = view;
    this.box = box;
    this.canvas = make("canvas", {class: "vv-canvas", tabindex: "0", role: "img",
      "aria-label": "The mechanism. Drag to turn, wheel to zoom, right drag to shift."});
    box.append(this.canvas);
    this.world = new THREE.Scene();
    this.eye = new Eye(view.shapes.up, view.shapes.sizes.length);
    this.frames = 0;
    this.scriptTimes = [];
    this.before = new Set();  // called with the time in seconds before each frame
    this.after = [];          // called once after the next frame
    this.plain = drawnBySoftware();
    this.renderer = makeRenderer(this.canvas, this.plain);
    this.rendererName = this.renderer ? nameOfRenderer(this.renderer.getContext()) : null;
    this.addLights();
    this.addFloor();
    this.triad = new Triad(box, this.eye, view.scene.gravity);
    this.resize = this.resize.bind(this);
    this.frame = this.frame.bind(this);
    new ResizeObserver(this.resize).observe(box);
    this.canvas.addEventListener("webglcontextrestored", () => this.invalidate());
    this.resize();
  }

  addLights() {
    const {up, east, north, length} = this.eye;
    this.sky = new THREE.HemisphereLight(0xffffff, 0x9aa4ae, 0.72);
    this.sky.position.fromArray(up);
    this.sun = new THREE.DirectionalLight(0xfff6ea, 0.72);
    this.sun.castShadow = !this.plain;
    this.sun.shadow.mapSize.set(1024, 1024);
    this.sun.shadow.radius = 3;
    this.sun.shadow.bias = -0.0012;
    this.sunWay = unit(sum(sum(up.map((v) => 2.2 * v), east, 0.7), north, -1.1));
    this.fill = new THREE.DirectionalLight(0xdfeaff, 0.32);
    this.world.add(this.sky, this.sun, this.sun.target, this.fill);
    this.length = length;
  }

  addFloor() {
    this.floor = new THREE.Group();
    this.shadow = new THREE.Mesh(new THREE.PlaneBufferGeometry(1, 1),
        new THREE.ShadowMaterial({opacity: 0.16}));
    this.shadow.receiveShadow = true;
    this.floor.add(this.shadow);
    this.world.add(this.floor);
  }

  // Floor and light for a mechanism that sweeps these points.
  surround(points) {
    const {eye} = this, along = (axis) => points.map((p) => dot(p, axis));
    const middle = (values) => 0.5 * (Math.min(...values) + Math.max(...values));
    const x = along(eye.east), y = along(eye.north), z = along(eye.up);
    const low = points.length ? Math.min(...z) - 0.16 * this.length : 0;
    const centre = points.length ? [middle(x), middle(y)] : [0, 0];
    const size = Math.max(this.length, ...x.map((v) => Math.abs(v - centre[0])),
        ...y.map((v) => Math.abs(v - centre[1])), ...z.map((v) => v - low));
    const step = niceStep(size / 6), half = Math.ceil(1.6 * size / step);
    const corner = [Math.round(centre[0] / step) * step, Math.round(centre[1] / step) * step];
    this.floor.matrixAutoUpdate = false;
    this.floor.matrix.makeBasis(vectorOf(eye.east), vectorOf(eye.north), vectorOf(eye.up))
        .multiply(new THREE.Matrix4().makeTranslation(corner[0], corner[1], low));
    this.shadow.scale.set(2 * half * step, 2 * half * step, 1);
    if (this.grid) {
      this.floor.remove(this.grid);
      this.grid.geometry.dispose();
      this.grid.material.dispose();
    }
    this.grid = gridLines(half, step);
    this.floor.add(this.grid);
    this.step = step;
    const origin = sum(sum(eye.east.map((v) => v * centre[0]), eye.north, centre[1]), eye.up, low);
    this.aimSun(origin, 1.7 * size);
    this.tint();
  }

  aimSun(origin, reach) {
    this.sun.target.position.fromArray(origin);
    this.sun.position.fromArray(sum(origin, this.sunWay, 3 * reach));
    const camera = this.sun.shadow.camera;
    Object.assign(camera, {left: -reach, right: reach, top: reach, bottom: -reach,
      near: 0.5 * reach, far: 6 * reach});
    camera.updateProjectionMatrix();
  }

  // Colours of the theme.
  tint() {
    const {theme} = this.view;
    if (this.renderer) this.renderer.setClearColor(new THREE.Color(theme.colour("--vv-stage")), 1);
    if (this.grid) this.grid.material.color = shade(theme.colour("--vv-grid"));
    this.shadow.material.opacity = theme.dark ? 0.4 : 0.17;
    this.sky.intensity = theme.dark ? 0.6 : 0.72;
    this.invalidate();
  }

  resize() {
    const width = Math.max(1, this.box.clientWidth), height = Math.max(1, this.box.clientHeight);
    Object.assign(this, {width, height});
    this.eye.aspect = width / height;
    if (this.renderer) {
      this.renderer.setPixelRatio(this.ratio());
      this.renderer.setSize(width, height, false);
    }
    this.triad.resize();
    this.invalidate();
  }

  // Pixels of the picture to one of the page. Where software draws, a moving picture is coarser, so
  // that it follows the hand; it becomes fine when it rests.
  ratio() {
    const coarse = this.plain && this.before.size > 0 && !this.recording;
    return coarse ? kCoarse : Math.min(2, window.devicePixelRatio || 1);
  }

  // Whether the picture has another fineness than it should.
  isUnlike() {
    return Boolean(this.renderer) && this.renderer.getPixelRatio() !== this.ratio();
  }

  sharpen() {
    if (!this.isUnlike()) return;
    this.renderer.setPixelRatio(this.ratio());
    this.dirty = true;
  }

  invalidate() {
    this.dirty = true;
    this.ask();
  }

  ask() {
    if (!this.asked) {
      this.asked = true;
      requestAnimationFrame(this.frame);
    }
  }

  frame(stamp) {
    this.asked = false;
    const begin = performance.now();
    for (const work of this.before) work(stamp / 1000);
    this.sharpen();
    if (this.dirty) this.draw();
    const after = this.after;
    this.after = [];
    for (const work of after) work();
    this.shownAt = this.shownAt || performance.now();  // ms from the beginning of the page
    if (this.scriptTimes.length === kKeptTimes) this.scriptTimes.shift();
    this.scriptTimes.push(performance.now() - begin);
    if (this.before.size || this.isUnlike()) this.ask();
  }

  draw() {
    this.dirty = false;
    ++this.frames;
    this.eye.apply();
    this.fill.position.fromArray(sum(this.eye.back(), this.eye.above(), 0.35));
    if (this.renderer) this.renderer.render(this.world, this.eye.camera);
    this.triad.draw(this.view.theme);
    this.view.emit("drawn");
  }

  // Pixels of a point of the world within the picture.
  pixelOf(point) {
    const v = vectorOf(point).project(this.eye.camera);
    return [0.5 * (1 + v.x) * this.width, 0.5 * (1 - v.y) * this.height];
  }

  // Pixels of a point of the world in the window, where a mouse would point at it.
  screenOf(point) {
    this.eye.apply();
    const at = this.pixelOf(point), box = this.canvas.getBoundingClientRect();
    return [box.left + at[0], box.top + at[1]];
  }

  // A ray of three.js through a mouse position.
  rayAt(event) {
    const box = this.canvas.getBoundingClientRect();
    this.caster = this.caster || new THREE.Raycaster();
    this.caster.setFromCamera({x: 2 * (event.clientX - box.left) / box.width - 1,
      y: 1 - 2 * (event.clientY - box.top) / box.height}, this.eye.camera);
    return this.caster;
  }
}

function contextOf(canvas, settings) {
  return canvas.getContext("webgl2", settings) || canvas.getContext("webgl", settings);
}

// Without a graphics processor the picture does without shadows and smooth edges, so that it
// follows the hand; an address that ends in #fine has them all the same.
function drawnBySoftware() {
  if (location.hash === "#fine") return false;
  const context = contextOf(document.createElement("canvas"), {});
  if (!context) return false;
  const name = nameOfRenderer(context), loss = context.getExtension("WEBGL_lose_context");
  if (loss) loss.loseContext();
  return /swiftshader|llvmpipe|softpipe|software|basic render/i.test(name);
}

// Null where the browser has no WebGL.
function makeRenderer(canvas, plain) {
  const context = contextOf(canvas, {antialias: !plain, alpha: false});
  if (!context) return null;
  const renderer = new THREE.WebGLRenderer({canvas: canvas, context: context});
  renderer.gammaOutput = true;
  renderer.gammaFactor = 2.2;
  renderer.shadowMap.enabled = !plain;
  renderer.shadowMap.type = THREE.PCFSoftShadowMap;
  return renderer;
}

function nameOfRenderer(context) {
  const extension = context.getExtension("WEBGL_debug_renderer_info");
  return String(context.getParameter(extension ? extension.UNMASKED_RENDERER_WEBGL
                                               : context.RENDERER));
}

// 1, 2 or 5 times a power of ten, not below the value.
function niceStep(value) {
  const power = Math.pow(10, Math.floor(Math.log10(value)));
  return [1, 2, 5, 10].find((factor) => factor * power >= value * (1 - 1e-9)) * power;
}

function gridLines(half, step) {
  const lines = [], end = half * step;
  for (let i = -half; i <= half; ++i) {
    lines.push(i * step, -end, 0, i * step, end, 0, -end, i * step, 0, end, i * step, 0);
  }
  const geometry = new THREE.BufferGeometry();
  geometry.setAttribute("position", new THREE.Float32BufferAttribute(lines, 3));
  return new THREE.LineSegments(geometry, new THREE.LineBasicMaterial({transparent: true,
    opacity: 0.55}));
}
