// The page's state and who is told of its changes: what is shown now, picked and hovered.

const kToolsHeight = 46;  // pixels of the picture under its tools

class View {
  constructor(root, scene) {
    this.root = root;
    this.scene = scene;
    this.listeners = {};
    this.now = makeNow(scene);
    this.picked = null;
    this.hovered = null;
    this.keeps = true;
    this.shown = {forces: true, moments: false, loads: true, weights: false, paths: true,
      frames: false, centres: false, grasps: scene.grasps.length > 0, cuts: false, limits: false,
      grid: true};
    this.shapes = new Shapes(scene);
    this.history = new History(scene);
    this.theme = new Theme(root, null);
  }

  get live() {
    return Boolean(this.session);
  }

  on(name, listener) {
    (this.listeners[name] = this.listeners[name] || []).push(listener);
  }

  emit(name, value) {
    for (const listener of this.listeners[name] || []) listener(value);
  }

  // Builds the picture and the panels into a layout's boxes.
  fill(boxes) {
    const {scene} = this;
    this.boxes = boxes;
    this.stage = new Stage(this, boxes.stage);
    this.nodes = new MechanismNodes(scene, this.shapes, this.stage.plain);
    this.marks = new Marks(scene, this.nodes, this.shapes);
    this.forces = new Forces(this);
    this.paths = new Paths(this);
    this.spring = new Spring(this);
    this.stage.world.add(this.nodes.root, this.forces.root, this.paths.root, this.spring.root);
    this.surround();
    this.orbit = new Orbit(this, this.stage.canvas, this.stage.eye);
    this.exports = new Exports(this);
    this.player = new Player(this, boxes.player);
    if (scene.session) this.session = new Session(this, scene.session);
    if (this.session) this.drag = new Drag(this);
    if (this.session) this.livePanel = new LivePanel(this, boxes.live);
    if (boxes.design) this.design = new Design(this, boxes.design);
    this.tree = new Tree(this, boxes.tree);
    this.values = new Values(this, boxes.values);
    this.plots = new Plots(this, boxes.plots);
    this.on("picked", () => this.plots.rebuild());
    this.plots.rebuild();
    this.theme.change = () => { this.stage.tint(); this.plots.rebuild(); };
    for (const [name, on] of Object.entries(this.shown)) this.show(name, on);
    scene.grasps.forEach((grasp, index) => {
      this.paths.add(grasp.link, grasp.pose.slice(0, 3), grasp.name, index);
    });
    this.normal = this.findNormal();
    this.lookWell();
    this.moved();
  }

  // The common axis of the pins of a mechanism that moves in a plane, in the world; else null.
  findNormal() {
    const inWorld = (joint) => rotate(this.now.poses, 7 * joint.first.link,
        axisOf(anchorOf(this.scene, joint, "first").pose, 2), [0, 0, 0]);
    const of = (type) => this.scene.joints.filter((joint) => joint.type === type).map(inWorld);
    const pins = of("revolute"), slides = of("prismatic");
    const planar = pins.length > 0 && pins.length + slides.length === this.scene.joints.length &&
        pins.every((axis) => isParallel(axis, pins[0])) &&
        slides.every((axis) => Math.abs(dot(axis, pins[0])) < 1e-6);
    return planar ? pins[0] : null;
  }

  // A mechanism in one plane is seen almost along its pins, another from a corner.
  lookWell() {
    const {eye} = this.stage, {normal} = this;
    if (normal && Math.abs(dot(normal, eye.up)) < 0.5) {
      const front = normal.some((v) => v > 0.7) ? normal : normal.map((v) => -v);
      const side = cross(eye.up, front);
      eye.lookFrom(sum(sum(front, side, 0.42), eye.up, 0.3));
    } else if (normal) {
      eye.lookFrom(sum(sum(eye.up.map((v) => 1.5 * v), eye.north, -1), eye.east, 0.35));
    } else {
      eye.lookFrom(sum(sum(eye.up.map((v) => 0.55 * v), eye.north, -1), eye.east, 0.62));
    }
    this.fit();
  }

  // Floor and light for where the mechanism reaches.
  surround() {
    this.swept = sweptPoints(this.scene, this.nodes);
    this.stage.surround(this.swept);
  }

  fit() {
    if (!this.swept) this.surround();
    const covered = Math.min(0.3, kToolsHeight / this.stage.height);
    this.stage.eye.fit(this.swept, 0.1 * this.shapes.sizes.length, covered);
    this.looked();
  }

  lookAlong(direction) {
    this.stage.eye.lookFrom(direction);
    this.fit();
  }

  // The eye has moved.
  looked() {
    this.stage.invalidate();
  }

