// Names of everything in a tree. What is under the pointer here is lit in the picture, and
// the other way round.

class Tree {
  constructor(view, box) {
    this.view = view;
    this.items = new Map();
    const {scene} = view;
    box.append(
        this.group("Links", scene.links.map((link, index) => this.item("link", index, link.name,
            linkColour(scene, index), index === scene.ground ? "ground" : ""))),
        this.group("Joints", scene.joints.map((joint, index) => this.item("joint", index,
            joint.name, null, joint.type + (joint.cut ? ", cut" : "")))));
    if (scene.grasps.length) box.append(this.group("Grasps", scene.grasps.map(
        (grasp, index) => this.item("grasp", index, grasp.name, null, "on " +
            scene.links[grasp.link].name))));
    view.on("picked", () => this.mark());
    view.on("hovered", () => this.mark());
  }

  group(title, items) {
    return make("details", {class: "vv-group", open: ""},
        make("summary", {}, make("span", {text: title}), make("small", {text: items.length})),
        make("ul", {}, ...items));
  }

  item(kind, index, name, colour, remark) {
    const swatch = make("i", {class: "vv-swatch vv-" + kind});
    if (colour) swatch.style.background = colour;
    const button = make("button", {class: "vv-item", "aria-pressed": "false", on: {
      click: () => this.view.pick(kind, index),
      pointerenter: () => this.view.hover(kind, index),
      pointerleave: () => this.view.hover(null, null),
      focus: () => this.view.hover(kind, index), blur: () => this.view.hover(null, null)}},
      swatch, make("span", {class: "vv-name", text: name}), make("small", {text: remark}));
    this.items.set(kind + index, button);
    return make("li", {}, button, kind === "link" ? this.glass(index, name) : null);
  }

  // A button that makes a link glass.
  glass(link, name) {
    const {nodes} = this.view;
    const button = make("button", {class: "vv-glass", title: "Glass: look and reach through it",
      "aria-label": "Glass: " + name, "aria-pressed": String(nodes.glass.has(link)),
      on: {click: () => {
        const on = !nodes.glass.has(link);
        this.view.makeGlass(link, on);
        button.setAttribute("aria-pressed", String(on));
      }}});
    return button;
  }

  mark() {
    const {picked, hovered} = this.view;
    for (const [key, button] of this.items) {
      const is = (what) => Boolean(what) && what.kind + what.index === key;
      button.classList.toggle("vv-hovered", is(hovered));
      button.setAttribute("aria-pressed", String(is(picked)));
    }
  }
}

// What is drawn beside the bodies, as check boxes.
const kToggles = [
  ["forces", "Joint forces"], ["moments", "Joint moments"], ["loads", "External loads"],
  ["weights", "Weights"], ["paths", "Paths"], ["frames", "Frames"],
  ["centres", "Centres of gravity"], ["grasps", "Grasps"], ["cuts", "Cut joints"],
  ["limits", "Limits"], ["grid", "Floor"]];

function toggles(view) {
  const box = make("div", {class: "vv-ticks"});
  const {scene} = view, motion = scene.motion;
  const useless = {loads: !(motion && (motion.loads.length || motion.hand)),
    grasps: !scene.grasps.length, cuts: !scene.joints.some((joint) => joint.cut),
    forces: !(motion && motion.wrenches) && !scene.session,
    moments: !(motion && motion.wrenches) && !scene.session};
  for (const [name, text] of kToggles) {
    if (useless[name]) continue;
    box.append(tick(text, view.shown[name], (on) => view.show(name, on)));
  }
  const scale = make("input", {type: "range", min: -1, max: 1, step: "any", value: 0,
    "aria-label": "Length of the arrows", on: {input: () => {
      view.forces.scaleUp = Math.pow(10, Number(scale.value));
      view.moved();
    }}});
  return make("div", {}, box, legend(view), useless.forces ? null
      : make("label", {class: "vv-scale"}, make("span", {text: "Length of the arrows"}), scale));
}

function legend(view) {
  const entries = [["certain", "force, certain"], ["undetermined", "force, not determined"]];
  const list = make("p", {class: "vv-legend"});
  if (!view.scene.motion && !view.scene.session) return list;
  for (const [name, text] of entries) {
    const mark = make("i", {});
    mark.style.background = "#" + kForceColours[name].toString(16).padStart(6, "0");
    list.append(make("span", {}, mark, make("span", {text})));
  }
  return list;
}
