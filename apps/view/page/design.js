// The panel that varies the design: a slider for each free parameter. The mechanism follows what is
// asked gradually; a mark on each slider shows what it has reached.

// Times [ms] for which what was asked here counts for more than news of the server.
const kPatience = 700;
const kFlight = 120;    // news that it goes no further may be older than the question

// One parameter: its slider, its field and the mark.
class ParameterRow {
  constructor(parameter, design, index) {
    this.parameter = parameter;
    this.design = design;
    this.index = index;
    this.now = this.asked = parameter.value;
    this.askedAt = -Infinity;
    this.held = false;     // the thumb is under a pointer
    this.editing = false;  // somebody types
    this.build();
    this.show();
  }

  build() {
    const {name, unit, lower, upper} = this.parameter, label = unit ? name + " in " + unit : name;
    this.slider = make("input", {type: "range", step: "any", min: lower, max: upper,
      "aria-label": label, on: {
        pointerdown: () => { this.held = true; },
        input: () => this.ask(Number(this.slider.value)), change: () => this.letGo()}});
    this.field = make("input", {type: "text", inputmode: "decimal", class: "vv-field",
      autocomplete: "off", spellcheck: "false", "aria-label": label + ", as a number",
      on: {input: () => { this.editing = true; }, change: () => this.apply(),
        blur: () => this.apply(), keydown: (event) => this.key(event)}});
    this.reached = make("small", {class: "vv-reached"});
    this.mark = make("i", {class: "vv-reached-mark", hidden: ""});
    this.element = make("div", {class: "vv-parameter", role: "group", "aria-label": name},
        make("div", {class: "vv-parameter-head"}, make("span", {class: "vv-name", text: name}),
            this.reached, this.field, make("small", {class: "vv-unit", text: unit || ""})),
        make("div", {class: "vv-parameter-way"}, make("small", {text: plain(lower)}),
            make("div", {class: "vv-track"}, this.slider, this.mark),
            make("small", {text: plain(upper)})));
  }

  // Keys of the field are its own, not those of the page.
  key(event) {
    event.stopPropagation();
    if (event.key === "Enter") this.apply();
    if (event.key === "Escape") this.stopEditing();
  }

  stopEditing() {
    this.editing = false;
    this.field.removeAttribute("aria-invalid");
    this.show();
  }

  apply() {
    if (!this.editing) return;
    const {name, unit, lower, upper} = this.parameter, text = this.field.value.trim();
    const value = text ? Number(text.replace(",", ".")) : NaN;
    if (value >= lower && value <= upper) {
      this.ask(value);
      return;
    }
    this.field.setAttribute("aria-invalid", "true");
    this.design.view.say(name + " is a number from " + plain(lower) + " to " + plain(upper) +
        (unit ? " " + unit : "") + ".", true);
  }

  ask(value) {
    this.asked = value;
    this.askedAt = performance.now();
    this.design.ask(this.index, value);
    this.stopEditing();
  }

  letGo() {
    this.held = false;
    this.show();
  }

  // News of the server. Where it goes no further, the slider goes back to what was reached, once
  // nobody holds it.
  follow(now, asked, stopped) {
    this.now = now;
    const own = performance.now() - this.askedAt < (stopped ? kFlight : kPatience);
    if (!this.held && !own) this.asked = stopped ? now : asked;
    this.show();
  }

  get isUnderWay() {
    const {lower, upper} = this.parameter;
    return Math.abs(this.now - this.asked) > 1e-3 * (upper - lower);
  }

  show() {
    const {lower, upper, unit} = this.parameter, under = this.isUnderWay;
    const part = upper > lower ? (this.now - lower) / (upper - lower) : 0;
    if (!this.held) this.slider.value = this.asked;
    this.slider.setAttribute("aria-valuetext", plain(this.asked) + " " + (unit || ""));
    if (!this.editing && this.field.value !== plain(this.asked)) {
      this.field.value = plain(this.asked);
    }
    this.mark.hidden = !under;
    this.mark.style.setProperty("--vv-part", Math.min(1, Math.max(0, part)).toFixed(5));
    setText(this.reached, under ? "now " + shown(this.now) : "");
  }
}

// A number as one types it.
function plain(value) {
  return String(Number(Number(value).toPrecision(6)));
}

class Design {
  constructor(view, box) {
    this.view = view;
    this.session = view.session;
    this.rows = view.scene.session.parameters.map(
        (parameter, index) => new ParameterRow(parameter, this, index));
    this.stopped = make("p", {class: "vv-stopped", role: "status", hidden: ""});
    this.work = make("p", {class: "vv-hint"});
    const button = (text, title, click) => make("button", {class: "vv-button", text, title,
      on: {click}});
    this.controls = make("fieldset", {class: "vv-controls", "aria-label": "Design"},
        ...this.rows.map((row) => row.element), this.stopped,
        make("div", {class: "vv-row"},
            button("Reset design", "Back to the values of the file", () => this.reset()),
            button("Save into the file", "The file with the values that the mechanism has now",
                () => this.session.send({do: "save", what: "parameters"}))));
    box.append(this.controls, this.work);
    this.outcome = new Outcome(view, box);
    // A thumb may be let go anywhere.
    const letGo = () => this.rows.forEach((row) => row.letGo());
    listen(window, {pointerup: letGo, pointercancel: letGo, blur: letGo});
    view.on("writer", () => this.showWriter());
    view.on("state", (state) => { if (state.design) this.show(state.design); });
    view.on("reshaped", () => this.sayMeshes());
    this.showWriter();
  }

  showWriter() {
    this.controls.disabled = !this.session.writer;
  }

  ask(index, value) {
    this.session.sendSoon("vary " + index, {do: "vary", parameter: index, value});
  }

  reset() {
    for (const row of this.rows) {
      row.stopEditing();
      row.ask(row.parameter.value);
    }
  }

  show(design) {
    this.rows.forEach((row, index) => row.follow(
        design.values[index], design.asked[index], Boolean(design.stopped)));
    this.stopped.hidden = !design.stopped;
    setText(this.stopped, design.stopped || "");
    setText(this.work, Number.isFinite(design.work) && design.work !== 0 ? "The changes have done " +
        shown(design.work) + " J of work on the mechanism." : "");
  }

  // A mesh is a shape of its own, which no parameter changes.
  sayMeshes() {
    if (this.saidMeshes || !this.view.scene.links.some((link) => link.mesh)) return;
    this.saidMeshes = true;
    this.view.say("Parts that are drawn by meshes keep their shape: a mesh has no parameters.");
  }
}