  // The mechanism has other numbers: what is drawn by them is drawn anew. The eye, the floor, what is
  // picked and what is held stay.
  reshape(fresh) {
    const {scene} = this;
    if (!takeNumbers(scene, fresh)) {
      this.say("The mechanism has other parts now. Open this page anew.", true);
      return;
    }
    this.player.retire();
    this.compare(null);
    this.shapes.measure();
    this.nodes.rebuild();
    this.marks.rebuild();
    this.forces.measure();
    this.paths.rebuild();
    this.normal = this.findNormal();
    this.swept = null;  // until somebody wants to see all of it
    this.light();
    this.emit("reshaped");
    this.moved();
  }

  // The mechanism has moved.
  moved() {
    if (!this.values) return;
    const {now} = this;
    this.nodes.setPoses(now.poses);
    this.forces.update(now, this.shown);
    this.spring.update(now);
    if (this.shown.paths) this.paths.update(now);
    const limits = now.atLimit.join();
    if (limits !== this.limits) {
      this.limits = limits;
      this.light();
    }
    this.values.refresh();
    this.plots.draw();
    this.stage.invalidate();
  }

  show(name, on) {
    this.shown[name] = on;
    if (name in this.marks.groups) this.marks.show(name, on);
    if (name === "paths") this.paths.root.visible = on;
    if (name === "grid") this.stage.floor.visible = on;
    this.moved();
  }

  // A link is seen and reached through, or not.
  makeGlass(link, on) {
    this.nodes.makeGlass(link, on);
    this.stage.invalidate();
  }

  light() {
    this.nodes.highlight(this.hovered, this.picked, this.now.atLimit);
    this.stage.invalidate();
  }

  pick(kind, index, point) {
    const same = kind && !point && this.picked && this.picked.kind === kind &&
        this.picked.index === index;
    this.picked = kind && !same ? {kind, index, point} : null;
    this.light();
    this.emit("picked");
  }

  pickHit(hit) {
    const point = placeBack(this.now.poses, 7 * hit.link, hit.point, [0, 0, 0]);
    this.pick(hit.kind, hit.index, hit.kind === "link" ? point : undefined);
  }

  hover(kind, index, event) {
    const same = this.hovered ? this.hovered.kind === kind && this.hovered.index === index : !kind;
    if (!same) {
      this.hovered = kind ? {kind, index} : null;
      this.light();
      this.emit("hovered");
    }
    this.showName(event);
  }

  // The name of what is under the mouse, beside the mouse.
  showName(event) {
    const {hovered, boxes} = this;
    boxes.name.hidden = !(hovered && event);
    if (boxes.name.hidden) return;
    const list = hovered.kind === "joint" ? this.scene.joints : this.scene.links;
    const box = boxes.stage.getBoundingClientRect();
    setText(boxes.name, list[hovered.index].name);
    const left = event.clientX - box.left;
    boxes.name.style.transform = "translate(" + (left + 14) + "px," +
        (event.clientY - box.top + 14) + "px)" +
        (left > 0.6 * box.width ? " translateX(-105%)" : "");
  }

  // What is under the mouse: {kind, index, link, point in the world} or null.
  hitAt(event) {
    this.nodes.root.updateMatrixWorld();
    const hits = this.stage.rayAt(event).intersectObjects(this.nodes.reachable, false);
    return hits.length ? Object.assign({point: hits[0].point.toArray()}, hits[0].object.userData)
                       : null;
  }

  // Looked up once a frame at most.
  hoverAt(event) {
    this.pointer = event;
    if (this.looking) return;
    this.looking = true;
    this.stage.after.push(() => {
      this.looking = false;
      const hit = this.hitAt(this.pointer);
      if (hit) this.hover(hit.kind, hit.index, this.pointer); else this.hover(null, null);
      this.stage.canvas.classList.toggle("vv-over", Boolean(hit));
    });
    this.stage.ask();
  }

  clickAt(event) {
    const hit = this.hitAt(event);
    if (hit) this.pickHit(hit); else this.pick(null, null);
  }

  // In a live session the mouse takes hold of the link under it.
  takesHold(event) {
    return Boolean(this.session && this.session.writer && this.session.kind !== "haptic" &&
        this.drag.begin(event));
  }

  // A pale second mechanism at other poses, or none.
  compare(poses) {
    if (poses && !this.ghost) {
      this.ghost = this.nodes.makeGhost();
      this.stage.world.add(this.ghost);
    }
    if (poses) {
      this.ghost.setPoses(poses);
    } else if (this.ghost) {
      this.stage.world.remove(this.ghost);
      this.ghost.dispose();
      this.ghost = null;
    }
    this.stage.invalidate();
  }

  showBanner(text) {
    setText(this.boxes.banner, text);
    this.boxes.banner.hidden = !text;
  }

  // Something to read for a while.
  say(text, refused) {
    setText(this.boxes.note, text);
    this.boxes.note.hidden = false;
    this.boxes.note.classList.toggle("vv-refused", Boolean(refused));
    clearTimeout(this.noteTimer);
    this.noteTimer = setTimeout(() => { this.boxes.note.hidden = true; }, 6000);
  }
}
