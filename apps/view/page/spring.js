// The spring between the hand and the held point, drawn as a coil, with its force in newtons.

const kCoils = 9;
const kCoilSteps = 12;  // a coil

class Spring {
  constructor(view) {
    this.view = view;
    this.size = view.shapes.sizes.rod;
    const count = kCoils * kCoilSteps + 1;
    this.geometry = new THREE.BufferGeometry();
    this.geometry.setAttribute("position",
        new THREE.BufferAttribute(new Float32Array(3 * count), 3).setUsage(THREE.DynamicDrawUsage));
    const colour = shade(kForceColours.hand);
    this.coil = new THREE.Line(this.geometry, new THREE.LineBasicMaterial({color: colour,
      depthTest: false, transparent: true}));
    this.coil.frustumCulled = false;
    this.coil.renderOrder = 6;
    const ball = new THREE.SphereBufferGeometry(0.9 * this.size, 20, 14);
    const material = new THREE.MeshBasicMaterial({color: colour, depthTest: false,
      transparent: true});
    this.held = new THREE.Mesh(ball, material);
    this.hand = new THREE.Mesh(ball, material);
    this.held.renderOrder = this.hand.renderOrder = 6;
    this.root = new THREE.Group();
    this.root.add(this.coil, this.held, this.hand);
    this.root.visible = false;
    this.label = make("output", {class: "vv-force", hidden: ""});
    view.stage.box.append(this.label);
    view.on("drawn", () => this.placeLabel());
  }

  // Between `point` and `target`, or nothing.
  update(now) {
    const {hand, haptic} = now;
    const from = hand ? hand.point : haptic ? haptic.grasp : null;
    const to = hand ? hand.target : haptic ? haptic.hand : null;
    this.root.visible = Boolean(from && to);
    this.label.hidden = !hand;
    if (!this.root.visible) return;
    this.from = from;
    this.held.position.set(from[0], from[1], from[2]);
    this.hand.position.set(to[0], to[1], to[2]);
    this.wind(from, to);
    if (hand) setText(this.label, shown(lengthOf(hand.force)) + " N");
  }

  wind(from, to) {
    const step = sum(to, from, -1), long = lengthOf(step);
    const way = long > 0 ? unit(step) : [0, 0, 1], x = acrossFrom(way), y = cross(way, x);
    const p = this.geometry.attributes.position.array, last = kCoils * kCoilSteps;
    for (let i = 0; i <= last; ++i) {
      const part = i / last, angle = 2 * Math.PI * i / kCoilSteps;
      const ends = Math.min(1, 8 * part, 8 * (1 - part));
      const wide = Math.min(this.size, 0.2 * long) * ends;
      for (let k = 0; k < 3; ++k) {
        p[3 * i + k] = from[k] + part * step[k] +
            wide * (Math.cos(angle) * x[k] + Math.sin(angle) * y[k]);
      }
    }
    this.geometry.attributes.position.needsUpdate = true;
  }

  placeLabel() {
    if (this.label.hidden) return;
    const at = this.view.stage.pixelOf(this.hand.position.toArray());
    this.label.style.transform = "translate(" + (at[0] + 14).toFixed(1) + "px," +
        (at[1] - 12).toFixed(1) + "px)";
  }
}
