// The panel of a live session: what the hand does, sliders of the joints, assembly modes, saving.

const kModeWords = {frozen: "standing still", held: "held", swinging: "swinging freely",
  haptic: "in the hand"};

class LivePanel {
  constructor(view, box) {
    this.view = view;
    this.session = view.session;
    this.status = make("p", {class: "vv-status", role: "status"});
    this.figures = make("tbody", {});
    box.append(this.status, make("table", {class: "vv-values"}, this.figures));
    this.rows = new Map();
    this.controls = make("fieldset", {class: "vv-controls"});
    this.files = make("p", {class: "vv-hint"});
    box.append(this.controls, this.files);
    if (this.session.kind !== "haptic") this.buildControls();
    view.on("writer", () => this.showStatus());
    view.on("state", (state) => this.showState(state));
    view.on("modes", (message) => this.showModes(message));
    view.on("files", (files) => this.offer(files));
    view.on("reshaped", () => this.forget());
    this.showStatus();
  }

  buildControls() {
    const {session, view} = this;
    const button = (text, message, title) => make("button", {class: "vv-button", text, title,
      on: {click: () => session.send(message)}});
    this.controls.append(
        tick("Stays where I let go", view.keeps, (on) => { view.keeps = on; },
            "The spring stays and holds the mechanism; otherwise it swings freely"),
        make("div", {class: "vv-row"},
            button("Let go", {do: "release", keep: false}, "Nobody holds it (escape)"),
            button("Swing", {do: "swing"}, "Free motion"),
            button("Freeze", {do: "freeze"}, "Stands still"),
            button("Reset", {do: "reset"}, "Back to the start")),
        this.buildSliders(), this.buildModes(),
        make("div", {class: "vv-row"},
            button("Save the pose", {do: "save", what: "mechanism"}, "As a mechanism file"),
            button("Save the drag", {do: "save", what: "motion"},
                "As a study of vmech loads, with its mechanism and table")));
  }

  // Of a mechanism with other numbers the assembly modes are others, and so may be its limits.
  forget() {
    if (this.modes) this.modes.replaceChildren();
    for (const slider of this.sliders || []) this.boundSlider(slider);
  }

  // One file is saved at once; of several, which a browser would ask about, each by its link.
  offer(files) {
    const blob = (file) => new Blob([file.text], {type: "text/plain"});
    for (const link of this.files.children) URL.revokeObjectURL(link.href);
    this.files.replaceChildren();
    if (files.length === 1) download(files[0].name, blob(files[0]));
    else files.forEach((file) => this.files.append(savingLink(file.name, blob(file)), " "));
  }

  buildSliders() {
    const {scene} = this.view, box = make("div", {class: "vv-sliders"});
    this.sliders = [];
    scene.joints.forEach((joint, index) => {
      if (joint.type === "spherical") return;  // has no single coordinate to set
      joint.freedoms.forEach((freedom, k) => {
        box.append(this.buildSlider(joint, index, freedom, k));
      });
    });
    return make("details", {class: "vv-group"}, make("summary", {text: "Joints"}), box);
  }

  buildSlider(joint, index, freedom, k) {
    const {name, factor} = freedomUnit(this.view.scene, freedom);
    const input = make("input", {type: "range", step: "any",
      "aria-label": freedom.name || joint.name});
    const out = make("output", {});
    const slider = {input, out, at: joint.at + k, factor, unit: name, joint: index, freedom: k};
    input.addEventListener("input", () => this.session.sendSoon("slide",
        {do: "slide", joint: index, freedom: k, value: Number(input.value)}));
    this.boundSlider(slider);
    this.sliders.push(slider);
    return make("label", {class: "vv-slider"}, make("span", {text: freedom.name || joint.name}),
        input, out);
  }

  boundSlider({input, joint, freedom}) {
    const {scene} = this.view, settings = scene.joints[joint].freedoms[freedom];
    const reach = settings.rotation ? Math.PI : scene.length;
    input.min = Number.isFinite(settings.lower) ? settings.lower : -reach;
    input.max = Number.isFinite(settings.upper) ? settings.upper : reach;
  }

