// Numbers of what is picked, at the instant that is shown: a joint's coordinates and load with its
// certainty, a link's mass and pose; without a pick every joint's load.

const kValuesPeriod = 90;  // ms between two fillings while the mechanism moves
const kWrenchNames = ["force x", "force y", "force z", "moment x", "moment y", "moment z"];

class Values {
  constructor(view, box) {
    this.view = view;
    this.box = box;
    this.last = 0;
    this.waiting = 0;
    view.on("picked", () => this.rebuild());
    view.on("paused", () => this.fill());
    view.on("writer", () => this.rebuild());
    this.rebuild();
  }

  rebuild() {
    const {picked, scene} = this.view;
    this.rows = [];
    this.box.replaceChildren();
    if (!picked) this.buildAll();
    else if (picked.kind === "joint") this.buildJoint(scene.joints[picked.index], picked.index);
    else if (picked.kind === "link") this.buildLink(scene.links[picked.index], picked);
    else this.buildGrasp(scene.grasps[picked.index], picked.index);
    this.fill();
  }

  title(text, remark) {
    this.box.append(make("h3", {class: "vv-picked"}, make("span", {text}),
        make("small", {text: remark}),
        make("button", {class: "vv-close", title: "Back to all joints", text: "×",
          "aria-label": "Back to all joints", on: {click: () => this.view.pick(null, null)}})));
  }

  table(...heads) {
    const body = make("tbody", {});
    this.box.append(make("table", {class: "vv-values"}, heads.length ? make("thead", {},
        make("tr", {}, ...heads.map((text) => make("th", {text, scope: "col"})))) : null, body));
    return body;
  }

  // A row whose number is read again at each filling.
  row(body, name, unitName, read, word) {
    const out = make("td", {class: "vv-number"});
    const certainty = make("td", {class: "vv-word"});
    body.append(make("tr", {}, make("th", {text: name, scope: "row"}), out,
        make("td", {class: "vv-unit", text: unitName}), certainty));
    this.rows.push(() => {
      setText(out, shown(read()));
      if (word) setText(certainty, word());
    });
  }

  buildAll() {
    const {scene, now} = this.view;
    if (!now.wrenches && !scene.session) {
      this.box.append(make("p", {class: "vv-hint",
        text: "Click a link or a joint to read its numbers."}));
      return;
    }
    const body = this.table("joint", "force N", "moment N m", "");
    scene.joints.forEach((joint, index) => {
      const cells = [make("td", {class: "vv-number"}), make("td", {class: "vv-number"}),
        make("td", {class: "vv-word"})];
      body.append(make("tr", {}, make("th", {scope: "row"}, make("button", {class: "vv-plain",
        text: joint.name, on: {click: () => this.view.pick("joint", index)}})), ...cells));
      this.rows.push(() => this.fillJoint(index, cells));
    });
  }

  fillJoint(index, cells) {
    const {now} = this.view, w = now.wrenches, at = 6 * index;
    const words = now.certainty && now.certainty[index];
    setText(cells[0], w ? shown(Math.hypot(w[at], w[at + 1], w[at + 2])) : "–");
    setText(cells[1], w ? shown(Math.hypot(w[at + 3], w[at + 4], w[at + 5])) : "–");
    setText(cells[2], now.atLimit.includes(index) ? "at a limit"
        : isCertain(words, 0, w, at) && isCertain(words, 3, w, at) ? "" : "not determined");
  }

  buildJoint(joint, index) {
    const {scene, now} = this.view;
    this.title(joint.name, joint.type + (joint.cut ? ", cut here" : "") + " · " +
        scene.links[joint.first.link].name + " – " + scene.links[joint.second.link].name);
    const body = this.table();
    joint.freedoms.forEach((freedom, k) => {
      const {name, factor} = freedomUnit(scene, freedom);
      const at = joint.at + k;
      this.row(body, freedom.name || "coordinate", name, () => factor * now.coordinates[at]);
      this.row(body, "rate", name + "/s", () => factor * now.rates[at]);
    });
    kWrenchNames.forEach((name, k) => this.row(body, name, k < 3 ? "N" : "N m",
        () => (now.wrenches ? now.wrenches[6 * index + k] : NaN),
        () => (now.certainty && now.wrenches ? now.certainty[index][k] : "")));
    this.box.append(make("p", {class: "vv-hint", text: "Load of " +
        scene.links[joint.first.link].name + " on " + scene.links[joint.second.link].name +
        ", in the axes of the joint's first anchor."}));
  }

  buildLink(link, picked) {
    const {view} = this, {units} = view.scene, {now} = view, at = 7 * picked.index;
    this.title(link.name, picked.index === view.scene.ground ? "ground" : "link");
    const body = this.table();
    const mass = () => view.scene.links[picked.index].mass;
    if (mass() !== undefined) this.row(body, "mass", "kg", mass);
    "xyz".split("").forEach((axis, k) => this.row(body, "origin " + axis, units.length,
        () => now.poses[at + k] / units.metres));
    if (picked.point) {
      const world = [0, 0, 0];
      "xyz".split("").forEach((axis, k) => this.row(body, "clicked point " + axis, units.length,
          () => place(now.poses, at, picked.point, world)[k] / units.metres));
      this.pathButton(picked.index, picked.point, link.name);
    }
  }

  buildGrasp(grasp, index) {
    const {view} = this, {units} = view.scene, world = [0, 0, 0];
    const pose = () => view.scene.grasps[index].pose;
    this.title(grasp.name, "grasp on " + view.scene.links[grasp.link].name);
    const body = this.table();
    "xyz".split("").forEach((axis, k) => this.row(body, axis, units.length,
        () => place(view.now.poses, 7 * grasp.link, pose(), world)[k] / units.metres));
    this.pathButton(grasp.link, pose().slice(0, 3), grasp.name, index);
  }

  // `grasp`: whose point it is, if it is that of one.
  pathButton(link, point, name, grasp) {
    const {paths} = this.view;
    const same = paths.paths.find((path) => path.link === link &&
        lengthOf(sum(path.point, point, -1)) < 1e-9);
    this.box.append(make("button", {class: "vv-button",
      text: same ? "Remove its path" : "Draw its path", on: {click: () => {
        if (same) paths.remove(same); else paths.add(link, point, name, grasp);
        this.view.show("paths", true);
        this.rebuild();
      }}}));
  }

  // Fills now, or soon if that was done a moment ago.
  refresh() {
    const wait = this.last + kValuesPeriod - performance.now();
    if (wait <= 0) this.fill();
    else if (!this.waiting) this.waiting = setTimeout(() => this.fill(), wait);
  }

  fill() {
    clearTimeout(this.waiting);
    this.waiting = 0;
    this.last = performance.now();
    for (const row of this.rows) row();
  }
}

function setText(element, text) {
  if (element.textContent !== text) element.textContent = text;
}