  buildModes() {
    this.modes = make("div", {class: "vv-modes"});
    const find = make("button", {class: "vv-button", text: "Find the assembly modes",
      on: {click: () => this.session.send({do: "modes"})}});
    return make("details", {class: "vv-group"}, make("summary", {text: "Assembly modes"}), find,
        this.modes);
  }

  showModes(message) {
    const {view} = this;
    const compare = make("select", {"aria-label": "Compare with", on: {change: () => {
      const chosen = message.modes[Number(compare.value)];
      view.compare(chosen ? chosen.poses.flat() : null);
    }}}, make("option", {value: -1, text: "compare with none"}), ...message.modes.map(
        (_, index) => make("option", {value: index, text: "compare with mode " + (index + 1)})));
    this.modes.replaceChildren(
        make("p", {class: "vv-hint",
          text: message.modes.length + " found. " + (message.note || "")}),
        make("div", {class: "vv-row"}, ...message.modes.map((_, index) => make("button",
            {class: "vv-button", text: "Mode " + (index + 1),
              on: {click: () => this.session.send({do: "mode", index: index})}}))), compare);
  }

  showStatus() {
    const words = {connecting: "Looking for the server.", gone:
        "The server is gone. Trying again each second.", watching:
        "Watching only: another page has hold of this session.",
    writer: this.session.kind === "haptic" ? "Shows the hand." : "Drag any link with the mouse."};
    const {state} = this.session;
    setText(this.status, words[state]);
    this.status.dataset.state = state;
    this.controls.disabled = state !== "writer";
    this.view.showBanner(state === "gone" ? words.gone : "");
    if (state === "watching" && !this.ask) {
      this.ask = make("button", {class: "vv-button", text: "Ask to take hold",
        on: {click: () => this.session.send({do: "write"})}});
      this.status.after(this.ask);
    } else if (state !== "watching" && this.ask) {
      this.ask.remove();
      this.ask = null;
    }
  }

  showState(state) {
    const stamp = performance.now();
    if (stamp - (this.filled || 0) < kValuesPeriod && !state.stopped) return;
    this.filled = stamp;
    this.figure("it is", kModeWords[state.mode] || state.mode, "");
    this.figure("time", shown(state.time), "s");
    if (state.hand) this.figure("force of the hand", shown(lengthOf(state.hand.force)), "N");
    else this.drop("force of the hand");
    if (Number.isFinite(state.closure)) {
      this.figure("loops open by", state.closure.toExponential(1), "");
    }
    if (state.rows !== undefined) this.figure("drag recorded", String(state.rows), "rows");
    const limits = (state.at_limit || []).map((joint) => this.view.scene.joints[joint].name);
    if (limits.length) this.figure("at a limit", limits.join(", "), "");
    else this.drop("at a limit");
    if (state.haptic) this.showHaptic(state.haptic);
    for (const slider of this.sliders || []) this.fillSlider(slider, state);
    if (state.stopped) this.view.say("It goes no further: a limit, or the end of what its loops allow.");
  }

  showHaptic(haptic) {
    for (const [name, wrench] of [["constraint", haptic.constraint], ["dynamic", haptic.dynamic]]) {
      if (!wrench) continue;
      this.figure(name + " force", shown(Math.hypot(wrench[0], wrench[1], wrench[2])), "N");
      this.figure(name + " moment", shown(Math.hypot(wrench[3], wrench[4], wrench[5])), "N m");
    }
    for (const figure of haptic.figures || []) {
      this.figure(figure.name, shown(figure.value), figure.unit);
    }
  }

  fillSlider(slider, state) {
    const value = state.coordinates[slider.at];
    if (document.activeElement !== slider.input) slider.input.value = value;
    setText(slider.out, shown(slider.factor * value) + " " + slider.unit);
    slider.out.classList.toggle("vv-limit", (state.at_limit || []).includes(slider.joint));
  }

  figure(name, value, unitName) {
    let row = this.rows.get(name);
    if (!row) {
      row = {out: make("td", {class: "vv-number"})};
      row.element = make("tr", {}, make("th", {text: name, scope: "row"}), row.out,
          make("td", {class: "vv-unit", text: unitName}));
      this.rows.set(name, row);
      this.figures.append(row.element);
    }
    setText(row.out, value);
  }

  drop(name) {
    const row = this.rows.get(name);
    if (row) row.element.remove();
    this.rows.delete(name);
  }
}
